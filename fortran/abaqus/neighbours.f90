! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The two continuum quads next to a four-node stabilised interface element, found by element number offsets.
module abaqus_neighbours
  use core_kinds, only: dp
  use core_quadrature, only: gauss_rule
  use elements_quad4, only: face_nodes, gauss_of_face
  use elements_interface_faces, only: coincidence_tolerance
  use elements_interface_point, only: interface_options
  use elements_interface_bulk, only: stabilisation_type, nitsche_parameters, sample_face, sample_gauss
  use abaqus_layout, only: integers, integer_position, j_offset_bottom, j_offset_top
  use abaqus_bulk_exchange, only: records, slot_of_bulk
  use abaqus_report, only: fatal
  implicit none(type, external)
  private
  public :: stress_of_neighbours

contains

  !> Weighted bulk stress of both points, and beta and gamma with (21) and (22) put in; `good` is false after a message.
  subroutine stress_of_neighbours(jelem, offset, options, coordinates, u, stabilisation, stress, good)
    integer, intent(in) :: jelem
    integer, intent(in) :: offset(2)                     !< from its number to those of the bottom and the top quad
    type(interface_options), intent(in) :: options
    real(dp), intent(in) :: coordinates(2, 4), u(2, 4)   !< of the interface nodes
    type(stabilisation_type), intent(inout) :: stabilisation
    real(dp), intent(out) :: stress(3, 2)                !< (s11, s22, s12) of each point
    logical, intent(out) :: good
    real(dp) :: bounds(2, 2)
    integer :: slot(2), side, k

    stress = 0.0_dp
    do side = 1, 2
      slot(side) = slot_of_bulk(jelem + offset(side))
      call check_neighbour(jelem, offset(side), side, slot(side), coordinates, u, good)
      if (.not. good) return
    end do
    do side = 1, 2
      bounds(:, side) = records(slot(side))%norm*records(slot(1))%face_length/records(slot(side))%area
    end do
    stabilisation = nitsche_parameters(stabilisation, bounds)
    do k = 1, 2
      stress(:, k) = stabilisation%gamma_bottom(1)*sampled(slot(1), options, 3 - k) &
        + (1.0_dp - stabilisation%gamma_bottom(1))*sampled(slot(2), options, k)
    end do
  end subroutine stress_of_neighbours

  !> Stress a quad offers for the point next to its face's first (k = 1) or second (k = 2) node.
  function sampled(slot, options, k) result(stress)
    integer, intent(in) :: slot
    type(interface_options), intent(in) :: options
    integer, intent(in) :: k
    real(dp) :: stress(3)
    integer, parameter :: gauss_place(2) = [2, 4]   ! positions in face_places
    integer, parameter :: end_place(2) = [1, 5]
    integer, parameter :: middle = 3

    select case (options%sampling)
    case (sample_face)
      stress = records(slot)%face_stress(:, merge(gauss_place(k), end_place(k), options%rule == gauss_rule))
    case (sample_gauss)
      stress = records(slot)%gauss_stress(:, gauss_of_face(k, records(slot)%face))
    case default
      stress = records(slot)%face_stress(:, middle)
    end select
  end function sampled

  !> Checks that a quad has been evaluated with the displacements of this iteration and shares its face with the
  !> interface: the bottom quad has nodes 2 and 1 of the interface on its face, the top one nodes 4 and 3.
  subroutine check_neighbour(jelem, offset, side, slot, coordinates, u, good)
    integer, intent(in) :: jelem, offset, side, slot
    real(dp), intent(in) :: coordinates(2, 4), u(2, 4)
    logical, intent(out) :: good
    integer, parameter :: rows(2) = [j_offset_bottom, j_offset_top]
    integer, parameter :: shared(2, 2) = reshape([2, 1, 4, 3], [2, 2])
    real(dp), parameter :: round_off = 16.0_dp*epsilon(1.0_dp)
    integer :: nodes(2), position
    character(len=40) :: property

    good = .false.
    position = integer_position(3, rows(side))
    property = 'JPROPS(%I) ' // trim(integers(rows(side))%name) // ' = %I'
    if (slot == 0) then
      call fatal(3, jelem, trim(property) // ': bulk element %I has not been evaluated before; it must be a U1 ' // &
        'with FACE, have a lower number than the interface element, and the job must run on one thread', &
        [position, offset, jelem + offset], [real(dp) ::])
      return
    end if
    nodes = face_nodes(:, records(slot)%face)
    if (any(abs(records(slot)%coordinates(:, nodes) - coordinates(:, shared(:, side))) &
      > coincidence_tolerance*records(slot)%face_length)) then
      call fatal(3, jelem, trim(property) // ': bulk element %I is not a neighbour: its face %I does not lie on ' // &
        'that edge of the interface', [position, offset, jelem + offset, records(slot)%face], [real(dp) ::])
      return
    end if
    good = all(abs(records(slot)%displacement(:, nodes) - u(:, shared(:, side))) &
      <= round_off*maxval(abs(u(:, shared(:, side)))))
    if (.not. good) call fatal(3, jelem, trim(property) // ': bulk element %I has not been evaluated before the ' // &
      'interface element in this iteration: give bulk elements lower numbers and run on one thread', &
      [position, offset, jelem + offset], [real(dp) ::])
  end subroutine check_neighbour

end module abaqus_neighbours
