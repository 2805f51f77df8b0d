! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The integration points of an interface between two coincident edges of two or three nodes: frame, area and jump operator.
!>
!> The tangent tau runs along the mid-line of the original coordinates, n is tau rotated by +90 degrees: bottom to top. The edges
!> may be curved: each point has its own frame.
module elements_interface_edges
  use core_kinds, only: dp
  use core_quadrature, only: line_points, line_weights
  use core_rotation, only: line_frame
  use core_shape_functions, only: line_shape, line_slope
  use core_status, only: status_type, zero_length, edges_apart, ok
  implicit none(type, external)
  private
  public :: interface_place, measure_interface, jump_operator, separation_at, coincidence_tolerance

  !> An integration point of the interface.
  type :: interface_place
    real(dp) :: s             !< along the interface, in (-1, 1)
    real(dp) :: position(2)   !< original one
    real(dp) :: frame(2, 2)   !< rows tau and n
    real(dp) :: length        !< of the interface that it stands for
  end type interface_place

  !> Distance, relative to the length, up to which nodes count as coincident: a mesh generator that prints few digits may cause it.
  real(dp), parameter :: coincidence_tolerance = 1.0e-4_dp

contains

  !> Integration points on the mid-line of two coincident edges: left and right end, the middle node last.
  pure subroutine measure_interface(nodes, bottom, top, rule, places, status)
    integer, intent(in) :: nodes                              !< of an edge, and points
    real(dp), intent(in) :: bottom(2, nodes), top(2, nodes)   !< original coordinates
    integer, intent(in) :: rule
    type(interface_place), intent(out) :: places(nodes)
    type(status_type), intent(out) :: status    !< zero_length, or edges_apart with the distance and its limit
    real(dp) :: middle(2, nodes), distance, edge, s(nodes), w(nodes), slope(2), along
    real(dp), parameter :: origin(2) = 0.0_dp
    integer :: k

    middle = 0.5_dp*(bottom + top)
    edge = maxval(abs(bottom(:, 2) - bottom(:, 1)))
    distance = maxval(abs(top - bottom))
    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    if (.not. edge > 0.0_dp) then
      status = status_type(zero_length, 0, edge, 0.0_dp)
    else if (distance > coincidence_tolerance*edge) then
      status = status_type(edges_apart, 0, distance, coincidence_tolerance*edge)
    end if
    if (status%code /= ok) return
    s = line_points(nodes, rule)
    w = line_weights(nodes, rule)
    do k = 1, nodes
      slope = matmul(middle, line_slope(nodes, s(k)))
      ! a middle node too close to an end folds the edge back
      along = dot_product(slope, middle(:, 2) - middle(:, 1))
      if (.not. along > 0.0_dp) then
        status = status_type(zero_length, 0, along, 0.0_dp)
        return
      end if
      places(k)%s = s(k)
      places(k)%position = matmul(middle, line_shape(nodes, s(k)))
      call line_frame(origin, slope, places(k)%frame, places(k)%length)
      places(k)%length = w(k)*places(k)%length
    end do
  end subroutine measure_interface

  !> N: the matrix that takes the displacements of an element to the separation (tau, n) at a point.
  pure function jump_operator(place, nodes, edges, unknowns) result(matrix)
    type(interface_place), intent(in) :: place
    integer, intent(in) :: nodes             !< of an edge
    integer, intent(in) :: edges(nodes, 2)   !< nodes of the bottom and the top edge in the element
    integer, intent(in) :: unknowns          !< of the element
    real(dp) :: matrix(2, unknowns)
    real(dp) :: shape(nodes)
    integer :: a, side, column

    shape = line_shape(nodes, place%s)
    matrix = 0.0_dp
    do side = 1, 2
      do a = 1, nodes
        column = 2*edges(a, side)
        matrix(:, column - 1:column) = merge(-shape(a), shape(a), side == 1)*place%frame
      end do
    end do
  end function jump_operator

  !> N u, from differences of displacements: a rigid motion of any size opens nothing, whatever its digits.
  pure function separation_at(place, nodes, edges, u) result(separation)
    type(interface_place), intent(in) :: place
    integer, intent(in) :: nodes
    integer, intent(in) :: edges(nodes, 2)
    real(dp), intent(in) :: u(:)             !< displacements of the element
    real(dp) :: separation(2)
    real(dp) :: shape(nodes), jump(2)
    integer :: a, top, bottom

    shape = line_shape(nodes, place%s)
    jump = 0.0_dp
    do a = 1, nodes
      top = 2*edges(a, 2)
      bottom = 2*edges(a, 1)
      jump = jump + shape(a)*(u(top - 1:top) - u(bottom - 1:bottom))
    end do
    separation = matmul(place%frame, jump)
  end function separation_at

end module elements_interface_edges
