! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Kind of the reals of every kernel.
module core_kinds
  use, intrinsic :: iso_fortran_env, only: real64
  implicit none(type, external)
  private
  public :: dp

  integer, parameter :: dp = real64

end module core_kinds
