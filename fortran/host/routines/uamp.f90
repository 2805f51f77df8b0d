! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> UAMP (User Subroutines Guide): the value of an amplitude at the end of an increment, and the sensors that it reads.
module host_uamp
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_f_procpointer, c_funloc, c_funptr, c_loc, c_ptr
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_messages, only: add_message
  use host_protect, only: begin_call, escape, protect
  implicit none (type, external)
  private
  public :: uamp_call_t, run_uamp, find_sensor

  abstract interface
    subroutine uamp_procedure(ampname, time, ampvalueold, dt, nprops, props, nsvars, svars, lflagsinfo, nsensor, &
                              sensorvalues, sensornames, jsensorlookuptable, ampvaluenew, lflagsdefine, ampderivative, &
                              ampsecderivative, ampincintegral, ampdoubleintegral)
      import :: dp, i4
      character(len=80) :: ampname, sensornames(*)
      real(dp) :: time(*), ampvalueold, dt, props(*), svars(*), sensorvalues(*), ampvaluenew, ampderivative, &
                  ampsecderivative, ampincintegral, ampdoubleintegral
      integer(i4) :: nprops, nsvars, lflagsinfo(*), nsensor, jsensorlookuptable(*), lflagsdefine(*)
    end subroutine uamp_procedure
  end interface

  !> One call. Arrays belong to the caller, and have one entry more than the counts say.
  type :: uamp_call_t
    type(c_funptr) :: address
    character(len=80) :: name = ' '
    real(dp) :: time(2) = 0          !< step and total time at the end of the increment
    real(dp) :: old = 0, dtime = 0
    integer(i4) :: info(4) = 0       !< lFlagsInfo: initialization, regular increment, cutbacks, step
    integer(i4) :: define(6) = 0     !< lFlagsDefine: the last two stop the analysis, and conclude the step
    real(dp) :: value = 0
    integer(i4) :: nprops = 0, nsvars = 0, nsensor = 0
    real(dp), pointer, contiguous :: props(:) => null(), svars(:) => null(), sensors(:) => null()
    character(len=80), pointer, contiguous :: names(:) => null()
  end type uamp_call_t

  type(uamp_call_t), pointer, save :: running => null()

contains

  !> left = 1 if the routine ended the analysis.
  subroutine run_uamp(arguments, kinc, left)
    type(uamp_call_t), intent(inout), target :: arguments
    integer(i4), intent(in) :: kinc
    integer(i4), intent(out) :: left
    current%routine = 'UAMP'
    current%element = 0
    current%step = arguments%info(4)
    current%increment = kinc
    call begin_call(0_i4, current%element)
    running => arguments
    left = int(protect(c_funloc(invoke), c_loc(arguments)), i4)
    nullify (running)
  end subroutine run_uamp

  !> Inputs of the routine are copied, so a routine that changes them affects nothing else.
  subroutine invoke(context) bind(c, name='uel_host_uamp')
    type(c_ptr), value :: context
    type(uamp_call_t), pointer :: a
    procedure(uamp_procedure), pointer :: uamp
    character(len=80) :: name
    real(dp) :: time(2), old, dtime, derivatives(4)
    integer(i4) :: nprops, nsvars, nsensor, info(4), table(1)
    call c_f_pointer(context, a)
    call c_f_procpointer(a%address, uamp)
    name = a%name
    time = a%time
    old = a%old
    dtime = a%dtime
    nprops = a%nprops
    nsvars = a%nsvars
    nsensor = a%nsensor
    info = a%info
    table = nsensor
    derivatives = 0
    call uamp(name, time, old, dtime, nprops, a%props, nsvars, a%svars, info, nsensor, a%sensors, a%names, table, a%value, &
              a%define, derivatives(1), derivatives(2), derivatives(3), derivatives(4))
  end subroutine invoke

  !> Number of a sensor in the current call; the analysis ends if there is no sensor with this name.
  function find_sensor(name) result(number)
    character(len=*), intent(in) :: name
    integer(i4) :: number
    if (associated(running)) then
      do number = 1, running%nsensor
        if (running%names(number) == name) return
      end do
    end if
    number = 0
    call add_message(-3_i4, 'there is no sensor '//trim(name)//' (*OUTPUT, HISTORY, SENSOR, NAME=)')
    call escape()
  end function find_sensor
end module host_uamp

!> Number of a sensor, for UAMP.
function igetsensorid(name, jsensorlookuptable) result(number)
  use host_kinds, only: i4
  use host_uamp, only: find_sensor
  implicit none (type, external)
  character(len=*), intent(in) :: name
  integer(i4), intent(in) :: jsensorlookuptable(*)
  integer(i4) :: number
  number = find_sensor(name)
end function igetsensorid

!> Value of a sensor at the end of the last increment, for UAMP.
function getsensorvalue(name, jsensorlookuptable, sensorvalues) result(value)
  use host_kinds, only: dp, i4
  use host_uamp, only: find_sensor
  implicit none (type, external)
  character(len=*), intent(in) :: name
  integer(i4), intent(in) :: jsensorlookuptable(*)
  real(dp), intent(in) :: sensorvalues(*)
  real(dp) :: value
  value = sensorvalues(find_sensor(name))
end function getsensorvalue
