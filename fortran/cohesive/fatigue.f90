! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Damage by cycles of a load whose greatest value alone is followed: the damage accumulation function CF20 of Davila et al.,
!> NASA/TP-2020-220584, beside the softening line of `cohesive_bilinear`.
!>
!> D is the share of the fracture energy of the present mode mix along that line, where separation and traction are
!> lambda*(D) = (1 - D) lambda_0 + D lambda_f and t*(D) = (1 - D)/f. A point that has been cycled is below it. Both are on one
!> secant, so that the relative separation s = lambda/lambda*(D) is t/t*(D) too, which a rigid law without damage has as well.
!> With the share B of mode II in the energy and the load ratio R
!>
!>     dD/dN = a (1 - D)**-m (s/E)**b  for s >= E, else 0;    a = 1/(gamma (b + m + 1)),    b = -7 eta/log10(E),
!>     E = 2 e/(e + 1 + R (e - 1)),    e = eps (1 - 0.42 B),    gamma = 10**7 cycles.
!>
!> An increment of N cycles integrates it as
!>
!>     (c1 - c0)/ln(c1/c0) (integral of (1 - D)**m dD) = N a,    c = (s/E)**-b at its start and its end,
!>
!> of second order, and exact where s grows exponentially with that integral: nearly so for m = 0 at a constant traction or
!> separation. c1 rises with D at the end, so that there is one solution, for any m > -1. Damage grows in increments at whose start
!> s >= E: no iteration crosses that limit.
module cohesive_fatigue
  use core_kinds, only: dp
  use core_root, only: root_search, search_between, searching, advance
  use cohesive_parameters, only: law_parameters
  use cohesive_mode_mix, only: measure_onset, measure_energy
  use cohesive_state, only: point_history, cycled_state
  implicit none(type, external)
  private
  public :: direction_measures, secant_line, growth_equation
  public :: grow_at_separation, measure_direction, damage_on, relative_separation
  public :: may_grow, growth_by_cycles, rate_of_damage, cycles_survived

  !> Cycles at which the endurance limit is defined, and their decimal logarithm.
  real(dp), parameter :: most_cycles = 1.0e7_dp, decades = 7.0_dp
  !> Part of the endurance limit that mode II lacks.
  real(dp), parameter :: less_in_shear = 0.42_dp
  !> Values of ENDURANCE and BRITTLENESS that 0 stands for: those of CompDam.
  real(dp), parameter :: usual_endurance = 0.2_dp, usual_brittleness = 0.95_dp

  !> Damage that is lost in the difference of two shares of it.
  real(dp), parameter :: rounding = 4.0_dp*epsilon(1.0_dp)

  !> Measures of the direction (sin theta, cos theta) of the separation, and their derivatives by theta.
  type :: direction_measures
    real(dp) :: onset, onset_slope     !< f of `cohesive_mode_mix`, 1/stress
    real(dp) :: energy, energy_slope   !< e, area/energy
    real(dp) :: shear, shear_slope     !< B
  end type direction_measures

  !> A secant: its stiffness K is that of 1/K - flexibility = lost/stiff, the separation `length` times stiff/K. Both terms are
  !> linear in one unknown, x of the consistent law, else the damage.
  type :: secant_line
    real(dp) :: stiff, lost                       !< 1; length/stress
    real(dp) :: stiff_slope = 0.0_dp              !< by the unknown
    real(dp) :: lost_slope = 0.0_dp
  end type secant_line

  !> The equation of an increment, zero at its end, with its derivatives.
  type :: growth_equation
    real(dp) :: value
    real(dp) :: by_unknown   !< rises with the damage
    real(dp) :: by_angle     !< by theta
    real(dp) :: by_length
  end type growth_equation

