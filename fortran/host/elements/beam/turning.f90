! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Beams of two nodes in space in large rotations: the strains of J.C. Simo, Computer Methods in Applied Mechanics and Engineering
!> 49 (1985) 55, at the middle. Unknowns and moments are those of host_corotation: rotation vectors, and moments about the global
!> axes, whose derivative is that by a complex step, not symmetric where rotations are large. The vectors of
!> the nodes are total rotations: Newton adds its corrections to them.
!>
!> The nodes turn by Q1 and Q2. The section in the middle turns by R = Q1 exp(h), Q2 = R exp(h): its curvature and twist are 2 h
!> over the length, whatever turn both nodes have in common.
module host_beam_turning
  use host_corotation, only: rotation_of
  use host_kinds, only: dp
  use host_polar, only: cross, step
  implicit none (type, external)
  private
  public :: turning_beam, turning_strains, half_turn, second, section_strains, section_work, third

contains

  !> Strains of the section, as host_beam has them, and its directions now.
  pure subroutine turning_strains(x, axes, centre, u, strain, turned)
    real(dp), intent(in) :: x(3, 2), axes(3, 3), centre(2, 2)   !< axes: columns t, 1, 2
    complex(dp), intent(in) :: u(6, 2)
    complex(dp), intent(out) :: strain(6)
    real(dp), intent(out) :: turned(3, 3)
    real(dp), parameter :: nothing(6) = 0, none(6, 6) = 0
    complex(dp) :: forces(6, 2), turn(3, 3)
    call respond_to(x, axes, centre, none, nothing, u, strain, forces, turn)
    turned = matmul(real(turn, dp), axes)
  end subroutine turning_strains

  !> Forces of the nodes and their stiffness, where the forces of the section are linear in its strains, but for an offset.
  pure subroutine turning_beam(x, axes, centre, section, offset, u, force, stiffness)
    real(dp), intent(in) :: x(3, 2), axes(3, 3), centre(2, 2), section(6, 6), offset(6), u(6, 2)
    real(dp), intent(out) :: force(6, 2), stiffness(12, 12)
    complex(dp) :: moved(6, 2), strains(6), forces(6, 2), turn(3, 3)
    integer :: i, k
    do k = 1, 2
      do i = 1, 6
        moved = u
        moved(i, k) = moved(i, k) + cmplx(0.0_dp, step, dp)
        call respond_to(x, axes, centre, section, offset, moved, strains, forces, turn)
        stiffness(:, 6*(k - 1) + i) = reshape(aimag(forces), [12])/step
      end do
    end do
    ! the last step has not changed the real part
    force = real(forces, dp)
  end subroutine turning_beam

  pure subroutine respond_to(x, axes, centre, section, offset, u, strain, force, turn)
    real(dp), intent(in) :: x(3, 2), axes(3, 3), centre(2, 2), section(6, 6), offset(6)
    complex(dp), intent(in) :: u(6, 2)
    complex(dp), intent(out) :: strain(6), force(6, 2)
    complex(dp), intent(out) :: turn(3, 3)     !< rotation of the section
    complex(dp) :: first(3, 3), half(3), bent(3), along(3), pull(3), moment(3), lever(3), square, ratio
    real(dp) :: length
    length = norm2(x(:, 2) - x(:, 1))
    first = rotation_of(u(4:, 1))
    half = half_turn(matmul(transpose(first), rotation_of(u(4:, 2))))
    turn = matmul(first, rotation_of(half))
    along = matmul(transpose(turn), x(:, 2) + u(:3, 2) - x(:, 1) - u(:3, 1))/length
    bent = 2*half/length
    strain = section_strains(axes, centre, along, bent)
    call section_work(axes, centre, matmul(section, strain) + offset, pull, moment)
    ! how the section in the middle turns with the nodes: by the mean of their spins, less second(half) half x (change of half)
    lever = length*cross(pull, along)
    square = sum(half*half)
    moment = 2*moment + second(square)*cross(half, lever)
    ! what the change of half is by the difference of the spins
    ratio = 1 - square*third(square)
    moment = 0.5_dp*(moment - third(square)*sum(half*moment)*half)/ratio
    force(:3, 2) = matmul(turn, pull)
    force(:3, 1) = -force(:3, 2)
    force(4:, 2) = matmul(turn, 0.5_dp*lever + moment)
    force(4:, 1) = matmul(turn, 0.5_dp*lever - moment)
  end subroutine respond_to

  !> Strains of the section by the tangent of the axis and the curvature, both in the directions of the start.
  pure function section_strains(axes, centre, along, bent) result(strain)
    real(dp), intent(in) :: axes(3, 3), centre(2, 2)
    complex(dp), intent(in) :: along(3), bent(3)
    complex(dp) :: strain(6)
    associate (t => axes(:, 1), one => axes(:, 2), two => axes(:, 3))
      strain = [sum(along*t) - 1, sum(along*two), sum(along*one), sum(bent*one), sum(bent*two), sum(bent*t)]
    end associate
    strain(1) = strain(1) + centre(2, 1)*strain(4) - centre(1, 1)*strain(5)
    strain(2) = strain(2) + centre(1, 2)*strain(6)
    strain(3) = strain(3) - centre(2, 2)*strain(6)
  end function section_strains

  !> What does work on that tangent and on that curvature.
  pure subroutine section_work(axes, centre, forces, pull, moment)
    real(dp), intent(in) :: axes(3, 3), centre(2, 2)
    complex(dp), intent(in) :: forces(6)
    complex(dp), intent(out) :: pull(3), moment(3)
    associate (t => axes(:, 1), one => axes(:, 2), two => axes(:, 3))
      pull = forces(1)*t + forces(2)*two + forces(3)*one
      moment = (forces(4) + centre(2, 1)*forces(1))*one + (forces(5) - centre(1, 1)*forces(1))*two &
               + (forces(6) + centre(1, 2)*forces(2) - centre(2, 2)*forces(3))*t
    end associate
  end subroutine section_work

  !> Half of the rotation vector of a rotation of less than 180 degrees.
  pure function half_turn(rotation) result(half)
    complex(dp), intent(in) :: rotation(3, 3)
    complex(dp) :: half(3)
    half = 0.5_dp*[rotation(3, 2) - rotation(2, 3), rotation(1, 3) - rotation(3, 1), rotation(2, 1) - rotation(1, 2)]
    ! sine of half the angle, by that of the angle and the cosine of half of it
    half = half/sqrt(1 + rotation(1, 1) + rotation(2, 2) + rotation(3, 3))
    half = half*arc(sum(half*half))
  end function half_turn

  !> asin(s)/s by the square of s; the complex function keeps no imaginary part as small as the step.
  pure complex(dp) function arc(square)
    complex(dp), intent(in) :: square
    real(dp) :: s, value, slope
    s = real(square, dp)
    if (s < 1.0e-3_dp) then
      value = 1 + s/6*(1 + s*9/20*(1 + s*25/42*(1 + s*49/72)))
      slope = (1 + s*9/10*(1 + s*25/28*(1 + s*49/54)))/6
    else
      value = asin(sqrt(s))/sqrt(s)
      slope = 0.5_dp*(1/sqrt(1 - s) - value)/s
    end if
    arc = cmplx(value, slope*aimag(square), dp)
  end function arc

  !> (1 - cos a)/a^2 by the square of a.
  pure complex(dp) function second(square)
    complex(dp), intent(in) :: square
    if (real(square, dp) < 1.0e-2_dp) then
      second = 0.5_dp*(1 - square/12*(1 - square/30*(1 - square/56*(1 - square/90))))
    else
      second = (1 - cos(sqrt(square)))/square
    end if
  end function second

  !> (a - sin a)/a^3 by the square of a.
  pure complex(dp) function third(square)
    complex(dp), intent(in) :: square
    if (real(square, dp) < 1.0e-2_dp) then
      third = (1 - square/20*(1 - square/42*(1 - square/72*(1 - square/110))))/6
    else
      third = (1 - sin(sqrt(square))/sqrt(square))/square
    end if
  end function third
end module host_beam_turning
