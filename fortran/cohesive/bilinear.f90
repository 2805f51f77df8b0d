! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Anisotropic bilinear mixed-mode law, equations (9) to (11) of the paper; components in the order (tau, n).
!>
!> In the direction c of the separation w = lambda c, the traction is t_i = tau ratio_i c_i. With
!> f = sqrt(sum_i (ratio_i c_i/strength_i)**2) of the quadratic stress criterion and
!> e = sum_i ratio_i c_i**2/(2 G_i) of the linear energy criterion, (10) is the onset at tau f = 1 and (11) the failure
!> at lambda = f/e. The straight line between the two is tau = (f - lambda e)/(f**2 - e flexibility).
module cohesive_bilinear
  use core_kinds, only: dp
  use core_status, only: status_type, too_brittle
  use cohesive_parameters, only: law_parameters
  implicit none(type, external)
  private
  public :: check_bilinear, bilinear_softening, bilinear_steepest

contains

  !> Demands delta_u > delta_c in every mode mix.
  !>
  !> That is f**2 > e flexibility, sum_i ratio_i c_i**2 (ratio_i/strength_i**2 - flexibility/(2 G_i)) > 0: it holds in
  !> every mix if and only if it holds in the two pure modes, strength_i**2 < 2 G_i alpha_i.
  pure subroutine check_bilinear(law, status)
    type(law_parameters), intent(in) :: law
    type(status_type), intent(out) :: status   !< too_brittle: item 1 for mode I, 2 for mode II, value and bound of G_c
    real(dp) :: least(2)

    least = 0.5_dp*law%strength**2*law%flexibility/law%ratio
    if (.not. law%toughness(2) > least(2)) then
      status = status_type(too_brittle, 1, law%toughness(2), least(2))
    else if (.not. law%toughness(1) > least(1)) then
      status = status_type(too_brittle, 2, law%toughness(1), least(1))
    end if
  end subroutine check_bilinear

  !> Softening curve along a direction of the separation, with its derivatives.
  pure subroutine bilinear_softening(law, separation, direction, traction, by_separation, by_direction)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: separation         !< lambda, length
    real(dp), intent(in) :: direction(2)       !< c, not negative, of unit length
    real(dp), intent(out) :: traction          !< tau, stress; zero after failure
    real(dp), intent(out) :: by_separation     !< stress/length
    real(dp), intent(out) :: by_direction(2)   !< by c, its components taken as independent
    real(dp), dimension(2) :: f_slope, e_slope
    real(dp) :: f, e, below

    traction = 0.0_dp
    by_separation = 0.0_dp
    by_direction = 0.0_dp
    f_slope = law%ratio*direction/law%strength
    f = sqrt(f_slope(1)**2 + f_slope(2)**2)
    e_slope = law%ratio*direction/law%toughness
    e = 0.5_dp*(e_slope(1)*direction(1) + e_slope(2)*direction(2))
    if (separation*e >= f) return

    f_slope = f_slope*(law%ratio/law%strength)/f
    below = f**2 - e*law%flexibility
    traction = (f - separation*e)/below
    by_separation = -e/below
    by_direction = (f_slope - separation*e_slope - traction*(2.0_dp*f*f_slope - law%flexibility*e_slope))/below
  end subroutine bilinear_softening

  !> Largest softening slope -d tau/d lambda = 1/(f**2/e - flexibility) of all directions.
  !>
  !> f**2/e is a mean of its values 2 G_i ratio_i/strength_i**2 in the pure modes, weighted by ratio_i c_i**2/(2 G_i).
  pure function bilinear_steepest(law) result(slope)
    type(law_parameters), intent(in) :: law
    real(dp) :: slope                          !< stress/length

    slope = 1.0_dp/(minval(2.0_dp*law%toughness*law%ratio/law%strength**2) - law%flexibility)
  end function bilinear_steepest

end module cohesive_bilinear
