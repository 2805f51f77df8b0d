! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Strengths and fracture energies at a rate of the separation: those of the deck times powers of the rate.
!>
!> The rate is that of the increment itself, (lambda - lambda_0)/dt, with the length lambda of the separation without penetration at
!> its end and lambda_0 at its start; it is 0 where lambda shrinks. So the law remains a function of the separation, and the
!> derivative of its traction by lambda holds that by the rate. The rate of the increment before would lag: where an increment
!> softens a point by more than the structure around it holds, the load then oscillates.
!>
!> The factors are (1 + rate/RATEREFERENCE)**m, the power law of Marusich and Ortiz, Int. J. for Numerical Methods in Engineering
!> 38 (1995) 3675, of rates up to RATELIMIT. They rise from 1 with a slope, and less and less. A power that begins at a threshold is
!> flat and then steep in small increments: Newton's method oscillates between both sides of it.
!>
!> The traction does not fall with the rate if the fracture energy grows at least as fast as the strength: neither the onset nor
!> the end of a straight softening then moves to a smaller separation. Where it falls, small increments have several solutions.
module cohesive_rate
  use core_kinds, only: dp
  use cohesive_parameters, only: law_parameters
  use cohesive_shear, only: resultant
  implicit none(type, external)
  private
  public :: depends_on_rate, begin_rate, rate_exponents, measure_rate, suit_rate, suit_steepest_rate

contains

  !> Whether strengths and fracture energies depend on the rate.
  pure logical function depends_on_rate(law)
    type(law_parameters), intent(in) :: law

    depends_on_rate = law%given%ratereference > 0.0_dp
  end function depends_on_rate

  !> Begins an increment of a point.
  pure subroutine begin_rate(law, separation, duration)
    type(law_parameters), intent(inout) :: law
    real(dp), intent(in) :: separation(3)   !< at the start
    real(dp), intent(in) :: duration
    real(dp) :: pair(2)

    if (.not. depends_on_rate(law)) return
    pair = resultant(separation)
    ! as in `damage_envelope`: to the last digit, where the separation has not changed
    law%rate%start = sqrt(pair(1)**2 + max(0.0_dp, pair(2))**2)
    law%rate%duration = duration
  end subroutine begin_rate

  !> Exponents of the strengths and of the fracture energies.
  pure function rate_exponents(law) result(exponents)
    type(law_parameters), intent(in) :: law
    real(dp) :: exponents(2)

    exponents = [law%given%strengthrate, law%given%toughnessrate]
    if (.not. exponents(2) > 0.0_dp) exponents(2) = exponents(1)
  end function rate_exponents

  !> Factors of the strengths and of the fracture energies at a separation, and their logarithmic derivatives by it.
  pure subroutine measure_rate(law, separation, factors, slopes)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: separation    !< lambda, length
    real(dp), intent(out) :: factors(2)
    real(dp), intent(out) :: slopes(2)    !< 1/length
    real(dp) :: grown, unit

    factors = 1.0_dp
    slopes = 0.0_dp
    grown = separation - law%rate%start
    unit = law%given%ratereference*law%rate%duration
    ! at the start of an increment the slope is that of growth, which Newton's method begins with
    if (.not. (unit > 0.0_dp .and. grown >= 0.0_dp)) return
    if (grown < law%given%ratelimit*law%rate%duration) then
      factors = (1.0_dp + grown/unit)**rate_exponents(law)
      slopes = rate_exponents(law)/(unit + grown)
    else
      factors = largest_base(law)**rate_exponents(law)
    end if
  end subroutine measure_rate

  !> Base of the powers at RATELIMIT.
  pure function largest_base(law) result(base)
    type(law_parameters), intent(in) :: law
    real(dp) :: base

    base = 1.0_dp + law%given%ratelimit/law%given%ratereference
  end function largest_base

  !> Gives a law the values at the rate with which a separation is reached; they are then its own.
  pure subroutine suit_rate(law, separation)
    type(law_parameters), intent(inout) :: law
    real(dp), intent(in) :: separation   !< lambda, length
    real(dp) :: factors(2), slopes(2)

    if (.not. depends_on_rate(law)) return
    call measure_rate(law, separation, factors, slopes)
    law%strength = factors(1)*law%strength
    law%toughness = factors(2)*law%toughness
    law%given%ratereference = 0.0_dp
  end subroutine suit_rate

  !> Gives a law the reserve `least_reserve` of the rate at which it softens most steeply, by its strengths alone, so that messages
  !> name the fracture energy of the deck. strength**2/toughness is monotonic in the rate.
  pure subroutine suit_steepest_rate(law)
    type(law_parameters), intent(inout) :: law
    real(dp) :: exponents(2)

    if (.not. depends_on_rate(law)) return
    exponents = rate_exponents(law)
    law%strength = law%strength*largest_base(law)**max(0.0_dp, exponents(1) - 0.5_dp*exponents(2))
  end subroutine suit_steepest_rate

end module cohesive_rate
