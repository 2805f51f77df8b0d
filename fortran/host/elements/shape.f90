! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Shape functions and integration points of the built-in continuum elements and their faces.
!>
!> A family is a cell with its interpolation. Families have the numbers of harness/uel/model/element_types.py, and nodes in the
!> order of Abaqus: corners, then the midside nodes. The rest of what defines an element type is in that file.
!> Numbers beyond those are families with integration points of their own (define_rule), of sections with layers.
module host_shape
  use core_serendipity, only: brick_places, quad_places, serendipity_functions
  use core_simplex, only: quadratic_simplex, quadratic_wedge, simplex_functions, tetrahedron_points, triangle_points, &
                          wedge_functions
  use host_kinds, only: dp, i4
  use host_messages, only: add_message
  use host_protect, only: escape
  implicit none (type, external)
  private
  public :: line2, quad4, tri3, rule_t, rule_of, find_rule, is_quadratic, is_multilinear, radius_of, hourglass_shapes, &
            parent_place, slopes_at_nodes, define_rule

  integer, parameter :: line2 = 1, line3 = 2, tri3 = 3, tri6 = 4, quad4 = 5, quad8 = 6, tet4 = 7, hex8 = 8, hex20 = 9, tet10 = 10
  integer, parameter :: wedge6 = 11, wedge15 = 12, families = wedge15, most_points = 27

  !> Parent coordinates of the nodes of lines.
  integer, parameter :: line(1, 3) = reshape([-1, 1, 0], [1, 3])

  !> Integration points of a family, counted along the first direction first.
  type :: rule_t
    integer :: family = 0, dim = 0, nodes = 0, corners = 0, points = 0
    logical :: reduced = .false.            !< one point stands for a quadrilateral or hexahedron, or for each of its layers
    real(dp), allocatable :: weight(:)      !< (points)
    real(dp), allocatable :: n(:, :)        !< (nodes, points) shape functions
    real(dp), allocatable :: dn(:, :, :)    !< (nodes, dim, points) their derivatives by the parent coordinates
  end type rule_t

  !> Rules requested so far, by family and number of points.
  type(rule_t), save, target :: rules(families, most_points)

  type :: shelf_t
    type(rule_t), pointer :: rule => null()
  end type shelf_t

  type(shelf_t), allocatable, save :: defined(:)   !< those of define_rule

