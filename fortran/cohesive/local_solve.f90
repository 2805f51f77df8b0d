! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The consistent stabilised law: the cohesive law has its own separation w, solved for at the integration point.
!>
!> The paper evaluates the damage of (16) at the displacement jump g. With a stiff law the jump is dominated by the gap of
!> Nitsche's method, zero only to the order of the element size. Here, with the trial traction p = <sigma>.n + beta g,
!>
!>     t(w; history) + beta w = p,      T = t(w; history).
!>
!> Before the onset of damage, t = alpha w, this is (16). With the secant stiffness K of t_i = K ratio_i w_i and
!> b = beta/ratio, w_i = p_i/(ratio_i (K + b_i)), so there is one scalar unknown. It is x = 1/(K + min b), which runs from
!> 1/(alpha_n + b), or 0 for an infinite alpha, to 1/b at failure; in it a bilinear law is a straight line wherever
!> b_1 = b_2. T depends on p alone.
!>
!> In space, p, w and T have two shears: the viscous overstress and friction act on the vectors, and the law is solved for the shear
!> resultant and the opening (`cohesive_shear`). The interface is closed where p_n < 0: the normal stiffness is not damaged there.
module cohesive_local_solve
  use core_kinds, only: dp
  use core_root, only: root_search, search_between, searching, advance
  use core_small_matrix, only: invert
  use cohesive_parameters, only: law_parameters
  use cohesive_law_properties, only: ppr_law
  use cohesive_shear, only: mode_of, shears, resultant, shear_direction, vector_tangent
  use cohesive_state, only: point_history, law_solution, driven_point, resultant_solution
  use cohesive_law, only: softening
  use cohesive_fatigue_local_solve, only: grow_by_cycles, measure_cycles
  use cohesive_local_equation, only: law_equation, equation_of, shares, direction_at, remainder_at, damage_of, damage_at_secant, &
    at_damage, softening_stiffness
  use cohesive_friction, only: friction_state, coulomb_friction, add_friction
  use cohesive_rate, only: depends_on_rate
  use cohesive_ppr_local_solve, only: solve_ppr_law, ppr_trial_of_rest
  implicit none(type, external)
  private
  public :: solve_law, opening_part

