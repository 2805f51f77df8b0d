! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Softening along several straight lines; components in the order (tau, n).
!>
!> With the measures f and e of `cohesive_mode_mix` and R = f**2/e, softening starts at tau f = 1, lambda = flexibility/f, and
!> follows
!>
!>     tau = T(x)/f,    x = (f lambda - flexibility)/h,    h = (R - flexibility)/2,    T(x) = sum_j a_j max(0, 1 - x/x_j),
!>
!> a sum of ramps with sum a_j = 1 and sum a_j x_j = 2, so that the area under the curve, with the triangle before the onset, is
!> 1/(2 e). One ramp, which ends at x = 2, is the bilinear law.
!>
!> LAW 5 has two ramps, those of two bilinear laws with one damage (Davila, Rose, Camanho, Int. J. of Fracture 158 (2009) 211): the
!> bridging has the share r of the traction at the onset and the share m of the fracture energy, and x_k = 2 (q_k R - flexibility)/
!> (R - flexibility) with q_1 = (1 - m)/(1 - r) and q_2 = m/r. Ramp k ends at lambda = q_k f/e, and its area is that of its share. r
!> and m are linear in the share of mode II in the energy.
!>
!> LAW 6 has a polygon through the points of a table, of one shape in all mode mixes.
module cohesive_multilinear
  use core_kinds, only: dp
  use core_status, only: status_type, ok, bridging_strength, bridging_energy, brittle_tip, brittle_bridging, brittle_mixed_line, &
    no_table, table_gap, table_separation, table_traction
  use cohesive_parameters, only: law_parameters, most_ramps
  use cohesive_law_properties, only: law_properties, bridging_law
  use cohesive_mode_mix, only: measure_onset, measure_energy, measure_share, direction_of_share, least_of_mixes
  implicit none(type, external)
  private
  public :: prepare_bridging, prepare_table, check_bridging, multilinear_softening, multilinear_steepest, multilinear_loss

  !> Ramps in one direction.
  type :: ramp_curve
    integer :: count
    real(dp) :: height(most_ramps)            !< a_j
    real(dp) :: last(most_ramps)              !< x_j
    real(dp) :: height_slope(3, most_ramps)   !< derivatives by f, e and the share of mode II in the energy
    real(dp) :: last_slope(3, most_ramps)
  end type ramp_curve

