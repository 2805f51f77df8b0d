! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Anisotropic bilinear mixed-mode law, equations (9) to (11) of the paper; components in the order (tau, n).
module cohesive_bilinear
  use core_kinds, only: dp
  use core_status, only: status_type, too_brittle
  implicit none(type, external)
  private
  public :: bilinear_damage, check_bilinear

contains

  !> Demands delta_u > delta_c in every mode mix.
  !>
  !> With f and e of `bilinear_damage`, delta_u > delta_c reads f**2 > e, that is
  !> sum_i alpha_i g_i**2 (alpha_i/strength_i**2 - 1/(2 G_i)) > 0: it holds in every mix if and only if it holds in
  !> the two pure modes, strength_i**2 < 2 G_i alpha_i.
  pure subroutine check_bilinear(stiffness, strength, toughness, status)
    real(dp), intent(in) :: stiffness(2), strength(2), toughness(2)
    type(status_type), intent(out) :: status   !< too_brittle: item 1 for mode I, 2 for mode II, value and bound of G_c
    real(dp) :: least(2)

    least = 0.5_dp*strength**2/stiffness
    if (.not. toughness(2) > least(2)) then
      status = status_type(too_brittle, 1, toughness(2), least(2))
    else if (.not. toughness(1) > least(1)) then
      status = status_type(too_brittle, 2, toughness(1), least(1))
    end if
  end subroutine check_bilinear

  !> Damage (9) at a separation without history, and its derivative.
  !>
  !> With f the quadratic stress criterion of the undamaged traction and e the linear energy criterion of the
  !> undamaged energy, delta_c = g_e/f (10) and delta_u = f g_e/e (11), where g_e is the equivalent separation. It
  !> cancels from (9): d = f (f - 1)/(f**2 - e) from f = 1 (onset) to e = f (failure), with no division by g_e.
  pure subroutine bilinear_damage(stiffness, strength, toughness, separation, damage, slope)
    real(dp), intent(in) :: stiffness(2), strength(2), toughness(2)
    real(dp), intent(in) :: separation(2)
    real(dp), intent(out) :: damage
    real(dp), intent(out) :: slope(2)   !< derivative by the separation; zero before onset and after failure
    real(dp) :: opening(2), stress_ratio(2), f_slope(2), e_slope(2), f, e, below

    slope = 0.0_dp
    damage = 0.0_dp
    opening = [separation(1), max(0.0_dp, separation(2))]
    stress_ratio = stiffness*opening/strength
    f = sqrt(stress_ratio(1)**2 + stress_ratio(2)**2)
    if (.not. f > 1.0_dp) return

    e_slope = stiffness*opening/toughness
    e = 0.5_dp*(e_slope(1)*opening(1) + e_slope(2)*opening(2))
    damage = 1.0_dp
    if (e >= f) return

    below = f**2 - e
    damage = f*(f - 1.0_dp)/below
    f_slope = stress_ratio*(stiffness/strength)/f
    slope = ((2.0_dp*f - 1.0_dp)*f_slope - damage*(2.0_dp*f*f_slope - e_slope))/below
  end subroutine bilinear_damage

end module cohesive_bilinear
