! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The two continuum elements next to a stabilised interface that shares their stress (U3, U10), found by element number offsets.
module abaqus_neighbours
  use core_kinds, only: dp
  use core_quadrature, only: gauss_rule
  use core_status, only: status_type, ok
  use elements_solid_faces, only: node_place, gauss_place, middle_place
  use elements_interface_faces, only: interface_place, measure_interface, most_apart
  use elements_interface_point, only: interface_options
  use elements_interface_bulk, only: stabilisation_type, nitsche_parameters, sample_face, sample_gauss
  use abaqus_check, only: report_status
  use abaqus_layout, only: faces, integers, j_offsetbottom, j_offsettop
  use abaqus_properties, only: integer_position
  use abaqus_bulk_exchange, only: bulk_record, records, slot_of_bulk
  use abaqus_report, only: fatal
  implicit none(type, external)
  private
  public :: stress_of_neighbours

  integer, parameter :: offset_rows(2) = [j_offsetbottom, j_offsettop]

contains

  !> Weighted nominal stress of each point, and beta and gamma with (21) and (22) put in; `good` is false after a message.
  subroutine stress_of_neighbours(itype, jelem, dim, points, given, options, coordinates, u, stabilisation, stress, good)
    integer, intent(in) :: itype, jelem
    integer, intent(in) :: dim, points                 !< points: also nodes of a face
    integer, intent(in) :: given(:)                    !< integer properties by their rows in the layout
    type(interface_options), intent(in) :: options
    real(dp), intent(in) :: coordinates(dim, 2*points), u(dim, 2*points)   !< of the interface nodes
    type(stabilisation_type), intent(inout) :: stabilisation
    real(dp), intent(out) :: stress(3, 3, points)
    logical, intent(out) :: good
    type(interface_place) :: places(points)
    type(status_type) :: status
    real(dp) :: bounds(2, 2), weight
    integer :: slot(2), matching(points, 2), nodes(points, 2), side, k

    stress = 0.0_dp
    nodes(:, 1) = faces(itype)%bottom(1:points)
    nodes(:, 2) = faces(itype)%top(1:points)
    call measure_interface(dim, points, points, coordinates(:, nodes(:, 1)), coordinates(:, nodes(:, 2)), gauss_rule, &
      options%direction, places, status)
    good = status%code == ok
    if (.not. good) then
      call report_status(itype, jelem, status)
      return
    end if
    do side = 1, 2
      slot(side) = slot_of_bulk(jelem + given(offset_rows(side)))
      call check_neighbour(itype, jelem, dim, points, given(offset_rows(side)), side, slot(side), coordinates(:, nodes(:, side)), &
        u(:, nodes(:, side)), places(1), matching(:, side), good)
      if (.not. good) return
    end do
    do side = 1, 2
      bounds(:, side) = records(slot(side))%norm*sum(places%area)/records(slot(side))%measure
    end do
    stabilisation = nitsche_parameters(stabilisation, bounds, 1.0_dp)
    do side = 1, 2
      weight = merge(stabilisation%gamma_bottom(1), 1.0_dp - stabilisation%gamma_bottom(1), side == 1)
      do k = 1, points
        stress(:, :, k) = stress(:, :, k) + weight*sampled(records(slot(side)), dim, options, matching(k, side))
      end do
    end do
  end subroutine stress_of_neighbours

  !> Stress that an element offers for the point next to node k of its face.
  pure function sampled(record, dim, options, k) result(stress)
    type(bulk_record), intent(in) :: record
    integer, intent(in) :: dim
    type(interface_options), intent(in) :: options
    integer, intent(in) :: k
    real(dp) :: stress(3, 3)

    select case (options%sampling)
    case (sample_face)
      stress = record%face_stress(:, :, merge(gauss_place(dim, k), node_place(k), options%rule == gauss_rule))
    case (sample_gauss)
      stress = record%gauss_stress(:, :, k)
    case default
      stress = record%face_stress(:, :, middle_place(dim))
    end select
  end function sampled

  !> Checks that an element has been evaluated with the displacements of this iteration, and that its face is the interface's, with
  !> the element below it (side 1) or above it.
  subroutine check_neighbour(itype, jelem, dim, points, offset, side, slot, coordinates, u, place, matching, good)
    integer, intent(in) :: itype, jelem, dim, points, offset, side, slot
    real(dp), intent(in) :: coordinates(dim, points), u(dim, points)   !< of the nodes of that face of the interface
    type(interface_place), intent(in) :: place                         !< a point of the interface
    integer, intent(out) :: matching(points)                           !< node of the face of the element, from 1
    logical, intent(out) :: good
    real(dp), parameter :: round_off = 16.0_dp*epsilon(1.0_dp)
    integer :: position, k
    character(len=40) :: property
    character(len=2) :: bulk
    character(len=4) :: shared

    bulk = merge('U1', 'U9', dim == 2)
    shared = merge('edge', 'face', dim == 2)
    good = .false.
    matching = 0
    position = integer_position(itype, offset_rows(side))
    property = 'JPROPS(%I) ' // trim(integers(offset_rows(side))%name) // ' = %I'
    if (slot == 0) then
      call fatal(itype, jelem, trim(property) // ': bulk element %I has not been evaluated before; it must be a ' // bulk // &
        ' with FACE, have a lower number than the interface element, and the job must run on one thread', &
        [position, offset, jelem + offset], [real(dp) ::])
      return
    end if
    associate (record => records(slot))
      matching = match(dim, points, record, coordinates)
      if (any(matching == 0) .or. .not. lies_on(side, record, place)) then
        call fatal(itype, jelem, trim(property) // ': bulk element %I is not a neighbour: its face %I does not lie on ' // &
          'that ' // shared // ' of the interface', [position, offset, jelem + offset, record%face], [real(dp) ::])
        return
      end if
      good = .true.
      do k = 1, points
        good = good .and. all(abs(record%displacement(1:dim, matching(k)) - u(:, k)) <= round_off*maxval(abs(u)))
      end do
    end associate
    if (.not. good) call fatal(itype, jelem, trim(property) // ': bulk element %I has not been evaluated before the ' // &
      'interface element in this iteration: give bulk elements lower numbers and run on one thread', &
      [position, offset, jelem + offset], [real(dp) ::])
  end subroutine check_neighbour

  !> Which node of the element's face each node of the interface lies on, 0: on none.
  pure function match(dim, points, record, coordinates) result(matching)
    integer, intent(in) :: dim, points
    type(bulk_record), intent(in) :: record
    real(dp), intent(in) :: coordinates(dim, points)
    integer :: matching(points)
    real(dp) :: distance(points)
    integer :: a, k

    matching = 0
    if (record%dimension /= dim) return
    do k = 1, points
      do a = 1, points
        distance(a) = maxval(abs(record%coordinates(1:dim, a) - coordinates(:, k)))
      end do
      a = minloc(distance, dim=1)
      if (distance(a) <= most_apart(dim, points, coordinates) .and. .not. any(matching == a)) matching(k) = a
    end do
  end function match

  !> Whether the middle of the element lies below the interface (side 1), or above it.
  pure logical function lies_on(side, record, place)
    integer, intent(in) :: side
    type(bulk_record), intent(in) :: record
    type(interface_place), intent(in) :: place

    lies_on = dot_product(record%middle - place%position, place%frame(2, :)) > 0.0_dp .eqv. side == 2
  end function lies_on

end module abaqus_neighbours
