! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What an interface point remembers and what an increment computes from it; components in the order (tau, n).
module cohesive_state
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: point_history, damage_state, law_solution

  !> What a point remembers from the end of the last increment.
  type :: point_history
    real(dp) :: separation(2) = 0.0_dp   !< (tau, n)
    real(dp) :: damage = 0.0_dp          !< the damage that acts
    real(dp) :: damage_max = 0.0_dp      !< largest damage of the envelope so far
    real(dp) :: largest(2) = 0.0_dp      !< largest separations so far: the history of the PPR law, of no other
    real(dp) :: dissipated(2) = 0.0_dp   !< by sliding and by opening, energy/area
    real(dp) :: viscous = 0.0_dp         !< by the viscous overstress, energy/area
    real(dp) :: friction_work = 0.0_dp          !< by friction, energy/area
  end type point_history

  !> Damage at the end of the increment.
  type :: damage_state
    real(dp) :: damage       !< the damage that acts
    real(dp) :: damage_max   !< largest damage of the envelope so far, this increment included
    real(dp) :: largest(2)   !< as in the history
    real(dp) :: acting(2)    !< damage of each component, t_i = (1 - acting_i) alpha_i g_i; but for the PPR law `damage`
    real(dp) :: slope(2, 2)  !< derivative of `acting` by the separation, 1/length
  end type damage_state

  !> Solution of the consistent law in a point.
  type :: law_solution
    real(dp) :: traction(2)        !< T, stress, tension positive
    real(dp) :: recoverable(2)     !< t: T less overstress and friction
    real(dp) :: overstress(2)      !< viscous part of T
    real(dp) :: friction           !< part of T_tau, stress
    real(dp) :: separation(2)      !< w, length
    real(dp) :: damage             !< the damage that acts
    real(dp) :: largest(2)         !< as in the history
    real(dp) :: stabilisation(2)   !< S of (17)
    real(dp) :: by_trial(2, 2)     !< dT/dp
    logical :: solved              !< false where no separation was found
    integer :: steps               !< of the search for it; 0 where the damage stays
  end type law_solution

end module cohesive_state
