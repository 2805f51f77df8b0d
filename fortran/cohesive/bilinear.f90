! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Bilinear mixed-mode laws: with the linear energy criterion, the paper's law, equations (9) to (11); with that of Benzeggagh and
!> Kenane or the power law, the law of Abaqus' cohesive elements with SOFTENING=LINEAR; components in the order (tau, n).
!>
!> With the measures f and e of `cohesive_mode_mix`, softening starts at tau f = 1 and ends at lambda = f/e; the straight
!> line between the two is tau = (f - lambda e)/(f**2 - e flexibility).
!>
!> Abaqus, after Camanho and Davila, NASA/TM-2002-211737, gives the separation at failure as 2 G_c/T_eff with an effective
!> traction T_eff at the onset. Here that is the component of the traction along the separation, so that the area under the curve is
!> G_c for unequal stiffnesses too; for equal ones it is the magnitude of the traction.
module cohesive_bilinear
  use core_kinds, only: dp
  use cohesive_parameters, only: law_parameters
  use cohesive_mode_mix, only: measure_onset, measure_energy, least_reserve
  implicit none(type, external)
  private
  public :: bilinear_softening, bilinear_steepest, bilinear_loss

contains

  !> Softening curve in a direction with the measures f and e, and its derivatives.
  pure subroutine bilinear_softening(law, separation, f, e, traction, by_separation, by_f, by_e)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: separation       !< lambda, length
    real(dp), intent(in) :: f, e             !< 1/stress, area/energy
    real(dp), intent(out) :: traction        !< tau, stress; zero after failure
    real(dp), intent(out) :: by_separation   !< stress/length
    real(dp), intent(out) :: by_f, by_e
    real(dp) :: below

    traction = 0.0_dp
    by_separation = 0.0_dp
    by_f = 0.0_dp
    by_e = 0.0_dp
    if (separation*e >= f) return

    below = f**2 - e*law%flexibility
    traction = (f - separation*e)/below
    by_separation = -e/below
    by_f = (1.0_dp - 2.0_dp*f*traction)/below
    by_e = (law%flexibility*traction - separation)/below
  end subroutine bilinear_softening

  !> Largest softening slope -d tau/d lambda = 1/(f**2/e - flexibility) of all directions.
  pure function bilinear_steepest(law) result(slope)
    type(law_parameters), intent(in) :: law
    real(dp) :: slope   !< stress/length
    real(dp) :: reserve, share

    call least_reserve(law, reserve, share)
    slope = 1.0_dp/(reserve - law%flexibility)
  end function bilinear_steepest

  !> Area of `loss` in a direction where 1/K - flexibility = lost/stiff: 1/(2 e) at failure.
  pure function bilinear_loss(law, direction, stiff, lost) result(loss)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: direction(2)     !< c, not negative, of unit length
    real(dp), intent(in) :: stiff, lost      !< not negative, not both zero
    real(dp) :: loss                         !< stress times length
    real(dp) :: f, e, slope(2)

    call measure_onset(law, direction, f, slope)
    call measure_energy(law, direction, e, slope)
    ! (lambda - tau flexibility)/(2 f) at tau = K lambda
    loss = 0.5_dp*lost/(e*lost + f**2*stiff)
  end function bilinear_loss

end module cohesive_bilinear
