! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> How a surface turns, in complex arithmetic: a displacement of `step` along the imaginary axis gives a derivative without an
!> error of truncation (W. Squire, G. Trapp, SIAM Review 40 (1998) 110).
module host_polar
  use host_kinds, only: dp
  implicit none (type, external)
  private
  public :: cross, polar_axes, step

  real(dp), parameter :: step = 1.0e-30_dp

contains

  !> Axes of a surface, in columns, and its normal: what two unit vectors normal to each other in it, and its normal, have become by
  !> the rotation in the polar decomposition of its deformation. along: what these vectors have become by the deformation.
  pure function polar_axes(along) result(axes)
    complex(dp), intent(in) :: along(3, 2)
    complex(dp) :: axes(3, 3)
    axes(:, 3) = unit(cross(along(:, 1), along(:, 2)))
    ! along these axes the deformation is symmetric
    axes(:, 1) = unit(along(:, 1) + cross(along(:, 2), axes(:, 3)))
    axes(:, 2) = cross(axes(:, 3), axes(:, 1))
  end function polar_axes

  pure function cross(a, b) result(c)
    complex(dp), intent(in) :: a(3), b(3)
    complex(dp) :: c(3)
    c = [a(2)*b(3) - a(3)*b(2), a(3)*b(1) - a(1)*b(3), a(1)*b(2) - a(2)*b(1)]
  end function cross

  pure function unit(a) result(b)
    complex(dp), intent(in) :: a(3)
    complex(dp) :: b(3)
    b = a/sqrt(sum(a*a))
  end function unit
end module host_polar
