! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> A call of a user element: arguments gathered between guards, results checked, its trial state kept.
module host_element
  use, intrinsic :: iso_c_binding, only: c_funptr
  use host_context, only: call_context, current, initial_stresses, output_variables
  use host_interfaces, only: uel_procedure, uelmat_procedure
  use host_kinds, only: dp, i4, i8
  use host_protect, only: begin_call
  use host_workspace, only: all_finite, copy, fill, i_a, i_amatrx, i_coords, i_du, i_energy, i_predef, i_props, i_rhs, i_svars, &
                            i_u, i_v, lay_out, n_arrays, same_bits, workspace_t
  implicit none (type, external)
  private
  public :: block_t, scalars_t, work, prepare, call_element, check_results, keep_smallest, keeps_state, untouched
  public :: fault_none, fault_left, fault_outside, fault_unset, fault_not_finite, fault_endless, fault_distorted
  public :: guards_stop, guards_notice, guards_search, entries_notice, entries_zero

  integer(i4), parameter :: fault_none = 0        !< all went well
  integer(i4), parameter :: fault_left = 1        !< the user routine ended the analysis
  integer(i4), parameter :: fault_outside = 2     !< a write outside an array
  integer(i4), parameter :: fault_unset = 3       !< an entry was not set
  integer(i4), parameter :: fault_not_finite = 4  !< an entry is NaN or infinite
  integer(i4), parameter :: fault_endless = 5     !< a call did not return within the time limit

  integer(i4), parameter :: fault_distorted = 6   !< a built-in element has turned inside out

  integer(i4), parameter :: guards_stop = 0       !< a write outside an array ends the pass; the element is searched for
  integer(i4), parameter :: guards_notice = 1     !< it is reported after the pass
  integer(i4), parameter :: guards_search = 2     !< each element is checked for it
  integer(i4), parameter :: guards_ignore = 3     !< it is ignored

  integer(i4), parameter :: entries_stop = 0      !< an entry of RHS or AMATRX that is not set ends the pass
  integer(i4), parameter :: entries_notice = 1    !< from the first one on, and after the pass, RHS and AMATRX are zero on entry
  integer(i4), parameter :: entries_zero = 2      !< RHS and AMATRX are zero on entry

  !> PNEWDT on entry: larger than any value that a user routine would return.
  real(dp), parameter :: untouched = 1.0e36_dp

  !> Scalars and short arrays of a call, under Abaqus' names. Each call gets copies: a user routine that changes them affects
  !> nothing else.
  type :: scalars_t
    integer(i4) :: ndofel = 0, nrhs = 0, nsvars = 0, nprops = 0, mcrd = 0, nnode = 0, jtype = 0, kstep = 0, kinc = 0, jelem = 0, &
                   ndload = 0, npredf = 0, mlvarx = 0, mdload = 1, njprop = 0, material = 0
    integer(i4) :: lflags(7) = 0
    real(dp) :: time(2) = 0, dtime = 0, params(3) = 0, pnewdt = untouched, period = 0
  end type scalars_t

  !> One pass over a block: what is called, with what, and where the results go. Arrays belong to the caller.
  type :: block_t
    type(c_funptr) :: address
    type(scalars_t) :: scalars           !< of each call, but for the number of the element and its loads
    logical :: with_material = .false.   !< call with UELMAT's 37 arguments
    logical :: symmetric = .false.       !< assemble (A + A^T)/2
    logical :: parallel = .false.        !< several threads may call elements at the same time
    integer(i4) :: guards = guards_stop  !< one of guards_*
    integer(i4) :: entries = entries_stop  !< one of entries_*
    logical :: want_matrix = .false.     !< check and assemble AMATRX
    logical :: want_residual = .false.   !< check and assemble RHS
    logical :: keeps_state = .false.     !< keep SVARS, ENERGY and the material history that a call leaves
    logical :: moves = .false.           !< V and A are given
    integer(i4) :: tensor = 0, iteration = 0
    integer(i4), pointer, contiguous :: labels(:) => null(), jprops(:) => null()
    integer(i4), pointer, contiguous :: equations(:, :) => null()  !< (ndofel, m) unknown, from 1
    integer(i4), pointer, contiguous :: map(:, :, :) => null()     !< (ndofel, ndofel, m) position in matrix, from 1
    real(dp), pointer, contiguous :: props(:) => null()
    real(dp), pointer, contiguous :: coords(:, :) => null()        !< (mcrd*nnode, m)
    real(dp), pointer, contiguous :: u(:) => null(), du(:) => null()
    real(dp), pointer, contiguous :: v(:) => null(), a(:) => null()   !< velocity and acceleration
    ! of the m elements, or of one that stands for all
    integer(i4), pointer, contiguous :: counts(:) => null()        !< (m) distributed loads
    integer(i4), pointer, contiguous :: kinds(:, :) => null()      !< (most, m) JDLTYP
    real(dp), pointer, contiguous :: loads(:, :, :) => null()      !< (2, most, m) magnitude at the end, increment
    real(dp), pointer, contiguous :: predef(:, :) => null()        !< (2*NPREDF*nnode, m)
    real(dp), pointer, contiguous :: svars(:, :) => null(), svars_trial(:, :) => null()     !< (nsvars, m)
    real(dp), pointer, contiguous :: energy(:, :) => null(), energy_trial(:, :) => null()   !< (8, m)
    real(dp), pointer, contiguous :: history(:, :, :) => null(), history_trial(:, :, :) => null()  !< (values, npt, m)
    real(dp), pointer, contiguous :: residual(:, :) => null()  !< (n, NRHS)
    real(dp), pointer, contiguous :: matrix(:) => null()
    real(dp), pointer, contiguous :: floor(:) => null()            !< (ndofel) |RHS| above which an entry counts as a term
    real(dp), pointer, contiguous :: flux(:, :) => null()          !< (ndofel, 3) sum of |RHS|, number of terms, the largest one
    integer :: first = 1                  !< element at which the loop on one thread begins
    integer(i4) :: alone = 0              !< elements that it has called again, since several threads could not go on
    real(dp) :: pnewdt = untouched        !< smallest returned, or one that is not finite
    real(dp) :: energy_sum(8) = 0
    integer(i4) :: fault = fault_none     !< one of fault_*
    integer(i4) :: position = 0           !< element of the fault, from 1; 0 if unknown
    integer(i4) :: culprit(3) = 0         !< first element that wrote outside an array, array and entry, with guards_search
    integer(i4) :: array = 0, index = 0   !< array (number in host_workspace) and entry of the fault, or routine and point
    integer(i4) :: unset(3) = 0           !< element, array and entry after which entries_notice became entries_zero
    procedure(uel_procedure), pointer, nopass :: uel => null()
    procedure(uelmat_procedure), pointer, nopass :: uelmat => null()
  end type block_t

  ! each thread has its own
  type(workspace_t), target, save :: work
  real(dp), allocatable, target, save :: discarded(:, :)   !< material history that a call leaves and that is not kept
  !$omp threadprivate(work, discarded)

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
    nullify (current%history, current%history_trial)
    if (associated(block%history)) then
      if (allocated(discarded)) deallocate (discarded)
      allocate (discarded(size(block%history, 1), size(block%history, 2)))
    end if
    current%step = block%scalars%kstep
    current%increment = block%scalars%kinc
    current%iteration = block%iteration
    current%tensor = block%tensor
    current%finite = .false.
    current%hybrid = .false.
    current%deformed = .false.
    current%distorted = 0
    current%routine = merge('UELMAT', 'UEL   ', block%with_material)
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

  !> Gather the arguments of an element, call it, and keep its trial state.
  subroutine call_element(block, e, work, now)
    type(block_t), intent(inout) :: block
    integer, intent(in) :: e
    ! those of the thread, which finds them once for all elements
    type(workspace_t), intent(inout), target :: work
    type(call_context), intent(inout), target :: now
    now%element = block%labels(e)
    call begin_call(now%thread, now%element)
    now%npt = 0
    now%layer = 1
    now%kspt = 1
    if (associated(block%history)) then
      now%history => block%history(:, :, e)
      if (block%keeps_state .or. block%scalars%lflags(3) == output_variables) then
        now%history_trial => block%history_trial(:, :, e)
      else
        now%history_trial => discarded
      end if
      now%history_trial = now%history
    end if
    call call_between_guards(block, e, merge(0_i8, work%unset, block%entries == entries_zero), work%memory, work%start, &
                             now)
  end subroutine call_element

  !> The same within the memory of a workspace.
  subroutine call_between_guards(block, e, on_entry, x, s, now)
    type(block_t), intent(inout) :: block
    integer, intent(in) :: e
    integer(i8), value :: on_entry   !< bits of the entries of RHS and AMATRX
    real(dp), intent(inout) :: x(*)
    integer, intent(in) :: s(n_arrays)
    type(call_context), intent(inout) :: now
    integer(i4) :: jprops(block%scalars%njprop)
    type(scalars_t) :: given
    integer :: ndofel, row
    given = block%scalars
    given%jelem = now%element
    now%pnewdt = untouched
    ndofel = int(given%ndofel)
    call gather(ndofel, block%equations(:, e), block%u, x(s(i_u)))
    call gather(ndofel, block%equations(:, e), block%du, x(s(i_du)))
    if (block%moves) then
      call gather(ndofel, block%equations(:, e), block%v, x(s(i_v)))
      call gather(ndofel, block%equations(:, e), block%a, x(s(i_a)))
    else
      call fill(ndofel, 0_i8, x(s(i_v)))
      call fill(ndofel, 0_i8, x(s(i_a)))
    end if
    call fill(ndofel*given%nrhs, on_entry, x(s(i_rhs)))
    call fill(ndofel*ndofel, on_entry, x(s(i_amatrx)))
    call copy(given%nsvars, block%svars(:, e), x(s(i_svars)))
    call copy(8, block%energy(:, e), x(s(i_energy)))
    call copy(given%nprops, block%props, x(s(i_props)))
    call copy(size(block%coords, 1), block%coords(:, e), x(s(i_coords)))
    call copy(size(block%predef, 1), block%predef(:, min(e, size(block%predef, 2))), x(s(i_predef)))
    jprops = block%jprops
    row = min(e, size(block%counts))
    if (block%counts(row) == 0) then
      call call_unloaded(block, given, x, s, jprops)
    else
      call call_loaded(block, row, given, x, s, jprops)
    end if
    if (block%scalars%lflags(3) == 1) call keep_smallest(min(given%pnewdt, now%pnewdt), given%pnewdt, block%pnewdt)
    if (block%keeps_state) then
      call copy(block%scalars%nsvars, x(s(i_svars)), block%svars_trial(:, e))
      call copy(8, x(s(i_energy)), block%energy_trial(:, e))
    end if
  end subroutine call_between_guards

  !> The call without distributed loads, as most are.
  subroutine call_unloaded(block, given, x, s, jprops)
    type(block_t), intent(in) :: block
    type(scalars_t), intent(inout) :: given
    real(dp), intent(inout) :: x(*)
    integer, intent(in) :: s(n_arrays)
    integer(i4), intent(inout) :: jprops(given%njprop)
    integer(i4) :: jdltyp(1, 2)
    real(dp) :: adlmag(1, 2), ddlmag(1, 2)
    jdltyp = 0
    adlmag = 0
    ddlmag = 0
    call invoke(block, given, x, s, jprops, jdltyp, adlmag, ddlmag)
  end subroutine call_unloaded

  !> The call with distributed loads. The second column, of the other load case with NRHS = 2, is zero.
  subroutine call_loaded(block, row, given, x, s, jprops)
    type(block_t), intent(in) :: block
    integer, intent(in) :: row   !< of the element in the distributed loads
    type(scalars_t), intent(inout) :: given
    real(dp), intent(inout) :: x(*)
    integer, intent(in) :: s(n_arrays)
    integer(i4), intent(inout) :: jprops(given%njprop)
    integer(i4) :: jdltyp(block%counts(row), 2)
    real(dp) :: adlmag(block%counts(row), 2), ddlmag(block%counts(row), 2)
    given%ndload = block%counts(row)
    given%mdload = given%ndload
    jdltyp(:, 1) = block%kinds(:given%ndload, row)
    adlmag(:, 1) = block%loads(1, :given%ndload, row)
    ddlmag(:, 1) = block%loads(2, :given%ndload, row)
    jdltyp(:, 2) = 0
    adlmag(:, 2) = 0
    ddlmag(:, 2) = 0
    call invoke(block, given, x, s, jprops, jdltyp, adlmag, ddlmag)
  end subroutine call_loaded

  !> The call itself.
  subroutine invoke(block, given, x, s, jprops, jdltyp, adlmag, ddlmag)
    type(block_t), intent(in) :: block
    type(scalars_t), intent(inout) :: given
    real(dp), intent(inout) :: x(*)
    integer, intent(in) :: s(n_arrays)
    integer(i4), intent(inout) :: jprops(given%njprop), jdltyp(given%mdload, 2)
    real(dp), intent(inout) :: adlmag(given%mdload, 2), ddlmag(given%mdload, 2)
    if (block%with_material) then
      call block%uelmat(x(s(i_rhs)), x(s(i_amatrx)), x(s(i_svars)), x(s(i_energy)), given%ndofel, given%nrhs, given%nsvars, &
                        x(s(i_props)), given%nprops, x(s(i_coords)), given%mcrd, given%nnode, x(s(i_u)), x(s(i_du)), &
                        x(s(i_v)), x(s(i_a)), given%jtype, given%time, given%dtime, given%kstep, given%kinc, given%jelem, &
                        given%params, given%ndload, jdltyp, adlmag, x(s(i_predef)), given%npredf, given%lflags, &
                        given%mlvarx, ddlmag, given%mdload, given%pnewdt, jprops, given%njprop, given%period, given%material)
    else
      call block%uel(x(s(i_rhs)), x(s(i_amatrx)), x(s(i_svars)), x(s(i_energy)), given%ndofel, given%nrhs, given%nsvars, &
                     x(s(i_props)), given%nprops, x(s(i_coords)), given%mcrd, given%nnode, x(s(i_u)), x(s(i_du)), &
                     x(s(i_v)), x(s(i_a)), given%jtype, given%time, given%dtime, given%kstep, given%kinc, given%jelem, &
                     given%params, given%ndload, jdltyp, adlmag, x(s(i_predef)), given%npredf, given%lflags, given%mlvarx, &
                     ddlmag, given%mdload, given%pnewdt, jprops, given%njprop, given%period)
    end if
  end subroutine invoke

  !> Keep the smallest PNEWDT, or one that is not finite: no comparison finds a NaN, which stays for the caller to see.
  pure subroutine keep_smallest(smallest, returned, kept)
    real(dp), intent(in) :: smallest   !< of the element and its materials
    real(dp), intent(in) :: returned   !< by the element
    real(dp), intent(inout) :: kept
    if (.not. abs(kept) <= huge(kept)) return
    kept = min(kept, smallest)
    if (.not. abs(returned) <= huge(returned)) kept = returned
  end subroutine keep_smallest

  !> Calls whose SVARS and ENERGY are kept: the normal one, that for initial stresses, and that for the initial acceleration,
  !> as the example of UEL in the User Subroutines Guide needs for the forces at the start of the first increment.
  elemental logical function keeps_state(request)
    integer(i4), intent(in) :: request   !< LFLAGS(3)
    keeps_state = any(request == [1_i4, 6_i4, initial_stresses])
  end function keeps_state

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

  !> Entries of a vector of the system.
  subroutine gather(n, equations, x, y)
    integer, intent(in) :: n
    integer(i4), intent(in) :: equations(n)
    real(dp), intent(in) :: x(*)
    real(dp), intent(inout) :: y(n)
    y = x(equations)
  end subroutine gather
end module host_element
