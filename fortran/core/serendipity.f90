! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Shape functions of lines, quads and hexahedra with corner nodes and, in the serendipity family, midside nodes.
module core_serendipity
  use core_kinds, only: dp
  use core_shape_functions, only: to_position
  implicit none(type, external)
  private
  public :: serendipity_functions, quad8_gradient, brick_gradient, quad_places, brick_places

  !> Parent coordinates of the nodes of the quad: corners counter-clockwise, then the midside nodes of the edges 1-2, 2-3, 3-4, 4-1.
  integer, parameter :: quad_places(2, 8) = reshape([-1, -1, 1, -1, 1, 1, -1, 1, 0, -1, 1, 0, 0, 1, -1, 0], [2, 8])

  !> Those of the hexahedron: corners of its lower and its upper face, then the midside nodes.
  integer, parameter :: brick_places(3, 20) = reshape([ &
    -1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1, &
    0, -1, -1, 1, 0, -1, 0, 1, -1, -1, 0, -1, 0, -1, 1, 1, 0, 1, 0, 1, 1, -1, 0, 1, &
    -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0], [3, 20])

contains

  !> Shape functions and their derivatives by the parent coordinates: a product over the directions, times a sum at corners if there
  !> are midside nodes.
  pure subroutine serendipity_functions(dim, nodes, places, parent, n, dn)
    integer, intent(in) :: dim                  !< 1 to 3
    integer, intent(in) :: nodes                !< with midside nodes if more than 2**dim
    integer, intent(in) :: places(dim, nodes)   !< parent coordinates of the nodes: -1, 0 or 1
    real(dp), intent(in) :: parent(dim)         !< of the point
    real(dp), intent(out) :: n(nodes), dn(nodes, dim)

    call evaluate(dim, nodes, places, parent, n, dn)
  end subroutine serendipity_functions

  !> The same, private to this file: a compiler may specialise it for the sizes of a call.
  pure subroutine evaluate(dim, nodes, places, parent, n, dn)
    integer, intent(in) :: dim, nodes, places(dim, nodes)
    real(dp), intent(in) :: parent(dim)
    real(dp), intent(out) :: n(nodes), dn(nodes, dim)
    real(dp) :: factor(-1:1, dim), slope(-1:1, dim), others, total
    integer :: i, j, k
    logical :: corner

    factor(-1, :) = (1.0_dp - parent)/2.0_dp
    factor(0, :) = 1.0_dp - parent**2
    factor(1, :) = (1.0_dp + parent)/2.0_dp
    slope(-1, :) = -0.5_dp
    slope(0, :) = -2.0_dp*parent
    slope(1, :) = 0.5_dp
    do k = 1, nodes
      corner = nodes > 2**dim .and. all(places(:, k) /= 0)
      total = 1.0_dp
      if (corner) total = sum(places(:, k)*parent) - (dim - 1)
      n(k) = 1.0_dp
      do i = 1, dim
        n(k) = n(k)*factor(places(i, k), i)
      end do
      do i = 1, dim
        others = 1.0_dp
        do j = 1, dim
          if (j /= i) others = others*factor(places(j, k), j)
        end do
        dn(k, i) = slope(places(i, k), i)*others*total
        if (corner) dn(k, i) = dn(k, i) + n(k)*places(i, k)
      end do
      n(k) = n(k)*total
    end do
  end subroutine evaluate

  !> Derivatives of the shape functions of the eight-node quad by x and y, and the Jacobian, at (xi, eta).
  !> Where the Jacobian is not positive the derivatives are zero.
  pure subroutine quad8_gradient(coordinates, point, gradient, jacobian)
    real(dp), intent(in) :: coordinates(2, 8)  !< nodes, length
    real(dp), intent(in) :: point(2)           !< (xi, eta)
    real(dp), intent(out) :: gradient(2, 8)    !< dN/dx, dN/dy of each node, 1/length
    real(dp), intent(out) :: jacobian          !< d(x, y)/d(xi, eta), area
    real(dp) :: n(8), by_parent(8, 2)

    call evaluate(2, 8, quad_places, point, n, by_parent)
    call to_position(2, 8, coordinates, by_parent, gradient, jacobian)
  end subroutine quad8_gradient

  !> Those of the hexahedron with 8 or 20 nodes by x, y and z, and the Jacobian, at (xi, eta, zeta).
  pure subroutine brick_gradient(nodes, coordinates, point, gradient, jacobian)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: coordinates(3, nodes)   !< length
    real(dp), intent(in) :: point(3)
    real(dp), intent(out) :: gradient(3, nodes)     !< 1/length
    real(dp), intent(out) :: jacobian               !< volume
    real(dp) :: n(nodes), by_parent(nodes, 3)

    call evaluate(3, nodes, brick_places(:, 1:nodes), point, n, by_parent)
    call to_position(3, nodes, coordinates, by_parent, gradient, jacobian)
  end subroutine brick_gradient

end module core_serendipity
