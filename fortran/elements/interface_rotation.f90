! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Large rotations of an interface element. The frame of a point goes with the mid-line or mid-surface between the present faces,
!> which turns by Q. The law acts on the displacements less this rotation,
!>
!>     v = transpose(Q) x - X,    g = N v,
!>
!> with the operators of the original configuration. A crack that opens turns its faces apart, and the solids with them:
!> <sigma>.n is made of the displacements of each solid less the rotation of its own face. The rotation of the mid-surface would
!> leave strains of half of the square of the angle, and their stress.
!>
!> Nodal forces are the derivatives of the same work by the displacements, so that they have no resultant moment, and the tangent is
!> symmetric where the law is. Tractions are per original area; the strain of the bulk is small: the nominal traction P N is
!> Q sigma N to its first order.
module elements_interface_rotation
  use core_kinds, only: dp
  use core_rotation, only: turned_frame, frame_curvature
  use core_status, only: status_type, zero_length, ok
  use elements_interface_faces, only: interface_place
  implicit none(type, external)
  private
  public :: turn_place, co_rotated, by_displacements, add_turning
  public :: turn_faces, co_rotated_solids, solids_by_displacements, add_turning_of_solids

contains

  !> Turns the frame of a point with the mid-line or mid-surface, and gives the derivative of the frame by the nodes of that.
  pure subroutine turn_place(dim, nodes, faces, original, present, place, turning, status)
    integer, intent(in) :: dim, nodes, faces(nodes, 2)
    real(dp), intent(in) :: original(:), present(:)              !< coordinates of the element's nodes, one node after the other
    type(interface_place), intent(inout) :: place
    real(dp), intent(out) :: turning(3, dim, dim, nodes)         !< row of the frame, component, direction, node
    type(status_type), intent(out) :: status                     !< zero_length
    real(dp) :: start(dim, nodes), now(dim, nodes), by_node(nodes, dim - 1), turned(3, 3), measure

    start = middle_of(dim, nodes, faces, original)
    now = middle_of(dim, nodes, faces, present)
    by_node = place%slope(1:nodes, 1:dim - 1)
    call turned_frame(dim, nodes, matmul(start, by_node), matmul(now, by_node), place%frame, by_node, turned, turning, measure)
    place%frame = turned
    status = status_type(merge(ok, zero_length, measure > 0.0_dp), 0, measure, 0.0_dp)
  end subroutine turn_place

  !> Nodes of the mid-line or mid-surface.
  pure function middle_of(dim, nodes, faces, coordinates) result(middle)
    integer, intent(in) :: dim, nodes, faces(nodes, 2)
    real(dp), intent(in) :: coordinates(:)
    real(dp) :: middle(dim, nodes)
    integer :: a, i

    do a = 1, nodes
      do i = 1, dim
        middle(i, a) = 0.5_dp*(coordinates(dim*(faces(a, 1) - 1) + i) + coordinates(dim*(faces(a, 2) - 1) + i))
      end do
    end do
  end function middle_of

  !> Displacements less the rotation of a point: transpose(Q) x - X, with Q from the original to the present frame.
  pure function co_rotated(dim, frame, turned, original, present) result(u)
    integer, intent(in) :: dim
    real(dp), intent(in) :: frame(3, 3), turned(3, 3)      !< rows of the original and the present frame
    real(dp), intent(in) :: original(:), present(:)        !< coordinates about their means
    real(dp) :: u(size(original))
    real(dp) :: back(dim, dim)
    integer :: a

    back = matmul(transpose(frame(1:dim, 1:dim)), turned(1:dim, 1:dim))
    do a = 0, size(original) - dim, dim
      u(a + 1:a + dim) = matmul(back, present(a + 1:a + dim)) - original(a + 1:a + dim)
    end do
  end function co_rotated

  !> Derivative by the displacements of what a matrix makes of the co-rotated ones. A node of the mid-surface moves by half of what
  !> each of its two nodes does.
  pure function by_displacements(dim, nodes, faces, frame, turned, turning, present, matrix) result(derivative)
    integer, intent(in) :: dim, nodes, faces(nodes, 2)
    real(dp), intent(in) :: frame(3, 3), turned(3, 3)
    real(dp), intent(in) :: turning(3, dim, dim, nodes)    !< row of the present frame, component, direction, node
    real(dp), intent(in) :: present(:)                     !< coordinates about their mean
    real(dp), intent(in) :: matrix(:, :)                   !< (unknowns, components)
    real(dp) :: derivative(size(matrix, 1), size(matrix, 2))
    real(dp) :: back(dim, dim), moments(dim, dim), change
    integer :: a, c, i, q, side, row

    back = matmul(transpose(turned(1:dim, 1:dim)), frame(1:dim, 1:dim))
    do c = 1, size(matrix, 2)
      do a = 0, size(present) - dim, dim
        derivative(a + 1:a + dim, c) = matmul(back, matrix(a + 1:a + dim, c))
      end do
      moments = moments_of(dim, frame, matrix(:, c), present)
      do q = 1, nodes
        do i = 1, dim
          change = 0.5_dp*sum(turning(1:dim, :, i, q)*moments)
          do side = 1, 2
            row = dim*(faces(q, side) - 1) + i
            derivative(row, c) = derivative(row, c) + change
          end do
        end do
      end do
    end do
  end function by_displacements

  !> Sum of frame force_a (x) x_a over the nodes: what the entries of the present frame are multiplied by in force.v.
  pure function moments_of(dim, frame, force, present) result(moments)
    integer, intent(in) :: dim
    real(dp), intent(in) :: frame(3, 3)
    real(dp), intent(in) :: force(:), present(:)           !< of the nodes, one after the other
    real(dp) :: moments(dim, dim)
    real(dp) :: global(dim, dim)
    integer :: a, j

    global = 0.0_dp
    do a = 0, size(force) - dim, dim
      do j = 1, dim
        global(:, j) = global(:, j) + force(a + 1:a + dim)*present(a + j)
      end do
    end do
    moments = matmul(frame(1:dim, 1:dim), global)
  end function moments_of

  !> Turns the frame of a point with the bottom and with the top face, as `turn_place` does with the surface between them.
  pure subroutine turn_faces(dim, nodes, faces, original, present, place, turned, turning, status)
    integer, intent(in) :: dim, nodes, faces(nodes, 2)
    real(dp), intent(in) :: original(:), present(:)              !< coordinates of the element's nodes, one node after the other
    type(interface_place), intent(in) :: place
    type(interface_place), intent(out) :: turned(2)              !< of the bottom and the top face
    real(dp), intent(out) :: turning(3, dim, dim, nodes, 2)
    type(status_type), intent(out) :: status                     !< zero_length
    integer :: side

    do side = 1, 2
      turned(side) = place
      call turn_place(dim, nodes, spread(faces(:, side), 2, 2), original, present, turned(side), turning(:, :, :, :, side), status)
      if (status%code /= ok) return
    end do
  end subroutine turn_faces

  !> Displacements of both solids less the rotations of their faces.
  pure function co_rotated_solids(dim, split, frame, turned, original, present) result(u)
    integer, intent(in) :: dim
    integer, intent(in) :: split                           !< unknowns of the solid below, which come first
    real(dp), intent(in) :: frame(3, 3)
    type(interface_place), intent(in) :: turned(2)
    real(dp), intent(in) :: original(:), present(:)        !< coordinates about their means
    real(dp) :: u(size(original))

    u(:split) = co_rotated(dim, frame, turned(1)%frame, original(:split), present(:split))
    u(split + 1:) = co_rotated(dim, frame, turned(2)%frame, original(split + 1:), present(split + 1:))
  end function co_rotated_solids

  !> Derivative by the displacements of what a matrix makes of them.
  pure function solids_by_displacements(dim, nodes, faces, split, frame, turned, turning, present, matrix) result(derivative)
    integer, intent(in) :: dim, nodes, faces(nodes, 2), split
    real(dp), intent(in) :: frame(3, 3)
    type(interface_place), intent(in) :: turned(2)
    real(dp), intent(in) :: turning(3, dim, dim, nodes, 2), present(:), matrix(:, :)   !< matrix: (unknowns, components)
    real(dp) :: derivative(size(matrix, 1), size(matrix, 2))
    integer :: side, first, last, own(nodes, 2)

    do side = 1, 2
      call find_solid(side, dim, faces, split, size(present), first, last, own)
      derivative(first:last, :) = by_displacements(dim, nodes, own, frame, turned(side)%frame, turning(:, :, :, :, side), &
        present(first:last), matrix(first:last, :))
    end do
  end function solids_by_displacements

  !> Adds to the tangent how the forces on both solids turn with their faces.
  pure subroutine add_turning_of_solids(area, dim, nodes, faces, split, place, turned, turning, original, present, force, tangent)
    real(dp), intent(in) :: area
    integer, intent(in) :: dim, nodes, faces(nodes, 2), split
    type(interface_place), intent(in) :: place, turned(2)
    real(dp), intent(in) :: turning(3, dim, dim, nodes, 2), original(:), present(:)
    real(dp), intent(in) :: force(size(present))             !< in the original directions, per area
    real(dp), intent(inout) :: tangent(:, :)
    integer :: side, first, last, own(nodes, 2)

    do side = 1, 2
      call find_solid(side, dim, faces, split, size(present), first, last, own)
      call add_turning(area, dim, nodes, own, place, turned(side), turning(:, :, :, :, side), original(first:last), &
        present(first:last), force(first:last), tangent(first:last, first:last))
    end do
  end subroutine add_turning_of_solids

  !> Unknowns of the solid below, 1, or above, 2, and the nodes of its face, both of the "mid-surface" of this face alone.
  pure subroutine find_solid(side, dim, faces, split, unknowns, first, last, own)
    integer, intent(in) :: side, dim, faces(:, :), split, unknowns
    integer, intent(out) :: first, last
    integer, intent(out) :: own(:, :)        !< among the nodes of the solid

    first = merge(1, split + 1, side == 1)
    last = merge(split, unknowns, side == 1)
    own = spread(faces(:, side) - (first - 1)/dim, 2, 2)
  end subroutine find_solid

  !> Adds to the tangent how the forces of a point on the co-rotated displacements turn with its frame: the second derivative of
  !> force.v at constant force.
  pure subroutine add_turning(area, dim, nodes, faces, place, turned, turning, original, present, force, tangent)
    real(dp), intent(in) :: area
    integer, intent(in) :: dim, nodes, faces(nodes, 2)
    type(interface_place), intent(in) :: place, turned       !< with the original and the present frame
    real(dp), intent(in) :: turning(3, dim, dim, nodes)      !< row of the present frame, component, direction, node
    real(dp), intent(in) :: original(:), present(:)          !< coordinates about their means
    real(dp), intent(in) :: force(size(present))             !< in the original directions, per area
    real(dp), intent(inout) :: tangent(:, :)
    real(dp) :: by_node(nodes, dim - 1), rows(dim, size(present)/dim), moments(3, 3), curvature(dim*nodes, dim*nodes)
    real(dp), dimension(size(present)) :: change, of_column
    integer :: q, i, j, a, side, column, row, p

    rows = matmul(place%frame(1:dim, 1:dim), reshape(force, shape(rows)))
    moments = 0.0_dp
    moments(1:dim, 1:dim) = moments_of(dim, place%frame, force, present)
    by_node = place%slope(1:nodes, 1:dim - 1)
    curvature = (0.25_dp*area)*frame_curvature(dim, nodes, matmul(middle_of(dim, nodes, faces, original), by_node), &
      matmul(middle_of(dim, nodes, faces, present), by_node), place%frame, by_node, turned%frame, turning, moments)
    rows = (0.5_dp*area)*rows
    do q = 1, nodes
      do i = 1, dim
        do a = 1, size(rows, 2)
          do j = 1, dim
            change(dim*(a - 1) + j) = dot_product(turning(1:dim, j, i, q), rows(:, a))
          end do
        end do
        of_column = change
        do side = 1, 2
          do p = 1, nodes
            row = dim*(faces(p, side) - 1)
            of_column(row + 1:row + dim) = of_column(row + 1:row + dim) + curvature(dim*(p - 1) + 1:dim*p, dim*(q - 1) + i)
          end do
        end do
        do side = 1, 2
          column = dim*(faces(q, side) - 1) + i
          tangent(:, column) = tangent(:, column) + of_column
          tangent(column, :) = tangent(column, :) + change
        end do
      end do
    end do
  end subroutine add_turning

end module elements_interface_rotation
