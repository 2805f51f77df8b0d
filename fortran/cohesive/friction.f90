! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Coulomb friction of a closed point in the consistent closure.
module cohesive_friction
  use core_kinds, only: dp
  use cohesive_parameters, only: law_parameters
  implicit none(type, external)
  private
  public :: rub

contains

  !> Coulomb friction on the damaged share D of a closed point, D at the start of the increment: |friction| <= mu D |T_n|.
  !>
  !> It sticks where this holds with w_tau as it was, else it slides. As beta closes the law, so it does the friction: no
  !> further stiffness is needed.
  pure subroutine rub(law, damage, pressed, p, held, sticks, friction, slope)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: damage
    real(dp), intent(in) :: pressed      !< T_n of a closed point, zero of an open one
    real(dp), intent(in) :: p            !< p_tau
    real(dp), intent(in) :: held         !< p_tau at which w_tau stays as it was, without friction
    logical, intent(out) :: sticks
    real(dp), intent(out) :: friction    !< stress
    real(dp), intent(out) :: slope       !< derivative of the friction by T_n
    real(dp) :: excess

    sticks = .false.
    friction = 0.0_dp
    slope = 0.0_dp
    if (.not. (law%friction*damage > 0.0_dp .and. pressed < 0.0_dp)) return
    excess = p - held
    sticks = abs(excess) <= -law%friction*damage*pressed
    friction = excess
    if (sticks) return
    slope = sign(law%friction*damage, -excess)
    friction = slope*pressed
  end subroutine rub

end module cohesive_friction
