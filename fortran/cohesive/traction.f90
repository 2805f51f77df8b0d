! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Interface traction from damage: equation (8) and its stabilised form (16), both in components (tau, n).
module cohesive_traction
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: standard_traction, stabilised_traction

contains

  !> T = alpha (1 - d) g, equation (8); a closed interface (g_n < 0) keeps its undamaged normal stiffness.
  !> Without the slope of the damage the tangent is the secant matrix (24), with it the consistent tangent (23).
  pure subroutine standard_traction(stiffness, separation, damage, slope, traction, tangent)
    real(dp), intent(in) :: stiffness(2)    !< alpha, stress/length
    real(dp), intent(in) :: separation(2)   !< g, opening positive
    real(dp), intent(in) :: damage(2)       !< of each component
    real(dp), intent(in) :: slope(2, 2)     !< derivative of the damage by g, zero for the secant matrix
    real(dp), intent(out) :: traction(2)    !< stress, tension positive
    real(dp), intent(out) :: tangent(2, 2)  !< dT/dg
    real(dp) :: secant(2), softening(2)

    secant = damaged(stiffness, damage, separation(2) < 0.0_dp)
    traction = secant*separation
    softening = stiffness*separation
    if (separation(2) < 0.0_dp) softening(2) = 0.0_dp
    tangent(:, 1) = -softening*slope(:, 1)
    tangent(:, 2) = -softening*slope(:, 2)
    tangent(1, 1) = tangent(1, 1) + secant(1)
    tangent(2, 2) = tangent(2, 2) + secant(2)
  end subroutine standard_traction

  !> T = (1 - S) <sigma>.n + S K g with K = alpha (1 - d) and S = beta/(K + beta), equations (16) and (17).
  !>
  !> Written with the trial traction p = <sigma>.n + beta g it is T = p K/(K + beta). The interface is closed where p_n < 0: the
  !> open and the closed branch meet at p_n = 0, whereas the sign of g_n, zero only to the order of the element size, would make the
  !> iteration chatter. A closed interface keeps its undamaged normal stiffness.
  pure subroutine stabilised_traction(stiffness, beta, separation, bulk, damage, slope, traction, stabilisation, &
    tangent)
    real(dp), intent(in) :: stiffness(2)        !< alpha, stress/length
    real(dp), intent(in) :: beta(2)             !< stress/length
    real(dp), intent(in) :: separation(2)       !< g, opening positive
    real(dp), intent(in) :: bulk(2)             !< <sigma>.n, stress
    real(dp), intent(in) :: damage(2)           !< of each component
    real(dp), intent(in) :: slope(2, 2)         !< derivative of the damage by g, zero for the secant matrix
    real(dp), intent(out) :: traction(2)        !< T, stress, tension positive
    real(dp), intent(out) :: stabilisation(2)   !< S
    real(dp), intent(out) :: tangent(2, 2)      !< dT/dg at constant bulk stress; by that stress it is 1 - S, diagonal
    real(dp) :: trial(2), secant(2), softening(2)
    logical :: closed

    trial = bulk + beta*separation
    closed = trial(2) < 0.0_dp
    secant = damaged(stiffness, damage, closed)
    stabilisation = beta/(secant + beta)
    traction = trial*(secant/(secant + beta))
    softening = trial*stabilisation*stiffness/(secant + beta)
    if (closed) softening(2) = 0.0_dp
    tangent(:, 1) = -softening*slope(:, 1)
    tangent(:, 2) = -softening*slope(:, 2)
    tangent(1, 1) = tangent(1, 1) + stabilisation(1)*secant(1)
    tangent(2, 2) = tangent(2, 2) + stabilisation(2)*secant(2)
  end subroutine stabilised_traction

  !> Stiffness alpha (1 - d); of a closed interface the normal one is not damaged.
  pure function damaged(stiffness, damage, closed) result(secant)
    real(dp), intent(in) :: stiffness(2), damage(2)
    logical, intent(in) :: closed
    real(dp) :: secant(2)

    secant = (1.0_dp - damage)*stiffness
    if (closed) secant(2) = stiffness(2)
  end function damaged

end module cohesive_traction
