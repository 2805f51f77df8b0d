! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Shape functions and integration points of the built-in continuum elements and their faces: lines of 2 and 3 nodes,
!> triangles of 3 and 6, quadrilaterals of 4 and 8, tetrahedra of 4, hexahedra of 8 and 20, numbered as in Abaqus.
module host_shape
  use host_kinds, only: dp
  implicit none (type, external)
  private
  public :: rule_t, rule_of, radius_of, hourglass_shapes

  !> Parent coordinates of the nodes: corners, then the middles of the edges.
  integer, parameter :: line(3) = [-1, 1, 0]
  integer, parameter :: quad(2, 8) = reshape([-1, -1, 1, -1, 1, 1, -1, 1, 0, -1, 1, 0, 0, 1, -1, 0], [2, 8])
  integer, parameter :: hex(3, 20) = reshape([ &
    -1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1, &
    0, -1, -1, 1, 0, -1, 0, 1, -1, -1, 0, -1, 0, -1, 1, 1, 0, 1, 0, 1, 1, -1, 0, 1, &
    -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0], [3, 20])

  !> Integration points of an element type, points counted along the first direction first.
  type :: rule_t
    integer :: dim = 0, nodes = 0, points = 0
    real(dp), allocatable :: weight(:)      !< (points)
    real(dp), allocatable :: n(:, :)        !< (nodes, points) shape functions
    real(dp), allocatable :: dn(:, :, :)    !< (nodes, dim, points) their derivatives by the parent coordinates
  end type rule_t

  !> Rules asked for so far: they are the same for all elements of a type.
  integer, parameter :: most = 32
  type(rule_t), save, target :: rules(most)
  integer, save :: known = 0

