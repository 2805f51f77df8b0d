! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Energy that an interface point dissipates in an increment, per area, and the share of its fracture energy that it has dissipated;
!> pairs are (tau, n).
!>
!> With t_i = K ratio_i w_i the stored energy is K/2 sum ratio_i w_i**2, and a point dissipates -dK/2 sum ratio_i w_i**2. While
!> damage grows, the separation lies on the envelope of the law, so that the energy dissipated along a direction is a function of
!> K: `loss`. Its difference between the ends of an increment is exact along a direction, whatever the size of the increment, and
!> whether the separation has been at the envelope before, comes back to it, from the other side even, or goes beyond failure.
!> Where the direction turns meanwhile, the one half-way is taken, with an error of second order. K never grows, so that no
!> increment dissipates a negative energy. The PPR law, whose components have secants of their own, has the same in `cohesive_ppr`.
!>
!> SPENT is the share of the fracture energy that a straight path to the present state dissipates, a function of K and the
!> direction: the rest is what the point will dissipate on its way to failure in that direction. Where a path turns towards a
!> tougher mode the function falls; SPENT keeps its largest value. It is 1 at failure, and nowhere else.
module cohesive_dissipation
  use core_kinds, only: dp
  use cohesive_parameters, only: law_parameters, ppr_law
  use cohesive_shear, only: mode_of, shears, resultant
  use cohesive_state, only: point_history, damage_state, law_solution
  use cohesive_law, only: loss, softening, stiffness_of, damage_envelope
  use cohesive_local_solve, only: damage_at_secant, softening_stiffness, opening_part
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
    real(dp), dimension(2) :: before, after, direction, growth, work, most
    real(dp), dimension(3) :: g0, g1, of_component
    real(dp) :: reached, ends, old(2), new(2), not_used(2)

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
      old = [1.0_dp - history%damage, law%flexibility*history%damage]
      new = [1.0_dp - state%damage, law%flexibility*state%damage]
      call damage_envelope(law, before, reached, not_used)
      call damage_envelope(law, after, ends, not_used)
      direction = direction_of_growth(before, after, reached, history%damage, ends)
      work = work_of_damage(law, direction, old, new)
      spent = max(spent, share_spent(law, after, new))
    end if
    if (law%viscosity > 0.0_dp) then
      growth = 0.5_dp*stiffness_of(law)*growth
      of_component = growth(mode_of)*g0*g1
      most = max(0.0_dp, [sum(of_component(shears)), of_component(2)])
      work = min(work, most)
      viscous = viscous + sum(most - work)
    end if
    dissipated = dissipated + work
  end subroutine dissipate

  !> Energies dissipated up to the end of an increment of the consistent law; by backward Euler for the overstress and the friction.
  pure subroutine dissipate_consistently(law, history, state, dissipated, viscous, friction_work, spent)
    type(law_parameters), intent(in) :: law
    type(point_history), intent(in) :: history
    type(law_solution), intent(in) :: state
    real(dp), intent(out) :: dissipated(2)     !< by sliding and by opening
    real(dp), intent(out) :: viscous
    real(dp), intent(out) :: friction_work
    real(dp), intent(out) :: spent             !< share of the fracture energy
    real(dp), dimension(3) :: w0, w1
    real(dp), dimension(2) :: before, after, direction, old, new

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
    else
      old = secant_at(law, history%damage)
      new = secant_at(law, state%damage)
      direction = direction_of_growth(before, after, damage_without_history(law, before), history%damage, state%damage)
      dissipated = dissipated + work_of_damage(law, direction, old, new)
      spent = max(spent, share_spent(law, after, new))
    end if
  end subroutine dissipate_consistently

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

  !> Direction half-way between the separation at which the damage begins to grow and that at the end of the increment; zero
  !> without separations. Between the ends, the damage of the envelope is taken to be linear.
  pure function direction_of_growth(before, after, reached, damage, ends) result(direction)
    real(dp), intent(in) :: before(2), after(2)   !< separations at the ends of the increment
    real(dp), intent(in) :: reached, ends         !< damage of the envelope there, without history
    real(dp), intent(in) :: damage                !< at the start
    real(dp) :: direction(2)
    real(dp) :: part, length

    part = 0.0_dp
    if (ends > max(reached, damage)) part = max(0.0_dp, damage - reached)/(ends - reached)
    direction = after + before + part*(after - before)
    length = norm2(direction)
    if (length > 0.0_dp) direction = direction/length
  end function direction_of_growth

  !> Energy that sliding and opening dissipate in a direction while the secant stiffness falls.
  pure function work_of_damage(law, direction, old, new) result(work)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: direction(2)     !< of unit length, or zero
    real(dp), intent(in) :: old(2), new(2)   !< secant stiffnesses as `loss` takes them
    real(dp) :: work(2)

    work = 0.0_dp
    if (.not. maxval(direction) > 0.0_dp) return
    work = law%ratio*direction**2*max(0.0_dp, loss(law, direction, new(1), new(2)) - loss(law, direction, old(1), old(2)))
  end function work_of_damage

  !> Share of the fracture energy that is dissipated in the direction of a separation once the secant stiffness has fallen so far; 0
  !> without a separation.
  pure function share_spent(law, separation, secant) result(share)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: separation(2)
    real(dp), intent(in) :: secant(2)        !< as `loss` takes it
    real(dp) :: share
    real(dp) :: direction(2), length

    share = 0.0_dp
    length = norm2(separation)
    if (.not. secant(1) > 0.0_dp) then
      share = 1.0_dp
    else if (length > 0.0_dp) then
      direction = separation/length
      share = min(1.0_dp, loss(law, direction, secant(1), secant(2))/loss(law, direction, 0.0_dp, 1.0_dp))
    end if
  end function share_spent

end module cohesive_dissipation
