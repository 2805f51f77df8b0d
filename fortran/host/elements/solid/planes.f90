! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Generalised plane strain: fibres between two rigid planes, which move against each other.
!>
!> The reference node X0, Y0 has the change w1 of the length of its fibre and the relative rotations w2, w3 of the planes about both
!> axes. The fibre at x, y has the length (Abaqus Theory Guide, Generalized plane strain elements)
!>
!>     t = t0 + w1 + w2 (y - Y0) - w3 (x - X0)
!>
!> and the strain ln(t/t0), which with small displacements is linear in w. The three are unknowns of the element, behind those
!> of its nodes. In elements with straight edges all points have the fibre of the middle of the nodes: so Abaqus' Verification Guide
!> shows it (Generalized plane strain elements with relative motion of bounding planes).
module host_planes
  use host_context, only: current
  use host_forces, only: add_axisymmetric_point, add_geometric, by_volume
  use host_kinds, only: dp
  use host_protect, only: escape
  use host_shape, only: is_quadratic, rule_t
  implicit none (type, external)
  private
  public :: planes_t, planes, add_curvature_of_fibres, add_stress_of_fibres, find_fibre

  integer, parameter :: planes = 3     !< unknowns of the reference node

  !> Two planes, and what their reference node has at the end of the increment, and its change.
  type :: planes_t
    real(dp) :: origin(2) = 0          !< X0, Y0
    real(dp) :: length = 1             !< t0
    real(dp) :: w(planes) = 0, dw(planes) = 0
  end type planes_t

contains

  !> Length of the fibre of a point over that before any displacement, and derivatives of the logarithm by the displacements of the
  !> nodes and by w. Leaves the pass if the planes have met.
  subroutine find_fibre(this, rule, point, x, w, ratio, by_nodes, by_planes)
    type(planes_t), intent(in) :: this
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: point
    real(dp), intent(in) :: x(2, rule%nodes), w(planes)
    real(dp), intent(out) :: ratio, by_nodes(2, rule%nodes), by_planes(planes)
    real(dp) :: n(rule%nodes), place(2)
    n = functions(rule, point)
    place = matmul(x, n) - this%origin
    ratio = 1 + (w(1) + w(2)*place(2) - w(3)*place(1))/this%length
    if (ratio <= 0) then
      current%distorted = point
      call escape()
    end if
    by_nodes(1, :) = -w(3)*n/(this%length*ratio)
    by_nodes(2, :) = w(2)*n/(this%length*ratio)
    by_planes = [1.0_dp, place(2), -place(1)]/(this%length*ratio)
  end subroutine find_fibre

  !> Shape functions at the fibre of a point.
  pure function functions(rule, point) result(n)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: point
    real(dp) :: n(rule%nodes)
    n = 1.0_dp/rule%nodes
    if (is_quadratic(rule)) n = rule%n(:, point)
  end function functions

  !> As add_geometric (host_forces), of all unknowns: b has the strains by the nodes, then by w; fibre the derivatives of the
  !> logarithm of the fibre, and ratio its length. The part of 33 is 33 times the second derivatives of the logarithm.
  subroutine add_stress_of_fibres(this, rule, point, g, fibre, ratio, stress, volume, modulus, stiffness)
    type(planes_t), intent(in) :: this
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: point
    real(dp), intent(in) :: g(rule%nodes, 3)         !< the third is zero
    real(dp), intent(in) :: fibre(2*rule%nodes + planes), ratio, stress(4), volume
    real(dp), intent(inout) :: modulus(4, 4), stiffness(2*rule%nodes + planes, 2*rule%nodes + planes)
    real(dp) :: by_product(rule%nodes)
    integer :: i, n
    n = 2*rule%nodes
    call add_geometric(2, 3, 4, rule%nodes, g, stress, volume, modulus, stiffness(:n, :n))
    ! - 2 of the square of the strain are in the modulus, and one is here
    do i = 1, size(fibre)
      stiffness(:, i) = stiffness(:, i) + volume*stress(3)*fibre(i)*fibre
    end do
    by_product = volume*stress(3)*functions(rule, point)/(this%length*ratio)
    stiffness(2:n:2, n + 2) = stiffness(2:n:2, n + 2) + by_product
    stiffness(n + 2, 2:n:2) = stiffness(n + 2, 2:n:2) + by_product
    stiffness(1:n:2, n + 3) = stiffness(1:n:2, n + 3) - by_product
    stiffness(n + 3, 1:n:2) = stiffness(n + 3, 1:n:2) - by_product
  end subroutine add_stress_of_fibres

  !> As add_curvature (host_mean_volume): tangent of a given multiple of a stress, volume included.
  subroutine add_curvature_of_fibres(this, rule, point, g, b, fibre, ratio, unit, multiple, stiffness)
    type(planes_t), intent(in) :: this
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: point
    real(dp), intent(in) :: g(rule%nodes, 3), b(2*rule%nodes + planes, 4), fibre(2*rule%nodes + planes), ratio
    real(dp), intent(in) :: unit(4), multiple        !< the stress, and its factor, volume included
    real(dp), intent(inout) :: stiffness(2*rule%nodes + planes, 2*rule%nodes + planes)
    real(dp) :: modulus(4, 4), none(4), no_force(2*rule%nodes + planes)
    modulus = by_volume(4, 3, unit)
    none = 0
    no_force = 0
    call add_stress_of_fibres(this, rule, point, g, fibre, ratio, unit, multiple, modulus, stiffness)
    call add_axisymmetric_point(size(no_force), b, none, multiple*modulus, no_force, stiffness)
  end subroutine add_curvature_of_fibres
end module host_planes
