! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Hourglass control of elements of one integration point with four or eight nodes: the total stiffness of Abaqus/Standard.
!>
!> h is a pattern of 1 and -1 at the nodes, B the mean gradients of the shape functions over the volume V before any
!> displacement. gamma = h - B (x h) is what of the pattern no linear displacement has, q = u gamma is the hourglass
!> displacement (D.P. Flanagan, T. Belytschko, Int. J. for Numerical Methods in Engineering 17 (1981) 679). With large
!> displacements F^T q takes the place of q, with the mean deformation gradient F = 1 + u B. The energy is half of
!> stiffness times (F^T q)^2, the stiffness, of the parameter r (0.005 times the shear modulus unless the deck has another):
!>
!>   in the plane and about an axis   r V sum(B**2)/(h gamma)**2, the sum over both directions
!>   in space                         0.2357 r V sum(B(:, i)**2) in direction i
!>
!> How this is known: *HOURGLASS STIFFNESS and reactions of single elements in Abaqus R2018x, CAX4RT and C3D8RT of skewed
!> shapes with and without NLGEOM, and CPS4R of square shape. For CPE4R, and CPS4R of other shapes, it is inferred.
module host_hourglass
  use host_kinds, only: dp
  use host_kinematics, only: mean_gradients
  use host_shape, only: hourglass_shapes
  implicit none (type, external)
  private
  public :: has_hourglass_modes, resist_hourglass

  real(dp), parameter :: factor_in_space = 0.2357_dp     !< sqrt(2)/6 in four digits, as Abaqus has it

contains

  !> Whether displacements other than rigid ones leave the points of an element without strain.
  pure logical function has_hourglass_modes(dim, nodes, points)
    integer, intent(in) :: dim, nodes, points
    has_hourglass_modes = points == 1 .and. nodes == 2**dim
  end function has_hourglass_modes

  !> Add force and tangent of the hourglass control; its energy.
  subroutine resist_hourglass(dim, direct, parameter, finite, x, u, force, stiffness, energy)
    integer, intent(in) :: dim, direct        !< direct strains (host_kinematics)
    real(dp), intent(in) :: parameter         !< hourglass stiffness parameter, in the plane times thickness or angle
    logical, intent(in) :: finite             !< large displacements
    real(dp), intent(in) :: x(dim, 2**dim), u(dim, 2**dim)
    real(dp), intent(inout) :: force(dim, 2**dim), stiffness(dim*2**dim, dim*2**dim), energy
    integer, parameter :: modes(3) = [0, 1, 4]
    real(dp) :: gradient(2**dim, direct), b(2**dim, dim), volume, h(2**dim, modes(dim)), gamma(2**dim, modes(dim))
    real(dp) :: f(dim, dim), q(dim, modes(dim)), k(dim), moved, modal(dim), path(dim, 2**dim), between(2**dim, 2**dim)
    integer :: i, j, mode
    call mean_gradients(dim, direct, x, gradient, volume)
    b = gradient(:, :dim)
    h = hourglass_shapes(dim)
    gamma = h - matmul(b, matmul(x, h))
    q = matmul(u, gamma)
    f = 0
    do i = 1, dim
      f(i, i) = 1
    end do
    if (finite) f = f + matmul(u, b)
    if (dim == 2) then
      k = parameter*volume*sum(b**2)/dot_product(h(:, 1), gamma(:, 1))**2
    else
      k = factor_in_space*parameter*volume*sum(b**2, 1)
    end if
    energy = 0
    do mode = 1, modes(dim)
      do i = 1, dim
        moved = dot_product(f(:, i), q(:, mode))
        modal(i) = k(i)*moved
        energy = energy + 0.5_dp*modal(i)*moved
        ! change of (F^T q)_i with the displacements
        do j = 1, dim
          path(j, :) = f(j, i)*gamma(:, mode)
          if (finite) path(j, :) = path(j, :) + q(j, mode)*b(:, i)
        end do
        force = force + modal(i)*path
        call add_square(size(path), k(i), path, stiffness)
      end do
      if (.not. finite) cycle
      do j = 1, 2**dim
        between(:, j) = gamma(:, mode)*dot_product(b(j, :), modal) + matmul(b, modal)*gamma(j, mode)
      end do
      do i = 1, dim
        stiffness(i::dim, i::dim) = stiffness(i::dim, i::dim) + between
      end do
    end do
  end subroutine resist_hourglass

  !> Add a factor times the product of a vector with itself.
  pure subroutine add_square(n, factor, vector, stiffness)
    integer, intent(in) :: n
    real(dp), intent(in) :: factor, vector(n)
    real(dp), intent(inout) :: stiffness(n, n)
    integer :: i
    do i = 1, n
      stiffness(:, i) = stiffness(:, i) + factor*vector(i)*vector
    end do
  end subroutine add_square
end module host_hourglass
