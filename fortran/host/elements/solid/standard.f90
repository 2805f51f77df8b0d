! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Kinematics of continuum elements whose strains are those of the displacements of their nodes.
!>
!> In large displacements the strain of the increment and its gradient are those of its middle.
module host_standard_kinematics
  use host_forces, only: add_geometric_of => add_geometric
  use host_gradients, only: all_gradients, find_deformation, gradient_of
  use host_kinds, only: dp
  use host_solid_element, only: solid_t
  use host_solid_kinematics, only: kinematics_t, make_room, strain_by
  implicit none (type, external)
  private
  public :: standard_t

  type, extends(kinematics_t) :: standard_t
    real(dp), allocatable :: g_mid(:, :, :), b_mid(:, :, :)   !< as g and b, in the middle of the increment
  contains
    procedure :: prepare
    procedure :: find_strain
    procedure :: add_geometric
    procedure, non_overridable :: make_middle
  end type standard_t

contains

  subroutine prepare(this, element)
    class(standard_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    real(dp) :: unused(element%rule%points)
    call make_room(this, element)
    this%now = element%x
    if (element%finite) this%now = element%x + element%u
    associate (rule => element%rule, direct => element%direct, strains => element%strains)
      call all_gradients(rule, direct, strains, this%averaged, this%now, this%g, this%b, this%volume)
      if (element%finite) then
        call this%make_middle()
        call all_gradients(rule, direct, strains, this%averaged, this%now - 0.5_dp*element%du, this%g_mid, this%b_mid, unused)
      end if
    end associate
    this%volume_now = this%volume
    if (.not. element%finite) this%volume_before = this%volume
    if (element%finite .and. element%deforms) then
      call find_deformation(element%rule, element%direct, this%averaged, element%x, element%u, element%du, this%deformation, &
                            this%volume_before)
    end if
  end subroutine prepare

  !> Make the arrays of the middle as large as those of the end.
  subroutine make_middle(this)
    class(standard_t), intent(inout) :: this
    if (allocated(this%b_mid)) then
      if (all(shape(this%b_mid) == shape(this%b)) .and. all(shape(this%g_mid) == shape(this%g))) return
      deallocate (this%g_mid, this%b_mid)
    end if
    allocate (this%g_mid, mold=this%g)
    allocate (this%b_mid, mold=this%b)
  end subroutine make_middle

  subroutine find_strain(this, element, p, b, strain)
    class(standard_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(in) :: b(element%n + this%others, element%strains)
    real(dp), intent(out) :: strain(element%strains)
    if (element%finite) then
      this%gradient = gradient_of(element%dim, element%direct, element%nodes, element%du, this%g_mid(:, :, p))
      call strain_by(element%n, element%strains, this%b_mid(:, :, p), element%du, strain)
    else
      call strain_by(element%n, element%strains, this%b(:, :, p), element%u, strain)
    end if
  end subroutine find_strain

  subroutine add_geometric(this, element, p, b, stress, weight, modulus, stiffness)
    class(standard_t), intent(in) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(in) :: b(element%n + this%others, element%strains), stress(element%strains), weight
    real(dp), intent(inout) :: modulus(element%strains, element%strains)
    real(dp), intent(inout) :: stiffness(element%n + this%others, element%n + this%others)
    call add_geometric_of(element%dim, element%direct, element%strains, element%nodes, this%g(:, :, p), stress, weight, modulus, &
                          stiffness)
  end subroutine add_geometric
end module host_standard_kinematics
