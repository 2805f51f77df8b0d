! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Damage of an interface point, whatever the law: envelope, history, viscous regularisation, energies.
!>
!> Note on signs: the paper defines the jump as u(2) - u(1) with n from Omega(2) to Omega(1), yet takes max(0, delta_n) as the
!> opening: the two contradict each other. Here "bottom" is Omega(2), "top" is Omega(1), n points from bottom to top, the separation
!> is u_top - u_bottom (opening positive), and the traction is sigma.n (tension positive).
!>
!> Pairs are in the order (tau, n) of equation (8), tau the shear resultant of `cohesive_shear`.
!>
!> A law is a softening curve tau(lambda) for every direction c of the separation, w = lambda c with c = (|w_tau|, w_n)/
!> lambda, from which the traction follows as t_i = tau ratio_i c_i. It is continued towards smaller separations than that
!> at the onset of damage, down to none; the straight line lambda/flexibility meets it at the onset. To add a law, add a module
!> with `_softening`, `_steepest` and `_loss` and a line in each select case below. The PPR law is different: each of its
!> components has its own damage, and it brings its own routines.
module cohesive_law
  use core_kinds, only: dp
  use core_status, only: status_type, ok, small_beta, falls_with_rate
  use cohesive_parameters, only: law_parameters
  use cohesive_law_properties, only: law_properties, bilinear_law, exponential_law, ppr_law, bridging_law, table_law
  use cohesive_state, only: point_history, damage_state
  use cohesive_mode_mix, only: measure_onset, measure_energy, measure_share, check_mode_mix, least_reserve
  use cohesive_bilinear, only: bilinear_softening, bilinear_steepest, bilinear_loss
  use cohesive_fatigue, only: grow_at_separation
  use cohesive_rate, only: depends_on_rate, measure_rate, rate_exponents, suit_steepest_rate
  use cohesive_exponential, only: exponential_softening, exponential_steepest, exponential_loss
  use cohesive_multilinear, only: prepare_bridging, prepare_table, check_bridging, multilinear_softening, multilinear_steepest, &
    multilinear_loss
  use cohesive_ppr, only: prepare_ppr, check_ppr, check_ppr_beta, raise_ppr_beta, evolve_ppr
  implicit none(type, external)
  private
  public :: prepare_law, check_law, check_beta, raise_beta, softening, loss, stiffness_of, damage_envelope, evolve_damage