contains

  !> The rule of a family. Leaves the pass if there is none.
  function rule_of(family, points) result(rule)
    integer, intent(in) :: family, points
    type(rule_t), pointer :: rule
    character(len=80) :: text
    call find_rule(family, points, rule)
    if (associated(rule)) return
    write (text, '(a,i0,a,i0,a)') 'family ', family, ' with ', points, ' integration points is not known to the host'
    call add_message(-3_i4, trim(text))
    call escape()
  end function rule_of

  !> The rule of a family, not associated if there is none.
  subroutine find_rule(family, points, rule)
    integer, intent(in) :: family, points
    type(rule_t), pointer, intent(out) :: rule
    nullify (rule)
    if (family > families .and. allocated(defined)) then
      if (family > families + size(defined)) return
      associate (own => defined(family - families)%rule)
        if (own%points == points) then
          rule => own
        else
          call find_standard(own%family, points, rule)
        end if
      end associate
    else
      call find_standard(family, points, rule)
    end if
  end subroutine find_rule

  !> The same of a family that is not defined by its points.
  subroutine find_standard(family, points, rule)
    integer, intent(in) :: family, points
    type(rule_t), pointer, intent(out) :: rule
    real(dp), allocatable :: parent(:, :), weight(:)
    logical :: known
    nullify (rule)
    if (min(family, points) < 1 .or. family > families .or. points > most_points) return
    if (.not. allocated(rules(family, points)%weight)) then
      allocate (parent(sizes_of(family, 1), points), weight(points))
      call integration_points(family, points, parent, weight, known)
      if (.not. known) return
      call evaluate(family, parent, weight, rules(family, points))
    end if
    rule => rules(family, points)
  end subroutine find_standard

  !> Make a rule known; returns the number of a family that has it, and with any other number of points the rule of the family.
  function define_rule(family, parent, weight, reduced) result(number)
    integer, intent(in) :: family
    logical, intent(in) :: reduced
    real(dp), intent(in) :: parent(:, :), weight(:)    !< (dimension, points) parent coordinates; weights
    integer :: number
    type(shelf_t) :: new
    allocate (new%rule)
    call evaluate(family, parent, weight, new%rule)
    new%rule%reduced = reduced
    if (.not. allocated(defined)) allocate (defined(0))
    defined = [defined, new]
    number = families + size(defined)
  end function define_rule

  !> Shape functions at the points of a rule.
  subroutine evaluate(family, parent, weight, rule)
    integer, intent(in) :: family
    real(dp), intent(in) :: parent(:, :), weight(:)
    type(rule_t), intent(out) :: rule
    integer :: p
    rule%family = family
    rule%dim = sizes_of(family, 1)
    rule%nodes = sizes_of(family, 2)
    rule%corners = sizes_of(family, 3)
    rule%points = size(weight)
    rule%reduced = rule%points == 1 .and. is_multilinear(rule)
    allocate (rule%n(rule%nodes, rule%points), rule%dn(rule%nodes, rule%dim, rule%points))
    do p = 1, rule%points
      call shape_functions(family, parent(:, p), rule%n(:, p), rule%dn(:, :, p))
    end do
    rule%weight = weight
  end subroutine evaluate

  !> Dimension, nodes or corners of a family.
  pure integer function sizes_of(family, which)
    integer, intent(in) :: family, which
    integer :: sizes(3)
    select case (family)
    case (line2)
      sizes = [1, 2, 2]
    case (line3)
      sizes = [1, 3, 2]
    case (tri3)
      sizes = [2, 3, 3]
    case (tri6)
      sizes = [2, 6, 3]
    case (quad4)
      sizes = [2, 4, 4]
    case (quad8)
      sizes = [2, 8, 4]
    case (tet4)
      sizes = [3, 4, 4]
    case (hex8)
      sizes = [3, 8, 8]
    case (hex20)
      sizes = [3, 20, 8]
    case (tet10)
      sizes = [3, 10, 4]
    case (wedge6)
      sizes = [3, 6, 6]
    case (wedge15)
      sizes = [3, 15, 6]
    case default
      sizes = 0
    end select
    sizes_of = sizes(which)
  end function sizes_of

  !> Whether there are midside nodes.
  pure logical function is_quadratic(rule)
    type(rule_t), intent(in) :: rule
    is_quadratic = rule%nodes > rule%corners
  end function is_quadratic

  !> Quadrilaterals of four and hexahedra of eight nodes.
  pure logical function is_multilinear(rule)
    type(rule_t), intent(in) :: rule
    is_multilinear = any(rule%family == [quad4, hex8])
  end function is_multilinear

  !> Parent coordinates of a point of a triangle, a quadrilateral or a hexahedron.
  pure function parent_place(rule, point) result(place)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: point
    real(dp) :: place(rule%dim)
    select case (rule%family)
    case (tri3)
      place = rule%n(2:, point)
    case (quad4, quad8)
      place = matmul(quad_places(:, :rule%nodes), rule%n(:, point))
    case default
      place = matmul(brick_places(:, :rule%nodes), rule%n(:, point))
    end select
  end function parent_place

  !> Derivatives of the shape functions by the parent coordinates at the nodes (nodes, 2, place) of a triangle of three nodes or of
  !> a quadrilateral.
  pure function slopes_at_nodes(family) result(slopes)
    integer, intent(in) :: family
    real(dp), allocatable :: slopes(:, :, :)
    real(dp), allocatable :: n(:)
    integer :: k, nodes
    nodes = sizes_of(family, 2)
    allocate (slopes(nodes, 2, nodes), n(nodes))
    do k = 1, nodes
      call shape_functions(family, real(quad_places(:, k), dp), n, slopes(:, :, k))
    end do
  end function slopes_at_nodes

  !> Distance of a point from the axis (direction 2) if the element is axisymmetric, else 1.
  pure real(dp) function radius_of(rule, point, axisymmetric, x)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: point
    logical, intent(in) :: axisymmetric
    real(dp), intent(in) :: x(:, :)     !< (dimension, nodes)
    radius_of = 1
    if (axisymmetric) radius_of = dot_product(x(1, :), rule%n(:, point))
  end function radius_of

  !> Parent coordinates (dimension, points) and weights; known is false if a family has no such rule.
  pure subroutine integration_points(family, points, parent, weight, known)
    integer, intent(in) :: family, points
    real(dp), intent(out) :: parent(:, :), weight(:)
    logical, intent(out) :: known
    select case (family)
    case (line2, line3, quad4, quad8, hex8, hex20)
      call gauss_points(parent, weight, known)
    case (tri3, tri6)
      call triangle_points(points, parent, weight, known)
    case (tet4, tet10)
      call tetrahedron_points(points, parent, weight, known)
    case (wedge6, wedge15)
      call wedge_points(points, parent, weight, known)
    case default
      known = .false.
    end select
  end subroutine integration_points

  !> One, two or three Gauss points in each direction.
  pure subroutine gauss_points(parent, weight, known)
    real(dp), intent(out) :: parent(:, :), weight(:)
    logical, intent(out) :: known
    real(dp), parameter :: two = 1/sqrt(3.0_dp), three = sqrt(0.6_dp), middle = 8.0_dp/9, outer = 5.0_dp/9
    integer :: along, i, k, p, rest
    along = nint(real(size(weight), dp)**(1.0_dp/size(parent, 1)))
    known = along <= 3 .and. along**size(parent, 1) == size(weight)
    do p = 1, size(weight)
      rest = p - 1
      weight(p) = 1
      do i = 1, size(parent, 1)
        k = mod(rest, along)
        rest = rest/along
        select case (along)
        case (1)
          parent(i, p) = 0
          weight(p) = 2*weight(p)
        case (2)
          parent(i, p) = (2*k - 1)*two
        case default
          parent(i, p) = (k - 1)*three
          weight(p) = weight(p)*merge(middle, outer, k == 1)
        end select
      end do
    end do
  end subroutine gauss_points

  !> Points of a wedge: its middle, or those of a triangle, one layer after the other at two or three Gauss points across.
  pure subroutine wedge_points(points, parent, weight, known)
    integer, intent(in) :: points
    real(dp), intent(out) :: parent(:, :), weight(:)
    logical, intent(out) :: known
    real(dp), allocatable :: triangle(:, :), area(:), across(:, :), height(:)
    integer :: first, k, layers
    layers = merge(1, 2, points == 1)
    if (mod(points, 3) == 0 .and. points > 6) layers = 3
    allocate (triangle(2, points/layers), area(points/layers), across(1, layers), height(layers))
    call gauss_points(across, height, known)
    call triangle_points(size(area), triangle, area, known)
    known = known .and. layers*size(area) == points
    if (.not. known) return
    do k = 1, layers
      first = (k - 1)*size(area)
      parent(:2, first + 1:first + size(area)) = triangle
      parent(3, first + 1:first + size(area)) = across(1, k)
      weight(first + 1:first + size(area)) = height(k)*area
    end do
  end subroutine wedge_points

  !> Shape functions and their derivatives by the parent coordinates.
  pure subroutine shape_functions(family, parent, n, dn)
    integer, intent(in) :: family
    real(dp), intent(in) :: parent(:)
    real(dp), intent(out) :: n(:), dn(:, :)
    select case (family)
    case (line2, line3)
      call serendipity_functions(1, size(n), line(:, :size(n)), parent, n, dn)
    case (quad4, quad8)
      call serendipity_functions(2, size(n), quad_places(:, :size(n)), parent, n, dn)
    case (hex8, hex20)
      call serendipity_functions(3, size(n), brick_places(:, :size(n)), parent, n, dn)
    case (tri3, tet4)
      call simplex_functions(parent, n, dn)
    case (tri6, tet10)
      call quadratic_simplex(parent, n, dn)
    case (wedge6)
      call wedge_functions(parent, n, dn)
    case (wedge15)
      call quadratic_wedge(parent, n, dn)
    case default   ! other families have no points
      n = 0
      dn = 0
    end select
  end subroutine shape_functions

  !> Displacement patterns without strain in the middle of an element with 4 or 8 nodes, 1 and -1 at the nodes: xy; and yz, xz, xy,
  !> xyz.
  pure function hourglass_shapes(dim) result(pattern)
    integer, intent(in) :: dim
    real(dp) :: pattern(2**dim, merge(1, 4, dim == 2))
    if (dim == 2) then
      pattern(:, 1) = quad_places(1, :4)*quad_places(2, :4)
    else
      pattern(:, 1) = brick_places(2, :8)*brick_places(3, :8)
      pattern(:, 2) = brick_places(1, :8)*brick_places(3, :8)
      pattern(:, 3) = brick_places(1, :8)*brick_places(2, :8)
      pattern(:, 4) = pattern(:, 3)*brick_places(3, :8)
    end if
  end function hourglass_shapes
end module host_shape
