! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> One message in a job about interface elements that fail and are too long for the process zone.
!>
!> It depends on the state at the start of the increment, which belongs to a solution, as that of an iteration may not. Several
!> threads read and set the same flag: the worst that can happen is that each of them sends the message. The flag is set after
!> the message, since a host may end the call there and repeat it on one thread.
module abaqus_long_elements
  use core_kinds, only: dp
  use cohesive_parameters, only: law_parameters
  use materials_linear_elasticity, only: engineering_constants
  use elements_interface_point, only: interface_point
  use elements_process_zone, only: failing_point, measure_zone
  use abaqus_report, only: warn
  implicit none(type, external)
  private
  public :: warn_if_long, forget_long_elements

  integer, parameter :: least_elements = 3   !< that the zone has to hold
  logical :: told = .false.

contains

  !> The message, if the element is the first one of the job that calls for it.
  subroutine warn_if_long(itype, jelem, faces, coordinates, direction, materials, law, points)
    integer, intent(in) :: itype, jelem
    integer, intent(in) :: faces(:, :)                       !< nodes of the bottom and the top face, a column each
    real(dp), intent(in) :: coordinates(:, :)                !< original ones, (2 or 3, nodes)
    real(dp), intent(in) :: direction(3)                     !< for s, in space; zero: none
    type(engineering_constants), intent(in) :: materials(2)  !< of the solids below and above
    type(law_parameters), intent(in) :: law
    type(interface_point), intent(in) :: points(:)           !< at the start of the increment
    real(dp) :: length, zone, share
    integer :: k

    if (told) return
    k = failing_point(points, law)
    if (k == 0) return
    call measure_zone(faces, coordinates, direction, materials, law, points(k)%history%dissipated, length, zone, share)
    if (least_elements*length <= zone) return
    call warn(itype, jelem, 'fails and is %R long, the process zone at most %R (%I per cent mode II): expected at least ' // &
      '%I elements in it; with fewer the load comes out too high. Told once in a job', &
      [nint(100.0_dp*share), least_elements], [length, zone])
    told = .true.
  end subroutine warn_if_long

  !> At the start and the end of an analysis.
  subroutine forget_long_elements()
    told = .false.
  end subroutine forget_long_elements

end module abaqus_long_elements
