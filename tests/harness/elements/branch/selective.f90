! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Kinematics with selective reduced integration: the volume strain of all points is that in the middle of the element.
module host_selective
  use core_mean_dilatation, only: set_volume_strain
  use core_strains, only: strain_matrix
  use host_kinds, only: dp
  use host_kinematics, only: gradients
  use host_shape, only: rule_of
  use host_solid_element, only: solid_t
  use host_standard_kinematics, only: standard_t
  implicit none (type, external)
  private
  public :: selective_t

  type, extends(standard_t) :: selective_t
  contains
    procedure :: prepare
  end type selective_t

contains

  subroutine prepare(this, element)
    class(selective_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    call this%standard_t%prepare(element)
    call take_middle(element, this%now, this%b)
    if (element%finite) call take_middle(element, this%now - 0.5_dp*element%du, this%b_mid)
  end subroutine prepare

  !> Replace the volume strains by that in the middle.
  subroutine take_middle(element, x, b)
    type(solid_t), intent(in) :: element
    real(dp), intent(in) :: x(element%dim, element%nodes)
    real(dp), intent(inout) :: b(element%n, element%strains, element%rule%points)
    real(dp) :: g(element%nodes, element%direct), middle(element%n, element%strains), volume
    integer :: p
    call gradients(rule_of(element%rule%family, 1), element%direct, 1, x, g, volume)
    call strain_matrix(element%dim, element%direct, element%nodes, g, middle)
    do p = 1, element%rule%points
      call set_volume_strain(element%direct, element%n, element%strains, sum(middle(:, :element%direct), 2), b(:, :, p))
    end do
  end subroutine take_middle
end module host_selective
