! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> One message in a job about temperatures that change at a self-contained interface element: the traction of its quads or bricks
!> is that of their displacements, without thermal strains.
!>
!> Whether the plies expand is not among the properties, so this is a warning. As in `abaqus_long_elements`, several threads may
!> send it once each, and the flag is set after the message.
module abaqus_temperatures
  use core_kinds, only: dp
  use abaqus_layout, only: elements, with_solids
  use abaqus_report, only: warn
  implicit none(type, external)
  private
  public :: warn_if_heated, forget_temperatures

  logical :: told = .false.

contains

  !> The message, if the element is the first one of the job that calls for it.
  subroutine warn_if_heated(jtype, jelem, npredf, predef)
    integer, intent(in) :: jtype, jelem
    integer, intent(in) :: npredf              !< predefined fields, of which the temperature is the first
    real(dp), intent(in) :: predef(:, :, :)    !< (2, npredf, nodes) end value and increment at the nodes
    integer :: node

    if (told .or. npredf < 1) return
    if (iand(elements(jtype)%family, with_solids) == 0) return
    do node = 1, size(predef, 3)
      if (.not. abs(predef(2, 1, node)) > 0.0_dp) cycle
      call warn(jtype, jelem, 'the temperature of its node %I changes by %R, to %R: its traction has no thermal strains. ' // &
        'If the plies expand, take the standard element (U2, U5, U7, U11). Told once in a job', [node], &
        [predef(2, 1, node), predef(1, 1, node)])
      told = .true.
      return
    end do
  end subroutine warn_if_heated

  !> At the start and the end of an analysis.
  subroutine forget_temperatures()
    told = .false.
  end subroutine forget_temperatures

end module abaqus_temperatures
