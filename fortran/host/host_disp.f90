! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> DISP for all values that *BOUNDARY, USER prescribes (User Subroutines Guide, DISP).
module host_disp
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_f_procpointer, c_funloc, c_funptr, c_loc, c_ptr
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_protect, only: calls, protect
  implicit none (type, external)
  private
  public :: disp_pass_t, run_disp

  abstract interface
    subroutine disp_procedure(u, kstep, kinc, time, node, noel, jdof, coords)
      import :: dp, i4
      real(dp) :: u(*), time(*), coords(*)
      integer(i4) :: kstep, kinc, node, noel, jdof
    end subroutine disp_procedure
  end interface

  !> One pass over all values. Arrays belong to the caller.
  type :: disp_pass_t
    type(c_funptr) :: address
    integer(i4) :: kstep = 0, kinc = 0, last = 0                 !< last: value that was asked for last
    real(dp) :: time(2) = 0                                      !< step and total time at the end of the increment
    integer(i4), pointer, contiguous :: places(:, :) => null()   !< (2, n) node number, dof
    real(dp), pointer, contiguous :: coords(:, :) => null()      !< (3, n) of the nodes
    real(dp), pointer, contiguous :: values(:) => null()         !< (n) by magnitude and amplitude, then those of DISP
  end type disp_pass_t

contains

  !> left = 1 if the routine ended the analysis, at pass%last.
  subroutine run_disp(pass, left)
    type(disp_pass_t), intent(inout), target :: pass
    integer(i4), intent(out) :: left
    current%routine = 'DISP'
    current%element = 0
    current%step = pass%kstep
    current%increment = pass%kinc
    left = int(protect(c_funloc(all_values), c_loc(pass)), i4)
  end subroutine run_disp

  subroutine all_values(context) bind(c, name='uel_host_disp_values')
    type(c_ptr), value :: context
    type(disp_pass_t), pointer :: pass
    procedure(disp_procedure), pointer :: disp
    integer(i4) :: k, kstep, kinc, node, noel, jdof
    real(dp) :: u(3), time(2), coords(3)
    call c_f_pointer(context, pass)
    call c_f_procpointer(pass%address, disp)
    do k = 1, size(pass%values, kind=i4)
      pass%last = k
      calls = calls + 1
      u = [pass%values(k), 0.0_dp, 0.0_dp]
      kstep = pass%kstep
      kinc = pass%kinc
      time = pass%time
      node = pass%places(1, k)
      noel = 0
      jdof = pass%places(2, k)
      coords = pass%coords(:, k)
      call disp(u, kstep, kinc, time, node, noel, jdof, coords)
      pass%values(k) = u(1)
    end do
  end subroutine all_values
end module host_disp
