! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Elements of a block on several threads, with the sums of one thread to the bit.
!>
!> The elements are taken strip by strip. In a strip each thread calls the next element that nobody has called, with a workspace
!> and a context of its own, and keeps what it returns. Then each thread adds the entries of the sums that belong to it, element by
!> element in their order. Two strips in turn have their own memory, so the threads wait for each other once in a strip.
!>
!> Whatever is not an ordinary return (a message, XIT, a signal, an entry that is not a number, a write outside an array, the time
!> limit) leaves the strip without a trace: one thread calls its elements again, and tells of it.
module host_team
  use, intrinsic :: iso_c_binding, only: c_funloc, c_loc, c_ptr
  use omp_lib, only: omp_get_thread_num, omp_get_num_threads
  use host_block, only: block_t, fault_none, untouched
  use host_context, only: current, threads
  use host_element, only: arguments, call_element, check_results, keep_smallest, prepare, work
  use host_kinds, only: dp, i4
  use host_protect, only: most_seats, on_seat, on_threads
  use host_scatter, only: add_energy, add_magnitude, add_own_matrix, add_own_residual, keep_matrix
  use host_workspace, only: arm_guards, find_damage, i_amatrx, i_energy, i_rhs, take_guards, workspace_t
  implicit none (type, external)
  private
  public :: run_team

  !> Elements of a strip, per thread: so many that waiting for each other costs little, and that their matrices stay in the cache.
  integer, parameter :: most_elements = 64, most_entries = 2**16
  !> Unknowns in a row that belong to the same thread: a cache line of the sums seldom has two owners.
  integer, parameter :: unknowns_in_a_row = 48

  type :: team_t
    type(block_t), pointer :: block => null()
    type(workspace_t), pointer :: guards => null()   !< what they hold, in the workspace of the first thread
    integer :: length = 0                            !< elements of a strip
    integer :: next(0:3) = 0                         !< in a strip, the element that nobody has called; for four strips in turn
    integer :: broken = 0                            !< the strip that one thread has to repeat, 0 for none
    ! of the elements of two strips in turn; what two threads write has no cache line in common
    integer(i4), allocatable :: owner(:, :, :)       !< threads to which its unknowns belong
    real(dp), allocatable :: kept(:, :, :)           !< RHS, ENERGY, PNEWDT and AMATRX
  end type team_t

  type(team_t), target, save :: team
  integer, save :: strip = 1    !< that this thread works on
  !$omp threadprivate(strip)