contains

  !> Shares of the bridging by the properties of the deck.
  pure subroutine prepare_bridging(law, status)
    type(law_parameters), intent(inout) :: law
    type(status_type), intent(out) :: status   !< bridging_strength, bridging_energy: item 1 for mode I, 2 for mode II, value, bound
    real(dp), dimension(2) :: strength, energy
    integer :: i

    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    strength = [law%given%taubridge, law%given%sigmabridge]
    energy = [law%given%giibridge, law%given%gibridge]
    if (.not. strength(1) > 0.0_dp) strength(1) = strength(2)*law%strength(1)/law%strength(2)
    if (.not. energy(1) > 0.0_dp) energy(1) = energy(2)*law%toughness(1)/law%toughness(2)
    do i = 2, 1, -1
      if (.not. (strength(i) > 0.0_dp .and. strength(i) < law%strength(i))) then
        status = status_type(bridging_strength, 3 - i, strength(i), law%strength(i))
        return
      else if (.not. (energy(i) > 0.0_dp .and. energy(i) < law%toughness(i))) then
        status = status_type(bridging_energy, 3 - i, energy(i), law%toughness(i))
        return
      end if
    end do
    law%bridging_strength = strength/law%strength
    law%bridging_energy = energy/law%toughness
  end subroutine prepare_bridging

  !> Ramps of the polygon by the properties of the deck.
  pure subroutine prepare_table(law, status)
    type(law_parameters), intent(inout) :: law
    type(status_type), intent(out) :: status   !< as of `check_table`
    real(dp), dimension(0:most_ramps) :: x, t
    real(dp) :: slope, next
    integer :: count, k

    call check_table(law%given, x, t, count, status)
    if (status%code /= ok) return
    x = x/sum(0.5_dp*(t(0:count - 1) + t(1:count))*(x(1:count) - x(0:count - 1)))
    law%ramps = count
    slope = (t(1) - t(0))/(x(1) - x(0))
    do k = 1, count
      next = 0.0_dp
      if (k < count) next = (t(k + 1) - t(k))/(x(k + 1) - x(k))
      law%ramp_end(k) = x(k)
      law%ramp_height(k) = (next - slope)*x(k)
      slope = next
    end do
  end subroutine prepare_table

  !> Points of a table, from (0, 1) to (1, 0). The separations increase, the tractions do not, and none vanishes before the end.
  pure subroutine check_table(given, x, t, count, status)
    type(law_properties), intent(in) :: given
    real(dp), intent(out) :: x(0:most_ramps), t(0:most_ramps)
    integer, intent(out) :: count              !< of the lines
    type(status_type), intent(out) :: status   !< no_table; of point `item` table_gap: no point before it;
                                               !< table_separation, table_traction: value and the bound by the point before
    integer :: k

    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    x = [0.0_dp, given%separation1, given%separation2, given%separation3, given%separation4, given%separation5, 0.0_dp]
    t = [1.0_dp, given%traction1, given%traction2, given%traction3, given%traction4, given%traction5, 0.0_dp]
    count = 1
    do k = 1, most_ramps - 1
      if (.not. (x(k) > 0.0_dp .or. t(k) > 0.0_dp)) cycle
      if (k > count) then
        status = status_type(table_gap, k, x(k), 0.0_dp)
      else if (.not. x(k) > x(k - 1)) then
        status = status_type(table_separation, k, x(k), x(k - 1))
      else if (.not. (t(k) > 0.0_dp .and. t(k) <= t(k - 1))) then
        status = status_type(table_traction, k, t(k), t(k - 1))
      end if
      if (status%code /= ok) return
      count = k + 1
    end do
    if (count == 1) status = status_type(no_table, 1, 0.0_dp, 0.0_dp)
    x(count) = 1.0_dp
    t(count) = 0.0_dp
  end subroutine check_table

  !> Demands of a law with a total that is not too brittle that neither of its two parts is, in any mode mix.
  pure subroutine check_bridging(law, status)
    type(law_parameters), intent(in) :: law
    type(status_type), intent(out) :: status   !< brittle_tip, brittle_bridging: item 1 for mode I, 2 for mode II, value and bound
                                               !< of the energy; brittle_mixed_line: as too_brittle_mixed
    real(dp) :: reserve, share, elastic
    integer :: i

    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    if (.not. law%flexibility > 0.0_dp) return
    do i = 2, 1, -1
      ! strength of the total times length at the onset
      elastic = 0.5_dp*law%strength(i)**2*law%flexibility/law%ratio(i)
      associate (energy => law%bridging_energy(i)*law%toughness(i), part => law%bridging_strength(i)*elastic)
        if (.not. energy > part) then
          status = status_type(brittle_bridging, 3 - i, energy, part)
        else if (.not. law%toughness(i) - energy > elastic - part) then
          status = status_type(brittle_tip, 3 - i, energy, law%toughness(i) - elastic + part)
        end if
      end associate
      if (status%code /= ok) return
    end do
    call least_of_mixes(law, shorter_reserve, reserve, share)
    if (.not. reserve > law%flexibility) status = status_type(brittle_mixed_line, nint(100.0_dp*share), 1.0_dp/law%flexibility, &
      1.0_dp/reserve)
  end subroutine check_bridging

  !> The smaller one of q_k R at a share of mode II in the energy.
  pure function shorter_reserve(law, share) result(reserve)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: share
    real(dp) :: reserve
    real(dp) :: direction(2), f, e, r, m, slope(2)

    direction = direction_of_share(law, share)
    call measure_onset(law, direction, f, slope)
    call measure_energy(law, direction, e, slope)
    r = mixed(law%bridging_strength, share)
    m = mixed(law%bridging_energy, share)
    reserve = min((1.0_dp - m)/(1.0_dp - r), m/r)*f**2/e
  end function shorter_reserve

  !> A share of the bridging, linear in the share of mode II in the energy.
  pure function mixed(pure_modes, share) result(value)
    real(dp), intent(in) :: pure_modes(2)   !< in mode II and I
    real(dp), intent(in) :: share
    real(dp) :: value

    value = pure_modes(2) + (pure_modes(1) - pure_modes(2))*share
  end function mixed

  !> Ramps of a law in a direction with the measures f and e and a share of mode II in the energy.
  pure subroutine find_ramps(law, f, e, share, curve)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: f, e, share
    type(ramp_curve), intent(out) :: curve
    real(dp), parameter :: by_share(3) = [0.0_dp, 0.0_dp, 1.0_dp]
    real(dp) :: r, m, q(2), reserve, r_slope(3), m_slope(3), q_slope(3, 2), reserve_slope(3)
    integer :: k

    if (law%kind /= bridging_law) then
      curve%count = law%ramps
      curve%height = law%ramp_height
      curve%last = law%ramp_end
      curve%height_slope = 0.0_dp
      curve%last_slope = 0.0_dp
      return
    end if
    r = mixed(law%bridging_strength, share)
    m = mixed(law%bridging_energy, share)
    r_slope = (law%bridging_strength(1) - law%bridging_strength(2))*by_share
    m_slope = (law%bridging_energy(1) - law%bridging_energy(2))*by_share
    q = [(1.0_dp - m)/(1.0_dp - r), m/r]
    q_slope(:, 1) = (q(1)*r_slope - m_slope)/(1.0_dp - r)
    q_slope(:, 2) = (m_slope - q(2)*r_slope)/r
    reserve = f**2/e
    reserve_slope = [2.0_dp*f, -reserve, 0.0_dp]/e
    curve%count = 2
    curve%height(:2) = [1.0_dp - r, r]
    curve%height_slope(:, 1) = -r_slope
    curve%height_slope(:, 2) = r_slope
    do k = 1, 2
      curve%last(k) = 2.0_dp*(q(k)*reserve - law%flexibility)/(reserve - law%flexibility)
      curve%last_slope(:, k) = (2.0_dp*(q_slope(:, k)*reserve + q(k)*reserve_slope) - curve%last(k)*reserve_slope) &
        /(reserve - law%flexibility)
    end do
  end subroutine find_ramps

  !> Softening curve in a direction with the measures f and e and a share of mode II in the energy, and its derivatives.
  pure subroutine multilinear_softening(law, separation, f, e, share, traction, by_separation, by_f, by_e, by_share)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: separation        !< lambda, length
    real(dp), intent(in) :: f, e, share       !< 1/stress, area/energy, 1
    real(dp), intent(out) :: traction         !< tau, stress; zero after failure
    real(dp), intent(out) :: by_separation    !< stress/length
    real(dp), intent(out) :: by_f, by_e, by_share
    type(ramp_curve) :: curve
    real(dp) :: below, beyond, x, height, slope, height_slope(3)
    integer :: j

    call find_ramps(law, f, e, share, curve)
    below = f**2 - e*law%flexibility
    beyond = f*separation - law%flexibility
    x = 2.0_dp*e*beyond/below
    height = 0.0_dp
    slope = 0.0_dp
    height_slope = 0.0_dp
    do j = 1, curve%count
      associate (a => curve%height(j), last => curve%last(j))
        if (x >= last) cycle
        height = height + a*(1.0_dp - x/last)
        slope = slope - a/last
        height_slope = height_slope + (1.0_dp - x/last)*curve%height_slope(:, j) + a*x/last**2*curve%last_slope(:, j)
      end associate
    end do
    traction = height/f
    by_separation = 2.0_dp*e*slope/below
    by_f = (height_slope(1) + slope*2.0_dp*(e*separation - x*f)/below - traction)/f
    by_e = (height_slope(2) + slope*(2.0_dp*beyond + x*law%flexibility)/below)/f
    by_share = height_slope(3)/f
  end subroutine multilinear_softening

  !> Largest softening slope -d tau/d lambda = -T'/h of all directions.
  pure function multilinear_steepest(law) result(slope)
    type(law_parameters), intent(in) :: law
    real(dp) :: slope   !< stress/length
    real(dp) :: least, share

    call least_of_mixes(law, gentlest_inverse, least, share)
    slope = 1.0_dp/least
  end function multilinear_steepest

  !> Inverse of the largest softening slope at a share of mode II in the energy.
  pure function gentlest_inverse(law, share) result(inverse)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: share
    real(dp) :: inverse   !< length/stress
    type(ramp_curve) :: curve
    real(dp) :: direction(2), f, e, slope, steepest, not_used(2)
    integer :: j

    direction = direction_of_share(law, share)
    call measure_onset(law, direction, f, not_used)
    call measure_energy(law, direction, e, not_used)
    call find_ramps(law, f, e, share, curve)
    steepest = 0.0_dp
    associate (n => curve%count)
      do j = 1, n
        slope = sum(curve%height(:n)/curve%last(:n), mask=curve%last(:n) >= curve%last(j))
        steepest = max(steepest, slope)
      end do
    end associate
    inverse = 0.5_dp*(f**2/e - law%flexibility)/steepest
  end function gentlest_inverse

  !> Area of `loss` in a direction where 1/K - flexibility = lost/stiff: 1/(2 e) at failure.
  !>
  !> T(x) (flexibility stiff + lost) = stiff (flexibility + h x) is linear in x between the ends of the ramps. Both sides at an end
  !> tell whether x is beyond it. With the integral of T up to x the area is
  !> sum_j a_j min(1, x/x_j) (flexibility + h x_j)/(2 f**2), without a difference of large numbers.
  pure function multilinear_loss(law, direction, stiff, lost) result(loss)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: direction(2)     !< c, not negative, of unit length
    real(dp), intent(in) :: stiff, lost      !< not negative, not both zero
    real(dp) :: loss                         !< stress times length
    type(ramp_curve) :: curve
    logical :: passed(most_ramps)
    real(dp) :: f, e, h, x, share, not_used(2)
    integer :: j

    call measure_onset(law, direction, f, not_used)
    call measure_energy(law, direction, e, not_used)
    call measure_share(law, direction, share, not_used)
    call find_ramps(law, f, e, share, curve)
    loss = 0.5_dp/e
    if (.not. stiff > 0.0_dp) return
    h = 0.5_dp*(f**2/e - law%flexibility)
    associate (n => curve%count, whole => law%flexibility*stiff + lost)
      associate (a => curve%height(:n), last => curve%last(:n))
        do j = 1, n
          passed(j) = sum(a*max(0.0_dp, 1.0_dp - last(j)/last))*whole > stiff*(law%flexibility + h*last(j))
        end do
        ! the heights of all ramps are 1 together
        x = (lost - sum(a, mask=passed(:n))*whole)/(h*stiff + sum(a/last, mask=.not. passed(:n))*whole)
        loss = 0.5_dp*sum(a*min(1.0_dp, max(0.0_dp, x)/last)*(law%flexibility + h*last))/f**2
      end associate
    end associate
  end function multilinear_loss

end module cohesive_multilinear
