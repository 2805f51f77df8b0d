! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Large rotations of shells whose strains are small: the shell moves with its element, and deforms in axes that turn with it.
!>
!> The element turns by R, the rotation in the polar decomposition of the mean deformation of its middle surface. What its nodes do
!> beside that is small (C.C. Rankin, F.A. Brogan, J. Pressure Vessel Technology 108 (1986) 165; C.A. Felippa, B. Haugen, Computer
!> Methods in Applied Mechanics and Engineering 194 (2005) 2285):
!>
!>     displacements  R'(x - mean x) - (X - mean X),    rotations  f(s.s) s,  s = axial(R' Q) = sin(angle) axis
!>
!> with Q = exp(rotation vector), the unknowns of a node, and f(square of the sine) = angle/sine, a series. Their work gives the
!> forces of the nodes, and their moments about the global axes, as Abaqus has them in *CLOAD and RM. The derivative by the unknowns
!> is that by a complex step: it includes all that the turning adds to the stiffness. Since a moment is no derivative by the
!> rotation vector, it is not symmetric where rotations are large.
module host_corotation
  use host_kinds, only: dp
  use host_polar, only: cross, polar_axes, step
  implicit none (type, external)
  private
  public :: corotation_t, local_motion, rotation_of, turn_back

  !> Where an element is: components of local and global axes are those of the axes at the start.
  type :: corotation_t
    complex(dp), allocatable :: local(:, :)       !< (6, nodes) displacements and rotations less those of the element
    complex(dp), allocatable :: arm(:, :)         !< (3, nodes) from the middle to the nodes, in local axes
    complex(dp), allocatable :: nodal(:, :, :)    !< (3, 3, nodes) R' Q
    complex(dp), allocatable :: sine(:, :)        !< (3, nodes) s
    complex(dp) :: rotation(3, 3) = 0             !< R
    complex(dp) :: stretch(3) = 0                 !< 11, 22 and 12 of the mean deformation
  end type corotation_t

  !> Of asin(s)/s by the square of s: to 1e-4 for 40 degrees between a node and its element.
  real(dp), parameter :: series(4) = [1.0_dp/6, 3.0_dp/40, 5.0_dp/112, 35.0_dp/1152]

