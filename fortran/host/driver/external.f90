! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> UEXTERNALDB, called so that XIT in it returns here.
module host_external
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_f_procpointer, c_funloc, c_funptr, c_intptr_t, c_loc, c_ptr
  use host_context, only: current
  use host_interfaces, only: uexternaldb_procedure
  use host_kinds, only: dp, i4, i8
  use host_protect, only: begin_call, protect
  implicit none (type, external)
  private
  public :: call_external_database

  type :: arguments_t
    procedure(uexternaldb_procedure), pointer, nopass :: routine => null()
    integer(i4) :: lop = 0, lrestart = 0, kstep = 0, kinc = 0
    real(dp) :: time(2) = 0, dtime = 0
  end type arguments_t

contains

  !> left = 1 if the routine ended the analysis, else 0.
  subroutine call_external_database(address, lop, lrestart, time, dtime, kstep, kinc, left)
    integer(i8), intent(in) :: address
    integer(i4), intent(in) :: lop, lrestart, kstep, kinc
    real(dp), intent(in) :: time(2), dtime
    integer(i4), intent(out) :: left
    type(arguments_t), target :: arguments
    type(c_funptr) :: pointer
    pointer = transfer(int(address, c_intptr_t), pointer)
    call c_f_procpointer(pointer, arguments%routine)
    arguments%lop = lop
    arguments%lrestart = lrestart
    arguments%kstep = kstep
    arguments%kinc = kinc
    arguments%time = time
    arguments%dtime = dtime
    current%routine = 'UEXTERNALDB'
    current%element = 0
    call begin_call(0_i4, current%element)
    current%step = kstep
    current%increment = kinc
    left = int(protect(c_funloc(invoke), c_loc(arguments)), i4)
  end subroutine call_external_database

  subroutine invoke(context) bind(c)
    type(c_ptr), value :: context
    type(arguments_t), pointer :: arguments
    call c_f_pointer(context, arguments)
    call arguments%routine(arguments%lop, arguments%lrestart, arguments%time, arguments%dtime, arguments%kstep, &
                           arguments%kinc)
  end subroutine invoke
end module host_external
