! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> A law of the tests: the traction stays at the strength on a share s of the way from the onset to failure, and falls on a
!> line from there. Components in the order (tau, n).
!>
!> With the measures f and e of `cohesive_mode_mix`, the onset is at c = flexibility/f, failure at u with (u - c)(1 + s) =
!> f/e - c, by which the area under the curve is 1/(2 e). s = 0 is the bilinear law.
module cohesive_plateau
  use core_kinds, only: dp
  use cohesive_parameters, only: law_parameters
  use cohesive_mode_mix, only: measure_onset, measure_energy, least_reserve
  implicit none(type, external)
  private
  public :: plateau_softening, plateau_steepest, plateau_loss

contains

  !> Softening curve in a direction with the measures f and e, and its derivatives.
  pure subroutine plateau_softening(law, separation, f, e, traction, by_separation, by_f, by_e)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: separation       !< lambda, length
    real(dp), intent(in) :: f, e             !< 1/stress, area/energy
    real(dp), intent(out) :: traction        !< tau, stress; zero after failure
    real(dp), intent(out) :: by_separation   !< stress/length
    real(dp), intent(out) :: by_f, by_e
    real(dp) :: onset, failure, fall, slope(2), onset_slope(2), failure_slope(2), fall_slope(2)

    onset = law%flexibility/f
    failure = onset + (f/e - onset)/(1.0_dp + law%given%plateau)
    fall = (1.0_dp - law%given%plateau)*(failure - onset)
    traction = 1.0_dp/f
    by_separation = 0.0_dp
    by_f = -1.0_dp/f**2
    by_e = 0.0_dp
    if (separation <= failure - fall) return

    traction = max(0.0_dp, (failure - separation)/(f*fall))
    by_f = 0.0_dp
    if (.not. traction > 0.0_dp) return
    by_separation = -1.0_dp/(f*fall)
    ! by f and e
    onset_slope = [-onset/f, 0.0_dp]
    failure_slope = onset_slope + ([1.0_dp/e, -f/e**2] - onset_slope)/(1.0_dp + law%given%plateau)
    fall_slope = (1.0_dp - law%given%plateau)*(failure_slope - onset_slope)
    slope = failure_slope/(f*fall) - traction*([1.0_dp/f, 0.0_dp] + fall_slope/fall)
    by_f = slope(1)
    by_e = slope(2)
  end subroutine plateau_softening

  !> Largest softening slope -d tau/d lambda of all directions.
  pure function plateau_steepest(law) result(slope)
    type(law_parameters), intent(in) :: law
    real(dp) :: slope   !< stress/length
    real(dp) :: reserve, share

    call least_reserve(law, reserve, share)
    slope = (1.0_dp + law%given%plateau)/((1.0_dp - law%given%plateau)*(reserve - law%flexibility))
  end function plateau_steepest

  !> Area of `loss` in a direction where 1/K - flexibility = lost/stiff: 1/(2 e) at failure.
  pure function plateau_loss(law, direction, stiff, lost) result(loss)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: direction(2)     !< c, not negative, of unit length
    real(dp), intent(in) :: stiff, lost      !< not negative, not both zero
    real(dp) :: loss                         !< stress times length
    real(dp) :: f, e, onset, failure, fall, slope(2)

    call measure_onset(law, direction, f, slope)
    call measure_energy(law, direction, e, slope)
    onset = law%flexibility/f
    failure = onset + (f/e - onset)/(1.0_dp + law%given%plateau)
    fall = (1.0_dp - law%given%plateau)*(failure - onset)
    if (lost <= (f*(failure - fall) - law%flexibility)*stiff) then
      loss = 0.5_dp*lost/(f**2*stiff)
    else
      ! tau = K lambda = (failure - lambda)/(f fall)
      loss = 0.5_dp/e - 0.5_dp*failure**2*stiff/(lost + law%flexibility*stiff + f*fall*stiff)
    end if
  end function plateau_loss

end module cohesive_plateau