contains

  !> The rule of an element type.
  function rule_of(dim, nodes, points) result(rule)
    integer, intent(in) :: dim, nodes, points
    type(rule_t), pointer :: rule
    real(dp) :: parent(dim)
    integer :: k, p
    do k = 1, known
      rule => rules(k)
      if (rule%nodes == nodes .and. rule%points == points .and. rule%dim == dim) return
    end do
    known = known + 1
    rule => rules(known)
    rule%dim = dim
    rule%nodes = nodes
    rule%points = points
    allocate (rule%weight(points), rule%n(nodes, points), rule%dn(nodes, dim, points))
    do p = 1, points
      call integration_point(dim, nodes, points, p, parent, rule%weight(p))
      call shape_functions(dim, nodes, parent, rule%n(:, p), rule%dn(:, :, p))
    end do
  end function rule_of

  !> Distance of a point from the axis (direction 2) where the element is axisymmetric, else 1.
  pure real(dp) function radius_of(rule, point, axisymmetric, x)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: point
    logical, intent(in) :: axisymmetric
    real(dp), intent(in) :: x(:, :)     !< (dimension, nodes)
    radius_of = 1
    if (axisymmetric) radius_of = dot_product(x(1, :), rule%n(:, point))
  end function radius_of

  !> Parent coordinates and weight of a point.
  pure subroutine integration_point(dim, nodes, points, point, parent, weight)
    integer, intent(in) :: dim, nodes, points, point
    real(dp), intent(out) :: parent(dim), weight
    real(dp), parameter :: two = 1/sqrt(3.0_dp), three = sqrt(0.6_dp), middle = 8.0_dp/9, outer = 5.0_dp/9
    integer :: i, k, rest, along
    if (nodes == dim + 1 .and. points == 1) then
      parent = 1.0_dp/nodes
      weight = merge(0.5_dp, 1.0_dp/6, dim == 2)
      return
    end if
    if (dim == 2 .and. (nodes == 3 .or. nodes == 6)) then
      call triangle_point(points, point, parent, weight)
      return
    end if
    along = nint(real(points, dp)**(1.0_dp/dim))
    rest = point - 1
    weight = 1
    do i = 1, dim
      k = mod(rest, along)
      rest = rest/along
      select case (along)
      case (1)
        parent(i) = 0
        weight = 2*weight
      case (2)
        parent(i) = (2*k - 1)*two
      case default
        parent(i) = (k - 1)*three
        weight = weight*merge(middle, outer, k == 1)
      end select
    end do
  end subroutine integration_point

  !> A point of a triangle: of three, exact for polynomials of degree 2, or of six for those of degree 4 (D.A. Dunavant,
  !> Int. J. for Numerical Methods in Engineering 21 (1985) 1129).
  pure subroutine triangle_point(points, point, parent, weight)
    integer, intent(in) :: points, point
    real(dp), intent(out) :: parent(2), weight
    real(dp), parameter :: near(3) = [1.0_dp/6, 0.445948490915965_dp, 0.091576213509771_dp]
    real(dp), parameter :: area(3) = [1.0_dp/3, 0.223381589678011_dp, 0.109951743655322_dp]
    integer :: kind
    kind = 1
    if (points == 6) kind = merge(2, 3, point <= 3)
    weight = 0.5_dp*area(kind)
    parent = near(kind)
    if (mod(point, 3) == 2) parent(1) = 1 - 2*near(kind)
    if (mod(point, 3) == 0) parent(2) = 1 - 2*near(kind)
  end subroutine triangle_point

  !> Quadratic functions of a triangle: corners, then the middles of the edges.
  pure subroutine triangle_functions(parent, n, dn)
    real(dp), intent(in) :: parent(2)
    real(dp), intent(out) :: n(6), dn(6, 2)
    real(dp), parameter :: slope(3, 2) = reshape([-1.0_dp, 1.0_dp, 0.0_dp, -1.0_dp, 0.0_dp, 1.0_dp], [3, 2])
    real(dp) :: area(3)
    integer :: k, next
    area = [1 - sum(parent), parent]
    do k = 1, 3
      next = mod(k, 3) + 1
      n(k) = area(k)*(2*area(k) - 1)
      dn(k, :) = (4*area(k) - 1)*slope(k, :)
      n(3 + k) = 4*area(k)*area(next)
      dn(3 + k, :) = 4*(area(k)*slope(next, :) + area(next)*slope(k, :))
    end do
  end subroutine triangle_functions

  !> Shape functions and their derivatives by the parent coordinates.
  pure subroutine shape_functions(dim, nodes, parent, n, dn)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: parent(dim)
    real(dp), intent(out) :: n(nodes), dn(nodes, dim)
    integer :: k
    if (nodes == dim + 1 .and. dim > 1) then
      n = [1 - sum(parent), parent]
      dn = 0
      dn(1, :) = -1
      do k = 1, dim
        dn(k + 1, k) = 1
      end do
    else if (dim == 2 .and. nodes == 6) then
      call triangle_functions(parent, n, dn)
    else
      do k = 1, nodes
        call node_function(dim, node_at(dim, k), nodes > 2**dim, parent, n(k), dn(k, :))
      end do
    end if
  end subroutine shape_functions

  pure function node_at(dim, k) result(place)
    integer, intent(in) :: dim, k
    integer :: place(dim)
    select case (dim)
    case (1)
      place = line(k)
    case (2)
      place = quad(:, k)
    case default
      place = hex(:, k)
    end select
  end function node_at

  !> One function: a product over the directions, times a sum where there are middle nodes (serendipity family).
  pure subroutine node_function(dim, place, serendipity, parent, n, dn)
    integer, intent(in) :: dim, place(dim)
    logical, intent(in) :: serendipity
    real(dp), intent(in) :: parent(dim)
    real(dp), intent(out) :: n, dn(dim)
    real(dp) :: factor(dim), slope(dim), total, others
    integer :: i, j
    logical :: corner
    corner = all(place /= 0)
    where (place == 0)
      factor = 1 - parent**2
      slope = -2*parent
    else where
      factor = (1 + place*parent)/2
      slope = 0.5_dp*place
    end where
    total = 1
    if (serendipity .and. corner) total = sum(place*parent) - (dim - 1)
    n = product(factor)*total
    do i = 1, dim
      others = 1
      do j = 1, dim
        if (j /= i) others = others*factor(j)
      end do
      dn(i) = slope(i)*others*total
      if (serendipity .and. corner) dn(i) = dn(i) + product(factor)*place(i)
    end do
  end subroutine node_function

  !> Patterns of displacement without strain in the middle of an element of 4 or 8 nodes, 1 and -1 at the nodes:
  !> xy; and yz, xz, xy, xyz.
  pure function hourglass_shapes(dim) result(pattern)
    integer, intent(in) :: dim
    real(dp) :: pattern(2**dim, merge(1, 4, dim == 2))
    if (dim == 2) then
      pattern(:, 1) = quad(1, :4)*quad(2, :4)
    else
      pattern(:, 1) = hex(2, :8)*hex(3, :8)
      pattern(:, 2) = hex(1, :8)*hex(3, :8)
      pattern(:, 3) = hex(1, :8)*hex(2, :8)
      pattern(:, 4) = pattern(:, 3)*hex(3, :8)
    end if
  end function hourglass_shapes
end module host_shape