contains

  !> A law by its properties; an initial stiffness of 0 stands for an infinite one.
  pure subroutine prepare_law(kind, given, law, status)
    integer, intent(in) :: kind                !< value of LAW
    type(law_properties), intent(in) :: given
    type(law_parameters), intent(out) :: law
    type(status_type), intent(out) :: status

    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    law%kind = kind
    law%given = given
    law%flexibility = 0.0_dp
    law%ratio = 1.0_dp
    if (given%alphan > 0.0_dp) then
      law%flexibility = 1.0_dp/given%alphan
      law%ratio = [given%alphat/given%alphan, 1.0_dp]
    end if
    law%strength = [given%taumax, given%sigmamax]
    law%toughness = [given%giic, given%gic]
    law%viscosity = given%viscosity
    law%friction = given%friction
    if (kind == bilinear_law) return
    if (kind == ppr_law) then
      if (given%shapet > 0.0_dp) law%shape(1) = given%shapet
      if (given%shapen > 0.0_dp) law%shape(2) = given%shapen
      call prepare_ppr(law, status)
      return
    end if
    law%eta = given%eta
    if (given%power > 0.0_dp) law%power = given%power
    if (kind == bridging_law) call prepare_bridging(law, status)
    if (kind == table_law) call prepare_table(law, status)
  end subroutine prepare_law

  !> Checks what the ranges of single parameters cannot express; status%item is 1 for mode I, 2 for mode II.
  pure subroutine check_law(law, status)
    type(law_parameters), intent(in) :: law
    type(status_type), intent(out) :: status

    if (law%kind == ppr_law) then
      call check_ppr(law, status)
    else if (depends_on_rate(law)) then
      call check_rates(law, status)
    else
      call check_shape(law, status)
    end if
  end subroutine check_law

  !> Demands of a softening curve that failure comes after the onset of damage.
  pure subroutine check_shape(law, status)
    type(law_parameters), intent(in) :: law
    type(status_type), intent(out) :: status

    call check_mode_mix(law, status)
    if (status%code == ok .and. law%kind == bridging_law) call check_bridging(law, status)
  end subroutine check_shape

  !> The same at every rate, and that the traction does not fall with the rate: fortran/laws.md.
  pure subroutine check_rates(law, status)
    type(law_parameters), intent(in) :: law
    type(status_type), intent(out) :: status   !< falls_with_rate: TOUGHNESSRATE and its bound
    type(law_parameters) :: steepest
    real(dp) :: exponents(2), reserve, share, least

    steepest = law
    call suit_steepest_rate(steepest)
    call check_shape(steepest, status)
    if (status%code /= ok .or. .not. any(law%kind == [exponential_law, table_law])) return
    exponents = rate_exponents(law)
    call least_reserve(steepest, reserve, share)
    least = exponents(1)*(1.0_dp + law%flexibility/reserve)
    if (exponents(2) < least) status = status_type(falls_with_rate, 0, exponents(2), least)
  end subroutine check_rates

  !> Demands that beta exceeds the softening slope; otherwise the trial traction does not determine the separation.
  !>
  !> Along a fixed direction tau + b lambda grows with lambda if b exceeds the steepest slope k. Where b = beta/ratio differs
  !> between the two components, the direction changes with the damage; for the bilinear law the root stays the only one
  !> if b exceeds k (2 - b_min/b_max): fortran/laws.md.
  pure subroutine check_beta(law, beta, status)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: beta(2)            !< stress/length
    type(status_type), intent(out) :: status   !< small_beta: item 1 for beta_n, 2 for beta_tau, value and bound
    real(dp) :: b(2), least
    integer :: i

    if (law%kind == ppr_law) then
      call check_ppr_beta(law, beta, status)
      return
    end if
    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    b = beta/law%ratio
    least = steepest(law)*(2.0_dp - minval(b)/maxval(b))
    do i = 2, 1, -1
      if (.not. b(i) > least) then
        status = status_type(small_beta, 3 - i, beta(i), law%ratio(i)*least)
        return
      end if
    end do
  end subroutine check_beta

  !> Raises a beta that is an estimate, and less than twice what one beta for both components has to exceed, to that.
  !>
  !> Twice the slope k is the least beta at which the traction never falls faster than p rises: dT/dp = -k/(beta - k) >= -1. It also
  !> is more than `check_beta` demands of any pair. Beside a beta of the deck between k and that, the other one is raised to the
  !> same: a larger one would demand more of that of the deck.
  pure subroutine raise_beta(law, estimated, beta)
    type(law_parameters), intent(in) :: law
    logical, intent(in) :: estimated(2)        !< not a value of the deck
    real(dp), intent(inout) :: beta(2)         !< (tau, n), stress/length
    real(dp) :: slope, other, enough

    if (law%kind == ppr_law) then
      call raise_ppr_beta(law, estimated, beta)
      return
    end if
    slope = steepest(law)
    enough = 2.0_dp*slope
    other = minval(beta/law%ratio, mask=.not. estimated)   ! the largest number if both are estimates
    if (other > slope) enough = min(enough, other)
    where (estimated) beta = max(beta, law%ratio*enough)
  end subroutine raise_beta

  !> Largest softening slope -d tau/d lambda of a law.
  pure function steepest(law) result(slope)
    type(law_parameters), intent(in) :: law
    real(dp) :: slope   !< stress/length

    select case (law%kind)
    case (exponential_law)
      slope = exponential_steepest(law)
    case (bridging_law, table_law)
      slope = multilinear_steepest(law)
    case default
      slope = bilinear_steepest(law)
    end select
  end function steepest

  !> Softening curve of a law in the direction c = (sin theta, cos theta), with its derivatives by lambda and theta. Where the law
  !> depends on the rate, that is the rate with which this increment reaches lambda.
  pure subroutine softening(law, separation, direction, traction, by_separation, by_angle)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: separation       !< lambda, not negative, length
    real(dp), intent(in) :: direction(2)     !< c, not negative, of unit length
    real(dp), intent(out) :: traction        !< tau, stress
    real(dp), intent(out) :: by_separation   !< stress/length
    real(dp), intent(out) :: by_angle        !< stress
    real(dp) :: f, e, share, by_f, by_e, by_share, by_direction(2), f_slope(2), e_slope(2), share_slope(2), factors(2), slopes(2)

    call measure_onset(law, direction, f, f_slope)
    call measure_energy(law, direction, e, e_slope)
    if (depends_on_rate(law)) then
      call measure_rate(law, separation, factors, slopes)
      f = f/factors(1)
      f_slope = f_slope/factors(1)
      e = e/factors(2)
      e_slope = e_slope/factors(2)
    end if
    by_share = 0.0_dp
    share_slope = 0.0_dp
    select case (law%kind)
    case (exponential_law)
      call exponential_softening(law, separation, f, e, traction, by_separation, by_f, by_e)
    case (bridging_law, table_law)
      call measure_share(law, direction, share, share_slope)
      call multilinear_softening(law, separation, f, e, share, traction, by_separation, by_f, by_e, by_share)
    case default
      call bilinear_softening(law, separation, f, e, traction, by_separation, by_f, by_e)
    end select
    if (depends_on_rate(law)) by_separation = by_separation - by_f*f*slopes(1) - by_e*e*slopes(2)
    by_direction = by_f*f_slope + by_e*e_slope + by_share*share_slope
    by_angle = by_direction(1)*direction(2) - by_direction(2)*direction(1)
  end subroutine softening

  !> Area under the softening curve in a direction, less the triangle K lambda**2/2, once the secant stiffness has fallen to K: a
  !> function of K and the direction alone. Times ratio_i c_i**2, it is the energy per area that component i has dissipated.
  pure function loss(law, direction, stiff, lost) result(area)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: direction(2)     !< c, not negative, of unit length
    real(dp), intent(in) :: stiff, lost      !< not negative, 1/K - flexibility = lost/stiff; stiff is 0 at failure
    real(dp) :: area   !< stress times length

    select case (law%kind)
    case (exponential_law)
      area = exponential_loss(law, direction, stiff, lost)
    case (bridging_law, table_law)
      area = multilinear_loss(law, direction, stiff, lost)
    case default
      area = bilinear_loss(law, direction, stiff, lost)
    end select
  end function loss

  !> Initial stiffness alpha of a law that is not rigid.
  pure function stiffness_of(law) result(stiffness)
    type(law_parameters), intent(in) :: law
    real(dp) :: stiffness(2)

    stiffness = law%ratio/law%flexibility
  end function stiffness_of

  !> Damage d = 1 - tau flexibility/lambda of a law at a separation without history, and its slope; (9) for the bilinear one.
  pure subroutine damage_envelope(law, separation, damage, slope)
    type(law_parameters), intent(in) :: law    !< not rigid
    real(dp), intent(in) :: separation(2)      !< (tau, n), tau not negative
    real(dp), intent(out) :: damage
    real(dp), intent(out) :: slope(2)          !< zero before onset and after failure
    real(dp) :: direction(2), length, traction, by_separation, by_angle

    damage = 0.0_dp
    slope = 0.0_dp
    direction = [separation(1), max(0.0_dp, separation(2))]
    length = sqrt(direction(1)**2 + direction(2)**2)
    if (.not. length > 0.0_dp) return
    direction = direction/length
    call softening(law, length, direction, traction, by_separation, by_angle)
    if (traction*law%flexibility >= length) return
    damage = 1.0_dp - traction*law%flexibility/length
    slope = (traction/length - by_separation)*direction
    slope = slope - (by_angle/length)*[direction(2), -direction(1)]
    slope = slope*law%flexibility/length
  end subroutine damage_envelope

  !> Damage at the end of an increment.
  !>
  !> The damage of the envelope never heals: d = max over time of (9). Below it the response follows the secant to the origin and
  !> the slope is zero; on it, the slope is that of further loading.
  !>
  !> The damage that acts follows d with the relaxation time `viscosity`, d_v' = (d - d_v)/viscosity, integrated by
  !> backward Euler; an increment of zero duration leaves it unchanged. Without a duration there is no rate either, and a law that
  !> depends on it keeps its damage.
  pure subroutine evolve_damage(law, history, separation, dtime, state)
    type(law_parameters), intent(in) :: law
    type(point_history), intent(in) :: history
    real(dp), intent(in) :: separation(2)   !< (tau, n), tau not negative, opening positive
    real(dp), intent(in) :: dtime           !< duration of the increment
    type(damage_state), intent(out) :: state
    real(dp) :: fraction, slope(2)

    fraction = 1.0_dp
    if (law%viscosity > 0.0_dp) fraction = dtime/(law%viscosity + dtime)
    if (law%kind == ppr_law) then
      call evolve_ppr(law, history, separation, fraction, state)
      return
    end if
    call damage_envelope(law, separation, state%damage_max, slope)
    if (state%damage_max < history%damage_max .or. (depends_on_rate(law) .and. .not. dtime > 0.0_dp)) then
      state%damage_max = history%damage_max
      slope = 0.0_dp
    end if
    if (law%fatigue) call grow_at_separation(law, separation, history, state%damage_max, slope, state%cycled)
    state%damage = state%damage_max
    if (law%viscosity > 0.0_dp) then
      state%damage = history%damage + fraction*(state%damage_max - history%damage)
      slope = fraction*slope
    end if
    state%largest = 0.0_dp
    state%acting = state%damage
    state%slope(1, :) = slope
    state%slope(2, :) = slope
  end subroutine evolve_damage

end module cohesive_law
