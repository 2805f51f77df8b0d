! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Coulomb friction of a point in contact, in the consistent law; pairs are the shears (s, t).
module cohesive_friction
  use core_kinds, only: dp
  use core_limit, only: exceeds
  use cohesive_shear, only: shears
  implicit none(type, external)
  private
  public :: friction_state, coulomb_friction, add_friction

  !> Friction of a point.
  type :: friction_state
    logical :: acts                   !< the point is damaged and in contact; the rest is set where it does
    logical :: sticks
    real(dp) :: traction(2)           !< stress
    real(dp) :: by_pressed(2)         !< derivative by T_n
    real(dp) :: by_shear(2, 2)        !< derivative by the shear of p
  end type friction_state

contains

  !> Friction on the damaged share D of a point in contact, D at the start of the increment: |friction| <= mu D |T_n|.
  !>
  !> The point sticks if this holds with the shear of w unchanged; otherwise it slides against the friction, a radial return. Beta
  !> is also the stiffness of sticking: no other is needed.
  pure subroutine coulomb_friction(coefficient, pressed, excess, turning, friction)
    real(dp), intent(in) :: coefficient   !< mu D
    real(dp), intent(in) :: pressed       !< T_n, negative
    real(dp), intent(in) :: excess(2)     !< shear of p beyond that at which w does not slide, without friction
    real(dp), intent(in) :: turning       !< derivative of the excess by p, across the excess
    type(friction_state), intent(inout) :: friction
    real(dp) :: length, direction(2), most
    integer :: i

    length = abs(excess(1))
    if (abs(excess(2)) > 0.0_dp) length = hypot(excess(1), excess(2))
    most = -coefficient*pressed
    friction%sticks = .not. exceeds(length, most)
    friction%traction = excess
    friction%by_pressed = 0.0_dp
    friction%by_shear = 0.0_dp
    if (friction%sticks) return
    direction = excess/length
    friction%traction = most*direction
    friction%by_pressed = -coefficient*direction
    do i = 1, 2
      friction%by_shear(:, i) = -(turning*most/length)*direction*direction(i)
      friction%by_shear(i, i) = friction%by_shear(i, i) + turning*most/length
    end do
    ! without rounding in the plane
    if (.not. abs(direction(2)) > 0.0_dp) friction%by_shear(1, 1) = 0.0_dp
  end subroutine coulomb_friction

  !> Adds friction to dT/dp: it takes from the shear of p what it adds to that of T.
  pure subroutine add_friction(friction, pressed_by_trial, by_trial)
    type(friction_state), intent(in) :: friction
    real(dp), intent(in) :: pressed_by_trial   !< dT_n/dp_n in contact
    real(dp), intent(inout) :: by_trial(3, 3)  !< without friction
    real(dp) :: remainder(2, 2)
    integer :: i

    remainder = -by_trial(shears, shears)
    do i = 1, 2
      remainder(i, i) = remainder(i, i) + 1.0_dp
    end do
    if (friction%sticks) then
      by_trial(shears, shears) = by_trial(shears, shears) + remainder
    else
      by_trial(shears, shears) = by_trial(shears, shears) + matmul(remainder, friction%by_shear)
      by_trial(shears, 2) = pressed_by_trial*matmul(remainder, friction%by_pressed)
    end if
  end subroutine add_friction

end module cohesive_friction
