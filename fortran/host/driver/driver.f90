! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The element loop: one pass over a block of like elements, with checks and scatter.
module host_driver
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_funloc, c_loc, c_ptr
  use host_block, only: block_t, entries_notice, entries_zero, fault_distorted, fault_endless, fault_left, fault_none, &
                        fault_outside, fault_unset, guards_notice, guards_search, guards_stop
  use host_call, only: arguments_t, lay_out_arguments
  use host_context, only: call_context, current
  use host_element, only: arguments, call_element, check_results, prepare, work
  use host_kinds, only: dp, i4
  use host_protect, only: protect
  use host_scatter, only: add_energy, add_magnitude, add_matrix, add_residual
  use host_team, only: run_team
  use host_workspace, only: arm_guards, exchange_guard_values, find_damage, i_amatrx, i_energy, i_rhs, n_arrays, set_room, &
                            workspace_t
  implicit none (type, external)
  private
  public :: run_block, set_guard_values, set_guard_room

  !> Routines of points, in the order of POINT_ROUTINES in harness/uel/usersub/_binding.py.
  character(len=16), parameter :: point_routines(13) = &
    [character(len=16) :: 'UMAT', 'USDFLD', 'UMATHT', 'HETVAL', 'DFLUX', 'FILM', 'UHYPER', 'UANISOHYPER_INV', 'UHARD', &
     'UCREEPNETWORK', 'UTRSNETWORK', 'UVARM', 'CREEP']

  !> A pass of this thread. The places of its own variables are looked up once, not for each element.
  type :: pass_t
    type(block_t), pointer :: block => null()
    type(workspace_t), pointer :: work => null()
    type(arguments_t), pointer :: arguments => null()
    type(call_context), pointer :: now => null()
  end type pass_t

