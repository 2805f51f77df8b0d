! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> ORIENT for all elements of a block, at the start of the analysis (User Subroutines Guide, ORIENT): for each material point of
!> continuum elements, whose default basis directions are the global ones.
module host_orient
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_f_procpointer, c_funloc, c_funptr, c_loc, c_ptr
  use host_context, only: current
  use host_guarded, only: guarded_t, lay_out_guarded, warn_of_writes
  use host_kinds, only: dp, i4
  use host_kinematics, only: point_position
  use host_protect, only: begin_call, protect
  use host_shape, only: rule_of
  implicit none (type, external)
  private
  public :: orient_pass_t, run_orient

  abstract interface
    subroutine orient_procedure(t, noel, npt, layer, kspt, coords, basis, orname, nnodes, cnodes, jnnum)
      import :: dp, i4
      real(dp) :: t(*), coords(*), basis(*), cnodes(*)
      character(len=80) :: orname
      integer(i4) :: noel, npt, layer, kspt, nnodes, jnnum(*)
    end subroutine orient_procedure
  end interface

  !> One pass over a block. Arrays belong to the caller.
  type :: orient_pass_t
    type(c_funptr) :: address
    character(len=80) :: name = ' '                                !< of the orientation
    integer :: family = 0                                          !< of the elements (host_shape)
    integer(i4), pointer, contiguous :: labels(:) => null()
    integer(i4), pointer, contiguous :: nodes(:, :) => null()      !< (nnode, m) their numbers
    real(dp), pointer, contiguous :: coords(:, :, :) => null()     !< (mcrd, nnode, m)
    real(dp), pointer, contiguous :: t(:, :, :, :) => null()       !< (3, 3, points, m) as ORIENT leaves it, zero before
  end type orient_pass_t

  type(guarded_t), save, target :: work

contains

  !> left = 1 if the routine ended the analysis, at current%element.
  subroutine run_orient(pass, left)
    type(orient_pass_t), intent(in), target :: pass
    integer(i4), intent(out) :: left
    current%routine = 'ORIENT'
    current%step = 1
    current%increment = 0
    left = int(protect(c_funloc(all_points), c_loc(pass)), i4)
    if (left == 0) current%element = 0
  end subroutine run_orient

  subroutine all_points(context) bind(c, name='uel_host_orient_points')
    type(c_ptr), value :: context
    type(orient_pass_t), pointer :: pass
    logical :: reported(1)
    integer(i4) :: e, point
    call c_f_pointer(context, pass)
    reported = .false.
    call lay_out_guarded(work, [9])
    do e = 1, size(pass%labels, kind=i4)
      current%element = pass%labels(e)
      do point = 1, size(pass%t, 3, kind=i4)
        current%point = point
        call begin_call(0_i4, current%element)
        call call_orient(pass, point, pass%nodes(:, e), pass%coords(:, :, e), pass%t(:, :, point, e), reported)
      end do
    end do
  end subroutine all_points

  subroutine call_orient(pass, point, nodes, x, t, reported)
    type(orient_pass_t), intent(in) :: pass
    integer(i4), intent(in) :: point, nodes(:)
    real(dp), intent(in) :: x(:, :)
    real(dp), intent(out) :: t(3, 3)
    logical, intent(inout) :: reported(1)   !< a write outside T is
    procedure(orient_procedure), pointer :: orient
    real(dp) :: coords(3), basis(3, 3), cnodes(3, size(nodes))
    integer(i4) :: noel, npt, layer, kspt, nnodes, jnnum(size(nodes))
    character(len=80) :: orname
    call c_f_procpointer(pass%address, orient)
    coords = point_position(rule_of(pass%family, size(pass%t, 3)), int(point), x)
    basis = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])
    orname = pass%name
    noel = current%element
    npt = point
    layer = 0
    kspt = 0
    nnodes = size(nodes, kind=i4)
    jnnum = nodes
    cnodes = 0
    cnodes(:size(x, 1), :) = x
    associate (memory => work%memory, s => work%start(1))
      memory(s:s + 8) = 0
      call orient(memory(s), noel, npt, layer, kspt, coords, basis, orname, nnodes, cnodes, jnnum)
      call warn_of_writes(work, ['T'], ['3 x 3'], point, reported)
      t = reshape(memory(s:s + 8), [3, 3])
    end associate
  end subroutine call_orient
end module host_orient
