! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Values that user routines define at given points (User Subroutines Guide): DISP for what *BOUNDARY, USER prescribes, DLOAD for
!> nonuniform distributed loads on built-in elements.
module host_values
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_f_procpointer, c_funloc, c_funptr, c_loc, c_ptr
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_protect, only: begin_call, protect
  implicit none (type, external)
  private
  public :: value_pass_t, run_values

  abstract interface
    subroutine disp_procedure(u, kstep, kinc, time, node, noel, jdof, coords)
      import :: dp, i4
      real(dp) :: u(*), time(*), coords(*)
      integer(i4) :: kstep, kinc, node, noel, jdof
    end subroutine disp_procedure

    subroutine dload_procedure(f, kstep, kinc, time, noel, npt, layer, kspt, coords, jltyp, sname)
      import :: dp, i4
      real(dp) :: f, time(*), coords(*)
      integer(i4) :: kstep, kinc, noel, npt, layer, kspt, jltyp
      character(len=80) :: sname
    end subroutine dload_procedure
  end interface

  !> Rows of the places of DISP; DLOAD has one more.
  integer, parameter :: rows_of_disp = 2

  !> One pass over all places. Arrays belong to the caller.
  type :: value_pass_t
    type(c_funptr) :: address
    integer(i4) :: kstep = 0, kinc = 0
    integer(i4) :: last = 0                                      !< place that was asked for last
    real(dp) :: time(2) = 0                                      !< step and total time at the end of the increment
    integer(i4), pointer, contiguous :: places(:, :) => null()   !< DISP: node number, dof; DLOAD: element number, point, JLTYP
    real(dp), pointer, contiguous :: coords(:, :) => null()      !< (3, n)
    real(dp), pointer, contiguous :: values(:) => null()         !< (n) by magnitude and amplitude, then those of the routine
  end type value_pass_t

contains

  !> left = 1 if the routine ended the analysis, at pass%last.
  subroutine run_values(pass, left)
    type(value_pass_t), intent(inout), target :: pass
    integer(i4), intent(out) :: left
    current%routine = merge('DISP ', 'DLOAD', size(pass%places, 1) == rows_of_disp)
    current%element = 0
    current%step = pass%kstep
    current%increment = pass%kinc
    left = int(protect(c_funloc(all_places), c_loc(pass)), i4)
    if (left == 0) current%element = 0
  end subroutine run_values

  subroutine all_places(context) bind(c, name='uel_host_all_places')
    type(c_ptr), value :: context
    type(value_pass_t), pointer :: pass
    integer(i4) :: k
    call c_f_pointer(context, pass)
    do k = 1, size(pass%values, kind=i4)
      pass%last = k
      if (size(pass%places, 1) == rows_of_disp) then
        call begin_call(0_i4, 0_i4)
        call prescribe(pass, pass%places(:, k), pass%coords(:, k), pass%values(k))
      else
        current%element = pass%places(1, k)
        call begin_call(0_i4, current%element)
        call load(pass, pass%places(:, k), pass%coords(:, k), pass%values(k))
      end if
    end do
  end subroutine all_places

  ! arguments are copies, so a user routine that changes them affects nothing else

  subroutine prescribe(pass, place, x, value)
    type(value_pass_t), intent(in) :: pass
    integer(i4), intent(in) :: place(:)
    real(dp), intent(in) :: x(3)
    real(dp), intent(inout) :: value
    procedure(disp_procedure), pointer :: disp
    integer(i4) :: kstep, kinc, node, noel, jdof
    real(dp) :: u(3), time(2), coords(3)
    call c_f_procpointer(pass%address, disp)
    u = [value, 0.0_dp, 0.0_dp]
    kstep = pass%kstep
    kinc = pass%kinc
    time = pass%time
    node = place(1)
    noel = 0
    jdof = place(2)
    coords = x
    call disp(u, kstep, kinc, time, node, noel, jdof, coords)
    value = u(1)
  end subroutine prescribe

  subroutine load(pass, place, x, value)
    type(value_pass_t), intent(in) :: pass
    integer(i4), intent(in) :: place(:)
    real(dp), intent(in) :: x(3)
    real(dp), intent(inout) :: value
    procedure(dload_procedure), pointer :: dload
    integer(i4) :: kstep, kinc, noel, npt, layer, kspt, jltyp
    real(dp) :: f, time(2), coords(3)
    character(len=80) :: sname
    call c_f_procpointer(pass%address, dload)
    f = value
    kstep = pass%kstep
    kinc = pass%kinc
    time = pass%time
    noel = place(1)
    npt = place(2)
    layer = 1
    kspt = 1
    coords = x
    jltyp = place(3)
    sname = ' '
    call dload(f, kstep, kinc, time, noel, npt, layer, kspt, coords, jltyp, sname)
    value = f
  end subroutine load
end module host_values
