! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Values that user routines define at given points (User Subroutines Guide): DISP for what *BOUNDARY, USER prescribes, DLOAD for
!> nonuniform distributed loads on built-in elements, UTEMP and UFIELD for *TEMPERATURE, USER and *FIELD, USER.
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

    subroutine utemp_procedure(temp, nsecpt, kstep, kinc, time, node, coords)
      import :: dp, i4
      real(dp) :: temp(*), time(*), coords(*)
      integer(i4) :: nsecpt, kstep, kinc, node
    end subroutine utemp_procedure

    subroutine ufield_procedure(field, kfield, nsecpt, kstep, kinc, time, node, coords, temp, dtemp, nfield)
      import :: dp, i4
      real(dp) :: field(*), time(*), coords(*), temp(*), dtemp(*)
      integer(i4) :: kfield, nsecpt, kstep, kinc, node, nfield
    end subroutine ufield_procedure
  end interface

  !> Numbers of the routines, in the order of VALUE_ROUTINES in harness/uel/usersub/_binding.py.
  integer(i4), parameter :: of_disp = 1, of_dload = 2, of_utemp = 3, of_ufield = 4
  character(len=6), parameter :: names(4) = [character(len=6) :: 'DISP', 'DLOAD', 'UTEMP', 'UFIELD']

  !> One pass over all places. Arrays belong to the caller.
  type :: value_pass_t
    type(c_funptr) :: address
    integer(i4) :: routine = of_disp
    integer(i4) :: kstep = 0, kinc = 0
    integer(i4) :: last = 0                                      !< place that was asked for last
    real(dp) :: time(2) = 0                                      !< step and total time at the end of the increment
    real(dp) :: dtime = 0                                        !< time increment, for DISP
    !> DISP: node number, dof; DLOAD: element number, point, JLTYP; UTEMP, UFIELD: node number, number of the field
    integer(i4), pointer, contiguous :: places(:, :) => null()
    real(dp), pointer, contiguous :: temperatures(:, :) => null()   !< (2, n) for UFIELD: at the end, and the increment
    real(dp), pointer, contiguous :: coords(:, :) => null()      !< (3, n)
    real(dp), pointer, contiguous :: values(:) => null()         !< (n) by magnitude and amplitude, then those of the routine
  end type value_pass_t

contains

  !> left = 1 if the routine ended the analysis, at pass%last.
  subroutine run_values(pass, left)
    type(value_pass_t), intent(inout), target :: pass
    integer(i4), intent(out) :: left
    current%routine = names(pass%routine)
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
      if (pass%routine == of_dload) current%element = pass%places(1, k)
      call begin_call(0_i4, current%element)
      select case (pass%routine)
      case (of_disp)
        call prescribe(pass, pass%places(:, k), pass%coords(:, k), pass%values(k))
      case (of_dload)
        call load(pass, pass%places(:, k), pass%coords(:, k), pass%values(k))
      case default
        call predefine(pass, pass%places(:, k), pass%coords(:, k), pass%temperatures(:, k), pass%values(k))
      end select
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
    real(dp) :: u(3), time(3), coords(3)
    call c_f_procpointer(pass%address, disp)
    u = [value, 0.0_dp, 0.0_dp]
    kstep = pass%kstep
    kinc = pass%kinc
    time = [pass%time, pass%dtime]
    node = place(1)
    noel = 0
    jdof = place(2)
    coords = x
    call disp(u, kstep, kinc, time, node, noel, jdof, coords)
    value = u(1)
  end subroutine prescribe

  subroutine predefine(pass, place, x, temperature, value)
    type(value_pass_t), intent(in) :: pass
    integer(i4), intent(in) :: place(:)
    real(dp), intent(in) :: x(3), temperature(2)
    real(dp), intent(inout) :: value
    procedure(utemp_procedure), pointer :: utemp
    procedure(ufield_procedure), pointer :: ufield
    integer(i4) :: kstep, kinc, node, nsecpt, kfield, nfield
    real(dp) :: field(1), time(2), coords(3), temp(1), dtemp(1)
    field = value
    nsecpt = 1
    kstep = pass%kstep
    kinc = pass%kinc
    time = pass%time
    node = place(1)
    coords = x
    if (pass%routine == of_utemp) then
      call c_f_procpointer(pass%address, utemp)
      call utemp(field, nsecpt, kstep, kinc, time, node, coords)
    else
      call c_f_procpointer(pass%address, ufield)
      kfield = place(2)
      temp = temperature(1)
      dtemp = temperature(2)
      nfield = 1
      call ufield(field, kfield, nsecpt, kstep, kinc, time, node, coords, temp, dtemp, nfield)
    end if
    value = field(1)
  end subroutine predefine

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
