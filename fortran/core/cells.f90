! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The cells that solids fill and their faces, told apart by dimension and number of nodes: shape functions, integration points, and
!> the polynomial through the values at these points. Nodes are in the order of Abaqus.
module core_cells
  use core_kinds, only: dp
  use core_quadrature, only: gauss_abscissa, outer_abscissa, gauss_point, line_points, line_weights, gauss_rule
  use core_serendipity, only: serendipity_functions, quad_places, brick_places
  use core_simplex, only: simplex_functions, quadratic_simplex, wedge_functions, quadratic_wedge, triangle_points, &
    tetrahedron_points, inner_coordinate
  use core_shape_functions, only: quad_shape, quad_slope, to_position
  implicit none(type, external)
  private
  public :: corners_of, is_linear, is_multilinear, is_product, cell_functions, cell_gradient, node_parents
  public :: cell_point, points_of_cell, point_shares

contains

  !> Number of corners: the nodes of the cell without midside nodes.
  pure integer function corners_of(dim, nodes)
    integer, intent(in) :: dim, nodes

    corners_of = nodes
    if (is_linear(dim, nodes)) return
    select case (nodes)
    case (6)
      corners_of = 3
    case (8, 10)
      corners_of = 4
    case (15)
      corners_of = 6
    case default
      corners_of = 8
    end select
  end function corners_of

  !> Whether a cell has no midside nodes.
  pure logical function is_linear(dim, nodes)
    integer, intent(in) :: dim, nodes

    is_linear = nodes <= merge(4, 8, dim == 2)
  end function is_linear

  !> Whether a cell is a quad of four or a brick of eight nodes.
  pure logical function is_multilinear(dim, nodes)
    integer, intent(in) :: dim, nodes

    is_multilinear = nodes == 2**dim
  end function is_multilinear

  !> Whether a cell is a quad or a brick, with or without midside nodes.
  pure logical function is_product(dim, nodes)
    integer, intent(in) :: dim, nodes

    is_product = corners_of(dim, nodes) == 2**dim
  end function is_product

  !> Whether a cell is a wedge.
  pure logical function is_wedge(dim, nodes)
    integer, intent(in) :: dim, nodes

    is_wedge = dim == 3 .and. any(nodes == [6, 15])
  end function is_wedge

  !> Shape functions and their derivatives by the parent coordinates.
  pure subroutine cell_functions(dim, nodes, parent, n, dn)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: parent(dim)
    real(dp), intent(out) :: n(nodes), dn(nodes, dim)

    if (dim == 2 .and. nodes == 4) then
      n = quad_shape(parent)
      dn = quad_slope(parent)
    else if (is_product(dim, nodes)) then
      if (dim == 2) then
        call serendipity_functions(2, nodes, quad_places(:, 1:nodes), parent, n, dn)
      else
        call serendipity_functions(3, nodes, brick_places(:, 1:nodes), parent, n, dn)
      end if
    else if (is_wedge(dim, nodes)) then
      if (nodes == 6) then
        call wedge_functions(parent, n, dn)
      else
        call quadratic_wedge(parent, n, dn)
      end if
    else if (nodes == dim + 1) then
      call simplex_functions(parent, n, dn)
    else
      call quadratic_simplex(parent, n, dn)
    end if
  end subroutine cell_functions

  !> Derivatives of the shape functions by position, and the Jacobian. Where the Jacobian is not positive the derivatives are zero.
  pure subroutine cell_gradient(dim, nodes, coordinates, parent, gradient, jacobian)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: coordinates(dim, nodes)   !< length
    real(dp), intent(in) :: parent(dim)
    real(dp), intent(out) :: gradient(dim, nodes)     !< 1/length
    real(dp), intent(out) :: jacobian                 !< area or volume
    real(dp) :: n(nodes), by_parent(nodes, dim)

    call cell_functions(dim, nodes, parent, n, by_parent)
    call to_position(dim, nodes, coordinates, by_parent, gradient, jacobian)
  end subroutine cell_gradient

  !> Parent coordinates of the corners.
  pure function node_parents(dim, nodes) result(parents)
    integer, intent(in) :: dim, nodes
    real(dp) :: parents(dim, corners_of(dim, nodes))
    integer :: k

    if (is_product(dim, nodes)) then
      do k = 1, size(parents, 2)
        if (dim == 2) then
          parents(:, k) = quad_places(:, k)
        else
          parents(:, k) = brick_places(:, k)
        end if
      end do
      return
    end if
    parents = 0.0_dp
    if (is_wedge(dim, nodes)) then
      parents(3, 1:3) = -1.0_dp
      parents(3, 4:6) = 1.0_dp
      do k = 1, 2
        parents(k, [k + 1, k + 4]) = 1.0_dp
      end do
    else
      do k = 1, dim
        parents(k, k + 1) = 1.0_dp
      end do
    end if
  end function node_parents

  !> Number of the integration points of Abaqus' element, with full or, in quads and bricks, reduced integration.
  pure integer function points_of_cell(dim, nodes, reduced)
    integer, intent(in) :: dim, nodes
    logical, intent(in) :: reduced

    if (is_product(dim, nodes)) then
      points_of_cell = per_side(dim, nodes, reduced)**dim
    else if (is_wedge(dim, nodes)) then
      points_of_cell = merge(2, 9, nodes == 6)
    else
      points_of_cell = merge(1, dim + 1, nodes == dim + 1)
    end if
  end function points_of_cell

  !> Integration point k and its weight. C3D6 has one in the middle of each half, wedges of 15 nodes have three in each of three
  !> layers.
  pure subroutine cell_point(dim, nodes, reduced, k, parent, weight)
    integer, intent(in) :: dim, nodes
    logical, intent(in) :: reduced
    integer, intent(in) :: k
    real(dp), intent(out) :: parent(dim), weight
    real(dp) :: points(dim, 4), weights(4), height(3), of_layer(3)
    integer :: layers, of_triangle
    logical :: known

    if (is_product(dim, nodes)) then
      if (per_side(dim, nodes, reduced) == 1) then
        parent = 0.0_dp
        weight = 2.0_dp**dim
      else
        call gauss_point(dim, per_side(dim, nodes, reduced), k, parent, weight)
      end if
    else if (is_wedge(dim, nodes)) then
      layers = merge(2, 3, nodes == 6)
      of_triangle = merge(1, 3, nodes == 6)
      height(1:layers) = line_points(layers, gauss_rule)
      of_layer(1:layers) = line_weights(layers, gauss_rule)
      call triangle_points(of_triangle, points(1:2, 1:of_triangle), weights(1:of_triangle), known)
      parent(1:2) = points(1:2, 1 + mod(k - 1, of_triangle))
      parent(3) = height(1 + (k - 1)/of_triangle)
      weight = weights(1 + mod(k - 1, of_triangle))*of_layer(1 + (k - 1)/of_triangle)
    else
      of_triangle = points_of_cell(dim, nodes, reduced)
      if (dim == 2) then
        call triangle_points(of_triangle, points(:, 1:of_triangle), weights(1:of_triangle), known)
      else
        call tetrahedron_points(of_triangle, points(:, 1:of_triangle), weights(1:of_triangle), known)
      end if
      parent = points(:, k)
      weight = weights(k)
    end if
  end subroutine cell_point

  !> Shares of the integration points in the polynomial through their values, at a place.
  pure function point_shares(dim, nodes, reduced, parent) result(shares)
    integer, intent(in) :: dim, nodes
    logical, intent(in) :: reduced
    real(dp), intent(in) :: parent(dim)
    real(dp) :: shares(points_of_cell(dim, nodes, reduced))
    real(dp) :: along(3), triangle(3)
    integer :: i, k, rest, count, layers

    if (is_product(dim, nodes)) then
      count = per_side(dim, nodes, reduced)
      shares = 1.0_dp
      do i = 1, dim
        along(1:count) = line_shares(count, parent(i))
        do k = 1, size(shares)
          rest = mod((k - 1)/count**(i - 1), count)
          shares(k) = shares(k)*along(1 + rest)
        end do
      end do
    else if (is_wedge(dim, nodes)) then
      layers = merge(2, 3, nodes == 6)
      count = size(shares)/layers
      along(1:layers) = line_shares(layers, parent(3))
      triangle(1:count) = simplex_shares(2, count, parent(1:2))
      do k = 1, size(shares)
        shares(k) = triangle(1 + mod(k - 1, count))*along(1 + (k - 1)/count)
      end do
    else
      shares = simplex_shares(dim, size(shares), parent)
    end if
  end function point_shares

  !> Those of Gauss points along a line.
  pure function line_shares(count, s) result(shares)
    integer, intent(in) :: count      !< 1 to 3
    real(dp), intent(in) :: s
    real(dp) :: shares(count)
    real(dp) :: x

    select case (count)
    case (1)
      shares = 1.0_dp
    case (2)
      x = s/gauss_abscissa
      shares = [0.5_dp*(1.0_dp - x), 0.5_dp*(1.0_dp + x)]
    case default
      x = s/outer_abscissa
      shares = [0.5_dp*x*(x - 1.0_dp), 1.0_dp - x*x, 0.5_dp*x*(x + 1.0_dp)]
    end select
  end function line_shares

  !> Those of the one point, or of a point near each corner, of a triangle or tetrahedron.
  pure function simplex_shares(dim, count, parent) result(shares)
    integer, intent(in) :: dim, count
    real(dp), intent(in) :: parent(dim)
    real(dp) :: shares(count)
    real(dp) :: inner

    if (count == 1) then
      shares = 1.0_dp
      return
    end if
    inner = inner_coordinate(dim)
    shares(1) = 1.0_dp - sum(parent)
    shares(2:) = parent
    shares = (shares - inner)/(1.0_dp - (dim + 1)*inner)
  end function simplex_shares

  !> Integration points of a quad or brick along each direction: as many as an edge has nodes, or one less.
  pure integer function per_side(dim, nodes, reduced)
    integer, intent(in) :: dim, nodes
    logical, intent(in) :: reduced

    per_side = merge(2, 3, is_multilinear(dim, nodes)) - merge(1, 0, reduced)
  end function per_side

end module core_cells
