! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Kinds of the host and the bit patterns with which it marks memory.
module host_kinds
  use, intrinsic :: iso_fortran_env, only: dp => real64, i4 => int32, i8 => int64
  implicit none (type, external)
  private
  public :: dp, i4, i8, unset_bits, guard_bits

  !> Our own quiet NaN: RHS and AMATRX hold it before each call, so an entry that still has it was not set.
  integer(i8), parameter :: unset_bits = int(z'7ff8a5a5deadbeef', i8)
  !> Another one, in the guards around each array: any change is a write outside an array.
  integer(i8), parameter :: guard_bits = int(z'7ff8c3c3feedface', i8)
end module host_kinds
