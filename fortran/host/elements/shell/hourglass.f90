! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Hourglass control and drilling of shells of four nodes with one point, S4R.
!>
!> B are the gradients of the shape functions in the middle, A the area, h the pattern of 1 and -1 at the nodes and
!> gamma = h - B (x h) its part that is in no linear field. With s = A sum(B**2)/(h gamma)**2 the energies are half of
!>
!>   membrane            r_F G t s q**2, q = gamma u along both axes of the plane
!>   rotations           48 r_theta I s q**2, q = gamma theta about both axes, I = the integral of G z**2 from the nodes' surface
!>   transverse shear    2/3 K s q**2, q = difference of the shear strains at opposite edges, summed over both pairs, less that of a
!>                       constant shear strain; K = mean of the transverse shear stiffnesses
!>   drilling            D A/4 (theta - omega)**2/(1 + A/(10 t**2)) at each node, D = G t/6, with theta about the normal and the
!>                       rotation omega of the surface at the node
!>
!> with r_F = 0.005 and r_theta = 0.00375 as in the Analysis User's Guide (Section controls).
!>
!> How this is known: the displacements, stresses and reactions of a frame of 600 S4R in plates and tubes (a public job of Abaqus
!> 6.14, jrHoss/Abaqus-Scrypting) leave forces that these terms account for to 1e-2 in the plane and 2e-2 across it; with them the
!> frame, and a wing of 3461 S4R (leal26/leafy_wingy), have the printed displacements and averages
!> (harness/uel/procedures/fidelity.md). All elements there are plane rectangles: for others it is inferred.
module host_shell_hourglass
  use core_rotation, only: cross
  use core_small_matrix, only: invert
  use host_kinds, only: dp
  use host_shell_strains, only: assumed_shear, shell_point
  implicit none (type, external)
  private
  public :: drilling_of_corners, hourglass_of_shell

  real(dp), parameter :: pattern(4) = [1, -1, 1, -1]
  real(dp), parameter :: corner(2, 4) = reshape([-1, -1, 1, -1, 1, 1, -1, 1], [2, 4])
  real(dp), parameter :: thinness = 0.1_dp       !< factor of the area over the square of the thickness
  real(dp), parameter :: of_shear = 2.0_dp/3     !< part of the transverse shear stiffness

  !> What the displacements of an element are beside linear ones.
  type :: pattern_t
    real(dp) :: gamma(4) = 0
    real(dp) :: scale = 0          !< A sum(B**2)/(h gamma)**2
    real(dp) :: q(2, 24) = 0       !< along the axes of the plane, without that of a rigid rotation of a warped element
  end type pattern_t

contains

  pure function pattern_of(x, middle, area) result(found)
    real(dp), intent(in) :: x(3, 4), area
    type(shell_point), intent(in) :: middle
    type(pattern_t) :: found
    real(dp) :: places(3, 4), warp
    integer :: i, k
    places = matmul(middle%frame, x)
    associate (b => middle%gradient(:4, :))
      found%gamma = pattern - matmul(b, matmul(places(:2, :), pattern))
      found%scale = area*sum(b**2)/dot_product(pattern, found%gamma)**2
      warp = dot_product(places(3, :), found%gamma)
      do k = 1, 4
        do i = 1, 2
          found%q(i, 6*k - 5:6*k - 3) = found%gamma(k)*middle%frame(i, :) + warp*b(k, i)*middle%frame(3, :)
        end do
      end do
    end associate
  end function pattern_of

  !> Stiffness of the hourglass control.
  pure function hourglass_of_shell(x, v, middle, area, moduli, shear, constant_shear) result(stiffness)
    real(dp), intent(in) :: x(3, 4), v(3, 4)         !< v: directors
    type(shell_point), intent(in) :: middle
    real(dp), intent(in) :: area
    real(dp), intent(in) :: moduli(2)                !< r_F G t and 48 r_theta I
    real(dp), intent(in) :: shear                    !< K
    real(dp), intent(in) :: constant_shear(2, 24)    !< transverse shear strains in the middle
    real(dp) :: stiffness(24, 24), q(24)
    type(pattern_t) :: found
    integer :: i, k
    found = pattern_of(x, middle, area)
    stiffness = 0
    do i = 1, 2
      stiffness = stiffness + moduli(1)*found%scale*square(found%q(i, :))
      q = 0
      do k = 1, 4
        q(6*k - 2:6*k) = found%gamma(k)*middle%frame(i, :)
      end do
      stiffness = stiffness + moduli(2)*found%scale*square(q)
    end do
    q = edge_shear(x, v) - matmul(matmul(matmul(middle%frame(:2, :), x), pattern), constant_shear)
    stiffness = stiffness + of_shear*shear*found%scale*square(q)
  end function hourglass_of_shell

  !> Difference of the shear strains along opposite edges, by displacements and rotations, summed over both pairs.
  pure function edge_shear(x, v) result(q)
    real(dp), intent(in) :: x(3, 4), v(3, 4)
    real(dp) :: q(24), at(2, 4, 4), factors(4, 4)
    integer :: a, k
    factors = 0
    do a = 1, 2
      at = assumed_shear(4, merge([0.0_dp, 1.0_dp], [1.0_dp, 0.0_dp], a == 1))
      factors = factors + at(a, :, :)
      at = assumed_shear(4, merge([0.0_dp, -1.0_dp], [-1.0_dp, 0.0_dp], a == 1))
      factors = factors - at(a, :, :)
    end do
    do k = 1, 4
      q(6*k - 5:6*k - 3) = matmul(v, factors(k, :))
      q(6*k - 2:6*k) = cross(v(:, k), matmul(x, factors(:, k)))
    end do
  end function edge_shear

  !> Stiffness against drilling.
  pure function drilling_of_corners(x, middle, area, thickness, modulus) result(stiffness)
    real(dp), intent(in) :: x(3, 4)
    type(shell_point), intent(in) :: middle
    real(dp), intent(in) :: area, thickness
    real(dp), intent(in) :: modulus       !< D
    real(dp) :: stiffness(24, 24), inverse(2, 2), determinant, drill(24), slope(2)
    type(pattern_t) :: found
    integer :: c, k
    found = pattern_of(x, middle, area)
    call invert(2, middle%jacobian, inverse, determinant)
    stiffness = 0
    do c = 1, 4
      ! gradients at a corner are those in the middle and gamma/4 times this
      slope = matmul(inverse, corner([2, 1], c))
      drill = 0.125_dp*(slope(2)*found%q(1, :) - slope(1)*found%q(2, :))
      do k = 1, 4
        drill(6*k - 5:6*k - 3) = drill(6*k - 5:6*k - 3) &
                                 + 0.5_dp*(middle%gradient(k, 2)*middle%frame(1, :) - middle%gradient(k, 1)*middle%frame(2, :))
      end do
      drill(6*c - 2:6*c) = middle%frame(3, :)
      stiffness = stiffness + square(drill)
    end do
    stiffness = 0.25_dp*area*modulus/(1 + thinness*area/thickness**2)*stiffness
  end function drilling_of_corners

  pure function square(q)
    real(dp), intent(in) :: q(24)
    real(dp) :: square(24, 24)
    square = spread(q, 2, 24)*spread(q, 1, 24)
  end function square
end module host_shell_hourglass
