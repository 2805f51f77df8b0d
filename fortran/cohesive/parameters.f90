! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The parameters that describe every cohesive law; components in the order (tau, n).
module cohesive_parameters
  use core_kinds, only: dp
  use cohesive_law_properties, only: law_properties
  implicit none(type, external)
  private
  public :: law_parameters, load_cycles, rate_increment, most_ramps

  !> Lines of a polygon through the points of a table: one more than there are points among the properties.
  integer, parameter :: most_ramps = 6

  !> Cycles of a load between a least and a greatest value, of which the analysis follows the greatest.
  type :: load_cycles
    real(dp) :: count = 0.0_dp        !< cycles in the increment; zero: none
    real(dp) :: load_ratio = 0.0_dp   !< least over greatest load, from -1 and below 1
  end type load_cycles

  !> Increment of a point whose law depends on the rate of the separation.
  type :: rate_increment
    real(dp) :: start = 0.0_dp      !< length of the separation at its start
    real(dp) :: duration = 0.0_dp
  end type rate_increment

  !> Parameters of a law. The initial stiffness is alpha_i = ratio_i/flexibility: laws use the flexibility, which stays finite for
  !> an infinite stiffness.
  type :: law_parameters
    integer :: kind           !< one of `cohesive_law_properties`
    real(dp) :: flexibility   !< 1/alpha_n, length/stress; 0 for a law that is rigid up to the onset of damage
    real(dp) :: ratio(2)      !< alpha/alpha_n; 1 where alpha is infinite
    real(dp) :: strength(2)   !< tau_max, sigma_max, stress
    real(dp) :: toughness(2)  !< G_IIc, G_Ic, energy/area
    real(dp) :: viscosity     !< relaxation time; 0 for none
    logical :: paced = .false.      !< the overstress of the consistent law does not fade before failure
    real(dp) :: friction = 0.0_dp   !< coefficient of Coulomb friction in the consistent law; 0 for none
    real(dp) :: eta = 0.0_dp        !< exponent of Benzeggagh and Kenane; 0 for the power law
    real(dp) :: power = 1.0_dp      !< exponent of the power law, positive
    logical :: fatigue = .false.    !< damage grows by cycles in some steps
    type(load_cycles) :: cycles     !< of the increment
    type(rate_increment) :: rate    !< of the point, where the law depends on it: `cohesive_rate`
    type(law_properties) :: given   !< as in the deck: what a law of its own needs besides
    ! of the law with fibre bridging alone: shares of the bridging in the total, `prepare_bridging`
    real(dp) :: bridging_strength(2) = 0.0_dp
    real(dp) :: bridging_energy(2) = 0.0_dp
    ! of the law by a table alone: its ramps, `prepare_table`
    integer :: ramps = 0
    real(dp) :: ramp_height(most_ramps) = 0.0_dp
    real(dp) :: ramp_end(most_ramps) = 1.0_dp
    ! of the PPR law alone
    real(dp) :: shape(2) = 2.0_dp   !< exponents of the softening, the paper's beta and alpha, above 1
    real(dp) :: rise(2) = 0.0_dp    !< exponents of the rise, the paper's n and m: `prepare_ppr`
    real(dp) :: final(2) = 0.0_dp   !< separations at failure in the pure modes, length: `prepare_ppr`
  end type law_parameters

end module cohesive_parameters
