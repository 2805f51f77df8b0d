! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The PPR law: Park, Paulino and Roesler, J. of the Mechanics and Physics of Solids 57 (2009) 891-908, the potential of the
!> intrinsic model and, where the stiffness is infinite, that of the extrinsic one. Components are in the order (tau, n).
!>
!> With x_i = w_i/final_i and the exponents a of the softening (alpha and beta of the paper) and m of the rise (m and n),
!>
!>     F_i = (1 - x_i)**a_i (1 + a_i x_i/m_i)**m_i,    without the second factor for infinite stiffness,
!>
!> which falls from 1 to 0, the potential and its gradient, the traction, are
!>
!>     psi = G_i - F_i (G_i - G_j (1 - F_j)),    G_i <= G_j,
!>     t_i = -G_i F_i' c_j,    c_j = max(0, 1 - max(1, G_j/G_i) (1 - F_j)).
!>
!> -G_i F_i' is the curve of a pure mode: its peak is the strength and its area is G_i. c_j is the share that the other component
!> leaves of it. It vanishes from the paper's conjugate final separation on.
!>
!> The paper describes the rise by the slope indicator lambda = (separation at the peak)/final. Here the slope of the curve at the
!> origin is the initial stiffness; m and lambda follow from it.
!>
!> History: the largest separation so far of each component. Unloading is secant to the origin in both components, with
!> secants K_i = t_i/w_i at the largest separations of both. Park and Paulino, Engineering Fracture Mechanics 93 (2012)
!> 239-262, take the secant of a component at its own largest separation and the coupling at the current separation of the other, so
!> that sliding back heals the opening. Here no secant ever grows, so no path gains energy. While both separations grow, the two are
!> the same.
module cohesive_ppr
  use core_kinds, only: dp
  use core_root, only: root_search, search_between, searching, advance
  use core_status, only: status_type, ok, late_secant, small_beta, no_root
  use cohesive_parameters, only: law_parameters
  use cohesive_state, only: point_history, damage_state
  implicit none(type, external)
  private
  public :: ppr_component
  public :: prepare_ppr, check_ppr, check_ppr_beta, raise_ppr_beta, component_at, damage_at, evolve_ppr, ppr_damage_of_components
  public :: ppr_work_of_damage, ppr_share_spent

  !> A component at its largest separation.
  type :: ppr_component
    real(dp) :: secant     !< of the curve of its pure mode, stress/length; huge where it is rigid
    real(dp) :: traction   !< of that curve, stress
    real(dp) :: slope      !< of that curve, stress/length
    real(dp) :: share      !< c: the share that it leaves of the other component
    real(dp) :: by_share   !< derivative of c, 1/length
    real(dp) :: remainder  !< F: share of the fracture energy of its pure mode that is left
  end type ppr_component

  !> Half the width of the bracket of log(m): beyond these exponents the law counts as too soft.
  real(dp), parameter :: widest = 30.0_dp

