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
!> Components are in the order (tau, n). The interface is closed where p_n < 0: the normal stiffness is not damaged there.
module cohesive_local_solve
  use core_kinds, only: dp
  use core_root, only: root_search, search_between, searching, advance
  use core_small_matrix, only: invert
  use cohesive_parameters, only: law_parameters, ppr_law
  use cohesive_state, only: point_history, law_solution
  use cohesive_law, only: softening
  use cohesive_friction, only: coulomb_friction
  use cohesive_ppr, only: ppr_start_of_increment
  use cohesive_ppr_local_solve, only: solve_ppr_law
  implicit none(type, external)
  private
  public :: solve_law, dissipate_consistently

  !> The scalar equation: b, and p/ratio without its compressive part.
  type :: law_equation
    real(dp) :: b(2)         !< (beta + viscous part)/ratio, stress/length
    real(dp) :: least        !< smaller one of b
    real(dp) :: driving(2)   !< absolute value of p/ratio, stress
  end type law_equation

contains

  !> Traction, separation and damage for a trial traction, and the derivative of the traction by it.
  !>
  !> Viscosity adds the overstress eta dw/dt, by backward Euler: beta and p become beta + eta/dt and p + eta w_old/dt. Its
  !> eta = viscosity k (1 - D_old) ratio, with the softening stiffness k, vanishes at failed points. A lag of the damage cannot
  !> work: an undamaged point with infinite alpha does not open, and one that does not open has no damage to catch up with. In an
  !> increment of zero duration a viscous law keeps its damage.
  pure subroutine solve_law(law, beta, trial, dtime, secant_share, history, state)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: beta(2)              !< stress/length, (tau, n)
    real(dp), intent(in) :: trial(2)             !< p, stress
    real(dp), intent(in) :: dtime                !< duration of the increment
    real(dp), intent(in) :: secant_share         !< of the tangent at fixed damage in `by_trial`, from 0 to 1
    type(point_history), intent(in) :: history
    type(law_solution), intent(out) :: state
    type(law_equation) :: equation
    real(dp), dimension(2) :: viscous, old, p, stiff, soft
    real(dp) :: x, friction_slope
    logical :: closed, grows, sticks

    if (law%kind == ppr_law) then
      call solve_ppr_law(law, beta, trial, dtime, secant_share, history, state)
      return
    end if
    old = opening_part(history%separation)
    viscous = 0.0_dp
    if (law%viscosity > 0.0_dp .and. dtime > 0.0_dp) viscous = (law%viscosity/dtime) &
      *softening_stiffness(law)*(1.0_dp - history%damage)*law%ratio
    p = trial + viscous*old
    closed = p(2) < 0.0_dp
    equation%b = (beta + viscous)/law%ratio
    equation%least = minval(equation%b)
    x = at_damage(law, equation%least, history%damage)
    call shares(law, beta, equation, closed, x, stiff, soft)
    call coulomb_friction(law, history%damage, merge(p(2)*stiff(2), 0.0_dp, closed), p(1), &
      old(1)/max(soft(1), tiny(1.0_dp)), sticks, state%friction, friction_slope)
    p(1) = p(1) - state%friction
    equation%driving = [abs(p(1)), max(0.0_dp, p(2))]/law%ratio

    state%damage = history%damage
    state%largest = 0.0_dp
    grows = history%damage < 1.0_dp .and. .not. sticks .and. (dtime > 0.0_dp .or. .not. law%viscosity > 0.0_dp)
    state%solved = .true.
    state%steps = 0
    if (grows) call solve_for_damage(law, equation, x, grows, state%solved, state%steps)
    if (grows) then
      ! where it is nearly 1, rounding could make it decrease
      state%damage = max(history%damage, damage_of(law, equation%least, x))
      call shares(law, beta, equation, closed, x, stiff, soft)
    end if
    state%recoverable = stiff*p
    state%separation = soft*p
    if (sticks) state%separation(1) = old(1)
    state%overstress = viscous*(opening_part(state%separation) - old)
    state%traction = state%recoverable + state%overstress + [state%friction, 0.0_dp]
    state%stabilisation = beta*soft/(stiff + beta*soft)

    if (closed) viscous(2) = 0.0_dp
    state%by_trial = 0.0_dp
    state%by_trial(1, 1) = stiff(1) + viscous(1)*soft(1)
    state%by_trial(2, 2) = stiff(2) + viscous(2)*soft(2)
    if (grows .and. secant_share < 1.0_dp) call blend_loading(law, equation, x, p(1), closed, viscous, &
      1.0_dp - secant_share, state%by_trial)
    ! friction subtracts from p_tau what it adds to T_tau
    if (sticks) state%by_trial(1, 1) = 1.0_dp
    if (closed) state%by_trial(1, 2) = friction_slope*stiff(2)*(1.0_dp - state%by_trial(1, 1))
  end subroutine solve_law

  !> t and ratio w as shares of p, for the damage at x.
  pure subroutine shares(law, beta, equation, closed, x, stiff, soft)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: beta(2)
    type(law_equation), intent(in) :: equation
    logical, intent(in) :: closed
    real(dp), intent(in) :: x
    real(dp), intent(out) :: stiff(2)   !< t_i/p_i
    real(dp), intent(out) :: soft(2)    !< w_i/p_i, length/stress

    stiff = remainder_at(equation%least, x)/(1.0_dp + (equation%b - equation%least)*x)
    soft = x/(1.0_dp + (equation%b - equation%least)*x)/law%ratio
    if (closed) then
      stiff(2) = 1.0_dp/(1.0_dp + beta(2)*law%flexibility)
      soft(2) = law%flexibility*stiff(2)
    end if
  end subroutine shares

  !> Adds the slopes of growing damage to a share of dT/dp.
  pure subroutine blend_loading(law, equation, x, shear, closed, viscous, share, by_trial)
    type(law_parameters), intent(in) :: law
    type(law_equation), intent(in) :: equation
    real(dp), intent(in) :: x
    real(dp), intent(in) :: shear                   !< p_tau
    logical, intent(in) :: closed
    real(dp), intent(in) :: viscous(2)              !< overstress by w, stress/length
    real(dp), intent(in) :: share                   !< from 0 to 1
    real(dp), intent(inout) :: by_trial(2, 2)       !< at fixed damage; blended
    real(dp), dimension(2, 2) :: loading, opening

    call slopes_of_loading(law, equation, x, shear, loading, opening)
    loading(1, :) = loading(1, :) + viscous(1)*opening(1, :)
    loading(2, :) = loading(2, :) + viscous(2)*opening(2, :)
    if (closed) loading(:, 2) = [0.0_dp, by_trial(2, 2)]
    by_trial = (1.0_dp - share)*by_trial + share*loading
  end subroutine blend_loading

  !> Finds x at which the damage of the law belongs to the separation that this damage gives.
  !>
  !> h(x) = 1 - x min b - tau(lambda(x), c(x)) x/lambda, (K - tau/lambda) x with K = 1/x - min b, decreases from a positive value,
  !> if the damage grows at all, to one that is not positive at failure.
  pure subroutine solve_for_damage(law, equation, x, grows, solved, steps)
    type(law_parameters), intent(in) :: law
    type(law_equation), intent(in) :: equation
    real(dp), intent(inout) :: x         !< at the damage so far; at the damage of the end of the increment
    logical, intent(out) :: grows        !< false if the damage stays
    logical, intent(out) :: solved       !< false if the root was not found
    integer, intent(out) :: steps        !< of the search
    type(root_search) :: search
    real(dp) :: upper, h, slope, at_failure, not_used

    solved = .true.
    steps = 0
    grows = maxval(equation%driving) > 0.0_dp
    if (.not. grows) return
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

  !> Direction c of the separation at x, and lambda/x.
  pure subroutine direction_at(equation, x, length, direction)
    type(law_equation), intent(in) :: equation
    real(dp), intent(in) :: x
    real(dp), intent(out) :: length         !< stress
    real(dp), intent(out) :: direction(2)

    direction = equation%driving/(1.0_dp + (equation%b - equation%least)*x)
    length = sqrt(direction(1)**2 + direction(2)**2)
    direction = direction/length
  end subroutine direction_at

  !> dt/dp and dw/dp while the damage grows, through lambda and the angle theta of c = (sin theta, cos theta):
  !> p_i/ratio_i = tau c_i + b_i lambda c_i.
  pure subroutine slopes_of_loading(law, equation, x, shear, of_traction, of_separation)
    type(law_parameters), intent(in) :: law
    type(law_equation), intent(in) :: equation
    real(dp), intent(in) :: x
    real(dp), intent(in) :: shear                 !< p_tau, for its sign
    real(dp), intent(out) :: of_traction(2, 2)    !< dt/dp
    real(dp), intent(out) :: of_separation(2, 2)  !< dw/dp
    real(dp), dimension(2, 2) :: a, inverse, of_tau, of_w
    real(dp), dimension(2) :: direction, turned
    real(dp) :: length, traction, by_separation, by_angle, separation, sides(2), determinant
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
    sides = [sign(1.0_dp, shear), 1.0_dp]
    do j = 1, 2
      of_traction(:, j) = law%ratio*sides*of_tau(:, j)*(sides(j)/law%ratio(j))
      of_separation(:, j) = sides*of_w(:, j)*(sides(j)/law%ratio(j))
    end do
  end subroutine slopes_of_loading

  !> Damage D = (1 - K/alpha) k/(K + k) at x, k the softening stiffness.
  !>
  !> 1 - K/alpha jumps to 1 where alpha is large or infinite. D does not: under opening, a bilinear law has dissipated the
  !> fraction D of its fracture energy, at any alpha. It is a function of K alone, which never grows, so D never decreases.
  pure function damage_of(law, least, x) result(damage)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: least, x
    real(dp) :: damage
    real(dp) :: k, rest

    k = softening_stiffness(law)
    rest = remainder_at(least, x)
    damage = min(1.0_dp, k*max(0.0_dp, x - law%flexibility*rest)/(rest + k*x))
  end function damage_of

  !> x at a damage: the inverse of `damage_of`.
  pure function at_damage(law, least, damage) result(x)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: least, damage
    real(dp) :: x
    real(dp) :: k, flexible

    k = softening_stiffness(law)
    flexible = damage + k*law%flexibility
    x = 1.0_dp/least
    if (damage < 1.0_dp) x = flexible/(k*(1.0_dp - damage) + least*flexible)
  end function at_damage

  !> 1 - x min b = K x, zero at failure without rounding.
  pure function remainder_at(least, x) result(rest)
    real(dp), intent(in) :: least, x
    real(dp) :: rest

    rest = 0.0_dp
    if (x < 1.0_dp/least) rest = 1.0_dp - least*x
  end function remainder_at

  !> Softening stiffness k of the bilinear law in mode I.
  pure function softening_stiffness(law) result(k)
    type(law_parameters), intent(in) :: law
    real(dp) :: k

    k = 1.0_dp/(2.0_dp*law%toughness(2)/law%strength(2)**2 - law%flexibility)
  end function softening_stiffness

  !> The separation without the penetration of a closed interface.
  pure function opening_part(separation) result(part)
    real(dp), intent(in) :: separation(2)
    real(dp) :: part(2)

    part = [separation(1), max(0.0_dp, separation(2))]
  end function opening_part

  !> Energies dissipated up to the end of an increment, per area: by the trapezoidal rule (t0 w1 - t1 w0)/2, as in
  !> `dissipate`; and by backward Euler for the overstress and the friction.
  pure subroutine dissipate_consistently(law, history, old_traction, state, dissipated, viscous, friction_work)
    type(law_parameters), intent(in) :: law
    type(point_history), intent(in) :: history
    real(dp), intent(in) :: old_traction(2)    !< T at the start of the increment
    type(law_solution), intent(in) :: state
    real(dp), intent(out) :: dissipated(2)     !< by sliding and by opening
    real(dp), intent(out) :: viscous
    real(dp), intent(out) :: friction_work            !< by friction
    real(dp), dimension(2) :: w0, w1, t0, t1
    real(dp) :: k, flexible

    w0 = opening_part(history%separation)
    w1 = opening_part(state%separation)
    t1 = state%recoverable
    k = softening_stiffness(law)
    flexible = history%damage + k*law%flexibility
    if (law%kind == ppr_law) then
      t0 = ppr_start_of_increment(law, history, old_traction)
    else if (flexible > 0.0_dp) then
      t0 = law%ratio*w0*(k*(1.0_dp - history%damage)/flexible)
    else
      ! rigid so far
      t0 = old_traction
    end if
    dissipated = history%dissipated
    if (state%damage > history%damage) dissipated = dissipated + 0.5_dp*(opening_part(t0)*w1 - opening_part(t1)*w0)
    friction_work = history%friction_work + state%friction*(w1(1) - w0(1))
    viscous = history%viscous + dot_product(state%overstress, w1 - w0)
  end subroutine dissipate_consistently

end module cohesive_local_solve
