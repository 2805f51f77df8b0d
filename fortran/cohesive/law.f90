! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Damage of an interface point, whatever the law: envelope, history, viscous regularisation, energies.
!>
!> Sign note on the paper, which defines the jump as u(2) - u(1) with n from Omega(2) to Omega(1), and yet takes
!> max(0, delta_n) as the opening: both cannot hold. Here "bottom" is Omega(2), "top" is Omega(1), n points from bottom
!> to top, the separation is u_top - u_bottom (opening positive), and the traction is sigma.n (tension positive).
!>
!> Components are in the order (tau, n) of equation (8). A further law is a further envelope in `damage_envelope`.
module cohesive_law
  use core_kinds, only: dp
  use core_status, only: status_type
  use cohesive_bilinear, only: bilinear_damage, check_bilinear
  implicit none(type, external)
  private
  public :: law_parameters, point_history, damage_state
  public :: check_law, evolve_damage, dissipate
  public :: bilinear_law

  integer, parameter :: bilinear_law = 1

  !> Parameters of a law, (tau, n) each.
  type :: law_parameters
    integer :: kind                !< bilinear_law
    real(dp) :: stiffness(2)       !< alpha, stress/length
    real(dp) :: strength(2)        !< tau_max, sigma_max, stress
    real(dp) :: toughness(2)       !< G_IIc, G_Ic, energy/area
    real(dp) :: viscosity          !< relaxation time of the damage; 0 for none
  end type law_parameters

  !> What a point remembers from the end of the last increment.
  type :: point_history
    real(dp) :: separation(2) = 0.0_dp   !< (tau, n)
    real(dp) :: damage = 0.0_dp          !< the damage that acts
    real(dp) :: damage_max = 0.0_dp      !< largest damage of the envelope so far
    real(dp) :: dissipated(2) = 0.0_dp   !< by sliding and by opening, energy/area
    real(dp) :: viscous = 0.0_dp         !< by the viscous overstress, energy/area
  end type point_history

  !> Damage at the end of the increment.
  type :: damage_state
    real(dp) :: damage       !< the damage that acts
    real(dp) :: damage_max   !< largest damage of the envelope so far, this increment included
    real(dp) :: slope(2)     !< derivative of `damage` by the separation (tau, n), 1/length
  end type damage_state

contains

  !> Checks what the ranges of the single parameters cannot say; status%item is 1 for mode I, 2 for mode II.
  pure subroutine check_law(law, status)
    type(law_parameters), intent(in) :: law
    type(status_type), intent(out) :: status

    select case (law%kind)
    case default
      call check_bilinear(law%stiffness, law%strength, law%toughness, status)
    end select
  end subroutine check_law

  !> Damage of the envelope of the law at a separation, and its slope.
  pure subroutine damage_envelope(law, separation, damage, slope)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: separation(2)
    real(dp), intent(out) :: damage, slope(2)

    select case (law%kind)
    case default
      call bilinear_damage(law%stiffness, law%strength, law%toughness, separation, damage, slope)
    end select
  end subroutine damage_envelope

  !> Damage at the end of an increment.
  !>
  !> The envelope's damage never heals: d = max over time of (9). Below it the response is secant to the origin and the
  !> slope is zero; on it, the slope is that of further loading.
  !>
  !> The damage that acts follows d with the relaxation time `viscosity`, d_v' = (d - d_v)/viscosity, integrated by
  !> backward Euler; an increment of no duration leaves it as it is.
  pure subroutine evolve_damage(law, history, separation, dtime, state)
    type(law_parameters), intent(in) :: law
    type(point_history), intent(in) :: history
    real(dp), intent(in) :: separation(2)   !< (tau, n), opening positive
    real(dp), intent(in) :: dtime           !< duration of the increment
    type(damage_state), intent(out) :: state
    real(dp) :: fraction

    call damage_envelope(law, separation, state%damage_max, state%slope)
    if (state%damage_max < history%damage_max) then
      state%damage_max = history%damage_max
      state%slope = 0.0_dp
    end if
    state%damage = state%damage_max
    if (law%viscosity > 0.0_dp) then
      fraction = dtime/(law%viscosity + dtime)
      state%damage = history%damage + fraction*(state%damage_max - history%damage)
      state%slope = fraction*state%slope
    end if
  end subroutine evolve_damage

  !> Energies dissipated up to the end of an increment, per area.
  !>
  !> For each component, t = (1 - d) alpha g with the opening part of g_n, so that closed contact dissipates nothing.
  !> The work of the traction along a straight path by the trapezoidal rule, less the change of the stored energy
  !> t g/2, is (t0 + t1)(g1 - g0)/2 - (t1 g1 - t0 g0)/2 = (t0 g1 - t1 g0)/2 = alpha g0 g1 (d1 - d0)/2: exact wherever
  !> t is linear along the path. Of it, the overstress (d_max - d) alpha g of the viscous regularisation works
  !> `viscous`, by the trapezoidal rule too; the rest is due to damage, so that all three sum up to the work done.
  pure subroutine dissipate(law, history, separation, state, dissipated, viscous)
    type(law_parameters), intent(in) :: law
    type(point_history), intent(in) :: history
    real(dp), intent(in) :: separation(2)
    type(damage_state), intent(in) :: state
    real(dp), intent(out) :: dissipated(2)   !< by sliding and by opening
    real(dp), intent(out) :: viscous
    real(dp), dimension(2) :: g0, g1, all_of_it, overstress

    g0 = [history%separation(1), max(0.0_dp, history%separation(2))]
    g1 = [separation(1), max(0.0_dp, separation(2))]
    all_of_it = 0.5_dp*law%stiffness*g0*g1*(state%damage - history%damage)
    overstress = 0.5_dp*law%stiffness*(g1 - g0) &
      *((history%damage_max - history%damage)*g0 + (state%damage_max - state%damage)*g1)
    dissipated = history%dissipated + all_of_it - overstress
    viscous = history%viscous + overstress(1) + overstress(2)
  end subroutine dissipate

end module cohesive_law
