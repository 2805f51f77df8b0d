! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> SIGINI (User Subroutines Guide, SIGINI): the initial stress of each material point of built-in elements, once, before the first
!> step.
module host_sigini
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_f_procpointer, c_funloc, c_funptr, c_loc, c_ptr
  use host_context, only: current
  use host_guarded, only: guarded_t, lay_out_guarded, warn_of_writes
  use host_kinds, only: dp, i4
  use host_kinematics, only: point_position
  use host_protect, only: begin_call, protect
  use host_shape, only: rule_of
  implicit none (type, external)
  private
  public :: sigini_pass_t, run_sigini

  abstract interface
    subroutine sigini_procedure(sigma, coords, ntens, ncrds, noel, npt, layer, kspt, lrebar, names)
      import :: dp, i4
      real(dp) :: sigma(*), coords(*)
      integer(i4) :: ntens, ncrds, noel, npt, layer, kspt, lrebar
      character(len=80) :: names(2)
    end subroutine sigini_procedure
  end interface

  !> One pass over a block. Arrays belong to the caller.
  type :: sigini_pass_t
    type(c_funptr) :: address
    character(len=80) :: element_type = ' '
    integer :: family = 0                                          !< of the elements (host_shape)
    integer(i4), pointer, contiguous :: labels(:) => null()
    real(dp), pointer, contiguous :: coords(:, :, :) => null()     !< (mcrd, nnode, m)
    real(dp), pointer, contiguous :: sigma(:, :, :) => null()      !< (NTENS, points, m) as SIGINI leaves it, zero before
  end type sigini_pass_t

  type(guarded_t), save, target :: work

contains

  !> left = 1 if the routine ended the analysis, at current%element.
  subroutine run_sigini(pass, left)
    type(sigini_pass_t), intent(in), target :: pass
    integer(i4), intent(out) :: left
    current%routine = 'SIGINI'
    current%step = 1
    current%increment = 0
    left = int(protect(c_funloc(all_points), c_loc(pass)), i4)
    if (left == 0) current%element = 0
  end subroutine run_sigini

  subroutine all_points(context) bind(c, name='uel_host_sigini_points')
    type(c_ptr), value :: context
    type(sigini_pass_t), pointer :: pass
    logical :: reported(1)
    integer(i4) :: e, point
    call c_f_pointer(context, pass)
    reported = .false.
    call lay_out_guarded(work, [size(pass%sigma, 1)])
    do e = 1, size(pass%labels, kind=i4)
      current%element = pass%labels(e)
      do point = 1, size(pass%sigma, 2, kind=i4)
        current%point = point
        call begin_call(0_i4, current%element)
        call call_sigini(pass, point, pass%coords(:, :, e), pass%sigma(:, point, e), reported)
      end do
    end do
  end subroutine all_points

  subroutine call_sigini(pass, point, x, sigma, reported)
    type(sigini_pass_t), intent(in) :: pass
    integer(i4), intent(in) :: point
    real(dp), intent(in) :: x(:, :)
    real(dp), intent(out) :: sigma(:)
    logical, intent(inout) :: reported(1)   !< a write outside SIGMA is
    procedure(sigini_procedure), pointer :: sigini
    real(dp) :: coords(3)
    integer(i4) :: ntens, ncrds, noel, npt, layer, kspt, lrebar
    character(len=80) :: names(2)
    call c_f_procpointer(pass%address, sigini)
    coords = point_position(rule_of(pass%family, size(pass%sigma, 2)), int(point), x)
    ntens = size(sigma, kind=i4)
    ncrds = size(x, 1, kind=i4)
    noel = current%element
    npt = point
    layer = 1
    kspt = 1
    lrebar = 0
    names = [character(len=80) :: ' ', pass%element_type]
    associate (memory => work%memory, s => work%start(1))
      memory(s:s + ntens - 1) = 0
      call sigini(memory(s), coords, ntens, ncrds, noel, npt, layer, kspt, lrebar, names)
      call warn_of_writes(work, ['SIGMA'], ['NTENS'], point, reported)
      sigma = memory(s:s + size(sigma) - 1)
    end associate
  end subroutine call_sigini
end module host_sigini
