! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Shape functions and integration points of triangles, tetrahedra and wedges, nodes in the order of Abaqus: corners, then midside
!> nodes. Parent coordinates of a simplex are its area or volume coordinates but the first; the third one of a wedge is from -1
!> to 1.
module core_simplex
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: simplex_functions, quadratic_simplex, wedge_functions, quadratic_wedge
  public :: triangle_points, tetrahedron_points, inner_coordinate

  !> Smallest area or volume coordinate of the points of the rules of degree 2: three in a triangle, four in a tetrahedron.
  real(dp), parameter :: inner_coordinate(2:3) = [1.0_dp/6.0_dp, (5.0_dp - sqrt(5.0_dp))/20.0_dp]

contains

  !> Linear functions of a triangle or tetrahedron.
  pure subroutine simplex_functions(parent, n, dn)
    real(dp), intent(in) :: parent(:)
    real(dp), intent(out) :: n(:), dn(:, :)
    integer :: k

    n(1) = 1.0_dp - sum(parent)
    n(2:) = parent
    dn = 0.0_dp
    dn(1, :) = -1.0_dp
    do k = 1, size(parent)
      dn(k + 1, k) = 1.0_dp
    end do
  end subroutine simplex_functions

  !> Quadratic functions of a triangle or tetrahedron.
  pure subroutine quadratic_simplex(parent, n, dn)
    real(dp), intent(in) :: parent(:)
    real(dp), intent(out) :: n(:), dn(:, :)
    integer, parameter :: ends(2, 6) = reshape([1, 2, 2, 3, 3, 1, 1, 4, 2, 4, 3, 4], [2, 6])
    real(dp) :: linear(size(parent) + 1), slope(size(parent) + 1, size(parent))
    integer :: corners, k

    call simplex_functions(parent, linear, slope)
    corners = size(linear)
    do k = 1, corners
      n(k) = linear(k)*(2.0_dp*linear(k) - 1.0_dp)
      dn(k, :) = (4.0_dp*linear(k) - 1.0_dp)*slope(k, :)
    end do
    do k = 1, size(n) - corners
      associate (a => ends(1, k), b => ends(2, k))
        n(corners + k) = 4.0_dp*linear(a)*linear(b)
        dn(corners + k, :) = 4.0_dp*(linear(a)*slope(b, :) + linear(b)*slope(a, :))
      end associate
    end do
  end subroutine quadratic_simplex

  !> Functions of a wedge: linear ones of the triangle 1-2-3 and of the third coordinate.
  pure subroutine wedge_functions(parent, n, dn)
    real(dp), intent(in) :: parent(:)
    real(dp), intent(out) :: n(:), dn(:, :)
    real(dp) :: linear(3), slope(3, 2)
    integer :: first, side

    call simplex_functions(parent(:2), linear, slope)
    do side = -1, 1, 2
      first = merge(0, 3, side < 0)
      n(first + 1:first + 3) = linear*(1.0_dp + side*parent(3))/2.0_dp
      dn(first + 1:first + 3, :2) = slope*(1.0_dp + side*parent(3))/2.0_dp
      dn(first + 1:first + 3, 3) = side*linear/2.0_dp
    end do
  end subroutine wedge_functions

  !> Functions of a wedge with midside nodes: of both triangles, then of the edges between them.
  pure subroutine quadratic_wedge(parent, n, dn)
    real(dp), intent(in) :: parent(:)
    real(dp), intent(out) :: n(:), dn(:, :)
    real(dp) :: linear(3), slope(3, 2), of_triangle(6), its_slope(6, 2), across, by_third
    integer :: corner, edge, side

    call simplex_functions(parent(:2), linear, slope)
    call quadratic_simplex(parent(:2), of_triangle, its_slope)
    do side = -1, 1, 2
      corner = merge(0, 3, side < 0)
      edge = corner + 6
      across = (1.0_dp + side*parent(3))/2.0_dp
      by_third = 0.5_dp*side
      n(corner + 1:corner + 3) = of_triangle(:3)*across
      n(edge + 1:edge + 3) = of_triangle(4:)*across
      dn(corner + 1:corner + 3, :2) = its_slope(:3, :)*across
      dn(edge + 1:edge + 3, :2) = its_slope(4:, :)*across
      dn(corner + 1:corner + 3, 3) = of_triangle(:3)*by_third
      dn(edge + 1:edge + 3, 3) = of_triangle(4:)*by_third
    end do
    across = 1.0_dp - parent(3)**2
    by_third = -2.0_dp*parent(3)
    n(13:) = linear*across
    dn(13:, :2) = slope*across
    dn(13:, 3) = linear*by_third
    ! a corner function is the linear one across minus half of that of the midside node
    n(:3) = n(:3) - n(13:)/2.0_dp
    n(4:6) = n(4:6) - n(13:)/2.0_dp
    dn(:3, :) = dn(:3, :) - dn(13:, :)/2.0_dp
    dn(4:6, :) = dn(4:6, :) - dn(13:, :)/2.0_dp
  end subroutine quadratic_wedge

  !> Points of a triangle: its middle; three, exact for polynomials of degree 2, the first near node 1, and so on; or six for those
  !> of degree 4 (D.A. Dunavant, Int. J. for Numerical Methods in Engineering 21 (1985) 1129).
  pure subroutine triangle_points(points, parent, weight, known)
    integer, intent(in) :: points
    real(dp), intent(out) :: parent(:, :), weight(:)
    logical, intent(out) :: known
    real(dp), parameter :: near(3) = [inner_coordinate(2), 0.445948490915965_dp, 0.091576213509771_dp]
    real(dp), parameter :: area(3) = [1.0_dp/3.0_dp, 0.223381589678011_dp, 0.109951743655322_dp]
    integer :: kind, p

    known = any(points == [1, 3, 6])
    parent = 1.0_dp/3.0_dp
    weight = 0.5_dp
    if (points == 1) return
    do p = 1, points
      kind = 1
      if (points == 6) kind = merge(2, 3, p <= 3)
      weight(p) = 0.5_dp*area(kind)
      parent(:, p) = near(kind)
      if (mod(p, 3) == 2) parent(1, p) = 1.0_dp - 2.0_dp*near(kind)
      if (mod(p, 3) == 0) parent(2, p) = 1.0_dp - 2.0_dp*near(kind)
    end do
  end subroutine triangle_points

  !> Points of a tetrahedron: its middle; four, exact for polynomials of degree 2, the first near node 1, and so on; or
  !> fifteen for those of degree 5 (A.H. Stroud, Approximate Calculation of Multiple Integrals, 1971, T3: 5-1).
  pure subroutine tetrahedron_points(points, parent, weight, known)
    integer, intent(in) :: points
    real(dp), intent(out) :: parent(:, :), weight(:)
    logical, intent(out) :: known
    real(dp), parameter :: root = sqrt(15.0_dp)
    real(dp), parameter :: near(2) = [(7.0_dp - root)/34.0_dp, (7.0_dp + root)/34.0_dp], edge = (5.0_dp - root)/20.0_dp
    real(dp), parameter :: volume(2) = [2665.0_dp + 14.0_dp*root, 2665.0_dp - 14.0_dp*root]/37800.0_dp
    real(dp) :: corner(4)
    integer :: i, j, k

    known = any(points == [1, 4, 15])
    parent = 0.25_dp
    weight = 1.0_dp/6.0_dp
    select case (points)
    case (4)
      weight = 1.0_dp/24.0_dp
      do k = 1, 4
        corner = inner_coordinate(3)
        corner(k) = 1.0_dp - 3.0_dp*inner_coordinate(3)
        parent(:, k) = corner(2:)
      end do
    case (15)
      weight(1) = 16.0_dp/(6.0_dp*135.0_dp)
      do i = 1, 2
        do k = 1, 4
          corner = near(i)
          corner(k) = 1.0_dp - 3.0_dp*near(i)
          parent(:, 4*i - 3 + k) = corner(2:)
          weight(4*i - 3 + k) = volume(i)/6.0_dp
        end do
      end do
      k = 9
      do i = 1, 3
        do j = i + 1, 4
          k = k + 1
          corner = edge
          corner([i, j]) = 0.5_dp - edge
          parent(:, k) = corner(2:)
          weight(k) = 10.0_dp/(6.0_dp*189.0_dp)
        end do
      end do
    case default   ! the middle
    end select
  end subroutine tetrahedron_points

end module core_simplex
