! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Energy that an interface point dissipates in an increment, per area, and the share of its fracture energy that it has dissipated;
!> pairs are (tau, n).
!>
!> With t_i = K ratio_i w_i the stored energy is K/2 sum ratio_i w_i**2, and a point dissipates -dK/2 sum ratio_i w_i**2. While
!> damage grows, the separation lies on the envelope of the law, so that the energy dissipated along a direction is a function of
!> K: `loss`. Its difference between the ends of an increment is exact along a direction, whatever the size of the increment, and
!> whether the separation has been at the envelope before, comes back to it, from the other side even, or goes beyond failure.
!> Where the direction turns meanwhile, the difference is that along a path which bends, in eight straight parts. K never grows, so
!> that no increment dissipates a negative energy.
!>
!> Under cycles the separation is below the envelope. An increment with cycles dissipates the work of its tractions by the
!> trapezoidal rule less the change of the stored energy, (t0 w1 - t1 w0)/2.
!>
!> Where the law depends on the rate, damage grows along the envelope of the rate of the increment, and the same holds while the
!> rate is constant. Where it changes, the point starts beside that envelope. What it dissipates from there is in proportion to the
!> secants that it passes (`work_at_rate`): the work of its tractions less the change of the stored energy, but for an error of the
!> square of the increment.
!>
!> SPENT is the share of the fracture energy that a straight path to the present state dissipates, a function of K and the
!> direction: the rest is what the point will dissipate on its way to failure in that direction. Where a path turns towards a
!> tougher mode, or slows down, the function may fall; SPENT keeps its largest value. It is 1 at failure, and nowhere else.
module cohesive_dissipation
  use core_kinds, only: dp
  use cohesive_parameters, only: law_parameters
  use cohesive_law_properties, only: ppr_law
  use cohesive_shear, only: mode_of, shears, resultant
  use cohesive_state, only: point_history, damage_state, law_solution
  use cohesive_law, only: loss, softening, stiffness_of
  use cohesive_mode_mix, only: measure_onset
  use cohesive_local_solve, only: opening_part
  use cohesive_local_equation, only: damage_at_secant, softening_stiffness
  use cohesive_rate, only: depends_on_rate, suit_rate
  use cohesive_ppr, only: ppr_work_of_damage, ppr_share_spent, ppr_damage_of_components
  implicit none(type, external)
  private
  public :: dissipate, dissipate_consistently

