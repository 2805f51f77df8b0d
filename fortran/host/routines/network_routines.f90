! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> UCREEPNETWORK and UTRSNETWORK at a material point, with the arguments of Abaqus (User Subroutines Guide), which are the same
!> but for the entries of their arrays.
module host_network_routines
  use, intrinsic :: iso_c_binding, only: c_f_procpointer, c_funptr
  use host_context, only: current
  use host_guarded, only: guarded_t, lay_out_guarded, warn_of_no_numbers, warn_of_writes
  use host_kinds, only: dp, i4
  use host_point, only: fields_at_end, point_t
  implicit none (type, external)
  private
  public :: network_routine_t, call_network_routine, outputs

  !> Arrays that they write to.
  integer, parameter :: outputs = 2
  character(len=10), parameter :: names(outputs) = [character(len=10) :: 'OUTPUTDATA', 'STATEV']
  character(len=7), parameter :: sizes(outputs) = [character(len=7) :: 'NOUTPUT', '*DEPVAR']
  type(guarded_t), save, target :: work   ! each thread has its own
  !$omp threadprivate(work)

  type :: network_routine_t
    type(c_funptr) :: address
    character(len=16) :: routine = ' '          !< its name
    character(len=80) :: material = ' '
    integer(i4) :: network = 0                  !< NETWORKID
    real(dp), allocatable :: constants(:)       !< PROPS
    logical, pointer :: reported(:) => null()   !< (outputs) a write outside the array is
    logical, pointer :: spoilt(:) => null()     !< (outputs) NaN in the array is
  end type network_routine_t

  abstract interface
    subroutine network_procedure(outputdata, statev, noutput, nstatv, networkid, coords, temp, dtemp, nfield, predef, dpred, &
                                 nprops, props, i_array, niarray, r_array, nrarray, c_array, ncarray)
      import :: dp, i4
      real(dp) :: outputdata(*), statev(*), coords(*), temp, dtemp, predef(*), dpred(*), props(*), r_array(*)
      integer(i4) :: noutput, nstatv, networkid, nfield, nprops, i_array(*), niarray, nrarray, ncarray
      character(len=80) :: c_array(*)
    end subroutine network_procedure
  end interface

contains

  !> integers and reals: what follows KSTEP, KINC, NOEL, NPT, LAYER, KSPT in I_ARRAY and the time increment in R_ARRAY.
  subroutine call_network_routine(this, point, integers, times, reals, statev, output)
    type(network_routine_t), intent(in) :: this
    type(point_t), intent(inout) :: point
    integer(i4), intent(in) :: integers(:)
    real(dp), intent(in) :: times(2)               !< creep time at the end of the increment, length of the increment
    real(dp), intent(in) :: reals(:)
    real(dp), intent(inout) :: statev(:)
    real(dp), intent(out) :: output(:)
    procedure(network_procedure), pointer :: routine
    real(dp) :: coords(3), temp, dtemp, constants(size(this%constants)), r_array(4 + size(reals))
    real(dp), allocatable :: predef(:), dpred(:)
    integer(i4) :: noutput, nstatv, networkid, nfield, nprops, i_array(6 + size(integers)), niarray, nrarray, ncarray
    character(len=80) :: c_array(1)
    character(len=len(current%routine)) :: caller
    call c_f_procpointer(this%address, routine)
    noutput = size(output, kind=i4)
    nstatv = size(statev, kind=i4)
    call lay_out_guarded(work, [int(noutput), int(nstatv)])
    networkid = this%network
    coords = point%place
    call fields_at_end(point, temp, dtemp, predef, dpred)
    nfield = size(predef, kind=i4)
    constants = this%constants
    nprops = size(constants, kind=i4)
    i_array = [current%step, current%increment, current%element, point%number, 1_i4, 1_i4, integers]
    niarray = size(i_array, kind=i4)
    r_array = [current%time + current%dtime, times, reals]
    nrarray = size(r_array, kind=i4)
    c_array = this%material
    ncarray = 1
    caller = current%routine
    current%routine = this%routine
    current%point = point%number
    associate (x => work%memory, s => work%start)
      x(s(1):s(1) + noutput - 1) = 0
      x(s(2):s(2) + nstatv - 1) = statev
      call routine(x(s(1)), x(s(2)), noutput, nstatv, networkid, coords, temp, dtemp, nfield, predef, dpred, nprops, constants, &
                   i_array, niarray, r_array, nrarray, c_array, ncarray)
      call warn_of_writes(work, names, sizes, point%number, this%reported)
      call warn_of_no_numbers(work, names, point%number, this%spoilt)
      output = x(s(1):s(1) + noutput - 1)
      statev = x(s(2):s(2) + nstatv - 1)
    end associate
    current%routine = caller
  end subroutine call_network_routine
end module host_network_routines
