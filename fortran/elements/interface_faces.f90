! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The integration points of an interface between two faces: frame, area and jump operator.
!>
!> In the plane, faces are edges of two or three nodes, the middle node last: tau runs along the mid-line of the original
!> coordinates, from the first node to the second, and n is tau rotated by +90 degrees: bottom to top. In space, they are
!> triangles of three or six nodes or quadrilaterals of four or eight, corners and then midside nodes counter-clockwise seen
!> from the top: n is normal to the mid-surface, s the projection of a direction on it and t = n x s. Without a direction it is the
!> global x axis, or the z axis where x is within 0.1 degrees of n (Abaqus' local directions). Faces may be curved: each point has
!> its own frame.
module elements_interface_faces
  use core_cells, only: cell_functions, corners_of
  use core_kinds, only: dp
  use core_quadrature, only: line_points, line_weights, triangle_point
  use core_rotation, only: cross, least_degrees, line_frame, surface_frame
  use core_serendipity, only: quad_places
  use core_shape_functions, only: line_shape, line_slope
  use core_status, only: status_type, along_normal, zero_length, faces_apart, ok
  implicit none(type, external)
  private
  public :: interface_place, measure_interface, place_points, central_frame, jump_operator, separation_at
  public :: most_apart

  !> Nodes of a face, at most.
  integer, parameter :: most_nodes = 8

  !> An integration point of the interface.
  type :: interface_place
    real(dp) :: parent(2)     !< along the interface, each in (-1, 1)
    real(dp) :: shape(most_nodes)      !< shape functions of the nodes of a face
    real(dp) :: slope(most_nodes, 2)   !< their derivatives by the parent coordinates
    real(dp) :: position(3)   !< original one
    real(dp) :: frame(3, 3)   !< rows s, n and t; in the plane tau and n, and zero
    real(dp) :: area          !< of the interface that it stands for; in the plane its length
  end type interface_place

contains

  !> Integration points on the mid-line or mid-surface of two coincident faces: on a line from its first to its second node, on a
  !> surface each next to the node of its number, with midside nodes one more in the middle.
  pure subroutine measure_interface(dim, nodes, points, bottom, top, rule, direction, places, status)
    integer, intent(in) :: dim                                    !< 2 or 3
    integer, intent(in) :: nodes                                  !< of a face
    integer, intent(in) :: points                                 !< as many as nodes, on surfaces with midside nodes one more
    real(dp), intent(in) :: bottom(dim, nodes), top(dim, nodes)   !< original coordinates
    integer, intent(in) :: rule
    real(dp), intent(in) :: direction(3)        !< for s, in space; zero: none
    type(interface_place), intent(out) :: places(points)
    type(status_type), intent(out) :: status    !< zero_length, faces_apart with the distance and its limit, or along_normal
    real(dp) :: distance, limit

    limit = most_apart(dim, nodes, bottom)
    distance = maxval(abs(top - bottom))
    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    if (.not. limit > 0.0_dp) then
      status = status_type(zero_length, 0, limit, 0.0_dp)
    else if (distance > limit) then
      status = status_type(faces_apart, 0, distance, limit)
    end if
    if (status%code /= ok) return
    call place_points(dim, nodes, points, 0.5_dp*(bottom + top), rule, direction, places, status)
  end subroutine measure_interface

  !> Integration points on a line or a surface.
  pure subroutine place_points(dim, nodes, points, middle, rule, direction, places, status)
    integer, intent(in) :: dim, nodes, points, rule    !< as in `measure_interface`
    real(dp), intent(in) :: middle(dim, nodes)         !< original coordinates
    real(dp), intent(in) :: direction(3)               !< as in `measure_interface`
    type(interface_place), intent(out) :: places(points)
    type(status_type), intent(out) :: status           !< zero_length, or along_normal
    real(dp) :: edge
    integer :: k

    edge = most_apart(dim, nodes, middle)
    status = status_type(merge(ok, zero_length, edge > 0.0_dp), 0, edge, 0.0_dp)
    if (status%code /= ok) return
    do k = 1, points
      places(k)%position = 0.0_dp
      if (dim == 2) then
        call place_on_line(nodes, middle, rule, k, places(k), status)
      else
        call place_on_surface(nodes, middle, rule, k, direction, places(k), status)
      end if
      if (status%code /= ok) return
    end do
  end subroutine place_points

  !> Distance along any axis up to which nodes of two faces count as coincident: a mesh generator that prints few digits may cause
  !> it.
  pure function most_apart(dim, nodes, face) result(limit)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: face(dim, nodes)    !< coordinates of one of them
    real(dp) :: limit
    real(dp), parameter :: part_of_edge = 1.0e-4_dp
    real(dp) :: edge

    edge = maxval(abs(face(:, 2) - face(:, 1)))
    if (dim == 3) edge = max(edge, maxval(abs(face(:, 3) - face(:, 2))))
    limit = part_of_edge*edge
  end function most_apart

  !> Point k of a line.
  pure subroutine place_on_line(nodes, middle, rule, k, place, status)
    integer, intent(in) :: nodes, rule, k
    real(dp), intent(in) :: middle(2, nodes)
    type(interface_place), intent(inout) :: place
    type(status_type), intent(inout) :: status
    real(dp), dimension(nodes) :: s, w
    real(dp) :: slope(2), along, frame(2, 2)
    integer :: a
    real(dp), parameter :: origin(2) = 0.0_dp

    s = line_points(nodes, rule)
    w = line_weights(nodes, rule)
    place%parent = [s(k), 0.0_dp]
    call face_functions(2, nodes, place%parent, place%shape, place%slope)
    slope = 0.0_dp
    do a = 1, nodes
      place%position(1:2) = place%position(1:2) + place%shape(a)*middle(:, a)
      slope = slope + place%slope(a, 1)*middle(:, a)
    end do
    ! a middle node too close to an end folds the edge back
    along = dot_product(slope, middle(:, 2) - middle(:, 1))
    if (.not. along > 0.0_dp) then
      status = status_type(zero_length, 0, along, 0.0_dp)
      return
    end if
    call line_frame(origin, slope, frame, place%area)
    place%frame = 0.0_dp
    place%frame(1:2, 1:2) = frame
    place%area = w(k)*place%area
  end subroutine place_on_line

  !> Point k of a surface, next to node k or in the middle.
  pure subroutine place_on_surface(nodes, middle, rule, k, direction, place, status)
    integer, intent(in) :: nodes, rule, k
    real(dp), intent(in) :: middle(3, nodes), direction(3)
    type(interface_place), intent(inout) :: place
    type(status_type), intent(inout) :: status
    real(dp), dimension(merge(2, 3, nodes <= 4)) :: s, w
    real(dp) :: slopes(3, 2), weight, upright, degrees
    integer :: at(2), a

    if (corners_of(2, nodes) == 3) then
      call triangle_point(nodes, rule, k, place%parent, weight)
    else
      s = line_points(size(s), rule)
      w = line_weights(size(s), rule)
      at = 0
      if (k <= nodes) at = quad_places(:, k)
      at = 1 + (at + 1)*(size(s) - 1)/2
      place%parent = s(at)
      weight = product(w(at))
    end if
    call face_functions(3, nodes, place%parent, place%shape, place%slope)
    slopes = 0.0_dp
    do a = 1, nodes
      place%position = place%position + place%shape(a)*middle(:, a)
      slopes(:, 1) = slopes(:, 1) + place%slope(a, 1)*middle(:, a)
      slopes(:, 2) = slopes(:, 2) + place%slope(a, 2)*middle(:, a)
    end do
    call surface_frame(slopes(:, 1), slopes(:, 2), place%frame, place%area, direction, degrees)
    if (degrees < least_degrees) status = too_steep(degrees)
    ! a midside node too close to a corner, or a corner beyond the line of its neighbours, folds the surface back
    if (corners_of(2, nodes) == 3) then
      upright = dot_product(place%frame(2, :), cross(middle(:, 2) - middle(:, 1), middle(:, 3) - middle(:, 1)))
    else
      upright = dot_product(place%frame(2, :), cross(middle(:, 3) - middle(:, 1), middle(:, 4) - middle(:, 2)))
    end if
    if (.not. upright > 0.0_dp) status = status_type(zero_length, 0, upright, 0.0_dp)
    place%area = weight*place%area
  end subroutine place_on_surface

  !> Status of a direction that is so many degrees from the normal.
  pure function too_steep(degrees) result(status)
    real(dp), intent(in) :: degrees
    type(status_type) :: status

    status = status_type(along_normal, 0, degrees, least_degrees)
  end function too_steep

  !> Frame in the middle of the surface between two faces in space.
  pure subroutine central_frame(nodes, bottom, top, direction, frame, status)
    integer, intent(in) :: nodes       !< of a face
    real(dp), intent(in) :: bottom(3, nodes), top(3, nodes)
    real(dp), intent(in) :: direction(3)        !< for s; zero: none
    real(dp), intent(out) :: frame(3, 3)
    type(status_type), intent(out) :: status    !< ok, or along_normal
    real(dp) :: slopes(3, 2), area, parent(2), degrees, shape(most_nodes), slope(most_nodes, 2)
    integer :: a

    parent = merge(1.0_dp/3.0_dp, 0.0_dp, corners_of(2, nodes) == 3)
    call face_functions(3, nodes, parent, shape, slope)
    slopes = 0.0_dp
    do a = 1, nodes
      slopes(:, 1) = slopes(:, 1) + slope(a, 1)*(0.5_dp*(bottom(:, a) + top(:, a)))
      slopes(:, 2) = slopes(:, 2) + slope(a, 2)*(0.5_dp*(bottom(:, a) + top(:, a)))
    end do
    call surface_frame(slopes(:, 1), slopes(:, 2), frame, area, direction, degrees)
    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    if (degrees < least_degrees) status = too_steep(degrees)
  end subroutine central_frame

  !> Shape functions of a face and their derivatives by the parent coordinates.
  pure subroutine face_functions(dim, nodes, parent, shape, slope)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: parent(2)
    real(dp), intent(out) :: shape(most_nodes), slope(most_nodes, 2)   !< those of further nodes are zero

    shape = 0.0_dp
    slope = 0.0_dp
    if (dim == 2) then
      shape(1:nodes) = line_shape(nodes, parent(1))
      slope(1:nodes, 1) = line_slope(nodes, parent(1))
    else
      call cell_functions(2, nodes, parent, shape(1:nodes), slope(1:nodes, :))
    end if
  end subroutine face_functions

  !> N, transposed: the separation (tau, n) or (s, n, t) at a point by the displacements of an element.
  pure function jump_operator(dim, place, nodes, faces, unknowns) result(matrix)
    integer, intent(in) :: dim
    type(interface_place), intent(in) :: place
    integer, intent(in) :: nodes             !< of a face
    integer, intent(in) :: faces(nodes, 2)   !< nodes of the bottom and the top face in the element
    integer, intent(in) :: unknowns          !< of the element
    real(dp) :: matrix(unknowns, dim)
    integer :: a, i, bottom, top

    matrix = 0.0_dp
    do i = 1, dim
      do a = 1, nodes
        bottom = dim*(faces(a, 1) - 1)
        top = dim*(faces(a, 2) - 1)
        matrix(bottom + 1:bottom + dim, i) = -place%shape(a)*place%frame(i, 1:dim)
        matrix(top + 1:top + dim, i) = place%shape(a)*place%frame(i, 1:dim)
      end do
    end do
  end function jump_operator

  !> N u, from differences of displacements: a translation of any size opens nothing, whatever its digits.
  pure function separation_at(dim, place, nodes, faces, u) result(separation)
    integer, intent(in) :: dim
    type(interface_place), intent(in) :: place
    integer, intent(in) :: nodes
    integer, intent(in) :: faces(nodes, 2)
    real(dp), intent(in) :: u(:)             !< displacements of the element
    real(dp) :: separation(3)
    real(dp) :: jump(3)
    integer :: a, i, top, bottom

    jump = 0.0_dp
    do a = 1, nodes
      top = dim*(faces(a, 2) - 1)
      bottom = dim*(faces(a, 1) - 1)
      do i = 1, dim
        jump(i) = jump(i) + place%shape(a)*(u(top + i) - u(bottom + i))
      end do
    end do
    separation = matmul(place%frame, jump)
  end function separation_at

end module elements_interface_faces