contains

  !> Energies dissipated up to the end of an increment where the damage is that of the displacement jump.
  !>
  !> With VISCOSITY the damage lags behind, and t = (1 - d) alpha g lies off the envelope. Both parts together are the work less the
  !> change of the stored energy, (t0 g1 - t1 g0)/2 = alpha g0 g1 (d1 - d0)/2 by the trapezoidal rule, but nothing where that is
  !> negative. Damage has of it what the law dissipates, at most, and the overstress the rest.
  pure subroutine dissipate(law, history, separation, state, dissipated, viscous, spent)
    type(law_parameters), intent(in) :: law
    type(point_history), intent(in) :: history
    real(dp), intent(in) :: separation(3)
    type(damage_state), intent(in) :: state
    real(dp), intent(out) :: dissipated(2)   !< by sliding and by opening
    real(dp), intent(out) :: viscous
    real(dp), intent(out) :: spent           !< share of the fracture energy
    real(dp), dimension(2) :: before, after, growth, work, most
    real(dp), dimension(3) :: g0, g1, of_component
    real(dp) :: old, new

    dissipated = history%dissipated
    viscous = history%viscous
    spent = history%spent
    if (.not. (state%damage > history%damage .or. any(state%largest > history%largest))) return
    g0 = opening_part(history%separation)
    g1 = opening_part(separation)
    before = resultant(g0)
    after = resultant(g1)
    growth = state%acting - history%damage
    if (law%kind == ppr_law) then
      growth = state%acting - ppr_damage_of_components(law, history%largest)
      work = ppr_work_of_damage(law, history%largest, state%largest, before, after)
      spent = max(spent, ppr_share_spent(law, state%largest))
    else
      old = damage_at_secant(law, 1.0_dp - history%damage, law%flexibility)
      new = damage_at_secant(law, 1.0_dp - state%damage, law%flexibility)
      call follow_envelope(law, law%viscosity > 0.0_dp, before, after, (1.0_dp - history%damage)*stiffness_of(law)*before, old, &
        new, work, spent)
    end if
    if (law%viscosity > 0.0_dp .or. law%cycles%count > 0.0_dp) then
      growth = 0.5_dp*stiffness_of(law)*growth
      of_component = growth(mode_of)*g0*g1
      most = max(0.0_dp, [sum(of_component(shears)), of_component(2)])
      work = merge(most, min(work, most), law%cycles%count > 0.0_dp)
      viscous = viscous + sum(most - work)
    end if
    dissipated = dissipated + work
  end subroutine dissipate

  !> Energies dissipated up to the end of an increment of the consistent law; by backward Euler for the overstress and the friction.
  pure subroutine dissipate_consistently(law, history, traction, state, dissipated, viscous, friction_work, spent)
    type(law_parameters), intent(in) :: law
    type(point_history), intent(in) :: history
    real(dp), intent(in) :: traction(3)        !< at the start
    type(law_solution), intent(in) :: state
    real(dp), intent(out) :: dissipated(2)     !< by sliding and by opening
    real(dp), intent(out) :: viscous
    real(dp), intent(out) :: friction_work
    real(dp), intent(out) :: spent             !< share of the fracture energy
    real(dp), dimension(3) :: w0, w1, of_component
    real(dp), dimension(2) :: before, after, work

    w0 = opening_part(history%separation)
    w1 = opening_part(state%separation)
    friction_work = history%friction_work + dot_product(state%friction, w1(shears) - w0(shears))
    viscous = history%viscous + dot_product(state%overstress, w1 - w0)
    dissipated = history%dissipated
    spent = history%spent
    if (.not. (state%damage > history%damage .or. any(state%largest > history%largest))) return
    before = resultant(w0)
    after = resultant(w1)
    if (law%kind == ppr_law) then
      dissipated = dissipated + ppr_work_of_damage(law, history%largest, state%largest, before, after)
      spent = max(spent, ppr_share_spent(law, state%largest))
    else if (law%cycles%count > 0.0_dp) then
      of_component = 0.5_dp*(opening_part(traction)*w1 - opening_part(state%recoverable)*w0)
      dissipated = dissipated + max(0.0_dp, [sum(of_component(shears)), of_component(2)])
      spent = max(spent, share_spent(law, after, state%damage))
    else
      call follow_envelope(law, .false., before, after, resultant(opening_part(traction)), history%damage, state%damage, work, &
        spent)
      dissipated = dissipated + work
    end if
  end subroutine dissipate_consistently

  !> Energy that sliding and opening dissipate while the damage D grows on the envelope, and the share of the fracture energy.
  pure subroutine follow_envelope(law, lags, before, after, traction, old, new, work, spent)
    type(law_parameters), intent(in) :: law
    logical, intent(in) :: lags                   !< the damage is below that of the separation, at any rate
    real(dp), intent(in) :: before(2), after(2)   !< separations at the ends of the increment
    real(dp), intent(in) :: traction(2)           !< at its start
    real(dp), intent(in) :: old, new              !< D
    real(dp), intent(out) :: work(2)
    real(dp), intent(inout) :: spent
    type(law_parameters) :: present
    real(dp) :: last

    if (depends_on_rate(law)) then
      present = law
      call suit_rate(present, norm2(after))
      last = damage_by(present, law, new)
      if (lags) then
        work = work_of_damage(present, before, after, traction, damage_by(present, law, old), last)
      else
        work = work_at_rate(law, present, before, after, traction, damage_by(present, law, old), last)
      end if
      spent = max(spent, share_spent(present, after, last))
    else
      work = work_of_damage(law, before, after, traction, old, new)
      spent = max(spent, share_spent(law, after, new))
    end if
  end subroutine follow_envelope

  !> Energy that sliding and opening dissipate while the damage D grows to the envelope of the present rate.
  !>
  !> At the separation of the start, that envelope has a secant of its own. Beyond it, where the rate has fallen, the point first
  !> loses the difference to it. Short of it, where the rate has risen, it dissipates that share of what the envelope does. With
  !> straight lines both are the trapezoidal rule. A point that is within the envelope of the slowest rates has been unloaded: it
  !> follows its secant up to the envelope, as without a rate.
  pure function work_at_rate(law, present, before, after, traction, old, new) result(work)
    type(law_parameters), intent(in) :: law
    type(law_parameters), intent(in) :: present   !< the law at the rate of the increment
    real(dp), intent(in) :: before(2), after(2), traction(2)
    real(dp), intent(in) :: old, new              !< D of `present`
    real(dp) :: work(2)
    !> Damage that is lost in the rounding of a point on its envelope.
    real(dp), parameter :: rounding = sqrt(epsilon(1.0_dp))
    real(dp) :: reached, slowest, last, until(2)

    reached = min(new, damage_without_history(present, before))
    ! the separation has not grown yet: its rate is zero
    slowest = damage_by(present, law, damage_without_history(law, before))
    last = stiffness_at(present, secant_at(present, new))
    if (reached > old) then
      until = after
      if (.not. last > 0.0_dp) until = min(before, after)
      work = 0.5_dp*law%ratio*before*until*(stiffness_at(present, secant_at(present, old)) &
        - stiffness_at(present, secant_at(present, reached))) + work_of_damage(present, before, after, traction, reached, new)
    else if (old > 0.0_dp .and. new > reached .and. slowest > old - rounding) then
      work = (stiffness_at(present, secant_at(present, old)) - last)/(stiffness_at(present, secant_at(present, reached)) - last) &
        *work_of_damage(present, before, after, traction, reached, new)
    else
      work = work_of_damage(present, before, after, traction, old, new)
    end if
  end function work_at_rate

  !> Damage D by one law of the secant that has a damage by another law.
  pure function damage_by(law, other, damage) result(same)
    type(law_parameters), intent(in) :: law, other
    real(dp), intent(in) :: damage   !< by the other law
    real(dp) :: same
    real(dp) :: secant(2)

    secant = secant_at(other, damage)
    same = damage_at_secant(law, secant(1), secant(2) + law%flexibility*secant(1))
  end function damage_by

  !> Damage of the consistent law at a separation without history.
  pure function damage_without_history(law, separation) result(damage)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: separation(2)
    real(dp) :: damage
    real(dp) :: length, traction, by_separation, by_angle

    damage = 0.0_dp
    length = norm2(separation)
    if (.not. length > 0.0_dp) return
    call softening(law, length, separation/length, traction, by_separation, by_angle)
    damage = damage_at_secant(law, traction, length)
  end function damage_without_history

  !> Secant stiffness of the consistent law at a damage, as `loss` takes it.
  pure function secant_at(law, damage) result(secant)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: damage
    real(dp) :: secant(2)
    real(dp) :: k

    k = softening_stiffness(law)
    secant = [k*(1.0_dp - damage), damage*(1.0_dp + k*law%flexibility)]
  end function secant_at

  !> Energy that sliding and opening dissipate while the damage D grows.
  !>
  !> The separation follows a path between the ends of the increment. It leaves an intact point in the direction of its traction,
  !> and bends towards the end: what is across that direction grows with the square of what is along it. The further the separation
  !> has come before, the straighter is the path. Between two points of the path the energy is that of the direction of the middle.
  pure function work_of_damage(law, before, after, traction, old, new) result(work)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: before(2), after(2)   !< separations at the ends of the increment
    real(dp), intent(in) :: traction(2)           !< at its start
    real(dp), intent(in) :: old, new              !< D
    real(dp) :: work(2)
    integer, parameter :: parts = 8
    real(dp), dimension(2) :: change, bend, first, here, there, direction
    real(dp) :: most, damage, reached, s
    integer :: part

    work = 0.0_dp
    if (.not. new > old) return
    change = after - before
    first = unit(before)
    if (.not. old > 0.0_dp) first = direction_at_onset(law, traction, unit(after))
    bend = 0.0_dp
    if (norm2(after) > norm2(before)) then
      bend = (1.0_dp - norm2(before)/norm2(after))**2*(change - dot_product(change, first)*first)
    end if
    ! the damage of the path without history is not the one here where damage lags behind
    most = max(damage_without_history(law, after), new)
    here = before
    reached = old
    do part = 1, parts
      s = real(part, dp)/parts
      there = max(0.0_dp, before + s*change - s*(1.0_dp - s)*bend)
      damage = new
      if (part < parts) then
        damage = max(reached, old + (new - old)*(damage_without_history(law, there) - old)/(most - old))
        damage = min(damage, new)
      end if
      direction = unit(here + there)
      if (damage > reached .and. maxval(direction) > 0.0_dp) then
        work = work + work_along(law, direction, secant_at(law, reached), secant_at(law, damage))
        reached = damage
      end if
      here = there
    end do
  end function work_of_damage

  !> Direction in which an intact point begins to separate, from its traction below onset and the direction that follows.
  pure function direction_at_onset(law, traction, later) result(direction)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: traction(2), later(2)
    real(dp) :: direction(2)
    real(dp) :: f, not_used(2)

    direction = later
    if (.not. maxval(later) > 0.0_dp) return
    call measure_onset(law, later, f, not_used)
    direction = unit(traction/law%ratio + max(0.0_dp, 1.0_dp - norm2(traction/law%strength))*later/f)
  end function direction_at_onset

  !> The same in one direction.
  pure function work_along(law, direction, from, to) result(work)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: direction(2)
    real(dp), intent(in) :: from(2), to(2)   !< secant stiffnesses as `loss` takes them
    real(dp) :: work(2)

    work = law%ratio*direction**2*max(0.0_dp, loss(law, direction, to(1), to(2)) - loss(law, direction, from(1), from(2)))
  end function work_along

  !> Secant stiffness K.
  pure function stiffness_at(law, secant) result(stiffness)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: secant(2)   !< as `loss` takes it
    real(dp) :: stiffness

    stiffness = secant(1)/(secant(2) + law%flexibility*secant(1))
  end function stiffness_at

  !> A pair of unit length; zero where it has no length.
  pure function unit(pair) result(direction)
    real(dp), intent(in) :: pair(2)
    real(dp) :: direction(2)
    real(dp) :: length

    length = norm2(pair)
    direction = 0.0_dp
    if (length > 0.0_dp) direction = pair/length
  end function unit

  !> Share of the fracture energy that is dissipated in the direction of a separation at a damage D; 0 without a separation.
  pure function share_spent(law, separation, damage) result(share)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: separation(2)
    real(dp), intent(in) :: damage
    real(dp) :: share
    real(dp) :: direction(2), secant(2)

    share = 0.0_dp
    direction = unit(separation)
    secant = secant_at(law, damage)
    if (.not. secant(1) > 0.0_dp) then
      share = 1.0_dp
    else if (maxval(direction) > 0.0_dp) then
      share = min(1.0_dp, loss(law, direction, secant(1), secant(2))/loss(law, direction, 0.0_dp, 1.0_dp))
    end if
  end function share_spent

end module cohesive_dissipation
