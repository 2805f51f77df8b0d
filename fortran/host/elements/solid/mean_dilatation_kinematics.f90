! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Kinematics of fully integrated elements with straight edges (CPE4, CAX4, C3D8), which would lock where the volume is preserved:
!> the volume strain of their points is its mean over the element. host_gradients averages deformation gradients,
!> core_mean_dilatation the strain matrix (B-bar).
!>
!> Of hyperelastic materials the points share the change of the whole volume, so that forces are derivatives of the strain energy.
module host_mean_dilatation
  use host_kinds, only: dp
  use host_mean_dilatation_tangent, only: add_mean_volume
  use host_solid_element, only: solid_t
  use host_standard_kinematics, only: standard_t
  implicit none (type, external)
  private
  public :: mean_dilatation_t

  type, extends(standard_t) :: mean_dilatation_t
    real(dp), allocatable :: stress(:, :)    !< (strains, points) of hyperelastic materials in large displacements
  contains
    procedure :: prepare
    procedure :: add_tangent
    procedure :: finish
  end type mean_dilatation_t

contains

  subroutine prepare(this, element)
    class(mean_dilatation_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    this%averaged = .true.
    call this%standard_t%prepare(element)
    if (shares_volume(element)) this%volume = this%volume_before*sum(this%volume)/sum(this%volume_before)
  end subroutine prepare

  !> Whether the points share the change of the volume.
  pure logical function shares_volume(element)
    type(solid_t), intent(in) :: element
    shares_volume = element%finite .and. allocated(element%material%hyperelastic)
  end function shares_volume

  subroutine add_tangent(this, element, p, b, stress, weight, modulus, stiffness)
    class(mean_dilatation_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(in) :: b(element%n + this%others, element%strains), stress(element%strains), weight
    real(dp), intent(inout) :: modulus(element%strains, element%strains)
    real(dp), intent(inout) :: stiffness(element%n + this%others, element%n + this%others)
    call this%standard_t%add_tangent(element, p, b, stress, weight, modulus, stiffness)
    if (.not. shares_volume(element)) return
    if (p == 1) this%stress = spread(stress, 2, element%rule%points)
    this%stress(:, p) = stress
  end subroutine add_tangent

  subroutine finish(this, element, stiffness)
    class(mean_dilatation_t), intent(in) :: this
    type(solid_t), intent(in) :: element
    real(dp), intent(inout) :: stiffness(element%n + this%others, element%n + this%others)
    if (.not. shares_volume(element)) return
    call add_mean_volume(element%dim, element%direct, element%strains, element%nodes, element%rule%points, this%g, this%b, &
                         this%stress, this%volume*element%depth, this%volume_now, stiffness)
  end subroutine finish
end module host_mean_dilatation