contains

  !> Sets the exponents of the rise and the final separations.
  !>
  !> With k the initial stiffness, G k/strength**2 = a (a/m + 1)/q**2 and the product q = final strength/G of the
  !> paper, a function of m. Solved for log(m), from m = strength**2/(G k), its limit for a large stiffness. For the derivative: q
  !> makes the peak equal to the strength, so it does not depend on the position of the peak.
  pure subroutine prepare_ppr(law, status)
    type(law_parameters), intent(inout) :: law
    type(status_type), intent(out) :: status   !< no_root: item 1 for mode I, 2 for mode II
    type(root_search) :: search
    real(dp) :: wanted, m, a, q, peak, rises
    integer :: i

    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    do i = 1, 2
      a = law%shape(i)
      q = a
      if (law%flexibility > 0.0_dp) then
        wanted = law%toughness(i)*law%ratio(i)/(law%flexibility*law%strength(i)**2)
        search = search_between(-log(wanted) - widest, -log(wanted) + widest, -log(wanted), geometric=.false.)
        do while (searching(search))
          m = exp(search%x)
          peak = peak_of(a, m)
          q = final_of(a, m)
          rises = (m - 1.0_dp)*a*peak/(m + a*peak) - m*log(1.0_dp + a*peak/m)
          ! the slope is 1 for a stiff law and close to it otherwise
          call advance(search, -log(a*(a/m + 1.0_dp)/(wanted*q**2)), -(a/(a + m) + 2.0_dp*rises))
        end do
        if (.not. search%found) status = status_type(no_root, 3 - i, law%toughness(i), 0.0_dp)
        m = exp(search%x)
        q = final_of(a, m)
        law%rise(i) = m
      end if
      law%final(i) = q*law%toughness(i)/law%strength(i)
    end do
  end subroutine prepare_ppr

  !> Separation at the peak over the final one, lambda of the paper.
  pure function peak_of(a, m) result(peak)
    real(dp), intent(in) :: a, m
    real(dp) :: peak

    peak = sqrt(m/(a*(a + m - 1.0_dp)))
  end function peak_of

  !> Final separation in units of G/strength.
  pure function final_of(a, m) result(final)
    real(dp), intent(in) :: a, m
    real(dp) :: final
    real(dp) :: peak

    peak = peak_of(a, m)
    final = a*peak*(1.0_dp - peak)**(a - 1.0_dp)*(a/m + 1.0_dp)*(1.0_dp + a*peak/m)**(m - 1.0_dp)
  end function final_of

  !> Demands that the secant decreases from the origin on, as it does if and only if m <= a: a softer law has its steepest secant
  !> elsewhere.
  pure subroutine check_ppr(law, status)
    type(law_parameters), intent(in) :: law
    type(status_type), intent(out) :: status   !< late_secant: item 1 for mode I, 2 for mode II, value and bound of G_c
    real(dp) :: least, a
    integer :: i

    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    do i = 2, 1, -1
      a = law%shape(i)
      if (law%rise(i) <= a) cycle
      least = 2.0_dp*a/final_of(a, a)**2*law%strength(i)**2*law%flexibility/law%ratio(i)
      status = status_type(late_secant, 3 - i, law%toughness(i), least)
      return
    end do
  end subroutine check_ppr

  !> Demands a beta for which each trial traction has one separation: one that makes t + beta w strongly monotone,
  !> (beta_n - s_n) (beta_tau - s_tau) > o**2 with the largest softening slopes s and coupling o = max |dt_n/dw_tau|.
  pure subroutine check_ppr_beta(law, beta, status)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: beta(2)            !< stress/length
    type(status_type), intent(out) :: status   !< small_beta: item 1 for beta_n, 2 for beta_tau, value and bound
    real(dp) :: steepest(2), coupling, least
    integer :: i

    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    coupling = coupling_of(law)
    do i = 1, 2
      steepest(i) = steepest_of(law, i)
    end do
    do i = 2, 1, -1
      least = steepest(i) + coupling
      if (beta(3 - i) > steepest(3 - i)) least = steepest(i) + coupling**2/(beta(3 - i) - steepest(3 - i))
      if (beta(i) > least) cycle
      status = status_type(small_beta, 3 - i, beta(i), least)
      return
    end do
  end subroutine check_ppr_beta

  !> Raises estimates of beta to twice what `check_ppr_beta` demands of equal margins, s_i + o.
  pure subroutine raise_ppr_beta(law, estimated, beta)
    type(law_parameters), intent(in) :: law
    logical, intent(in) :: estimated(2)        !< not a value of the deck
    real(dp), intent(inout) :: beta(2)         !< (tau, n), stress/length
    integer :: i

    do i = 1, 2
      if (estimated(i)) beta(i) = max(beta(i), 2.0_dp*(steepest_of(law, i) + coupling_of(law)))
    end do
  end subroutine raise_ppr_beta

  !> Bound of |dt_n/dw_tau|.
  pure function coupling_of(law) result(coupling)
    type(law_parameters), intent(in) :: law
    real(dp) :: coupling   !< stress/length

    coupling = law%strength(1)*law%strength(2)/minval(law%toughness)
  end function coupling_of

  !> Bound of the softening slope of a pure mode, a >= 2: the largest value of (a - 1) traction/(final - w).
  !>
  !> It is the slope without a term of opposite sign; it is exact for a = 2 and for infinite stiffness.
  pure function steepest_of(law, i) result(slope)
    type(law_parameters), intent(in) :: law
    integer, intent(in) :: i
    real(dp) :: slope   !< stress/length
    real(dp) :: a, m, q, x

    a = law%shape(i)
    if (law%flexibility > 0.0_dp) then
      m = law%rise(i)
      q = (a/m)*(a + m - 2.0_dp)
      x = min(1.0_dp, (1.0_dp + sqrt(1.0_dp + 4.0_dp*q))/(2.0_dp*q))
      slope = (a - 1.0_dp)*(law%ratio(i)/law%flexibility)*x*(1.0_dp - x)**(a - 2.0_dp)*(1.0_dp + a*x/m)**(m - 1.0_dp)
    else
      slope = (a - 1.0_dp)*law%strength(i)/law%final(i)
    end if
  end function steepest_of

  !> A component at its largest separation.
  pure function component_at(law, i, largest) result(component)
    type(law_parameters), intent(in) :: law
    integer, intent(in) :: i            !< 1 tau, 2 n
    real(dp), intent(in) :: largest     !< not negative, length
    type(ppr_component) :: component
    real(dp) :: a, m, x, rest, rise, weight

    component = ppr_component(0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp)
    a = law%shape(i)
    m = law%rise(i)
    x = largest/law%final(i)
    if (x >= 1.0_dp) return
    rest = 1.0_dp - x
    if (law%flexibility > 0.0_dp) then
      rise = 1.0_dp + a*x/m
      component%secant = (law%ratio(i)/law%flexibility)*rest**(a - 1.0_dp)*rise**(m - 1.0_dp)
      component%traction = component%secant*largest
      component%slope = component%secant*(1.0_dp - x**2*(a/m)*(a + m - 1.0_dp))/(rest*rise)
      component%remainder = (rest*rise)*rest**(a - 1.0_dp)*rise**(m - 1.0_dp)
    else
      component%traction = law%strength(i)*rest**(a - 1.0_dp)
      component%secant = component%traction/max(largest, tiny(1.0_dp)*component%traction)
      component%slope = -(a - 1.0_dp)*component%traction/(rest*law%final(i))
      component%remainder = rest**a
    end if
    weight = max(1.0_dp, law%toughness(i)/law%toughness(3 - i))
    component%share = 1.0_dp - weight*(1.0_dp - component%remainder)
    if (component%share > 0.0_dp) then
      component%by_share = -weight*component%traction/law%toughness(i)
    else
      component%share = 0.0_dp
    end if
  end function component_at

  !> DAMAGE: 1 - (1 - x_tau)(1 - x_n) with the largest separations over the final ones. It is 0 before the first separation
  !> and 1 once neither component has any traction left.
  pure function damage_at(law, largest) result(damage)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: largest(2)
    real(dp) :: damage
    real(dp) :: x(2)

    x = min(1.0_dp, largest/law%final)
    damage = x(1) + x(2)*(1.0_dp - x(1))
  end function damage_at

  !> Damage d_i = 1 - K_i/alpha_i of each component of a law that is not rigid.
  pure function ppr_damage_of_components(law, largest) result(damage)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: largest(2)
    real(dp) :: damage(2)
    type(ppr_component) :: tau, n

    tau = component_at(law, 1, largest(1))
    n = component_at(law, 2, largest(2))
    damage = 1.0_dp - [tau%secant*n%share, n%secant*tau%share]*(law%flexibility/law%ratio)
  end function ppr_damage_of_components

  !> Damage at the end of an increment, of a law that is not rigid, at the displacement jump.
  !>
  !> The largest separations follow the current ones where these exceed them, with VISCOSITY by backward Euler.
  pure subroutine evolve_ppr(law, history, separation, fraction, state)
    type(law_parameters), intent(in) :: law
    type(point_history), intent(in) :: history
    real(dp), intent(in) :: separation(2)   !< (tau, n), tau not negative, opening positive
    real(dp), intent(in) :: fraction        !< of the excess by which the largest separations grow
    type(damage_state), intent(out) :: state
    type(ppr_component) :: parts(2)
    real(dp) :: jump(2), by_largest(2, 2)
    integer :: i, j

    jump = [separation(1), max(0.0_dp, separation(2))]
    state%largest = max(history%largest, jump)
    if (fraction < 1.0_dp) state%largest = history%largest + fraction*(state%largest - history%largest)
    do i = 1, 2
      parts(i) = component_at(law, i, state%largest(i))
    end do
    state%slope = 0.0_dp
    do i = 1, 2
      j = 3 - i
      state%acting(i) = 1.0_dp - parts(i)%secant*parts(j)%share*law%flexibility/law%ratio(i)
      by_largest(i, i) = 0.0_dp
      if (state%largest(i) > 0.0_dp) by_largest(i, i) = &
        (parts(i)%slope - parts(i)%secant)*parts(j)%share/state%largest(i)
      by_largest(i, j) = parts(i)%secant*parts(j)%by_share
    end do
    do j = 1, 2
      if (.not. jump(j) > history%largest(j)) cycle
      state%slope(:, j) = -by_largest(:, j)*fraction*law%flexibility/law%ratio
    end do
    state%damage = damage_at(law, state%largest)
    state%damage_max = max(history%damage_max, damage_at(law, max(state%largest, jump)))
  end subroutine evolve_ppr

  !> Energy per area that sliding and opening dissipate while the largest separations grow, both on a straight line.
  !>
  !> Where one of them grows alone, each energy is exact. Where both do, their sum is, as far as the traction has a potential: until
  !> the component of the larger toughness leaves nothing of the other one. From there on it dissipates alone. The line ends at
  !> failure, where neither component has any traction left.
  pure function ppr_work_of_damage(law, before, after, start, finish) result(work)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: before(2), after(2)   !< largest separations (tau, n), length
    real(dp), intent(in) :: start(2), finish(2)   !< separations at the ends of the increment, not negative
    real(dp) :: work(2)                           !< not negative
    integer, parameter :: steps = 8
    real(dp) :: growth(2), resting(2), ending(2), from(2), to(2), part
    integer :: step, first

    growth = after - before
    if (.not. all(growth > 0.0_dp)) then
      resting = sqrt(min(before**2, start*finish))
      work = work_of_step(law, before, after, merge(before, resting, growth > 0.0_dp), merge(after, resting, growth > 0.0_dp))
      return
    end if
    work = 0.0_dp
    if (any(before >= law%final)) return
    ending = after
    first = minloc((law%final - before)/growth, 1)
    if (after(first) > law%final(first)) then
      ending = before + ((law%final(first) - before(first))/growth(first))*growth
      ! an exponent near 1 makes much of a rounding
      ending(first) = law%final(first)
    end if
    part = part_with_potential(law, before, ending)
    to = before
    do step = 1, steps
      from = to
      to = before + (step*part/steps)*(ending - before)
      if (step == steps .and. part >= 1.0_dp) to = ending
      work = work + work_of_step(law, from, to, from, to)
    end do
    if (part < 1.0_dp) work = work + work_beyond_potential(law, to, ending)
  end function ppr_work_of_damage

  !> Share of the fracture energy that is dissipated on a straight path to the largest separations; 1 at failure.
  pure function ppr_share_spent(law, largest) result(share)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: largest(2)   !< (tau, n), one of them positive
    real(dp) :: share
    real(dp), parameter :: origin(2) = 0.0_dp
    real(dp) :: spent, left

    share = 1.0_dp
    if (any(largest >= law%final)) return
    spent = sum(ppr_work_of_damage(law, origin, largest, origin, largest))
    ! safely beyond failure, where the work ends
    left = sum(ppr_work_of_damage(law, largest, (2.0_dp/maxval(largest/law%final))*largest, largest, origin))
    share = spent/(spent + left)
  end function ppr_share_spent

  !> Part of the growth of both components in which the traction has a potential: until c of the larger toughness vanishes, where
  !> its F is 1 less the ratio of the toughnesses.
  pure function part_with_potential(law, before, after) result(part)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: before(2), after(2)   !< largest separations, length
    real(dp) :: part                              !< from 0 to 1
    type(root_search) :: search
    type(ppr_component) :: component
    real(dp) :: lowest, growth
    integer :: i

    i = maxloc(law%toughness, 1)
    lowest = 1.0_dp - law%toughness(3 - i)/law%toughness(i)
    part = 1.0_dp
    component = component_at(law, i, after(i))
    if (component%remainder >= lowest) return
    part = 0.0_dp
    component = component_at(law, i, before(i))
    if (component%remainder <= lowest) return
    growth = after(i) - before(i)
    search = search_between(0.0_dp, 1.0_dp, 0.5_dp, geometric=.false.)
    do while (searching(search))
      component = component_at(law, i, before(i) + search%x*growth)
      call advance(search, lowest - component%remainder, component%traction*growth/law%toughness(i))
    end do
    part = search%x
  end function part_with_potential

  !> Energy per area that the component of the larger toughness dissipates while both grow and the other one has no traction.
  !>
  !> It is the work of its traction less the change of the stored energy. The traction may vanish at failure with any positive power
  !> of what is left of the way, and is smoother in the square root of that, v. The error is below 1e-9 of the fracture energy for
  !> toughnesses in a ratio of 4, below 1e-6 for a ratio of 18 with exponents up to 3.
  pure function work_beyond_potential(law, before, after) result(work)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: before(2), after(2)   !< largest separations, length
    real(dp) :: work(2)
    ! of the Gauss rule of sixteen points
    real(dp), parameter :: abscissae(8) = [0.09501250983763744_dp, 0.28160355077925891_dp, 0.45801677765722739_dp, &
      0.61787624440264375_dp, 0.75540440835500303_dp, 0.86563120238783174_dp, 0.94457502307323258_dp, 0.98940093499164993_dp]
    real(dp), parameter :: weights(8) = [0.18945061045506850_dp, 0.18260341504492359_dp, 0.16915651939500254_dp, &
      0.14959598881657673_dp, 0.12462897125553387_dp, 0.09515851168249278_dp, 0.06225352393864789_dp, 0.02715245941175409_dp]
    real(dp) :: growth(2), whole, low, part, v, area
    integer :: i, k, side, half

    i = maxloc(law%toughness, 1)
    growth = after - before
    whole = max(1.0_dp, minval((law%final - before)/growth))
    low = sqrt(1.0_dp - 1.0_dp/whole)
    part = 0.25_dp*(1.0_dp - low)
    area = 0.0_dp
    do k = 1, size(weights)
      do side = -1, 1, 2
        do half = 1, 3, 2
          v = low + part*(half + side*abscissae(k))
          area = area + 2.0_dp*part*weights(k)*whole*v*traction_of(law, i, before + whole*(1.0_dp - v**2)*growth)
        end do
      end do
    end do
    work = 0.0_dp
    work(i) = max(0.0_dp, area*growth(i) - 0.5_dp*(traction_of(law, i, after)*after(i) &
      - traction_of(law, i, before)*before(i)))
  end function work_beyond_potential

  !> Traction of a component at the largest separations.
  pure function traction_of(law, i, largest) result(traction)
    type(law_parameters), intent(in) :: law
    integer, intent(in) :: i               !< 1 tau, 2 n
    real(dp), intent(in) :: largest(2)     !< length
    real(dp) :: traction                   !< stress
    type(ppr_component) :: own, other

    own = component_at(law, i, largest(i))
    other = component_at(law, 3 - i, largest(3 - i))
    traction = own%traction*other%share
  end function traction_of

  !> The same in a step.
  !>
  !> A component dissipates -w_i**2 dK_i/2. While it grows alone, the share c_j that the other leaves it stays, and `loss_of` is
  !> the integral; meanwhile the secant of the other falls with c_i, at the separation that it has. This is the mean of the two
  !> paths that let one component grow after the other. Their sums are the same where the traction has a potential.
  pure function work_of_step(law, before, after, start, finish) result(work)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: before(2), after(2)   !< largest separations
    real(dp), intent(in) :: start(2), finish(2)   !< separations, no more than these
    real(dp) :: work(2)
    type(ppr_component) :: old(2), new(2)
    real(dp) :: fall
    integer :: i, j

    do i = 1, 2
      old(i) = component_at(law, i, before(i))
      new(i) = component_at(law, i, after(i))
    end do
    do i = 1, 2
      j = 3 - i
      work(i) = 0.5_dp*(old(j)%share + new(j)%share)*max(0.0_dp, loss_of(law, i, after(i), new(i)) &
        - loss_of(law, i, before(i), old(i)))
      fall = max(0.0_dp, old(j)%share - new(j)%share)
      work(i) = work(i) + 0.25_dp*fall*(old(i)%secant*start(i)**2 + new(i)%secant*finish(i)**2)
    end do
  end function work_of_step

  !> Energy per area that a component has dissipated in its pure mode, of which `component` is the state.
  pure function loss_of(law, i, largest, component) result(loss)
    type(law_parameters), intent(in) :: law
    integer, intent(in) :: i            !< 1 tau, 2 n
    real(dp), intent(in) :: largest     !< length
    type(ppr_component), intent(in) :: component
    real(dp) :: loss

    loss = law%toughness(i)*(1.0_dp - component%remainder) - 0.5_dp*component%traction*largest
  end function loss_of

end module cohesive_ppr
