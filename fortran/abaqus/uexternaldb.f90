! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Entry point of Abaqus/Standard at the start and end of analysis, step and increment: it clears the shared module and lets
!> elements tell again what they tell once, before the first and after the last increment of an analysis.
subroutine uexternaldb(lop, lrestart, time, dtime, kstep, kinc)
  use core_kinds, only: dp
  use abaqus_bulk_exchange, only: clear_bulk_records
  use abaqus_long_elements, only: forget_long_elements
  use abaqus_raised_beta, only: forget_raised_beta
  use abaqus_temperatures, only: forget_temperatures
  implicit none(type, external)
  integer, intent(in) :: lop, lrestart, kstep, kinc
  real(dp), intent(in) :: time(2), dtime
  integer, parameter :: analysis_starts = 0, analysis_ends = 3

  if (lop == analysis_starts .or. lop == analysis_ends) then
    call clear_bulk_records()
    call forget_long_elements()
    call forget_raised_beta()
    call forget_temperatures()
  end if
end subroutine uexternaldb
