! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Cycles of an increment: from the step FATIGUE on, time is their number.
!>
!> Field variable 1 of the deck is the load ratio, so that blocks of cycles with different ones may follow each other, and steps
!> under a constant load, R = 1. Without field variables it is LOADRATIO.
module abaqus_cycles
  use core_kinds, only: dp
  use abaqus_layout, only: p_loadratio, j_fatigue
  use abaqus_lflags, only: is_linear_step
  use abaqus_report, only: fatal
  use cohesive_parameters, only: load_cycles
  implicit none(type, external)
  private
  public :: count_cycles

contains

  !> Cycles of an increment of a general step, and their load ratio at its end, the mean of the nodes; `good` is false after a
  !> message.
  subroutine count_cycles(itype, jelem, values, options, lflags, kstep, dtime, npredf, predef, cycles, good)
    integer, intent(in) :: itype, jelem
    real(dp), intent(in) :: values(:)          !< properties by their rows in the layout
    integer, intent(in) :: options(:)
    integer, intent(in) :: lflags(*), kstep
    real(dp), intent(in) :: dtime
    integer, intent(in) :: npredf              !< predefined fields, of which the temperature is the first
    real(dp), intent(in) :: predef(:, :, :)    !< (2, npredf, nodes) end value and increment at the nodes
    type(load_cycles), intent(out) :: cycles
    logical, intent(out) :: good

    good = .true.
    if (options(j_fatigue) <= 0 .or. kstep < options(j_fatigue) .or. is_linear_step(lflags)) return
    cycles%load_ratio = values(p_loadratio)
    if (npredf > 1) cycles%load_ratio = sum(predef(1, 2, :))/size(predef, 3)
    good = cycles%load_ratio >= -1.0_dp .and. cycles%load_ratio <= 1.0_dp
    ! a load that does not change has no cycles
    if (cycles%load_ratio < 1.0_dp) cycles%count = dtime
    if (.not. good) call fatal(itype, jelem, 'field variable 1, which is the load ratio since there is FATIGUE = %I, is %R: ' // &
      'expected a value from -1 to 1', [options(j_fatigue)], [cycles%load_ratio])
  end subroutine count_cycles

end module abaqus_cycles
