! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> DLOAD at all points of nonuniform distributed loads on built-in elements (User Subroutines Guide, DLOAD).
module host_dload
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_f_procpointer, c_funloc, c_funptr, c_loc, c_ptr
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_protect, only: calls, protect
  implicit none (type, external)
  private
  public :: dload_pass_t, run_dload

  abstract interface
    subroutine dload_procedure(f, kstep, kinc, time, noel, npt, layer, kspt, coords, jltyp, sname)
      import :: dp, i4
      real(dp) :: f, time(*), coords(*)
      integer(i4) :: kstep, kinc, noel, npt, layer, kspt, jltyp
      character(len=80) :: sname
    end subroutine dload_procedure
  end interface

  !> One pass over all points. Arrays belong to the caller.
  type :: dload_pass_t
    type(c_funptr) :: address
    integer(i4) :: kstep = 0, kinc = 0
    real(dp) :: time(2) = 0                                      !< step and total time at the end of the increment
    integer(i4), pointer, contiguous :: places(:, :) => null()   !< (3, n) element number, point, JLTYP
    real(dp), pointer, contiguous :: coords(:, :) => null()      !< (3, n)
    real(dp), pointer, contiguous :: values(:) => null()         !< (n) by magnitude and amplitude, then those of DLOAD
  end type dload_pass_t

contains

  !> left = 1 if the routine ended the analysis, at current%element.
  subroutine run_dload(pass, left)
    type(dload_pass_t), intent(in), target :: pass
    integer(i4), intent(out) :: left
    current%routine = 'DLOAD'
    current%step = pass%kstep
    current%increment = pass%kinc
    left = int(protect(c_funloc(all_points), c_loc(pass)), i4)
    if (left == 0) current%element = 0
  end subroutine run_dload

  subroutine all_points(context) bind(c, name='uel_host_dload_points')
    type(c_ptr), value :: context
    type(dload_pass_t), pointer :: pass
    procedure(dload_procedure), pointer :: dload
    integer(i4) :: k, kstep, kinc, noel, npt, layer, kspt, jltyp
    real(dp) :: f, time(2), coords(3)
    character(len=80) :: sname
    call c_f_pointer(context, pass)
    call c_f_procpointer(pass%address, dload)
    do k = 1, size(pass%values, kind=i4)
      current%element = pass%places(1, k)
      calls = calls + 1
      f = pass%values(k)
      kstep = pass%kstep
      kinc = pass%kinc
      time = pass%time
      noel = pass%places(1, k)
      npt = pass%places(2, k)
      layer = 1
      kspt = 1
      coords = pass%coords(:, k)
      jltyp = pass%places(3, k)
      sname = ' '
      call dload(f, kstep, kinc, time, noel, npt, layer, kspt, coords, jltyp, sname)
      pass%values(k) = f
    end do
  end subroutine all_points
end module host_dload
