! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Directions of *ORIENTATION at the points of continuum elements, for materials whose stress, strain and history are in them.
!>
!> With large displacements they turn in each increment with the rotation of the polar decomposition of its deformation gradient
!> (Theory Guide, State storage), so UMAT gets no DROT but the identity. DFGRD0 and DFGRD1 have the components of the deformation
!> gradient along the directions of their time, on both sides (D.R. Nolan, C. Lally, J.P. McGarry, J. of the Mechanical Behavior of
!> Biomedical Materials 126 (2022) 104940, print what Abaqus passes). The manual does not say how the strain of the increment,
!> that of its middle, gets into these directions: here, by its components along those of the middle, turned with the mean of the
!> identity and the deformation gradient of the increment. So rotation and stretch in an increment interact to the second order of
!> its size only.
module host_axes
  use core_rotation, only: polar_rotation
  use core_small_matrix, only: invert
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_kinematics, only: rotated
  use host_point, only: heat_t, point_t
  use host_protect, only: escape
  implicit none (type, external)
  private
  public :: carry_axes, turn_heat, values_of_axes, turn_matrix

  !> Values of SVARS for the directions of a point, as rows: at the start of the analysis, and now.
  integer, parameter :: values_of_axes = 18

  real(dp), parameter :: identity(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])

contains

  !> Directions at the end and in the middle of an increment, as rows; those at its end are kept. The point gets the components of
  !> the deformation gradients along the directions of their time, and no rotation. Leaves the pass if it is inside out.
  subroutine carry_axes(point, deformation, axes, middle)
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: deformation(3, 3, 2)     !< gradients at both ends of the increment
    real(dp), intent(inout) :: axes(3, 3)            !< at the start of the increment, then at its end
    real(dp), intent(out) :: middle(3, 3)
    real(dp) :: step(3, 3), inverse(3, 3), determinant
    call invert(3, deformation(:, :, 1), inverse, determinant)
    step = matmul(deformation(:, :, 2), inverse)
    middle = turned_axes(int(point%number), 0.5_dp*(identity + step), axes)
    point%deformation(:, :, 1) = matmul(axes, matmul(deformation(:, :, 1), transpose(axes)))
    axes = turned_axes(int(point%number), step, axes)
    point%deformation(:, :, 2) = matmul(axes, matmul(deformation(:, :, 2), transpose(axes)))
    point%rotation = identity
  end subroutine carry_axes

  !> Directions turned with a deformation.
  function turned_axes(point, deformation, start) result(axes)
    integer, intent(in) :: point
    real(dp), intent(in) :: deformation(3, 3), start(3, 3)
    real(dp) :: axes(3, 3), rotation(3, 3)
    logical :: good
    call polar_rotation(deformation, rotation, good)
    if (.not. good) then
      current%distorted = point
      call escape()
    end if
    axes = matmul(start, transpose(rotation))
  end function turned_axes

  !> (n, n) matrix from strains in global directions to those in the directions of axes (rows); stresses go back by its transpose.
  pure function turn_matrix(n, axes) result(turn)
    integer, intent(in) :: n                !< components, as rotated has them
    real(dp), intent(in) :: axes(3, 3)
    real(dp) :: turn(n, n), unit(n)
    integer :: k
    do k = 1, n
      unit = 0
      unit(k) = 1
      turn(:, k) = rotated(n, unit, axes, 2.0_dp)
    end do
  end function turn_matrix

  !> Derivatives of the heat terms of UMAT, from its directions to global ones.
  subroutine turn_heat(n, axes, heat)
    integer, intent(in) :: n                !< stress components
    real(dp), intent(in) :: axes(3, 3)
    type(heat_t), intent(inout) :: heat
    real(dp) :: back(n, n)
    back = transpose(turn_matrix(n, axes))
    heat%stress_by_temperature(:n) = matmul(back, heat%stress_by_temperature(:n))
    heat%source_by_strain(:n) = matmul(back, heat%source_by_strain(:n))
  end subroutine turn_heat
end module host_axes
