! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Limits of a response that an increment leaves a point on: yield stress, friction.
module core_limit
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: exceeds

  !> Part of the limit that does not count. The next increment begins on the limit but for rounding, which must not decide whether
  !> the point goes on: processors round differently, and so do points that are mirror images.
  real(dp), parameter :: least_excess = 1.0e-10_dp

contains

  !> True if a value is beyond its limit, and for NaN.
  elemental function exceeds(value, limit)
    real(dp), intent(in) :: value, limit
    logical :: exceeds

    exceeds = .not. value <= limit*(1.0_dp + least_excess)
  end function exceeds

end module core_limit
