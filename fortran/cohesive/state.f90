! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What an interface point remembers and what an increment computes from it.
!>
!> Vectors are in the components (s, n, t) of `cohesive_shear`; pairs are (tau, n): shear and opening.
module cohesive_state
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: cycled_state, point_history, damage_state, law_solution, driven_point, resultant_solution

  !> Effect of cycles on a point: `cohesive_fatigue`.
  type :: cycled_state
    real(dp) :: relative = 0.0_dp   !< s, separation over that at which the point would soften
    real(dp) :: rate = 0.0_dp       !< dD/dN, 1/cycle
    real(dp) :: cycles = 0.0_dp     !< until the present or until failure
    real(dp) :: grown = 0.0_dp      !< D that the cycles of the increment have added; zero where the softening line demands more
  end type cycled_state

  !> What a point remembers from the end of the last increment.
  type :: point_history
    real(dp) :: separation(3) = 0.0_dp   !< (s, n, t)
    real(dp) :: damage = 0.0_dp          !< the damage that acts
    real(dp) :: damage_max = 0.0_dp      !< largest damage of the envelope so far
    real(dp) :: largest(2) = 0.0_dp      !< largest separations so far, (tau, n): the history of the PPR law, of no other
    real(dp) :: dissipated(2) = 0.0_dp   !< by sliding and by opening, energy/area
    real(dp) :: viscous = 0.0_dp         !< by the viscous overstress, energy/area
    real(dp) :: friction_work = 0.0_dp   !< by friction, energy/area
    real(dp) :: spent = 0.0_dp           !< share of the fracture energy of the mode mix that is dissipated
    type(cycled_state) :: cycled         !< zero without fatigue
  end type point_history

  !> Damage at the end of the increment.
  type :: damage_state
    real(dp) :: damage       !< the damage that acts
    real(dp) :: damage_max   !< largest damage of the envelope so far, this increment included
    real(dp) :: largest(2)   !< as in the history
    real(dp) :: acting(2)    !< damage of shear and opening, t_i = (1 - acting_i) alpha_i g_i; but for the PPR law `damage`
    real(dp) :: slope(2, 2)  !< derivative of `acting` by the separation (tau, n), tau not negative, 1/length
    type(cycled_state) :: cycled
  end type damage_state

  !> What drives a point of the consistent law, in pairs (tau, n).
  type :: driven_point
    real(dp) :: beta(2)         !< stress/length
    real(dp) :: viscous(2)      !< overstress by separation, stress/length
    real(dp) :: trial(2)        !< p and the viscous part of the old separation, less friction; p_tau is not negative, stress
    real(dp) :: secant_share    !< of the tangent at fixed damage, from 0 to 1
    logical :: closed           !< p_n < 0
    logical :: sticks           !< friction holds the shear
    logical :: fixed            !< the damage may not grow
  end type driven_point

  !> Solution of the consistent law in (tau, n), both along the shear of p.
  type :: resultant_solution
    real(dp) :: recoverable(2)     !< T less overstress and friction, stress
    real(dp) :: separation(2)      !< w, length
    real(dp) :: damage             !< the damage that acts
    real(dp) :: largest(2)         !< as in the history
    real(dp) :: stabilisation(2)   !< S of (17)
    real(dp) :: share              !< T_tau/p_tau, overstress included
    real(dp) :: by_trial(2, 2)     !< dT/dp
    type(cycled_state) :: cycled
    logical :: solved
    integer :: steps
  end type resultant_solution

  !> Solution of the consistent law in a point.
  type :: law_solution
    real(dp) :: traction(3)        !< T, stress, tension positive
    real(dp) :: recoverable(3)     !< t: T less overstress and friction
    real(dp) :: overstress(3)      !< viscous part of T
    real(dp) :: friction(2)        !< part of (T_s, T_t), stress
    real(dp) :: separation(3)      !< w, length
    real(dp) :: damage             !< the damage that acts
    real(dp) :: largest(2)         !< as in the history
    real(dp) :: stabilisation(2)   !< S of (17), shear and opening
    real(dp) :: by_trial(3, 3)     !< dT/dp
    type(cycled_state) :: cycled
    logical :: solved              !< false where no separation was found
    integer :: steps               !< of the search for it; 0 where the damage stays
  end type law_solution

end module cohesive_state
