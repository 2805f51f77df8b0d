! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Kinematics of elements with straight edges and reduced integration (CPS4R, CPE4R, CAX4R, C3D8R): the uniform strain of one point,
!> or of one in each layer, which needs hourglass control (host_hourglass).
module host_uniform_kinematics
  use host_gradients, only: carry, gradients_of_points
  use host_kinds, only: dp
  use host_kinematics, only: mean_gradients
  use host_mean_dilatation_tangent, only: add_uniform_volume
  use host_solid_element, only: solid_t
  use host_solid_kinematics, only: kinematics_t
  use host_standard_kinematics, only: standard_t
  implicit none (type, external)
  private
  public :: uniform_t, find_start

  type, extends(standard_t) :: uniform_t
  contains
    procedure :: prepare
    procedure :: add_tangent
  end type uniform_t

contains

  subroutine prepare(this, element)
    class(uniform_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    real(dp) :: g_before(element%nodes, element%direct, element%rule%points)
    integer :: p
    call this%standard_t%prepare(element)
    call find_start(this, element, g_before)
    if (.not. element%finite .or. element%direct < 3) return
    do p = 1, element%rule%points
      associate (dim => element%dim, direct => element%direct, strains => element%strains, nodes => element%nodes)
        call carry(dim, direct, strains, nodes, g_before(:, :, p), element%u, this%g(:, :, p), this%b(:, :, p))
        call carry(dim, direct, strains, nodes, g_before(:, :, p), element%u - 0.5_dp*element%du, this%g_mid(:, :, p), &
                   this%b_mid(:, :, p))
      end associate
    end do
  end subroutine prepare

  !> Gradients and volumes before any displacement, and the mean ones of the element.
  subroutine find_start(this, element, g_before)
    class(kinematics_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    real(dp), intent(out) :: g_before(element%nodes, element%direct, element%rule%points)
    if (element%finite) then
      g_before = 0
      call gradients_of_points(element%rule, element%flat, element%x, g_before(:, :element%flat, :), this%volume_before)
    else
      g_before = this%g
    end if
    this%g_start = g_before(:, :, 1)
    this%volume_start = this%volume_before(1)
    if (element%rule%points > 1) then
      call mean_gradients(element%rule%family, element%direct, element%x, this%g_start, this%volume_start)
    end if
  end subroutine find_start

  !> The tangent of a hyperelastic material, and that of a given pressure, has the second derivatives of the whole volume.
  subroutine add_tangent(this, element, p, b, stress, weight, modulus, stiffness)
    class(uniform_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(in) :: b(element%n + this%others, element%strains), stress(element%strains), weight
    real(dp), intent(inout) :: modulus(element%strains, element%strains)
    real(dp), intent(inout) :: stiffness(element%n + this%others, element%n + this%others)
    call this%standard_t%add_tangent(element, p, b, stress, weight, modulus, stiffness)
    if (.not. (allocated(element%here%hyperelastic) .or. element%hybrid)) return
    call add_uniform_volume(element%rule%family, element%direct, element%strains, this%now, this%g(:, :, p), this%b(:, :, p), &
                            stress, weight, element%depth, stiffness)
  end subroutine add_tangent
end module host_uniform_kinematics
