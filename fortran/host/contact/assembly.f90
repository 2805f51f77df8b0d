! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Matrices of contact points in the values of a sparse matrix, whose entries change as points slide.
module host_contact_assembly
  use host_kinds, only: dp, i4
  implicit none (type, external)
  private
  public :: find_runs, add_row, position

contains

  !> Find the runs of unknowns that are neighbours, as those of a node are: so are their entries in a row of the matrix.
  pure subroutine find_runs(columns, runs, first, last)
    integer(i4), intent(in), contiguous :: columns(:)     !< unknowns, from 0
    integer, intent(out) :: runs
    integer, intent(out), contiguous :: first(:), last(:)   !< of each run, in the order of the unknowns
    integer :: i, k, next
    runs = 0
    i = 1
    do while (i <= size(columns))
      next = i + 1
      do while (next <= size(columns))
        if (columns(next) /= columns(next - 1) + 1) exit
        next = next + 1
      end do
      k = runs
      do while (k > 0)
        if (columns(first(k)) <= columns(i)) exit
        first(k + 1) = first(k)
        last(k + 1) = last(k)
        k = k - 1
      end do
      first(k + 1) = i
      last(k + 1) = next - 1
      runs = runs + 1
      i = next
    end do
  end subroutine find_runs

  !> Add a row to the values; the pattern has all of its entries. Rows of a node mostly have the same columns: each run is looked
  !> for where it was in the row before, then behind the last one.
  pure subroutine add_row(row, unknown, columns, first, last, offset, indptr, indices, values)
    real(dp), intent(in), contiguous :: row(:)
    integer(i4), intent(in) :: unknown                    !< of the row, from 0
    integer(i4), intent(in), contiguous :: columns(:)     !< unknowns, from 0
    integer, intent(in), contiguous :: first(:), last(:)  !< runs of columns, as `find_runs` has them
    integer(i4), intent(inout), contiguous :: offset(:)   !< of each run from the start of the row before, from 1
    integer(i4), intent(in), contiguous :: indptr(:), indices(:)   !< pattern, from 0; columns ascend in each row
    real(dp), intent(inout), contiguous :: values(:)
    integer(i4) :: start, end, entry, guess, span
    integer :: j, k
    start = indptr(unknown + 1)
    end = indptr(unknown + 2)
    entry = start + 1
    do k = 1, size(first)
      guess = min(start + offset(k), end)
      if (indices(guess) == columns(first(k))) then
        entry = guess
      else
        span = 1
        do while (entry + span < end)
          if (indices(entry + span) >= columns(first(k))) exit
          span = 2*span
        end do
        entry = entry - 1 + position(indices(entry:min(entry + span, end)), columns(first(k)))
        offset(k) = entry - start
      end if
      !GCC$ novector
      do j = first(k), last(k)
        values(entry + j - first(k)) = values(entry + j - first(k)) + row(j)
      end do
    end do
  end subroutine add_row

  !> Position of a number among ascending ones that contain it.
  pure function position(numbers, number) result(first)
    integer(i4), intent(in), contiguous :: numbers(:)
    integer(i4), intent(in) :: number
    integer(i4) :: first, last, middle
    first = 1
    last = size(numbers)
    do while (first < last)
      middle = (first + last)/2
      if (numbers(middle) < number) then
        first = middle + 1
      else
        last = middle
      end if
    end do
  end function position
end module host_contact_assembly
