! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Arrays that a user routine of material points writes to, each between guards, as those of elements are (host_workspace).
!>
!> The guards are checked after each call, so the point of a write outside an array is known; they are shorter than those of
!> elements, because there are many more calls. They hold a number that is practically zero: reading outside an array does not turn
!> the results into NaN.
module host_guarded
  use, intrinsic :: iso_c_binding, only: c_int64_t
  use host_context, only: current
  use host_kinds, only: dp, i4, i8
  use host_messages, only: add_message
  use host_workspace, only: all_finite, fill, first_difference
  implicit none (type, external)
  private
  public :: guarded_t, lay_out_guarded, warn_of_no_numbers, warn_of_writes

  !> Entries of the guard before an array; the one after it has as many as the array, within limits.
  integer, parameter :: before = 8, least = 40, most = 20000
  !> Space after the last array: a write beyond its guard does no harm.
  integer, parameter :: room = 20000
  integer(i8), parameter :: mark = transfer(1.0e-300_dp, 0_i8)

  type :: guarded_t
    real(dp), allocatable :: memory(:)
    integer, allocatable :: length(:)   !< entries of each array
    integer, allocatable :: start(:)    !< position of the first entry of each array
    integer, allocatable :: behind(:)   !< entries of the guard behind it
  end type guarded_t

contains

  !> Allocate arrays of these lengths; those that users most often take for longer come last. If they already have these lengths,
  !> they keep what the last call left.
  subroutine lay_out_guarded(work, length)
    type(guarded_t), intent(inout) :: work
    integer, intent(in) :: length(:)
    integer :: k, total
    if (allocated(work%length)) then
      if (all(work%length == length)) return
      deallocate (work%memory, work%length, work%start, work%behind)
    end if
    allocate (work%length(size(length)), work%start(size(length)), work%behind(size(length)))
    work%length = length
    work%behind = min(max(length, least), most)
    total = 0
    do k = 1, size(length)
      work%start(k) = total + before + 1
      total = total + before + length(k) + work%behind(k)
    end do
    allocate (work%memory(total + room))
    call fill(int(total + room, c_int64_t), mark, work%memory)
  end subroutine lay_out_guarded

  !> Warn of writes outside the arrays by the last call, once per array, and restore the guards.
  subroutine warn_of_writes(work, names, sizes, point, reported)
    type(guarded_t), intent(inout) :: work
    character(len=*), intent(in) :: names(:)
    character(len=*), intent(in) :: sizes(:)    !< where the lengths come from
    integer(i4), intent(in) :: point            !< from 1
    logical, intent(inout) :: reported(:)
    character(len=240) :: text
    integer :: k, entry, length, position
    do k = 1, size(work%length)
      length = work%length(k)
      entry = length + first_difference(work%behind(k), mark, work%memory(work%start(k) + length))
      if (entry == length) then
        position = first_difference(before, mark, work%memory(work%start(k) - before))
        if (position == 0) cycle
        entry = position - before
      end if
      call fill(int(work%behind(k), c_int64_t), mark, work%memory(work%start(k) + length))
      call fill(int(before, c_int64_t), mark, work%memory(work%start(k) - before))
      if (reported(k)) cycle
      write (text, '(a,i0,5a,i0,a,i0,3a,i0)') 'element ', current%element, ': ', trim(current%routine), &
        ' writes outside ', trim(names(k)), ': entry ', entry, ' of ', length, ' (', trim(sizes(k)), ') at integration point ', &
        point
      ! does not return on one thread of several, and is reported later
      call add_message(-1_i4, trim(text)//'; the run goes on, but what is written there is lost')
      reported(k) = .true.
    end do
  end subroutine warn_of_writes

  !> Warn of arrays in which the call left NaN or infinity, once per array.
  subroutine warn_of_no_numbers(work, names, point, reported)
    type(guarded_t), intent(in) :: work
    character(len=*), intent(in) :: names(:)
    integer(i4), intent(in) :: point            !< from 1
    logical, intent(inout) :: reported(:)
    character(len=240) :: text
    integer :: k, entry
    do k = 1, size(work%length)
      associate (array => work%memory(work%start(k):work%start(k) + work%length(k) - 1))
        if (all_finite(size(array), array) .or. reported(k)) cycle
        entry = findloc([(all_finite(1, array(entry:entry)), entry=1, size(array))], .false., dim=1)
      end associate
      write (text, '(a,i0,5a,i0,a,i0)') 'element ', current%element, ': ', trim(current%routine), ' sets an entry of ', &
        trim(names(k)), ' to NaN or infinity, entry ', entry, ', at integration point ', point
      call add_message(-1_i4, trim(text))
      reported(k) = .true.
    end do
  end subroutine warn_of_no_numbers
end module host_guarded
