! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Exponential softening; components in the order (tau, n).
!>
!> With the measures f and e of `cohesive_mode_mix`, softening starts at tau f = 1, lambda = flexibility/f, and follows
!> tau = exp(-x)/f, x = 2 e (f lambda - flexibility)/(f**2 - e flexibility): the decay at which the area under the curve,
!> with the triangle before the onset, is 1/(2 e).
!>
!> For infinite stiffness it is the law of Wells and Sluys, Int. J. for Numerical Methods in Engineering 50 (2001) 2667-2682,
!> t = strength exp(-strength w/G_c). The damage tends to 1 but never reaches it.
module cohesive_exponential
  use core_kinds, only: dp
  use cohesive_parameters, only: law_parameters
  use cohesive_mode_mix, only: measure_onset, measure_energy, least_reserve
  implicit none(type, external)
  private
  public :: exponential_softening, exponential_steepest

  !> Bound of -x before the onset, where the curve only has to lie above the elastic line.
  real(dp), parameter :: largest_rise = 100.0_dp

contains

  !> Softening curve along a direction of the separation, with its derivatives.
  pure subroutine exponential_softening(law, separation, direction, traction, by_separation, by_direction)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: separation         !< lambda, length
    real(dp), intent(in) :: direction(2)       !< c, not negative, of unit length
    real(dp), intent(out) :: traction          !< tau, stress
    real(dp), intent(out) :: by_separation     !< stress/length
    real(dp), intent(out) :: by_direction(2)   !< by c, its components taken as independent
    real(dp) :: f, e, below, beyond, x, f_slope(2), e_slope(2), x_slope(2)

    call measure_onset(law, direction, f, f_slope)
    call measure_energy(law, direction, e, e_slope)
    below = f**2 - e*law%flexibility
    beyond = f*separation - law%flexibility
    x = 2.0_dp*e*beyond/below
    traction = exp(-max(x, -largest_rise))/f
    by_separation = -traction*2.0_dp*e*f/below
    x_slope = (2.0_dp*(beyond*e_slope + e*separation*f_slope) - x*(2.0_dp*f*f_slope - law%flexibility*e_slope))/below
    by_direction = -traction*(f_slope/f + x_slope)
  end subroutine exponential_softening

  !> Largest softening slope, 2/(f**2/e - flexibility) at the onset in the steepest direction.
  pure function exponential_steepest(law) result(slope)
    type(law_parameters), intent(in) :: law
    real(dp) :: slope   !< stress/length
    real(dp) :: reserve, share

    call least_reserve(law, reserve, share)
    slope = 2.0_dp/(reserve - law%flexibility)
  end function exponential_steepest

end module cohesive_exponential
