! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Damage by cycles in the consistent law, whose separation depends on the damage: `cohesive_fatigue` and `cohesive_local_solve`.
!>
!> In x, 1/K - flexibility is (x - flexibility (1 - x min b))/(1 - x min b), and the separation lambda = x |v| with the vector v of
!> `direction_at`. So s = |v| ((1 - x min b) f + (x - flexibility (1 - x min b)) e/f), with nothing to divide by where a rigid law
!> has no damage, or no stiffness is left. s falls with x wherever min b exceeds the softening slope.
module cohesive_fatigue_local_solve
  use core_kinds, only: dp
  use core_root, only: root_search, search_between, searching, advance
  use cohesive_fatigue, only: direction_measures, secant_line, growth_equation, measure_direction, damage_on, relative_separation, &
    may_grow, growth_by_cycles, rate_of_damage, cycles_survived
  use cohesive_local_equation, only: law_equation, direction_at, remainder_at
  use cohesive_parameters, only: law_parameters
  use cohesive_state, only: cycled_state, point_history
  implicit none(type, external)
  private
  public :: grow_by_cycles, measure_cycles

contains

  !> Lets damage grow by the cycles of an increment, where they do more than the softening line demands.
  pure subroutine grow_by_cycles(law, equation, start, x_start, x, grown, by_driving, solved, steps)
    type(law_parameters), intent(in) :: law
    type(law_equation), intent(in) :: equation   !< driving is not zero
    real(dp), intent(in) :: start                !< s at the start of the increment
    real(dp), intent(in) :: x_start              !< at the damage there
    real(dp), intent(inout) :: x                 !< at the damage that the softening line demands; at that of the end
    real(dp), intent(out) :: grown               !< growth of D; zero where the cycles do not more
    real(dp), intent(out) :: by_driving(2)       !< derivative of x
    logical, intent(out) :: solved               !< false if the root was not found
    integer, intent(out) :: steps                !< of the search
    type(root_search) :: search
    type(direction_measures) :: measures
    real(dp) :: value, slope, upper, not_used, by_angle, by_length

    grown = 0.0_dp
    by_driving = 0.0_dp
    solved = .true.
    steps = 0
    upper = 1.0_dp/equation%least
    if (.not. (law%cycles%count > 0.0_dp .and. x < upper)) return
    measures = measures_at(law, equation, x)
    if (.not. may_grow(law, measures, start)) return
    call evaluate(law, equation, start, x_start, x, value, slope, by_angle, by_length)
    if (.not. value < 0.0_dp) return
    call evaluate(law, equation, start, x_start, upper, value, not_used, by_angle, by_length)
    if (value > 0.0_dp) then
      search = search_between(x, upper, x, geometric=.false.)
      do while (searching(search))
        call evaluate(law, equation, start, x_start, search%x, value, slope, by_angle, by_length)
        call advance(search, value, slope)
      end do
      x = search%x
      solved = search%found
      steps = search%steps
      call evaluate(law, equation, start, x_start, x, value, slope, by_angle, by_length)
      by_driving = -by_direction(equation, x, by_angle, by_length)/slope
    else
      x = upper
    end if
    measures = measures_at(law, equation, x)
    grown = damage_on(measures, secant_at(law, equation, x)) - damage_on(measures, secant_at(law, equation, x_start))
  end subroutine grow_by_cycles

  !> State of a point after an increment, for the next one and for output.
  pure subroutine measure_cycles(law, equation, x, history, state)
    type(law_parameters), intent(in) :: law
    type(law_equation), intent(in) :: equation
    real(dp), intent(in) :: x
    type(point_history), intent(in) :: history
    type(cycled_state), intent(inout) :: state
    type(direction_measures) :: measures
    type(secant_line) :: secant
    real(dp) :: length, direction(2)

    state%relative = 0.0_dp
    state%rate = 0.0_dp
    state%cycles = cycles_survived(law, history)
    if (.not. maxval(equation%driving) > 0.0_dp) return
    call direction_at(equation, x, length, direction)
    measures = measure_direction(law, direction)
    secant = secant_at(law, equation, x)
    state%relative = relative_separation(measures, secant, length)
    state%rate = rate_of_damage(law, measures, secant, state%relative)
  end subroutine measure_cycles

  !> The equation of `growth_by_cycles` at x: its value, its slope along x, on which the separation turns, and its derivatives by
  !> the direction and |v|.
  pure subroutine evaluate(law, equation, start, x_start, x, value, slope, by_angle, by_length)
    type(law_parameters), intent(in) :: law
    type(law_equation), intent(in) :: equation
    real(dp), intent(in) :: start, x_start, x
    real(dp), intent(out) :: value, slope, by_angle, by_length
    type(growth_equation) :: growth
    real(dp) :: length, direction(2), excess(2)

    call direction_at(equation, x, length, direction)
    growth = growth_by_cycles(law, measure_direction(law, direction), secant_at(law, equation, x_start), start, &
      secant_at(law, equation, x), length)
    value = growth%value
    by_angle = growth%by_angle
    by_length = growth%by_length
    excess = (equation%b - equation%least)/(1.0_dp + (equation%b - equation%least)*x)
    slope = growth%by_unknown + by_angle*(excess(2) - excess(1))*direction(1)*direction(2) &
      - by_length*length*sum(excess*direction**2)
  end subroutine evaluate

  !> Derivative by the driving p/ratio at fixed x.
  pure function by_direction(equation, x, by_angle, by_length) result(slope)
    type(law_equation), intent(in) :: equation
    real(dp), intent(in) :: x, by_angle, by_length
    real(dp) :: slope(2)
    real(dp) :: length, direction(2)

    call direction_at(equation, x, length, direction)
    slope = by_length*direction + by_angle*[direction(2), -direction(1)]/length
    slope = slope/(1.0_dp + (equation%b - equation%least)*x)
  end function by_direction

  !> Measures of the direction of the separation at x.
  pure function measures_at(law, equation, x) result(measures)
    type(law_parameters), intent(in) :: law
    type(law_equation), intent(in) :: equation
    real(dp), intent(in) :: x
    type(direction_measures) :: measures
    real(dp) :: length, direction(2)

    call direction_at(equation, x, length, direction)
    measures = measure_direction(law, direction)
  end function measures_at

  !> The secant at x.
  pure function secant_at(law, equation, x) result(secant)
    type(law_parameters), intent(in) :: law
    type(law_equation), intent(in) :: equation
    real(dp), intent(in) :: x
    type(secant_line) :: secant

    secant%stiff = remainder_at(equation%least, x)
    secant%lost = max(0.0_dp, x - law%flexibility*secant%stiff)
    secant%stiff_slope = -equation%least
    secant%lost_slope = 1.0_dp + law%flexibility*equation%least
  end function secant_at

end module cohesive_fatigue_local_solve
