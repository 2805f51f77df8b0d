! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What the host knows about the call that is running, for the utility routines that a user's file calls.
module host_context
  use host_kinds, only: dp, i4
  implicit none (type, external)
  private
  public :: call_context, current, job_name, output_directory

  type :: call_context
    integer(i4) :: element = 0    !< element number, 0 outside an element loop
    integer(i4) :: step = 0
    integer(i4) :: increment = 0
    integer(i4) :: tensor = 0     !< components of stress: 3, 4 or 6; 0 without a material
    real(dp), pointer, contiguous :: history(:, :) => null()        !< (values, npt) committed material history
    real(dp), pointer, contiguous :: history_trial(:, :) => null()  !< (values, npt) of this call
  end type call_context

  type(call_context), save :: current
  character(len=256), save :: job_name = ' '
  character(len=256), save :: output_directory = ' '
end module host_context
