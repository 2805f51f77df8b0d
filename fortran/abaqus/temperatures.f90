! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> One message in a job about temperatures that change at a self-contained interface element whose solids have no expansion.
!>
!> The plies may well have none, so this is a warning. As in `abaqus_long_elements`, several threads may
!> send it once each, and the flag is set after the message.
module abaqus_temperatures
  use core_kinds, only: dp
  use abaqus_layout, only: elements, with_solids, p_expansion1_bottom, p_expansion3_top
  use abaqus_report, only: warn
  implicit none(type, external)
  private
  public :: warn_if_heated, forget_temperatures, expands

  logical :: told = .false.

contains

  !> The message, if the element is the first one of the job that calls for it.
  subroutine warn_if_heated(itype, jelem, values, npredf, predef)
    integer, intent(in) :: itype, jelem
    real(dp), intent(in) :: values(:)          !< properties by their rows in the layout
    integer, intent(in) :: npredf              !< predefined fields, of which the temperature is the first
    real(dp), intent(in) :: predef(:, :, :)    !< (2, npredf, nodes) end value and increment at the nodes
    integer :: node

    if (told .or. npredf < 1) return
    if (iand(elements(itype)%family, with_solids) == 0 .or. expands(values)) return
    do node = 1, size(predef, 3)
      if (.not. abs(predef(2, 1, node)) > 0.0_dp) cycle
      call warn(itype, jelem, 'the temperature of its node %I changes by %R, to %R, and its solids do not expand: give ' // &
        'EXPANSION1 BOTTOM to EXPANSION3 TOP if the plies do. Told once in a job', [node], &
        [predef(2, 1, node), predef(1, 1, node)])
      told = .true.
      return
    end do
  end subroutine warn_if_heated

  !> Whether a solid has thermal expansion.
  pure logical function expands(values)
    real(dp), intent(in) :: values(:)          !< properties by their rows in the layout

    expands = maxval(abs(values(p_expansion1_bottom:p_expansion3_top))) > 0.0_dp
  end function expands

  !> At the start and the end of an analysis.
  subroutine forget_temperatures()
    told = .false.
  end subroutine forget_temperatures

end module abaqus_temperatures
