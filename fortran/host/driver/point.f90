! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> A material point of a built-in element: what the element tells its material and the user routines, and what they return beside
!> stress and tangent.
!>
!> An element has one `point_t`, which it moves from point to point; components that it does not set keep their defaults.
module host_point
  use host_context, only: current
  use host_kinds, only: dp, i4
  implicit none (type, external)
  private
  public :: fields_at_end, heat_t, move_to, npt_of, point_t, prepare_fields

  !> Heat terms of UMAT at the end of the increment, and of UHARD the last one; directions of the stresses, engineering shear
  !> strains.
  type :: heat_t
    real(dp) :: source = 0                   !< RPL, heat generated per volume and time
    real(dp) :: source_by_temperature = 0    !< DRPLDT
    real(dp) :: source_by_strain(6) = 0      !< DRPLDE
    real(dp) :: stress_by_temperature(6) = 0 !< DDSDDT
  end type heat_t

  type :: point_t
    ! where it is
    integer(i4) :: number = 0     !< in the history of the element, from 1
    integer(i4) :: npt = 0        !< of shells and layers: integration point; 0 elsewhere, where it is the number
    integer(i4) :: layer = 1
    integer(i4) :: kspt = 1       !< section point of the layer
    real(dp) :: place(3) = 0      !< coordinates
    real(dp) :: length = 0        !< characteristic length of the element
    real(dp), pointer, contiguous :: history(:) => null()        !< committed; null without a history
    real(dp), pointer, contiguous :: history_trial(:) => null()  !< of this call
    ! temperature and fields: (fields, 2) at the start of the increment, increments; null without any
    real(dp), pointer, contiguous :: fields(:, :) => null()
    ! large displacements: the next three are those of the point
    logical :: finite = .false.
    real(dp) :: rotation(3, 3) = 0         !< of the increment
    real(dp) :: deformation(3, 3, 2) = 0   !< deformation gradients at its start and end
    real(dp) :: turn(3, 3) = 0    !< from the directions of the material at the start of the job to those of these gradients
    ! hybrid elements: the mean stress is given
    logical :: hybrid = .false.
    real(dp) :: mean_stress = 0
    ! of its material
    real(dp) :: energy = 0        !< strain energy per volume now of a hyperelastic point
    real(dp) :: dissipated = 0    !< energy per volume now that its networks dissipate in the increment
    type(heat_t) :: heat          !< of the last call of UMAT or UHARD
  end type point_t

  ! temperature and fields of the point of this thread: a call that is left leaks nothing
  real(dp), allocatable, target, save :: room(:, :)
  !$omp threadprivate(room)

contains

  !> Move to the point with a number, and to its history.
  subroutine move_to(point, number)
    type(point_t), intent(inout) :: point
    integer, intent(in) :: number              !< from 1
    point%number = int(number, i4)
    point%history => null()
    point%history_trial => null()
    if (.not. associated(current%history)) return
    if (number < 1 .or. number > size(current%history, 2)) return
    point%history => current%history(:, number)
    point%history_trial => current%history_trial(:, number)
  end subroutine move_to

  !> NPT of user routines.
  pure integer(i4) function npt_of(point)
    type(point_t), intent(in) :: point
    npt_of = merge(point%npt, point%number, point%npt > 0)
  end function npt_of

  !> Give the point a temperature and fields, which are zero.
  subroutine prepare_fields(point, count)
    type(point_t), intent(inout) :: point
    integer, intent(in) :: count               !< of the temperature and the fields
    if (allocated(room)) then
      if (size(room, 1) /= count) deallocate (room)
    end if
    if (.not. allocated(room)) allocate (room(count, 2))
    room = 0
    point%fields => room
  end subroutine prepare_fields

  !> Temperature and fields at the end of the increment, and their increments; zero and none without any.
  subroutine fields_at_end(point, temperature, its_change, fields, their_changes)
    type(point_t), intent(in) :: point
    real(dp), intent(out) :: temperature, its_change
    real(dp), allocatable, intent(out) :: fields(:), their_changes(:)
    temperature = 0
    its_change = 0
    if (associated(point%fields)) then
      temperature = sum(point%fields(1, :))
      its_change = point%fields(1, 2)
      fields = sum(point%fields(2:, :), 2)
      their_changes = point%fields(2:, 2)
    else
      allocate (fields(0), their_changes(0))
    end if
  end subroutine fields_at_end
end module host_point
