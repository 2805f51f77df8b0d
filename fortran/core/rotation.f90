! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Local frames of lines and surfaces.
module core_rotation
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: line_frame, surface_frame, traction_operator, strain_rotation

contains

  !> Frame of a line: rows tau (from start to finish) and n (tau rotated by +90 degrees), and its length. The frame of a line of
  !> zero length is zero.
  pure subroutine line_frame(start, finish, frame, length)
    real(dp), intent(in) :: start(2), finish(2)
    real(dp), intent(out) :: frame(2, 2)
    real(dp), intent(out) :: length
    real(dp) :: along(2)

    along = finish - start
    length = hypot(along(1), along(2))
    frame = 0.0_dp
    if (length > 0.0_dp) then
      frame(1, :) = along/length
      frame(2, :) = [-frame(1, 2), frame(1, 1)]
    end if
  end subroutine line_frame

  !> Frame of a surface from two vectors in it, and the area that they span: rows s, n and t, where n is along their cross
  !> product, s the projection of the global x axis (of the z axis where x is within 0.1 degrees of n) and t = n x s. The frame of
  !> a surface without area is zero.
  pure subroutine surface_frame(first, second, frame, area)
    real(dp), intent(in) :: first(3), second(3)
    real(dp), intent(out) :: frame(3, 3)
    real(dp), intent(out) :: area
    real(dp), parameter :: smallest_sine = 1.745328e-3_dp   ! of 0.1 degrees
    real(dp) :: normal(3), along(3)
    integer :: axis

    frame = 0.0_dp
    normal = cross(first, second)
    area = norm2(normal)
    if (.not. area > 0.0_dp) return
    normal = normal/area
    axis = merge(1, 3, hypot(normal(2), normal(3)) >= smallest_sine)
    along = -normal(axis)*normal
    along(axis) = along(axis) + 1.0_dp
    frame(1, :) = along/norm2(along)
    frame(2, :) = normal
    frame(3, :) = cross(normal, frame(1, :))
  end subroutine surface_frame

  !> Cross product.
  pure function cross(a, b) result(c)
    real(dp), intent(in) :: a(3), b(3)
    real(dp) :: c(3)

    c = [a(2)*b(3) - a(3)*b(2), a(3)*b(1) - a(1)*b(3), a(1)*b(2) - a(2)*b(1)]
  end function cross

  !> Matrix that takes stress, in the plane (11, 22, 12), in space (11, 22, 33, 12, 13, 23), to the traction sigma.n in the
  !> components of the rows of a frame, of which n is the second one.
  pure function traction_operator(dim, frame) result(matrix)
    integer, intent(in) :: dim                !< 2 or 3
    real(dp), intent(in) :: frame(3, 3)       !< rows tau, n and zero, or s, n and t
    real(dp) :: matrix(dim, 3*(dim - 1))
    integer :: i

    do i = 1, dim
      matrix(i, :) = symmetric_product(dim, frame(i, :), frame(2, :))
    end do
  end function traction_operator

  !> Row that takes a stress to a.sigma.b.
  pure function symmetric_product(dim, a, b) result(row)
    integer, intent(in) :: dim
    real(dp), intent(in) :: a(3), b(3)
    real(dp) :: row(3*(dim - 1))

    row(1) = a(1)*b(1)
    row(2) = a(2)*b(2)
    if (dim == 2) then
      row(3) = a(1)*b(2) + a(2)*b(1)
      return
    end if
    row(3) = a(3)*b(3)
    row(4) = a(1)*b(2) + a(2)*b(1)
    row(5) = a(1)*b(3) + a(3)*b(1)
    row(6) = a(2)*b(3) + a(3)*b(2)
  end function symmetric_product

  !> Matrix that takes strains (11, 22, 33, 12, 13, 23; engineering shear) to those along the rows of a rotation.
  pure function strain_rotation(axes) result(matrix)
    real(dp), intent(in) :: axes(3, 3)
    real(dp) :: matrix(6, 6)
    integer, parameter :: first(6) = [1, 2, 3, 1, 1, 2], second(6) = [1, 2, 3, 2, 3, 3]
    integer :: i

    do i = 1, 6
      matrix(i, :) = symmetric_product(3, axes(first(i), :), axes(second(i), :))
      ! a shear strain counts twice, on both sides
      matrix(i, 4:6) = 0.5_dp*matrix(i, 4:6)
      if (i > 3) matrix(i, :) = 2.0_dp*matrix(i, :)
    end do
  end function strain_rotation

end module core_rotation
