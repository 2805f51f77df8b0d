! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Beams of three nodes in space in large rotations, at an integration point. Strains, unknowns and moments are those of
!> host_beam_turning, the tangent is that by a complex step.
!>
!> The nodes turn by Q1, Q2, Q3, and the section by Q2 exp(h), where h interpolates the rotation vectors of Q2' Q1, zero and Q2' Q3:
!> rotations of all nodes alike make no strains (M.A. Crisfield, G. Jelenic, Proceedings of the Royal Society A 455 (1999) 1125).
module host_beam_curved
  use host_beam_turning, only: half_turn, second, section_strains, section_work, third
  use host_corotation, only: rotation_of
  use host_kinds, only: dp
  use host_polar, only: cross, step
  implicit none (type, external)
  private
  public :: add_curved_beam, curved_strains, curved_point

  !> A point of the axis.
  type :: curved_point
    real(dp) :: n(3) = 0, slope(3) = 0        !< of the nodes along the axis; slopes per length
    real(dp) :: axes(3, 3) = 0                !< columns t, 1, 2 at the start
    real(dp) :: centre(2, 2) = 0              !< places of the centroid and of the shear centre
    real(dp) :: x(3, 3) = 0                   !< nodes
    real(dp) :: weight = 0                    !< length
  end type curved_point

  !> Where its section is.
  type :: state_t
    complex(dp) :: node(3, 3, 3) = 0          !< Q1, Q2, Q3
    complex(dp) :: relative(3, 3) = 0         !< rotation vectors of Q2' Q1, zero and Q2' Q3
    complex(dp) :: turn(3, 3) = 0             !< of the section
    complex(dp) :: h(3) = 0, h_slope(3) = 0
    complex(dp) :: along(3) = 0, bent(3) = 0  !< tangent of the axis and curvature in the directions of the start
  end type state_t

