! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Coulomb friction of a point in contact, in the consistent law.
module cohesive_friction
  use core_kinds, only: dp
  use cohesive_parameters, only: law_parameters
  implicit none(type, external)
  private
  public :: coulomb_friction

contains

  !> Friction on the damaged share D of a point in contact, D at the start of the increment: |friction| <= mu D |T_n|.
  !>
  !> The point sticks if this holds with w_tau unchanged; otherwise it slides. Beta is also the stiffness of sticking: no other is
  !> needed.
  pure subroutine coulomb_friction(law, damage, pressed, p, held, sticks, friction, slope)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: damage
    real(dp), intent(in) :: pressed      !< T_n in contact, zero without
    real(dp), intent(in) :: p            !< p_tau
    real(dp), intent(in) :: held         !< p_tau at which w_tau does not change, without friction
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
  end subroutine coulomb_friction

end module cohesive_friction