contains

  !> Traction, separation and damage for a trial traction, and the derivative of the traction by it.
  !>
  !> Viscosity adds the overstress eta dw/dt, by backward Euler: beta and p become beta + eta/dt and p + eta w_old/dt. Its
  !> eta = viscosity k (1 - D_old), with the softening stiffness k of each mode, vanishes at failed points. With PACING it is
  !> viscosity k until failure: a point softens as fast at its end as at its onset, and needs as much to do so steadily. A lag
  !> of the damage cannot work: an undamaged point with infinite alpha does not open, and one that does not open has no damage to
  !> catch up with. In an increment of zero duration a law that is viscous or depends on the rate keeps its damage.
  pure subroutine solve_law(law, beta, trial, dtime, secant_share, history, state)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: beta(2)              !< stress/length, (tau, n)
    real(dp), intent(in) :: trial(3)             !< p, stress
    real(dp), intent(in) :: dtime                !< duration of the increment
    real(dp), intent(in) :: secant_share         !< of the tangent at fixed damage in `by_trial`, from 0 to 1
    type(point_history), intent(in) :: history
    type(law_solution), intent(out) :: state
    type(driven_point) :: driven
    type(point_history) :: start
    type(resultant_solution) :: solution
    type(friction_state) :: friction
    real(dp) :: old(3), p(3), direction(2), rest(2), turning, pressed

    old = opening_part(history%separation)
    driven%beta = beta
    driven%viscous = 0.0_dp
    if (law%viscosity > 0.0_dp .and. dtime > 0.0_dp) driven%viscous = (law%viscosity/dtime) &
      *remaining_share(law, history%damage)*overstress_stiffness(law)
    driven%secant_share = secant_share
    driven%fixed = (law%viscosity > 0.0_dp .or. depends_on_rate(law)) .and. .not. dtime > 0.0_dp
    p = trial + driven%viscous(mode_of)*old
    driven%closed = p(2) < 0.0_dp
    driven%sticks = .false.
    start = history
    pressed = p(2)/(1.0_dp + beta(2)*law%flexibility)
    friction%acts = law%friction*history%damage > 0.0_dp .and. driven%closed
    if (friction%acts) then
      if (law%kind /= ppr_law .and. .not. driven%fixed) start%damage = max(history%damage, damage_of_shear(law, old))
      call find_rest(law, driven, start, p, old, rest, turning)
      call coulomb_friction(law%friction*history%damage, pressed, p(shears) - rest, 1.0_dp - turning, friction)
      driven%sticks = friction%sticks
      p(shears) = p(shears) - friction%traction
    end if
    driven%trial = resultant(p)
    if (law%kind == ppr_law) then
      call solve_ppr_law(law, driven, start, solution)
    else
      call solve_softening_law(law, driven, start, solution)
    end if

    direction = shear_direction(p)
    state%damage = solution%damage
    state%largest = solution%largest
    state%stabilisation = solution%stabilisation
    state%solved = solution%solved
    state%steps = solution%steps
    state%recoverable(shears) = solution%recoverable(1)*direction
    state%recoverable(2) = solution%recoverable(2)
    state%separation(shears) = solution%separation(1)*direction
    state%separation(2) = solution%separation(2)
    if (driven%sticks) state%separation(shears) = old(shears)
    state%overstress = driven%viscous(mode_of)*(opening_part(state%separation) - old)
    state%traction = state%recoverable + state%overstress
    state%by_trial = vector_tangent(direction, solution%share, solution%by_trial)
    state%cycled = solution%cycled
    state%friction = 0.0_dp
    if (.not. friction%acts) return
    state%friction = friction%traction
    state%traction(shears) = state%traction(shears) + friction%traction
    call add_friction(friction, 1.0_dp/(1.0_dp + beta(2)*law%flexibility), state%by_trial)
  end subroutine solve_law

  !> (p_s, p_t) at which the shear of w does not change, without friction.
  pure subroutine find_rest(law, driven, history, p, old, rest, turning)
    type(law_parameters), intent(in) :: law
    type(driven_point), intent(in) :: driven
    type(point_history), intent(in) :: history
    real(dp), intent(in) :: p(3), old(3)
    real(dp), intent(out) :: rest(2)
    real(dp), intent(out) :: turning   !< derivative of the rest by p, across p
    type(law_equation) :: equation
    real(dp) :: stiff(2), soft(2)

    if (law%kind == ppr_law) then
      call ppr_trial_of_rest(law, driven, history, p(shears), old(shears), rest, turning)
      return
    end if
    turning = 0.0_dp
    equation = equation_of(law, driven)
    call shares(law, driven, equation, at_damage(law, equation%least, history%damage), stiff, soft)
    rest = old(shears)/max(soft(1), tiny(1.0_dp))
  end subroutine find_rest

  !> Damage of the law at the shear of a separation. A point that has opened and closes has this at least, where it sticks too:
  !> the law of pure shear may be weaker than that of the mode mix before.
  pure function damage_of_shear(law, separation) result(damage)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: separation(3)
    real(dp) :: damage
    real(dp), parameter :: shear(2) = [1.0_dp, 0.0_dp]
    real(dp) :: pair(2), traction, by_separation, by_angle

    damage = 0.0_dp
    pair = resultant(separation)
    if (.not. pair(1) > 0.0_dp) return
    call softening(law, pair(1), shear, traction, by_separation, by_angle)
    damage = damage_at_secant(law, traction, pair(1))
  end function damage_of_shear

  !> The laws that are a softening curve in every direction, in (tau, n).
  pure subroutine solve_softening_law(law, driven, history, solution)
    type(law_parameters), intent(in) :: law
    type(driven_point), intent(in) :: driven
    type(point_history), intent(in) :: history
    type(resultant_solution), intent(out) :: solution
    type(law_equation) :: equation
    real(dp) :: stiff(2), soft(2), viscous(2), by_driving(2), start, x
    real(dp), dimension(2, 2) :: loading, opening
    logical :: may_grow, grows
    integer :: steps

    equation = equation_of(law, driven)
    equation%driving = [driven%trial(1), max(0.0_dp, driven%trial(2))]/law%ratio
    x = at_damage(law, equation%least, history%damage)
    solution%damage = history%damage
    solution%largest = 0.0_dp
    may_grow = history%damage < 1.0_dp .and. .not. (driven%sticks .or. driven%fixed) .and. maxval(equation%driving) > 0.0_dp
    grows = may_grow
    solution%solved = .true.
    solution%steps = 0
    start = x
    if (may_grow) call solve_for_damage(law, equation, x, grows, solution%solved, solution%steps)
    if (may_grow .and. law%cycles%count > 0.0_dp .and. solution%solved) then
      call grow_by_cycles(law, equation, history%cycled%relative, start, x, solution%cycled%grown, by_driving, &
        solution%solved, steps)
      solution%steps = solution%steps + steps
    end if
    ! where it is nearly 1, rounding could make it decrease
    if (grows .or. solution%cycled%grown > 0.0_dp) solution%damage = max(history%damage, damage_of(law, equation%least, x))
    if (law%fatigue) call measure_cycles(law, equation, x, history, solution%cycled)
    call shares(law, driven, equation, x, stiff, soft)
    solution%recoverable = stiff*driven%trial
    solution%separation = soft*driven%trial
    solution%stabilisation = driven%beta*soft/(stiff + driven%beta*soft)

    viscous = driven%viscous
    if (driven%closed) viscous(2) = 0.0_dp
    solution%share = stiff(1) + viscous(1)*soft(1)
    solution%by_trial = 0.0_dp
    solution%by_trial(1, 1) = solution%share
    solution%by_trial(2, 2) = stiff(2) + viscous(2)*soft(2)
    if (.not. driven%secant_share < 1.0_dp) return
    if (solution%cycled%grown > 0.0_dp) then
      call slopes_of_cycles(law, equation, x, by_driving, loading, opening)
    else if (grows) then
      call slopes_of_loading(law, equation, x, loading, opening)
    else
      return
    end if
    call blend_loading(driven%closed, viscous, 1.0_dp - driven%secant_share, loading, opening, solution%by_trial)
  end subroutine solve_softening_law

  !> Adds the slopes of growing damage to a share of dT/dp.
  pure subroutine blend_loading(closed, viscous, share, of_traction, of_separation, by_trial)
    logical, intent(in) :: closed
    real(dp), intent(in) :: viscous(2)              !< overstress by w, stress/length
    real(dp), intent(in) :: share                   !< from 0 to 1
    real(dp), intent(in) :: of_traction(2, 2)       !< dt/dp of growing damage
    real(dp), intent(in) :: of_separation(2, 2)     !< dw/dp
    real(dp), intent(inout) :: by_trial(2, 2)       !< at fixed damage; blended
    real(dp) :: loading(2, 2)

    loading(1, :) = of_traction(1, :) + viscous(1)*of_separation(1, :)
    loading(2, :) = of_traction(2, :) + viscous(2)*of_separation(2, :)
    if (closed) loading(:, 2) = [0.0_dp, by_trial(2, 2)]
    by_trial = (1.0_dp - share)*by_trial + share*loading
  end subroutine blend_loading

  !> Finds x at which the damage of the law belongs to the separation that this damage gives.
  !>
  !> h(x) = 1 - x min b - tau(lambda(x), c(x)) x/lambda, (K - tau/lambda) x with K = 1/x - min b, decreases from a positive value,
  !> if the damage grows at all, to one that is not positive at failure.
  pure subroutine solve_for_damage(law, equation, x, grows, solved, steps)
    type(law_parameters), intent(in) :: law
    type(law_equation), intent(in) :: equation   !< driving is not zero
    real(dp), intent(inout) :: x         !< at the damage so far; at the damage of the end of the increment
    logical, intent(out) :: grows        !< false if the damage stays
    logical, intent(out) :: solved       !< false if the root was not found
    integer, intent(out) :: steps        !< of the search
    type(root_search) :: search
    real(dp) :: upper, h, slope, at_failure, not_used

    solved = .true.
    steps = 0
    call law_residual(law, equation, x, h, slope)
    grows = h > 0.0_dp
    if (.not. grows) return
    upper = 1.0_dp/equation%least
    call law_residual(law, equation, upper, at_failure, not_used)
    if (at_failure >= 0.0_dp) then
      x = upper
      return
    end if
    search = search_between(x, upper, x, geometric=.false.)
    do
      call advance(search, -h, -slope)
      if (.not. searching(search)) exit
      call law_residual(law, equation, search%x, h, slope)
    end do
    x = search%x
    solved = search%found
    steps = search%steps
  end subroutine solve_for_damage

  !> h of `solve_for_damage` and its derivative.
  pure subroutine law_residual(law, equation, x, h, slope)
    type(law_parameters), intent(in) :: law
    type(law_equation), intent(in) :: equation
    real(dp), intent(in) :: x
    real(dp), intent(out) :: h, slope
    real(dp), dimension(2) :: direction, excess
    real(dp) :: length, traction, by_separation, by_angle, mean, turn

    call direction_at(equation, x, length, direction)
    call softening(law, x*length, direction, traction, by_separation, by_angle)
    h = remainder_at(equation%least, x) - traction/length
    ! v_i = driving_i/(1 + (b_i - min b) x) and its logarithmic derivative, which turns the direction
    excess = (equation%b - equation%least)/(1.0_dp + (equation%b - equation%least)*x)
    mean = excess(1)*direction(1)**2 + excess(2)*direction(2)**2
    turn = (excess(2) - excess(1))*direction(1)*direction(2)
    slope = -equation%least - by_separation*(1.0_dp - x*mean) - (by_angle*turn + traction*mean)/length
  end subroutine law_residual

  !> dt/dp and dw/dp while the damage grows, through lambda and the angle theta of c = (sin theta, cos theta):
  !> p_i/ratio_i = tau c_i + b_i lambda c_i.
  pure subroutine slopes_of_loading(law, equation, x, of_traction, of_separation)
    type(law_parameters), intent(in) :: law
    type(law_equation), intent(in) :: equation
    real(dp), intent(in) :: x
    real(dp), intent(out) :: of_traction(2, 2)    !< dt/dp
    real(dp), intent(out) :: of_separation(2, 2)  !< dw/dp
    real(dp), dimension(2, 2) :: a, inverse, of_tau, of_w
    real(dp), dimension(2) :: direction, turned
    real(dp) :: length, traction, by_separation, by_angle, separation, determinant
    integer :: j

    call direction_at(equation, x, length, direction)
    separation = x*length
    call softening(law, separation, direction, traction, by_separation, by_angle)
    turned = [direction(2), -direction(1)]
    of_tau(:, 1) = by_separation*direction
    of_tau(:, 2) = by_angle*direction + traction*turned
    of_w(:, 1) = direction
    of_w(:, 2) = separation*turned
    a(:, 1) = of_tau(:, 1) + equation%b*of_w(:, 1)
    a(:, 2) = of_tau(:, 2) + equation%b*of_w(:, 2)
    call invert(2, a, inverse, determinant)
    of_tau = matmul(of_tau, inverse)
    of_w = matmul(of_w, inverse)
    do j = 1, 2
      of_traction(:, j) = law%ratio*of_tau(:, j)/law%ratio(j)
      of_separation(:, j) = of_w(:, j)/law%ratio(j)
    end do
  end subroutine slopes_of_loading

  !> dt/dp and dw/dp while cycles let the damage grow, from dx/d(p/ratio).
  pure subroutine slopes_of_cycles(law, equation, x, by_driving, of_traction, of_separation)
    type(law_parameters), intent(in) :: law
    type(law_equation), intent(in) :: equation
    real(dp), intent(in) :: x
    real(dp), intent(in) :: by_driving(2)
    real(dp), intent(out) :: of_traction(2, 2)    !< dt/dp
    real(dp), intent(out) :: of_separation(2, 2)  !< dw/dp
    real(dp), dimension(2) :: share, share_slope
    integer :: j

    share = 1.0_dp/(1.0_dp + (equation%b - equation%least)*x)
    share_slope = -(equation%b - equation%least)*share**2
    do j = 1, 2
      of_traction(:, j) = law%ratio*equation%driving*(remainder_at(equation%least, x)*share_slope - equation%least*share) &
        *by_driving(j)/law%ratio(j)
      of_separation(:, j) = equation%driving*(x*share_slope + share)*by_driving(j)/law%ratio(j)
      of_traction(j, j) = of_traction(j, j) + remainder_at(equation%least, x)*share(j)
      of_separation(j, j) = of_separation(j, j) + x*share(j)/law%ratio(j)
    end do
  end subroutine slopes_of_cycles

  !> Stiffness of the viscous overstress of an undamaged point, without the relaxation time: k, or strength**2/(2 G) for PPR.
  pure function overstress_stiffness(law) result(k)
    type(law_parameters), intent(in) :: law
    real(dp) :: k(2)

    if (law%kind == ppr_law) then
      k = 0.5_dp*law%strength**2/law%toughness
    else
      k = softening_stiffness(law)*law%ratio
    end if
  end function overstress_stiffness

  !> Share of the overstress that acts at a damage.
  pure function remaining_share(law, damage) result(share)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: damage
    real(dp) :: share

    share = 1.0_dp - damage
    if (law%paced) share = merge(1.0_dp, 0.0_dp, damage < 1.0_dp)
  end function remaining_share

  !> A vector without the penetration, or the compression, of a closed interface.
  pure function opening_part(vector) result(part)
    real(dp), intent(in) :: vector(3)
    real(dp) :: part(3)

    part = [vector(1), max(0.0_dp, vector(2)), vector(3)]
  end function opening_part

end module cohesive_local_solve
