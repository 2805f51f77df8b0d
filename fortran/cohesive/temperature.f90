! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Strengths and fracture energies at a temperature: those of the deck times factors.
!>
!> Factors are linear between up to three points and constant outside of them. The shape of the law, the mode mix and the initial
!> stiffness stay. So does the damage, whose secant is then that of the present law.
module cohesive_temperature
  use core_kinds, only: dp
  use cohesive_parameters, only: law_parameters
  implicit none(type, external)
  private
  public :: suit_temperature, suit_steepest_temperature

contains

  !> Gives a law the values at a temperature.
  pure subroutine suit_temperature(law, temperature)
    type(law_parameters), intent(inout) :: law
    real(dp), intent(in) :: temperature
    real(dp) :: at(3), strength(3), toughness(3)
    integer :: points

    call table_of(law, points, at, strength, toughness)
    if (points == 1) return
    law%strength = value_at(points, at, strength, temperature)*[law%given%taumax, law%given%sigmamax]
    law%toughness = value_at(points, at, toughness, temperature)*[law%given%giic, law%given%gic]
  end subroutine suit_temperature

  !> Gives a law the values at the temperature of the table at which it softens most steeply: strength**2/toughness is largest.
  pure subroutine suit_steepest_temperature(law)
    type(law_parameters), intent(inout) :: law
    real(dp) :: at(3), strength(3), toughness(3)
    integer :: points

    call table_of(law, points, at, strength, toughness)
    call suit_temperature(law, at(maxloc(strength(1:points)**2/toughness(1:points), 1)))
  end subroutine suit_steepest_temperature

  !> Points of the table of temperatures.
  pure subroutine table_of(law, points, at, strength, toughness)
    type(law_parameters), intent(in) :: law
    integer, intent(out) :: points
    real(dp), intent(out) :: at(3), strength(3), toughness(3)

    associate (given => law%given)
      at = [given%temperature1, given%temperature2, given%temperature3]
      strength = [1.0_dp, given%strength2, given%strength3]
      toughness = [1.0_dp, given%toughness2, given%toughness3]
    end associate
    points = 1
    if (strength(2) > 0.0_dp) points = 2
    if (points == 2 .and. strength(3) > 0.0_dp) points = 3
    where (.not. toughness > 0.0_dp) toughness = strength
  end subroutine table_of

  !> Value of a line through points; constant before the first and beyond the last.
  pure function value_at(points, at, values, place) result(value)
    integer, intent(in) :: points
    real(dp), intent(in) :: at(:), values(:), place
    real(dp) :: value
    integer :: k

    value = values(1)
    do k = 2, points
      if (place <= at(k - 1)) exit
      value = values(k - 1) + (values(k) - values(k - 1))*min(1.0_dp, (place - at(k - 1))/(at(k) - at(k - 1)))
    end do
  end function value_at

end module cohesive_temperature
