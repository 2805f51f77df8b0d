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
  use core_strains, only: strain_matrix_of => strain_matrix
  use host_context, only: current
  use host_forces, only: add_geometric_of => add_geometric
  use host_gradients, only: average_volume_strain, find_deformation, gradient_of, gradients_of_points
  use host_kinds, only: dp
  use host_protect, only: escape
  use host_shape, only: is_quadratic, rule_t
  use host_solid_element, only: solid_t
  use host_solid_kinematics, only: make_room
  use host_standard_kinematics, only: standard_t
  use host_uniform_kinematics, only: find_start
  implicit none (type, external)
  private
  public :: between_planes_t, planes_t, planes

  integer, parameter :: planes = 3     !< unknowns of the reference node

  !> Two planes, and what their reference node has at the end of the increment, and its change.
  type :: planes_t
    real(dp) :: origin(2) = 0          !< X0, Y0
    real(dp) :: length = 1             !< t0
    real(dp) :: w(planes) = 0, dw(planes) = 0
  end type planes_t

  !> Kinematics of an element between them.
  type, extends(standard_t) :: between_planes_t
    type(planes_t) :: bounds
    real(dp), allocatable :: ratio(:)  !< (points) lengths of the fibres, over those before any displacement
    real(dp), allocatable :: by_planes(:, :), by_planes_mid(:, :)   !< (planes, points) derivatives of their logarithms by w
  contains
    procedure :: prepare
    procedure :: find_strain
    procedure :: strain_matrix
    procedure :: add_geometric
  end type between_planes_t

contains

  subroutine prepare(this, element)
    class(between_planes_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    real(dp), dimension(element%rule%points) :: unused, unused_ratio
    real(dp) :: g_before(element%nodes, element%direct, element%rule%points), w(planes)
    call make_room(this, element)
    call make_fibres(this, element%rule%points)
    this%now = element%x
    w = 0
    if (element%finite) then
      this%now = element%x + element%u
      w = this%bounds%w
    end if
    call fibre_gradients(this, element, this%now, w, this%g, this%b, this%volume, this%ratio, this%by_planes)
    if (element%finite) then
      call this%make_middle()
      w = this%bounds%w - 0.5_dp*this%bounds%dw
      call fibre_gradients(this, element, this%now - 0.5_dp*element%du, w, this%g_mid, this%b_mid, unused, unused_ratio, &
                           this%by_planes_mid)
    end if
    this%volume_now = this%volume
    if (.not. element%finite) this%volume_before = this%volume
    if (element%rule%reduced) call find_start(this, element, g_before)
    if (element%finite .and. element%deforms) call find_deformation_of_fibres(this, element)
  end subroutine prepare

  subroutine make_fibres(this, points)
    class(between_planes_t), intent(inout) :: this
    integer, intent(in) :: points
    if (allocated(this%ratio)) then
      if (size(this%ratio) == points) return
      deallocate (this%ratio, this%by_planes, this%by_planes_mid)
    end if
    allocate (this%ratio(points), this%by_planes(planes, points), this%by_planes_mid(planes, points))
  end subroutine make_fibres

  !> Gradients, strain matrices and volumes of all points, and their fibres.
  subroutine fibre_gradients(this, element, x, w, g, b, volume, ratio, by_planes)
    class(between_planes_t), intent(in) :: this
    type(solid_t), intent(in) :: element
    real(dp), intent(in) :: x(element%dim, element%nodes), w(planes)
    real(dp), intent(out) :: g(element%nodes, 3, element%rule%points), b(element%n, 4, element%rule%points)
    real(dp), dimension(element%rule%points), intent(out) :: volume, ratio
    real(dp), intent(out) :: by_planes(planes, element%rule%points)
    real(dp) :: by_nodes(element%dim, element%nodes)
    integer :: p
    g(:, 3:, :) = 0
    call gradients_of_points(element%rule, 2, x, g(:, :2, :), volume)
    do p = 1, element%rule%points
      call strain_matrix_of(2, 3, element%nodes, g(:, :, p), b(:, :, p))
      call find_fibre(this%bounds, element%rule, p, x, w, ratio(p), by_nodes, by_planes(:, p))
      b(:, 3, p) = reshape(by_nodes, [size(by_nodes)])
      volume(p) = volume(p)*ratio(p)
    end do
    ! fibres of elements with straight edges have one strain
    if (this%averaged) call average_volume_strain(element%rule, 2, 4, volume, b)
  end subroutine fibre_gradients

  !> Deformation gradients, with the stretches of the fibres.
  subroutine find_deformation_of_fibres(this, element)
    class(between_planes_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    real(dp) :: by_nodes(element%dim, element%nodes), by_planes(planes)
    integer :: p
    associate (rule => element%rule, x => element%x, u => element%u, du => element%du, bounds => this%bounds)
      call find_deformation(rule, 2, this%averaged, x, u, du, this%deformation, this%volume_before)
      do p = 1, rule%points
        associate (f => this%deformation(:, :, :, p))
          call find_fibre(bounds, rule, p, x + u - du, bounds%w - bounds%dw, f(3, 3, 1), by_nodes, by_planes)
          call find_fibre(bounds, rule, p, x + u, bounds%w, f(3, 3, 2), by_nodes, by_planes)
        end associate
      end do
    end associate
  end subroutine find_deformation_of_fibres

  subroutine find_strain(this, element, p, b, strain)
    class(between_planes_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(in) :: b(element%n + this%others, element%strains)
    real(dp), intent(out) :: strain(element%strains)
    call this%standard_t%find_strain(element, p, b, strain)
    if (element%finite) then
      strain(3) = strain(3) + dot_product(this%bounds%dw, this%by_planes_mid(:, p))
    else
      strain(3) = strain(3) + dot_product(this%bounds%w, this%by_planes(:, p))
    end if
  end subroutine find_strain

  !> The planes strain the fibres alone.
  subroutine strain_matrix(this, element, p, b)
    class(between_planes_t), intent(in) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(out) :: b(element%n + this%others, element%strains)
    b(:element%n, :) = this%b(:, :, p)
    b(element%n + 1:, :) = 0
    b(element%n + 1:, 3) = this%by_planes(:, p)
  end subroutine strain_matrix

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

  !> The part of 33 is 33 times the second derivatives of the logarithm of the fibre.
  subroutine add_geometric(this, element, p, b, stress, weight, modulus, stiffness)
    class(between_planes_t), intent(in) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(in) :: b(element%n + this%others, element%strains), stress(element%strains), weight
    real(dp), intent(inout) :: modulus(element%strains, element%strains)
    real(dp), intent(inout) :: stiffness(element%n + this%others, element%n + this%others)
    real(dp) :: by_product(element%nodes)
    integer :: i, n
    n = element%n
    call add_geometric_of(2, 3, 4, element%nodes, this%g(:, :, p), stress, weight, modulus, stiffness(:n, :n))
    ! - 2 of the square of the strain are in the modulus, and one is here
    do i = 1, size(b, 1)
      stiffness(:, i) = stiffness(:, i) + weight*stress(3)*b(i, 3)*b(:, 3)
    end do
    by_product = weight*stress(3)*functions(element%rule, p)/(this%bounds%length*this%ratio(p))
    stiffness(2:n:2, n + 2) = stiffness(2:n:2, n + 2) + by_product
    stiffness(n + 2, 2:n:2) = stiffness(n + 2, 2:n:2) + by_product
    stiffness(1:n:2, n + 3) = stiffness(1:n:2, n + 3) - by_product
    stiffness(n + 3, 1:n:2) = stiffness(n + 3, 1:n:2) - by_product
  end subroutine add_geometric
end module host_planes
