! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Local frames in the plane.
module core_rotation
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: line_frame, traction_operator

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

  !> Matrix that takes in-plane stress (11, 22, 12) to the traction sigma.n in components (tau, n).
  pure function traction_operator(frame) result(matrix)
    real(dp), intent(in) :: frame(2, 2)  !< rows tau and n
    real(dp) :: matrix(2, 3)
    real(dp) :: t1, t2, n1, n2

    t1 = frame(1, 1)
    t2 = frame(1, 2)
    n1 = frame(2, 1)
    n2 = frame(2, 2)
    matrix(1, :) = [t1*n1, t2*n2, t1*n2 + t2*n1]
    matrix(2, :) = [n1*n1, n2*n2, 2.0_dp*n1*n2]
  end function traction_operator

end module core_rotation