contains

  !> Strains of the section, and its directions now.
  pure subroutine curved_strains(point, u, strain, turned)
    type(curved_point), intent(in) :: point
    complex(dp), intent(in) :: u(6, 3)
    complex(dp), intent(out) :: strain(6)
    real(dp), intent(out) :: turned(3, 3)
    type(state_t) :: state
    state = state_of(point, u)
    strain = section_strains(point%axes, point%centre, state%along, state%bent)
    turned = matmul(real(state%turn, dp), point%axes)
  end subroutine curved_strains

  !> Add forces of the nodes and their stiffness, where the forces of the section are linear in its strains, but for an offset.
  pure subroutine add_curved_beam(point, section, offset, u, force, stiffness)
    type(curved_point), intent(in) :: point
    real(dp), intent(in) :: section(6, 6), offset(6), u(6, 3)
    real(dp), intent(inout) :: force(6, 3), stiffness(18, 18)
    complex(dp) :: moved(6, 3), forces(6, 3)
    integer :: i, k
    do k = 1, 3
      do i = 1, 6
        moved = u
        moved(i, k) = moved(i, k) + cmplx(0.0_dp, step, dp)
        forces = forces_of(point, section, offset, moved)
        stiffness(:, 6*(k - 1) + i) = stiffness(:, 6*(k - 1) + i) + reshape(aimag(forces), [18])/step
      end do
    end do
    ! the last step has not changed the real part
    force = force + real(forces, dp)
  end subroutine add_curved_beam

  pure function state_of(point, u) result(state)
    type(curved_point), intent(in) :: point
    complex(dp), intent(in) :: u(6, 3)
    type(state_t) :: state
    integer :: k
    do k = 1, 3
      state%node(:, :, k) = rotation_of(u(4:, k))
    end do
    do k = 1, 3, 2
      state%relative(:, k) = 2*half_turn(matmul(transpose(state%node(:, :, 2)), state%node(:, :, k)))
    end do
    state%h = matmul(state%relative, cmplx(point%n, kind=dp))
    state%h_slope = matmul(state%relative, cmplx(point%slope, kind=dp))
    state%turn = matmul(state%node(:, :, 2), rotation_of(state%h))
    state%along = matmul(transpose(state%turn), matmul(point%x + u(:3, :), cmplx(point%slope, kind=dp)))
    state%bent = spin(state%h, state%h_slope)
  end function state_of

  pure function forces_of(point, section, offset, u) result(force)
    type(curved_point), intent(in) :: point
    real(dp), intent(in) :: section(6, 6), offset(6)
    complex(dp), intent(in) :: u(6, 3)
    complex(dp) :: force(6, 3), strain(6), pull(3), moment(3), lever(3), by_turn(3), by_slope(3), of_node(3)
    type(state_t) :: state
    integer :: k
    state = state_of(point, u)
    strain = section_strains(point%axes, point%centre, state%along, state%bent)
    call section_work(point%axes, point%centre, matmul(section, strain) + offset, pull, moment)
    lever = cross(pull, state%along)
    do k = 1, 3
      force(:3, k) = point%slope(k)*matmul(state%turn, pull)
    end do
    force(4:, 2) = matmul(state%turn, lever)
    ! the curvature changes by the derivative of the spin along the axis and by the cross product of curvature and spin
    by_turn = spin_back(state%h, lever + cross(moment, state%bent)) + spin_back_slope(state%h, state%h_slope, moment)
    by_slope = spin_back(state%h, moment)
    do k = 1, 3, 2
      of_node = unspin_back(state%relative(:, k), point%n(k)*by_turn + point%slope(k)*by_slope)
      of_node = matmul(state%node(:, :, k), of_node)
      force(4:, k) = of_node
      force(4:, 2) = force(4:, 2) - of_node
    end do
    force = point%weight*force
  end function forces_of

  !> Spin of exp(h), in the directions that turn, by a change of h.
  pure function spin(h, change)
    complex(dp), intent(in) :: h(3), change(3)
    complex(dp) :: spin(3), square
    square = sum(h*h)
    spin = change - second(square)*cross(h, change) + third(square)*cross(h, cross(h, change))
  end function spin

  !> Its transpose.
  pure function spin_back(h, moment) result(back)
    complex(dp), intent(in) :: h(3), moment(3)
    complex(dp) :: back(3), square
    square = sum(h*h)
    back = moment + second(square)*cross(h, moment) + third(square)*cross(h, cross(h, moment))
  end function spin_back

  !> Derivative of that where h changes.
  pure function spin_back_slope(h, change, moment) result(back)
    complex(dp), intent(in) :: h(3), change(3), moment(3)
    complex(dp) :: back(3), square, rate
    square = sum(h*h)
    rate = 2*sum(h*change)
    back = second_slope(square)*rate*cross(h, moment) + second(square)*cross(change, moment) &
           + third_slope(square)*rate*cross(h, cross(h, moment)) &
           + third(square)*(cross(change, cross(h, moment)) + cross(h, cross(change, moment)))
  end function spin_back_slope

  !> Inverse of spin_back.
  pure function unspin_back(h, moment) result(back)
    complex(dp), intent(in) :: h(3), moment(3)
    complex(dp) :: back(3), square, factor
    square = sum(h*h)
    if (real(square, dp) < 1.0e-2_dp) then
      factor = (1 + square/60*(1 + square/42*(1 + square/40)))/12
    else
      factor = (1 - (1 - square*third(square))/(2*second(square)))/square
    end if
    back = moment - 0.5_dp*cross(h, moment) + factor*cross(h, cross(h, moment))
  end function unspin_back

  !> Derivative of `second` by the square.
  pure complex(dp) function second_slope(square)
    complex(dp), intent(in) :: square
    if (real(square, dp) < 1.0e-2_dp) then
      second_slope = -(1 - square/15*(1 - 3*square/112*(1 - 4*square/270)))/24
    else
      second_slope = (1 - square*third(square) - 2*second(square))/(2*square)
    end if
  end function second_slope

  !> Derivative of `third` by the square.
  pure complex(dp) function third_slope(square)
    complex(dp), intent(in) :: square
    if (real(square, dp) < 1.0e-2_dp) then
      third_slope = -(1 - square/21*(1 - square/48*(1 - 4*square/330)))/120
    else
      third_slope = (second(square) - 3*third(square))/(2*square)
    end if
  end function third_slope
end module host_beam_curved