contains

  !> Call the elements of the block; block%first is then the one at which one thread has to go on.
  subroutine run_team(block)
    type(block_t), intent(inout), target :: block
    integer :: n, ndofel
    ndofel = size(block%equations, 1)
    n = threads*max(min(most_elements, most_entries/ndofel**2), 4)
    if (size(block%labels) <= n/2) return
    team%block => block
    team%guards => work
    team%length = n
    team%next = [1, n + 1, 2*n + 1, 3*n + 1]
    team%broken = 0
    allocate (team%owner(padded(ndofel, 16), n, 0:1), &
              team%kept(padded(ndofel*size(block%residual, 2) + 9 + ndofel**2, 8), n, 0:1))
    call on_threads(c_funloc(all_threads), c_loc(team))
    deallocate (team%owner, team%kept)
    block%first = size(block%labels) + 1
    if (team%broken > 0) block%first = first_of(team%broken)
    block%alone = int(size(block%labels) + 1 - block%first, i4)
    call prepare(block)
  end subroutine run_team

  !> A number of entries, rounded up to whole cache lines of so many.
  pure integer function padded(entries, of_line)
    integer, intent(in) :: entries, of_line
    padded = (entries + of_line - 1)/of_line*of_line
  end function padded

  !> First element of a strip.
  integer function first_of(number)
    integer, intent(in) :: number
    first_of = (number - 1)*team%length + 1
  end function first_of

  subroutine all_threads(context) bind(c)
    type(c_ptr), value :: context   ! is the team
    !$omp parallel num_threads(min(threads, most_seats)) default(shared)
    current%thread = omp_get_thread_num()
    call take_guards(work, team%guards)
    call prepare(team%block)
    strip = 1
    do while (first_of(strip) <= size(team%block%labels))
      if (on_seat(current%thread, c_funloc(take_elements), context) /= 0) team%broken = strip
      !$omp barrier
      if (team%broken == strip) exit
      call add_own()
      ! all are past the strip that had this place, and nobody takes elements of the new one before all have met again
      if (current%thread == 0 .and. strip > 2) team%next(mod(strip + 1, 4)) = first_of(strip + 2)
      strip = strip + 1
    end do
    current%thread = 0
    !$omp end parallel
  end subroutine all_threads

  !> Call elements of the strip until there is none left.
  subroutine take_elements(context) bind(c)
    type(c_ptr), value :: context   ! is the team
    type(block_t) :: block
    integer :: array, e, first, index, k, last, m, n, others, side
    block = team%block
    n = size(block%equations, 1)
    m = n*size(block%residual, 2)
    others = omp_get_num_threads()
    first = first_of(strip)
    last = min(first + team%length - 1, size(block%labels))
    side = mod(strip, 2)
    do
      !$omp atomic capture
      e = team%next(mod(strip - 1, 4))
      team%next(mod(strip - 1, 4)) = team%next(mod(strip - 1, 4)) + 1
      !$omp end atomic
      if (e > last .or. team%broken == strip) exit
      block%pnewdt = untouched
      call call_element(block, e, arguments, current)
      call check_results(block, work)
      if (block%fault /= fault_none) team%broken = strip
      k = e - first + 1
      team%owner(:n, k, side) = mod((block%equations(:, e) - 1)/unknowns_in_a_row, others)
      associate (kept => team%kept(:, k, side))
        kept(:m) = work%memory(work%start(i_rhs):work%start(i_rhs) + m - 1)
        kept(m + 1:m + 8) = work%memory(work%start(i_energy):work%start(i_energy) + 7)
        kept(m + 9) = block%pnewdt
        if (block%want_matrix) call keep_matrix(n, work%memory(work%start(i_amatrx)), block%symmetric, kept(m + 10:))
      end associate
    end do
    call find_damage(work, array, index)
    if (array == 0) return
    call arm_guards(work)
    team%broken = strip
  end subroutine take_elements

  !> Add the part of the sums that belongs to this thread.
  subroutine add_own()
    logical :: own(size(team%block%equations, 1))
    integer :: e, k, m, n, side
    n = size(own)
    m = n*size(team%block%residual, 2)
    side = mod(strip, 2)
    associate (block => team%block)
      do e = first_of(strip), min(first_of(strip + 1) - 1, size(block%labels))
        k = e - first_of(strip) + 1
        own = team%owner(:n, k, side) == current%thread
        associate (kept => team%kept(:, k, side))
          if (block%want_residual) then
            call add_own_residual(n, own, kept, block%equations(:, e), block%residual(:, 1))
            if (block%scalars%nrhs == 2) then
              call add_own_residual(n, own, kept(n + 1:), block%equations(:, e), block%residual(:, 2))
            end if
          end if
          if (block%want_matrix) call add_own_matrix(n, own, kept(m + 10:), block%map(:, :, e), block%matrix)
          if (current%thread == 0) call add_totals(block, kept(:m), kept(m + 1:m + 8), kept(m + 9))
        end associate
      end do
    end associate
  end subroutine add_own

  !> The sums that have one entry, or one of each unknown of an element.
  subroutine add_totals(block, rhs, energy, pnewdt)
    type(block_t), intent(inout) :: block
    real(dp), intent(in) :: rhs(:), energy(8), pnewdt   !< of an element
    if (block%keeps_state) call add_energy(energy, block%energy_sum)
    if (block%want_residual) then
      call add_magnitude(size(block%floor), rhs, block%floor, block%flux(:, 1), block%flux(:, 2), block%flux(:, 3))
    end if
    call keep_smallest(pnewdt, pnewdt, block%pnewdt)
  end subroutine add_totals
end module host_team
