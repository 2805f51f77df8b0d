! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Force and tangent of an integration point of a built-in continuum element, from its stress and modulus.
module host_forces
  use host_kinds, only: dp
  implicit none (type, external)
  private
  public :: add_geometric, add_point, by_volume

contains

  !> Add force and tangent of a point with m strains; its volume is in stress and modulus.
  pure subroutine add_point(n, m, b, stress, modulus, force, stiffness)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: b(n, m), stress(m), modulus(m, m)
    real(dp), intent(inout) :: force(n), stiffness(n, n)
    select case (m)
    case (3)
      call add_plane_point(n, b, stress, modulus, force, stiffness)
    case (4)
      call add_axisymmetric_point(n, b, stress, modulus, force, stiffness)
    case default
      call add_space_point(n, b, stress, modulus, force, stiffness)
    end select
  end subroutine add_point

  !> The same in the plane. Sizes known at compile time make this and the next two, which do most of the work, fast.
  pure subroutine add_plane_point(n, b, stress, modulus, force, stiffness)
    integer, intent(in) :: n
    real(dp), intent(in) :: b(n, 3), stress(3), modulus(3, 3)
    real(dp), intent(inout) :: force(n), stiffness(n, n)
    real(dp) :: db(3)
    integer :: i, j
    do j = 1, n
      force(j) = force(j) + b(j, 1)*stress(1) + b(j, 2)*stress(2) + b(j, 3)*stress(3)
      db = modulus(:, 1)*b(j, 1) + modulus(:, 2)*b(j, 2) + modulus(:, 3)*b(j, 3)
      do i = 1, n
        stiffness(i, j) = stiffness(i, j) + b(i, 1)*db(1) + b(i, 2)*db(2) + b(i, 3)*db(3)
      end do
    end do
  end subroutine add_plane_point

  !> The same in an axisymmetric element.
  pure subroutine add_axisymmetric_point(n, b, stress, modulus, force, stiffness)
    integer, intent(in) :: n
    real(dp), intent(in) :: b(n, 4), stress(4), modulus(4, 4)
    real(dp), intent(inout) :: force(n), stiffness(n, n)
    real(dp) :: db(4)
    integer :: i, j
    do j = 1, n
      force(j) = force(j) + b(j, 1)*stress(1) + b(j, 2)*stress(2) + b(j, 3)*stress(3) + b(j, 4)*stress(4)
      db = modulus(:, 1)*b(j, 1) + modulus(:, 2)*b(j, 2) + modulus(:, 3)*b(j, 3) + modulus(:, 4)*b(j, 4)
      do i = 1, n
        stiffness(i, j) = stiffness(i, j) + b(i, 1)*db(1) + b(i, 2)*db(2) + b(i, 3)*db(3) + b(i, 4)*db(4)
      end do
    end do
  end subroutine add_axisymmetric_point

  !> The same in space.
  pure subroutine add_space_point(n, b, stress, modulus, force, stiffness)
    integer, intent(in) :: n
    real(dp), intent(in) :: b(n, 6), stress(6), modulus(6, 6)
    real(dp), intent(inout) :: force(n), stiffness(n, n)
    real(dp) :: db(6)
    integer :: i, j, k
    do j = 1, n
      db = 0
      do k = 1, 6
        force(j) = force(j) + b(j, k)*stress(k)
        db = db + modulus(:, k)*b(j, k)
      end do
      do i = 1, n
        stiffness(i, j) = stiffness(i, j) + b(i, 1)*db(1) + b(i, 2)*db(2) + b(i, 3)*db(3) &
                          + b(i, 4)*db(4) + b(i, 5)*db(5) + b(i, 6)*db(6)
      end do
    end do
  end subroutine add_space_point

  !> Change of the force for a stress that rotates with the material and keeps its magnitude: sigma : (grad dv^T grad du) to the
  !> stiffness, - 2 sigma : (dD dD) to the modulus.
  pure subroutine add_geometric(dim, direct, m, nodes, g, stress, volume, modulus, stiffness)
    integer, intent(in) :: dim, direct, m, nodes      !< m: number of strains
    real(dp), intent(in) :: g(nodes, direct), stress(m), volume
    real(dp), intent(inout) :: modulus(m, m), stiffness(:, :)
    integer, parameter :: first(3) = [1, 1, 2], second(3) = [2, 3, 3]
    real(dp) :: full(direct, direct), basis(direct, direct, m), between(nodes, nodes)
    integer :: i, j
    basis = 0
    full = 0
    do i = 1, direct
      basis(i, i, i) = 1
      full(i, i) = stress(i)
    end do
    do i = direct + 1, m
      basis(first(i - direct), second(i - direct), i) = 0.5_dp
      basis(second(i - direct), first(i - direct), i) = 0.5_dp
      full(first(i - direct), second(i - direct)) = stress(i)
      full(second(i - direct), first(i - direct)) = stress(i)
    end do
    do j = 1, m
      do i = 1, m
        modulus(i, j) = modulus(i, j) - 2*sum(transpose(basis(:, :, i))*matmul(full, basis(:, :, j)))
      end do
    end do
    between = volume*matmul(g(:, :dim), matmul(full(:dim, :dim), transpose(g(:, :dim))))
    do i = 1, dim
      stiffness(i::dim, i::dim) = stiffness(i::dim, i::dim) + between
    end do
    if (direct == dim) return
    do i = 1, nodes
      stiffness(1::2, 2*i - 1) = stiffness(1::2, 2*i - 1) + volume*full(3, 3)*g(i, 3)*g(:, 3)
    end do
  end subroutine add_geometric

  !> Symmetric part of the derivative, by the strains, of a stress that is divided by the volume: a stress that grows with it.
  pure function by_volume(m, direct, stress) result(modulus)
    integer, intent(in) :: m, direct
    real(dp), intent(in) :: stress(m)
    real(dp) :: modulus(m, m)
    integer :: i
    modulus = 0
    do i = 1, direct
      modulus(:, i) = modulus(:, i) + 0.5_dp*stress
      modulus(i, :) = modulus(i, :) + 0.5_dp*stress
    end do
  end function by_volume
end module host_forces