contains

  !> Lets the damage of a law whose separation is the displacement jump grow by the cycles of an increment.
  pure subroutine grow_at_separation(law, separation, history, damage, slope, cycled)
    type(law_parameters), intent(in) :: law        !< not rigid
    real(dp), intent(in) :: separation(2)          !< (tau, n), tau not negative
    type(point_history), intent(in) :: history
    real(dp), intent(inout) :: damage              !< that the softening line demands, 1 - K/alpha; that of the end
    real(dp), intent(inout) :: slope(2)            !< its derivative by the separation
    type(cycled_state), intent(inout) :: cycled
    type(root_search) :: search
    type(direction_measures) :: measures
    type(secant_line) :: before
    type(growth_equation) :: equation
    real(dp) :: direction(2), separated, length

    cycled%cycles = cycles_survived(law, history)
    direction = [separation(1), max(0.0_dp, separation(2))]
    separated = norm2(direction)
    if (.not. separated > 0.0_dp) return
    direction = direction/separated
    length = separated/law%flexibility
    measures = measure_direction(law, direction)
    before = secant_of_damage(law, history%damage_max)
    if (damage < 1.0_dp .and. may_grow(law, measures, history%cycled%relative)) then
      equation = growth_by_cycles(law, measures, before, history%cycled%relative, secant_of_damage(law, damage), length)
      if (equation%value < 0.0_dp) then
        search = search_between(damage, 1.0_dp, damage, geometric=.false.)
        damage = 1.0_dp
        slope = 0.0_dp
        equation = growth_by_cycles(law, measures, before, history%cycled%relative, secant_of_damage(law, damage), length)
        if (equation%value > 0.0_dp) then
          do while (searching(search))
            equation = growth_by_cycles(law, measures, before, history%cycled%relative, secant_of_damage(law, search%x), length)
            call advance(search, equation%value, equation%by_unknown)
          end do
          damage = search%x
          equation = growth_by_cycles(law, measures, before, history%cycled%relative, secant_of_damage(law, damage), length)
          slope = -(equation%by_length/law%flexibility*direction &
            + equation%by_angle/separated*[direction(2), -direction(1)])/equation%by_unknown
        end if
        cycled%grown = damage_on(measures, secant_of_damage(law, damage)) - damage_on(measures, before)
      end if
    end if
    cycled%relative = relative_separation(measures, secant_of_damage(law, damage), length)
    cycled%rate = rate_of_damage(law, measures, secant_of_damage(law, damage), cycled%relative)
  end subroutine grow_at_separation

  !> The secant of a damage 1 - K/alpha.
  pure function secant_of_damage(law, damage) result(secant)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: damage
    type(secant_line) :: secant

    secant = secant_line(1.0_dp - damage, law%flexibility*damage, -1.0_dp, law%flexibility)
  end function secant_of_damage

  !> Measures of a direction.
  pure function measure_direction(law, direction) result(measures)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: direction(2)   !< (tau, n), not negative, of unit length
    type(direction_measures) :: measures
    real(dp) :: f_slope(2), e_slope(2), rho

    call measure_onset(law, direction, measures%onset, f_slope)
    call measure_energy(law, direction, measures%energy, e_slope)
    measures%onset_slope = f_slope(1)*direction(2) - f_slope(2)*direction(1)
    measures%energy_slope = e_slope(1)*direction(2) - e_slope(2)*direction(1)
    rho = sum(law%ratio*direction**2)
    measures%shear = law%ratio(1)*direction(1)**2/rho
    measures%shear_slope = 2.0_dp*law%ratio(1)*law%ratio(2)*direction(1)*direction(2)/rho**2
  end function measure_direction

  !> D on a secant.
  pure function damage_on(measures, secant) result(damage)
    type(direction_measures), intent(in) :: measures
    type(secant_line), intent(in) :: secant
    real(dp) :: damage

    damage = measures%energy*secant%lost/(measures%onset**2*secant%stiff + measures%energy*secant%lost)
  end function damage_on

  !> s on a secant.
  pure function relative_separation(measures, secant, length) result(relative)
    type(direction_measures), intent(in) :: measures
    type(secant_line), intent(in) :: secant
    real(dp), intent(in) :: length   !< stress
    real(dp) :: relative

    relative = length*(measures%onset*secant%stiff + measures%energy*secant%lost/measures%onset)
  end function relative_separation

  !> Whether damage may grow by the cycles of an increment.
  pure function may_grow(law, measures, start) result(grows)
    type(law_parameters), intent(in) :: law
    type(direction_measures), intent(in) :: measures
    real(dp), intent(in) :: start   !< s at its start
    logical :: grows
    real(dp) :: limit, exponent, slope

    grows = law%cycles%count > 0.0_dp
    if (.not. grows) return
    call endurance(law, measures%shear, limit, exponent, slope)
    grows = start >= limit
  end function may_grow

  !> Integral of (1 - D)**m over the damage of the increment less that over its cycles.
  pure function growth_by_cycles(law, measures, before, start, secant, length) result(equation)
    type(law_parameters), intent(in) :: law
    type(direction_measures), intent(in) :: measures   !< of the direction at the end
    type(secant_line), intent(in) :: before            !< at the start
    real(dp), intent(in) :: start                      !< s there, positive
    type(secant_line), intent(in) :: secant            !< at the end
    real(dp), intent(in) :: length                     !< at the end, stress
    type(growth_equation) :: equation
    real(dp) :: limit, exponent, slope, power, growth, mean, by_first, by_last
    real(dp) :: old, old_angle, new, new_angle, new_unknown, last, last_angle, last_unknown, by_shear, by_relative

    call remaining_share(measures, before, old, old_angle, new_unknown)
    call remaining_share(measures, secant, new, new_angle, new_unknown)
    last = relative_separation(measures, secant, length)
    last_unknown = length*(measures%onset*secant%stiff_slope + measures%energy*secant%lost_slope/measures%onset)
    last_angle = length*(measures%onset_slope*secant%stiff + secant%lost/measures%onset &
      *(measures%energy_slope - measures%energy*measures%onset_slope/measures%onset))

    call endurance(law, measures%shear, limit, exponent, slope)
    power = law%given%exponent + 1.0_dp
    call logarithmic_mean(-exponent*log(start/limit), -exponent*log(last/limit), mean, by_first, by_last)
    growth = law%cycles%count/(most_cycles*(exponent + power)*mean)
    equation%value = (old**power - new**power)/power - growth
    if (abs(equation%value) < rounding*old**power/power) equation%value = 0.0_dp
    equation%by_unknown = 0.0_dp
    equation%by_angle = 0.0_dp
    equation%by_length = 0.0_dp
    ! a point that fails stays where it is
    if (.not. new > 0.0_dp) return
    by_relative = -growth*exponent*by_last/(mean*last)
    ! b ln E does not depend on the direction, so that neither does ln c + b ln s
    by_shear = -growth*slope*((by_first*log(start) + by_last*log(last))/mean - 1.0_dp/(exponent + power))
    equation%by_unknown = by_relative*last_unknown - new**law%given%exponent*new_unknown
    equation%by_angle = old**law%given%exponent*old_angle - new**law%given%exponent*new_angle + by_relative*last_angle &
      + by_shear*measures%shear_slope
    equation%by_length = by_relative*last/length
  end function growth_by_cycles

  !> dD/dN; zero below the endurance limit, at failure and without cycles.
  pure function rate_of_damage(law, measures, secant, relative) result(rate)
    type(law_parameters), intent(in) :: law
    type(direction_measures), intent(in) :: measures
    type(secant_line), intent(in) :: secant
    real(dp), intent(in) :: relative   !< s
    real(dp) :: rate                   !< 1/cycle
    real(dp) :: limit, exponent, slope, damage

    rate = 0.0_dp
    damage = damage_on(measures, secant)
    if (.not. (damage < 1.0_dp .and. may_grow(law, measures, relative))) return
    call endurance(law, measures%shear, limit, exponent, slope)
    rate = (relative/limit)**exponent/(most_cycles*(exponent + law%given%exponent + 1.0_dp)) &
      *(1.0_dp - damage)**(-law%given%exponent)
  end function rate_of_damage

  !> Cycles of a point until the end of an increment, or until the end of that in which it failed.
  pure function cycles_survived(law, history) result(cycles)
    type(law_parameters), intent(in) :: law
    type(point_history), intent(in) :: history   !< at the start of the increment
    real(dp) :: cycles

    cycles = history%cycled%cycles
    if (history%damage_max < 1.0_dp) cycles = cycles + law%cycles%count
  end function cycles_survived

  !> 1 - D on a secant, and its derivatives by theta and by the unknown.
  pure subroutine remaining_share(measures, secant, share, by_angle, by_unknown)
    type(direction_measures), intent(in) :: measures
    type(secant_line), intent(in) :: secant
    real(dp), intent(out) :: share, by_angle, by_unknown
    real(dp) :: all

    all = measures%onset**2*secant%stiff + measures%energy*secant%lost
    share = measures%onset**2*secant%stiff/all
    by_angle = -measures%onset*secant%stiff*secant%lost*(measures%onset*measures%energy_slope &
      - 2.0_dp*measures%energy*measures%onset_slope)/all**2
    by_unknown = -measures%onset**2*measures%energy*(secant%lost_slope*secant%stiff - secant%lost*secant%stiff_slope)/all**2
  end subroutine remaining_share

  !> E and b in a mode mix, and the derivative of b by the share of mode II.
  pure subroutine endurance(law, shear, limit, exponent, slope)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: shear   !< B
    real(dp), intent(out) :: limit, exponent, slope
    real(dp) :: reversed, reversed_slope, ratio, logarithm

    reversed = usual_endurance
    if (law%given%endurance > 0.0_dp) reversed = law%given%endurance
    reversed_slope = -less_in_shear*reversed
    reversed = reversed*(1.0_dp - less_in_shear*shear)
    ratio = law%cycles%load_ratio
    limit = 2.0_dp*reversed/(reversed + 1.0_dp + ratio*(reversed - 1.0_dp))
    logarithm = log(limit)
    exponent = usual_brittleness
    if (law%given%brittleness > 0.0_dp) exponent = law%given%brittleness
    exponent = -decades*exponent*log(10.0_dp)/logarithm
    slope = -exponent/logarithm*reversed_slope*(1.0_dp/reversed - (1.0_dp + ratio)/(reversed + 1.0_dp + ratio*(reversed - 1.0_dp)))
  end subroutine endurance

  !> Logarithmic mean of exp(first) and exp(last), and its derivatives by both.
  pure subroutine logarithmic_mean(first, last, mean, by_first, by_last)
    real(dp), intent(in) :: first, last
    real(dp), intent(out) :: mean, by_first, by_last
    !> Below, the series are exact to rounding.
    real(dp), parameter :: small = 0.02_dp
    real(dp) :: middle, half, shape, shape_slope

    half = 0.5_dp*(last - first)
    if (abs(half) < small) then
      middle = exp(0.5_dp*(first + last))
      shape = 1.0_dp + half**2/6.0_dp*(1.0_dp + half**2/20.0_dp)
      shape_slope = half/3.0_dp*(1.0_dp + half**2/10.0_dp*(1.0_dp + half**2/28.0_dp))
      mean = middle*shape
      by_first = 0.5_dp*middle*(shape - shape_slope)
      by_last = 0.5_dp*middle*(shape + shape_slope)
    else
      mean = 0.5_dp*(exp(last) - exp(first))/half
      by_first = 0.5_dp*(mean - exp(first))/half
      by_last = 0.5_dp*(exp(last) - mean)/half
    end if
  end subroutine logarithmic_mean

end module cohesive_fatigue
