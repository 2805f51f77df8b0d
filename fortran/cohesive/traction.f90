! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Interface traction from damage: equation (8) and its stabilised form (16), in the components (s, n, t) of `cohesive_shear`.
module cohesive_traction
  use core_kinds, only: dp
  use cohesive_shear, only: mode_of, shears
  implicit none(type, external)
  private
  public :: standard_traction, stabilised_traction

contains

  !> T = alpha (1 - d) g, equation (8); a closed interface (g_n < 0) keeps its undamaged normal stiffness.
  !> Without the slope of the damage the tangent is the secant matrix (24), with it the consistent tangent (23).
  pure subroutine standard_traction(stiffness, separation, direction, damage, slope, traction, tangent)
    real(dp), intent(in) :: stiffness(2)    !< alpha, stress/length, (tau, n)
    real(dp), intent(in) :: separation(3)   !< g, opening positive
    real(dp), intent(in) :: direction(2)    !< of its shear
    real(dp), intent(in) :: damage(2)       !< of shear and opening
    real(dp), intent(in) :: slope(2, 2)     !< derivative of the damage by (|g_tau|, g_n), zero for the secant matrix
    real(dp), intent(out) :: traction(3)    !< stress, tension positive
    real(dp), intent(out) :: tangent(3, 3)  !< dT/dg
    real(dp) :: secant(2), softening(3)

    secant = damaged(stiffness, damage, separation(2) < 0.0_dp)
    traction = secant(mode_of)*separation
    softening = stiffness(mode_of)*separation
    if (separation(2) < 0.0_dp) softening(2) = 0.0_dp
    tangent = damage_tangent(secant, softening, direction, slope)
  end subroutine standard_traction

  !> T = (1 - S) <sigma>.n + S K g with K = alpha (1 - d) and S = beta/(K + beta), equations (16) and (17).
  !>
  !> Written with the trial traction p = <sigma>.n + beta g it is T = p K/(K + beta). The interface is closed where p_n < 0: the
  !> open and the closed branch meet at p_n = 0, whereas the sign of g_n, zero only to the order of the element size, would make the
  !> iteration chatter. A closed interface keeps its undamaged normal stiffness.
  pure subroutine stabilised_traction(stiffness, beta, separation, direction, bulk, damage, slope, traction, stabilisation, &
    tangent)
    real(dp), intent(in) :: stiffness(2)        !< alpha, stress/length, (tau, n)
    real(dp), intent(in) :: beta(2)             !< stress/length, (tau, n)
    real(dp), intent(in) :: separation(3)       !< g, opening positive
    real(dp), intent(in) :: direction(2)        !< of its shear
    real(dp), intent(in) :: bulk(3)             !< <sigma>.n, stress
    real(dp), intent(in) :: damage(2)           !< of shear and opening
    real(dp), intent(in) :: slope(2, 2)         !< derivative of the damage by (|g_tau|, g_n), zero for the secant matrix
    real(dp), intent(out) :: traction(3)        !< T, stress, tension positive
    real(dp), intent(out) :: stabilisation(2)   !< S of shear and opening
    real(dp), intent(out) :: tangent(3, 3)      !< dT/dg at constant bulk stress; by that stress it is 1 - S, diagonal
    real(dp) :: trial(3), secant(2), kept(2), softening(3)
    logical :: closed

    trial = bulk + beta(mode_of)*separation
    closed = trial(2) < 0.0_dp
    secant = damaged(stiffness, damage, closed)
    stabilisation = beta/(secant + beta)
    kept = secant/(secant + beta)
    traction = trial*kept(mode_of)
    kept = stabilisation*stiffness/(secant + beta)
    softening = trial*kept(mode_of)
    if (closed) softening(2) = 0.0_dp
    tangent = damage_tangent(stabilisation*secant, softening, direction, slope)
  end subroutine stabilised_traction

  !> Derivative of secant_i g_i, less softening_i for each unit of the damage.
  pure function damage_tangent(secant, softening, direction, slope) result(tangent)
    real(dp), intent(in) :: secant(2), softening(3), direction(2), slope(2, 2)
    real(dp) :: tangent(3, 3)
    integer :: i

    do i = 1, 3
      tangent(i, shears) = -softening(i)*slope(mode_of(i), 1)*direction
      tangent(i, 2) = -softening(i)*slope(mode_of(i), 2)
      tangent(i, i) = tangent(i, i) + secant(mode_of(i))
    end do
  end function damage_tangent

  !> Stiffness alpha (1 - d); of a closed interface the normal one is not damaged.
  pure function damaged(stiffness, damage, closed) result(secant)
    real(dp), intent(in) :: stiffness(2), damage(2)
    logical, intent(in) :: closed
    real(dp) :: secant(2)

    secant = (1.0_dp - damage)*stiffness
    if (closed) secant(2) = stiffness(2)
  end function damaged

end module cohesive_traction
