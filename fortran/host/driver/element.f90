! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> A call of a user element: its results are checked, and its trial state kept.
module host_element
  use, intrinsic :: iso_c_binding, only: c_int64_t
  use host_block, only: block_t, fault_none, fault_not_finite, fault_unset, untouched
  use host_call, only: arguments_t, call_routine, lay_out_arguments, set_loads
  use host_context, only: call_context, current, output_variables
  use host_kinds, only: dp, i4
  use host_workspace, only: all_finite, i_amatrx, i_coords, i_du, i_energy, i_predef, i_props, i_rhs, i_svars, lay_out, &
                            n_arrays, same_bits, workspace_t
  implicit none (type, external)
  private
  public :: arguments, work, prepare, call_element, check_results, keep_smallest

  ! each thread has its own
  type(workspace_t), target, save :: work
  type(arguments_t), target, save :: arguments
  real(dp), allocatable, target, save :: discarded(:, :)   !< material history that a call leaves and that is not kept
  !$omp threadprivate(work, arguments, discarded)

contains

  !> Workspace and context of this block, with intact guards. Column 2 of DU is always zero.
  subroutine prepare(block)
    type(block_t), intent(in) :: block
    integer :: length(n_arrays)
    length = block%scalars%ndofel
    length(i_rhs) = block%scalars%ndofel*block%scalars%nrhs
    length(i_du) = length(i_rhs)   ! column 2 stays zero
    length(i_amatrx) = block%scalars%ndofel**2
    length(i_svars) = block%scalars%nsvars
    length(i_energy) = 8
    length(i_props) = block%scalars%nprops
    length(i_coords) = size(block%coords, 1)
    length(i_predef) = size(block%predef, 1)
    call lay_out(work, length)
    call lay_out_arguments(block, work, arguments)
    nullify (current%history, current%history_trial, current%visible%values)
    if (associated(block%history)) then
      if (allocated(discarded)) deallocate (discarded)
      allocate (discarded(size(block%history, 1), size(block%history, 2)))
    end if
    current%step = block%scalars%kstep
    current%increment = block%scalars%kinc
    current%iteration = block%iteration
    current%tensor = block%tensor
    current%deformed = .false.
    current%distorted = 0
    current%routine = merge('UELMAT', 'UEL   ', block%scalars%material > 0)
    if (block%built_in) current%routine = 'element'
    current%time = block%scalars%time - block%scalars%dtime
    current%dtime = block%scalars%dtime
    current%flags = block%scalars%lflags(:4)
    current%procedure = merge(0_i4, block%scalars%lflags(1), block%scalars%lflags(3) == 6)
  end subroutine prepare

  !> Set the fault if an entry of RHS or AMATRX of the current element is not a number, as far as they are checked.
  subroutine check_results(block, work)
    type(block_t), intent(inout) :: block
    type(workspace_t), intent(in) :: work
    if (block%want_residual) call check(block, work, i_rhs)
    if (block%want_matrix .and. block%fault == fault_none) call check(block, work, i_amatrx)
  end subroutine check_results

  !> Call an element; its trial state is kept.
  subroutine call_element(block, e, arguments, now)
    type(block_t), intent(inout) :: block
    integer, intent(in) :: e
    ! those of the thread, which finds them once for all elements
    type(arguments_t), intent(inout) :: arguments
    type(call_context), intent(inout) :: now
    now%element = block%labels(e)
    now%pnewdt = untouched
    if (associated(block%history)) call offer_history(block, e, now)
    if (arguments%layout%loaded /= 0) call set_loads(block, min(e, size(block%counts)), arguments)
    call call_routine(arguments%layout, int(e - 1, c_int64_t), now%thread, now%element)
    if (block%scalars%lflags(3) == 1) then
      call keep_smallest(min(arguments%given%pnewdt, now%pnewdt), arguments%given%pnewdt, block%pnewdt)
    end if
  end subroutine call_element

  !> The material history of an element: what is committed, and a copy that its call changes.
  subroutine offer_history(block, e, now)
    type(block_t), intent(in) :: block
    integer, intent(in) :: e
    type(call_context), intent(inout) :: now
    now%history => block%history(:, :, e)
    if (block%keeps_state .or. block%scalars%lflags(3) == output_variables) then
      now%history_trial => block%history_trial(:, :, e)
    else
      now%history_trial => discarded
    end if
    now%history_trial = now%history
  end subroutine offer_history

  !> Keep the smallest PNEWDT, or one that is not finite: no comparison finds a NaN, which stays for the caller to see.
  pure subroutine keep_smallest(smallest, returned, kept)
    real(dp), intent(in) :: smallest   !< of the element and its materials
    real(dp), intent(in) :: returned   !< by the element
    real(dp), intent(inout) :: kept
    if (.not. abs(kept) <= huge(kept)) return
    kept = min(kept, smallest)
    if (.not. abs(returned) <= huge(returned)) kept = returned
  end subroutine keep_smallest

  !> Set the fault if an entry of an array of the current element is not a number.
  subroutine check(block, work, array)
    type(block_t), intent(inout) :: block
    type(workspace_t), intent(in) :: work
    integer, intent(in) :: array
    integer :: i, n, s
    s = work%start(array)
    n = work%length(array)
    if (all_finite(n, work%memory(s))) return
    do i = 1, n
      if (all_finite(1, work%memory(s + i - 1))) cycle
      block%fault = merge(fault_unset, fault_not_finite, same_bits(work%memory(s + i - 1), work%unset))
      block%array = array
      block%index = i
      return
    end do
  end subroutine check
end module host_element
