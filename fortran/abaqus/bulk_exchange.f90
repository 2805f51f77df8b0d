! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The shared module of the paper's section 3.1: what the continuum elements next to an interface (U1, U9 with FACE) store for the
!> stabilised interface elements that share their stress (U3, U10), by element number.
!>
!> It holds the last evaluation of each of them, so they must be called before the interface element in every
!> iteration (lower element numbers), on one thread and in one process.
module abaqus_bulk_exchange
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: bulk_record, records
  public :: store_bulk, slot_of_bulk, clear_bulk_records

  !> Last evaluation of an element, in space; in the plane third components are zero. Stresses are nominal ones, which take the
  !> original normal to the traction per original area: with large rotations Q sigma, to the first order of the strain.
  type :: bulk_record
    integer :: dimension = 0, face = 0
    real(dp) :: coordinates(3, 4) = 0.0_dp        !< original, of the nodes of the face
    real(dp) :: displacement(3, 4) = 0.0_dp
    real(dp) :: middle(3) = 0.0_dp                !< mean of the original coordinates of all its nodes
    real(dp) :: measure = 0.0_dp                  !< area or volume
    real(dp) :: norm = 0.0_dp                     !< |D| of its stiffness
    real(dp) :: gauss_stress(3, 3, 4) = 0.0_dp    !< of its Gauss points next to the nodes of the face
    real(dp) :: face_stress(3, 3, 9) = 0.0_dp     !< at the places of elements_solid_faces
  end type bulk_record

  type(bulk_record), allocatable, protected :: records(:)
  integer, allocatable :: slots(:)
  integer :: used = 0

contains

  !> Slot of an element in `records`, 0 if it has stored nothing.
  function slot_of_bulk(jelem) result(slot)
    integer, intent(in) :: jelem
    integer :: slot

    slot = 0
    if (.not. allocated(slots)) return
    if (jelem >= 1 .and. jelem <= size(slots)) slot = slots(jelem)
  end function slot_of_bulk

  !> Keeps the record of an element; storage grows with the largest element number and the number of records.
  subroutine store_bulk(jelem, record)
    integer, intent(in) :: jelem
    type(bulk_record), intent(in) :: record

    call make_room(jelem)
    if (slots(jelem) == 0) then
      used = used + 1
      slots(jelem) = used
    end if
    records(slots(jelem)) = record
  end subroutine store_bulk

  !> Makes sure that element number jelem has an entry in `slots` and that one more record fits.
  subroutine make_room(jelem)
    integer, intent(in) :: jelem
    type(bulk_record), allocatable :: more_records(:)
    integer, allocatable :: more_slots(:)

    if (.not. allocated(slots)) then
      allocate (slots(1000), records(100))
      slots = 0
    end if
    if (jelem > size(slots)) then
      allocate (more_slots(2*jelem))
      more_slots(1:size(slots)) = slots
      more_slots(size(slots) + 1:) = 0
      call move_alloc(more_slots, slots)
    end if
    if (used == size(records)) then
      allocate (more_records(2*used))
      more_records(1:used) = records
      call move_alloc(more_records, records)
    end if
  end subroutine make_room

  !> Forgets everything, at the start and the end of an analysis.
  subroutine clear_bulk_records()
    if (allocated(slots)) deallocate (slots, records)
    used = 0
  end subroutine clear_bulk_records

end module abaqus_bulk_exchange