contains

  !> Run a pass. On a fault, fault, position, array and index say what happened and the sums are invalid, except in a block that
  !> continues after a write outside an array: its sums are those of the pass.
  subroutine run_block(block)
    type(block_t), intent(inout), target :: block
    type(pass_t), target :: pass
    integer :: array, index
    call prepare(block)
    if (block%parallel) call run_team(block)
    pass = pass_t(block, work, arguments, current)
    select case (protect(c_funloc(loop), c_loc(pass)))
    case (0)
    case (2)
      block%fault = fault_endless
    case default
      block%fault = merge(fault_distorted, fault_left, current%distorted /= 0)
      block%index = current%distorted
      block%array = findloc(point_routines, current%routine, dim=1)
      if (block%array > 0) block%index = current%point
    end select
    call find_damage(work, array, index)
    if (array > 0 .and. block%guards == guards_stop) call diagnose(block, array, index)
    if (block%guards /= guards_stop) call notice(block, array, index)
    if (block%fault == fault_none .and. block%unset(1) > 0) call report(block, fault_unset, block%unset)
    current%element = 0
    current%iteration = 0
  end subroutine run_block

  !> Swap the values of guards and unset entries, see exchange_guard_values.
  subroutine set_guard_values(values)
    real(dp), intent(inout) :: values(n_arrays + 1)
    call exchange_guard_values(work, values)
  end subroutine set_guard_values

  !> Swap the minimum number of entries of the guard after each array.
  subroutine set_guard_room(room)
    integer, intent(inout) :: room
    call set_room(work, room)
  end subroutine set_guard_room

  subroutine loop(context) bind(c)
    type(c_ptr), value :: context   ! is the pass
    type(pass_t), pointer :: pass
    call c_f_pointer(context, pass)
    call all_elements(pass%block, pass%work, pass%arguments, pass%now)
  end subroutine loop

  !> All elements of the block, until a fault.
  subroutine all_elements(block, work, arguments, now)
    type(block_t), intent(inout) :: block
    type(workspace_t), intent(in) :: work
    type(arguments_t), intent(inout) :: arguments
    type(call_context), intent(inout) :: now
    integer :: e, ndofel, array, index
    ndofel = int(block%scalars%ndofel)
    do e = block%first, size(block%labels)
      block%position = e
      call call_element(block, e, arguments, now)
      if (block%guards == guards_search .and. block%culprit(1) == 0) then
        call find_damage(work, array, index)
        if (array > 0) block%culprit = int([e, array, index], i4)
      end if
      call check_results(block, work)
      if (block%fault == fault_unset .and. block%entries == entries_notice) call repeat_on_zeros(block, e)
      if (block%fault /= fault_none) return
      if (block%keeps_state) call add_energy(work%memory(work%start(i_energy)), block%energy_sum)
      if (block%want_residual) then
        call add_residual(ndofel, work%memory(work%start(i_rhs)), block%equations(:, e), block%residual(:, 1))
        call add_magnitude(ndofel, work%memory(work%start(i_rhs)), block%floor, block%flux(:, 1), block%flux(:, 2), &
                           block%flux(:, 3))
        if (block%scalars%nrhs == 2) then
          call add_residual(ndofel, work%memory(work%start(i_rhs) + ndofel), block%equations(:, e), block%residual(:, 2))
        end if
      end if
      if (block%want_matrix) then
        call add_matrix(ndofel, work%memory(work%start(i_amatrx)), block%map(:, :, e), block%symmetric, block%matrix)
      end if
    end do
  end subroutine all_elements

  !> Repeat the call of an element that left an entry unset, with RHS and AMATRX zero on entry; likewise for the elements after it.
  subroutine repeat_on_zeros(block, e)
    type(block_t), intent(inout) :: block
    integer, intent(in) :: e
    block%unset = [int(e, i4), block%array, block%index]
    block%entries = entries_zero
    block%fault = fault_none
    call lay_out_arguments(block, work, arguments)
    call call_element(block, e, arguments, current)
    call check_results(block, work)
  end subroutine repeat_on_zeros

  !> Find the element that wrote outside an array: run the block again and check after each element. If the second run does no
  !> damage, the element remains unknown (position 0).
  subroutine diagnose(block, array, index)
    type(block_t), intent(inout), target :: block
    integer, intent(in) :: array, index
    block%fault = fault_outside
    block%position = 0
    block%array = array
    block%index = index
    call arm_guards(work)
    if (protect(c_funloc(search), c_loc(block)) /= 0) call look(block)
    call arm_guards(work)
  end subroutine diagnose

  !> Report damage, unless the pass has ended with another fault. The element is known only if each one was checked.
  subroutine notice(block, array, index)
    type(block_t), intent(inout) :: block
    integer, intent(in) :: array, index
    if (array > 0) call arm_guards(work)
    if (block%fault /= fault_none) return
    if (block%guards == guards_notice .and. array > 0) then
      block%fault = fault_outside
      block%position = 0
      block%array = array
      block%index = index
    else if (block%guards == guards_search .and. block%culprit(1) > 0) then
      call report(block, fault_outside, block%culprit)
    end if
  end subroutine notice

  !> Report what the pass has noticed: element, array and entry.
  subroutine report(block, fault, place)
    type(block_t), intent(inout) :: block
    integer(i4), intent(in) :: fault, place(3)
    block%fault = fault
    block%position = place(1)
    block%array = place(2)
    block%index = place(3)
  end subroutine report

  !> Second run over the block.
  subroutine search(context) bind(c)
    type(c_ptr), value :: context
    type(block_t), pointer :: block
    integer :: e
    call c_f_pointer(context, block)
    do e = 1, size(block%labels)
      call call_element(block, e, arguments, current)
      call look(block)
      if (block%position > 0) return
    end do
  end subroutine search

  !> Attribute damaged guards to the current element.
  subroutine look(block)
    type(block_t), intent(inout) :: block
    integer :: array, index
    call find_damage(work, array, index)
    if (array == 0) return
    block%array = array
    block%index = index
    block%position = findloc(block%labels, current%element, dim=1)
  end subroutine look

end module host_driver