contains

  !> Motion of an element without its rotation. frame: rows, axes of the middle surface at the start; gradient: of the nodes'
  !> shape functions along its first two, in the middle.
  pure function local_motion(nodes, x, frame, gradient, u) result(found)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(3, nodes), frame(3, 3), gradient(nodes, 2)
    complex(dp), intent(in) :: u(6, nodes)
    type(corotation_t) :: found
    complex(dp) :: now(3, nodes), along(3, 2), axes(3, 3)
    integer :: k
    allocate (found%local(6, nodes), found%arm(3, nodes), found%nodal(3, 3, nodes), found%sine(3, nodes))
    now = x + u(:3, :)
    along = matmul(now, gradient)
    axes = polar_axes(along)
    found%stretch = [sum(along(:, 1)*axes(:, 1)), sum(along(:, 2)*axes(:, 2)), sum(along(:, 1)*axes(:, 2))]
    found%rotation = matmul(axes, frame)
    found%arm = matmul(transpose(found%rotation), now - spread(sum(now, 2)/nodes, 2, nodes))
    found%local(:3, :) = found%arm - (x - spread(sum(x, 2)/nodes, 2, nodes))
    do k = 1, nodes
      found%nodal(:, :, k) = matmul(transpose(found%rotation), rotation_of(u(4:, k)))
      associate (q => found%nodal(:, :, k))
        found%sine(:, k) = 0.5_dp*[q(3, 2) - q(2, 3), q(1, 3) - q(3, 1), q(2, 1) - q(1, 2)]
      end associate
      found%local(4:, k) = found%sine(:, k)*angle_over_sine(sum(found%sine(:, k)**2))
    end do
  end function local_motion

  !> Forces and stiffness by the local motion, to those by the displacements and rotation vectors of the nodes.
  pure subroutine turn_back(nodes, x, frame, gradient, u, force, stiffness)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(3, nodes), frame(3, 3), gradient(nodes, 2), u(6, nodes)
    real(dp), intent(inout) :: force(6, nodes), stiffness(6*nodes, 6*nodes)
    type(corotation_t) :: at
    complex(dp) :: moved(6, nodes), pushed(6, nodes)
    real(dp) :: given(6*nodes), turned(6*nodes, 6*nodes)
    integer :: i, k
    given = reshape(force, [6*nodes])
    do k = 1, nodes
      do i = 1, 6
        moved = u
        moved(i, k) = moved(i, k) + cmplx(0.0_dp, step, dp)
        at = local_motion(nodes, x, frame, gradient, moved)
        associate (change => reshape(aimag(at%local), [6*nodes]))
          pushed = reshape(cmplx(given, matmul(stiffness, change), dp), [6, nodes])
        end associate
        pushed = spatial(nodes, frame, gradient, at, pushed)
        turned(:, 6*(k - 1) + i) = reshape(aimag(pushed), [6*nodes])/step
      end do
    end do
    stiffness = turned
    ! the last step has not changed the real part
    force = real(pushed, dp)
  end subroutine turn_back

  !> Forces and moments about the global axes by those that do work on the local motion.
  pure function spatial(nodes, frame, gradient, at, local) result(force)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: frame(3, 3), gradient(nodes, 2)
    type(corotation_t), intent(in) :: at
    complex(dp), intent(in) :: local(6, nodes)
    complex(dp) :: force(6, nodes), moment(3), mean(3), by_turn(3), bent(2), determinant, square
    integer :: k
    mean = sum(local(:3, :), 2)/nodes
    by_turn = 0
    do k = 1, nodes
      ! by the sines
      square = sum(at%sine(:, k)**2)
      moment = angle_over_sine(square)*local(4:, k) + 2*slope(square)*sum(at%sine(:, k)*local(4:, k))*at%sine(:, k)
      ! by a turn of the node, which changes the skew part of its matrix
      moment = 0.5_dp*(trace(at%nodal(:, :, k))*moment - matmul(transpose(at%nodal(:, :, k)), moment))
      force(4:, k) = matmul(at%rotation, moment)
      by_turn = by_turn - moment - cross(at%arm(:, k), local(:3, k))
    end do
    ! by a turn of the element, in its axes: what the nodes move it by
    by_turn = matmul(frame, by_turn)
    associate (s => at%stretch)
      determinant = s(1)*s(2) - s(3)**2
      ! inverse of the stretch
      bent = [s(2)*by_turn(2) + s(3)*by_turn(1), -s(3)*by_turn(2) - s(1)*by_turn(1)]/determinant
    end associate
    do k = 1, nodes
      force(:3, k) = -matmul(transpose(frame), [ &
                             by_turn(3)*gradient(k, 2)/(at%stretch(1) + at%stretch(2)), &
                             -by_turn(3)*gradient(k, 1)/(at%stretch(1) + at%stretch(2)), &
                             bent(1)*gradient(k, 1) + bent(2)*gradient(k, 2)])
      force(:3, k) = matmul(at%rotation, force(:3, k) + local(:3, k) - mean)
    end do
  end function spatial

  !> f, by the square of the sine.
  pure complex(dp) function angle_over_sine(square)
    complex(dp), intent(in) :: square
    angle_over_sine = 1 + square*(series(1) + square*(series(2) + square*(series(3) + square*series(4))))
  end function angle_over_sine

  !> Its derivative.
  pure complex(dp) function slope(square)
    complex(dp), intent(in) :: square
    slope = series(1) + square*(2*series(2) + square*(3*series(3) + square*4*series(4)))
  end function slope

  !> Rotation by a rotation vector (O. Rodrigues).
  pure function rotation_of(vector) result(rotation)
    complex(dp), intent(in) :: vector(3)
    complex(dp) :: rotation(3, 3), square, angle, first, second, skew(3, 3)
    integer :: i
    square = sum(vector*vector)
    if (real(square, dp) < 1.0e-4_dp) then
      first = 1 - square/6*(1 - square/20*(1 - square/42))
      second = 0.5_dp - square/24*(1 - square/30*(1 - square/56))
    else
      angle = sqrt(square)
      first = sin(angle)/angle
      second = 0.5_dp*(sin(angle/2)/(angle/2))**2
    end if
    skew = 0
    skew(2:3, 1) = [vector(3), -vector(2)]
    skew([1, 3], 2) = [-vector(3), vector(1)]
    skew(:2, 3) = [vector(2), -vector(1)]
    rotation = first*skew + second*matmul(skew, skew)
    do i = 1, 3
      rotation(i, i) = rotation(i, i) + 1
    end do
  end function rotation_of

  pure complex(dp) function trace(a)
    complex(dp), intent(in) :: a(3, 3)
    trace = a(1, 1) + a(2, 2) + a(3, 3)
  end function trace
end module host_corotation
