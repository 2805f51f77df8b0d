! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The root of an increasing function of one variable in a bracket: Newton's method, and bisection where its step leaves the
!> bracket. The caller evaluates the function, so nothing has to be passed through:
!>
!>     search = search_between(lower, upper, start)
!>     do while (searching(search))
!>       value, slope at search%x
!>       call advance(search, value, slope)
!>     end do
!>
!> Afterwards `search%found` says whether x is the root up to rounding. It is not if the steps have run out or the function was NaN.
module core_root
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: root_search, search_between, searching, advance

  !> A bisection between two numbers of the same sign and any magnitude ends after about 60 steps.
  integer, parameter :: most_steps = 100

  !> Relative change of x below which the next one would be rounding.
  real(dp), parameter :: rounding = 2.0_dp*epsilon(1.0_dp)

  !> State of a search.
  type :: root_search
    real(dp) :: x                  !< where to evaluate the function next; the root, once found
    integer :: steps = 0           !< evaluations of the function so far
    logical :: found = .false.
    logical :: failed = .false.    !< the function was NaN
    real(dp) :: lower, upper       !< the root is between them
    logical :: geometric = .false. !< the middle is that of the logarithms
  end type root_search

contains

  !> A search that starts at `start`. geometric: the bracket is positive, and its ends may differ by orders of magnitude.
  pure function search_between(lower, upper, start, geometric) result(search)
    real(dp), intent(in) :: lower, upper, start
    logical, intent(in) :: geometric
    type(root_search) :: search

    search%x = start
    search%lower = lower
    search%upper = upper
    search%geometric = geometric
  end function search_between

  !> Whether the search needs the function at x.
  pure function searching(search) result(wanted)
    type(root_search), intent(in) :: search
    logical :: wanted

    wanted = .not. (search%found .or. search%failed) .and. search%steps < most_steps
  end function searching

  !> Takes the value and the slope of the function at x.
  pure subroutine advance(search, value, slope)
    type(root_search), intent(inout) :: search
    real(dp), intent(in) :: value, slope
    real(dp) :: new

    search%steps = search%steps + 1
    if (value > 0.0_dp) then
      search%upper = search%x
    else if (value < 0.0_dp) then
      search%lower = search%x
    else
      search%found = abs(value) <= 0.0_dp
      if (.not. search%found) search%failed = .true.
      return
    end if
    ! a step longer than the bracket is rejected, and never overflows
    if (abs(value) < slope*(search%upper - search%lower)) then
      new = search%x - value/slope
      ! before the bracket is looked at: a step onto the root ends at the end of the bracket from which it came
      search%found = abs(new - search%x) <= rounding*abs(search%x)
      if (search%found) return
      if (new > search%lower .and. new < search%upper) then
        search%x = new
        return
      end if
    end if
    new = 0.5_dp*(search%lower + search%upper)
    if (search%geometric .and. search%lower > 0.0_dp) new = sqrt(search%lower)*sqrt(search%upper)
    search%found = abs(new - search%x) <= rounding*abs(search%x)
    search%x = new
  end subroutine advance

end module core_root
