! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Points and weights of the quadrature rules.
module core_quadrature
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: gauss_abscissa, outer_abscissa, line_points, line_weights, gauss_point, triangle_point
  public :: gauss_rule, newton_cotes_rule

  real(dp), parameter :: gauss_abscissa = 0.577350269189625764509148780501957_dp

  !> Outer points of the three-point Gauss rule.
  real(dp), parameter :: outer_abscissa = 0.774596669241483377035853079956480_dp

  integer, parameter :: gauss_rule = 0
  integer, parameter :: newton_cotes_rule = 1

contains

  !> Points of a line rule on (-1, 1): Gauss, or Newton-Cotes (the ends, with three points the middle too).
  pure function line_points(count, rule) result(points)
    integer, intent(in) :: count    !< 2 or 3
    integer, intent(in) :: rule
    real(dp) :: points(count)

    if (count == 2) then
      points = [-1.0_dp, 1.0_dp]
      if (rule == gauss_rule) points = gauss_abscissa*points
    else
      points = [-1.0_dp, 0.0_dp, 1.0_dp]
      if (rule == gauss_rule) points = outer_abscissa*points
    end if
  end function line_points

  !> Their weights; Newton-Cotes of three points is Simpson's rule.
  pure function line_weights(count, rule) result(weights)
    integer, intent(in) :: count    !< 2 or 3
    integer, intent(in) :: rule
    real(dp) :: weights(count)

    if (count == 2) then
      weights = 1.0_dp
    else if (rule == gauss_rule) then
      weights = [5.0_dp, 8.0_dp, 5.0_dp]/9.0_dp
    else
      weights = [1.0_dp, 4.0_dp, 1.0_dp]/3.0_dp
    end if
  end function line_weights

  !> Point k of a Gauss rule of quads or bricks, the first direction first as in Abaqus' CPS4 and C3D8, and its weight.
  pure subroutine gauss_point(dim, per_side, k, point, weight)
    integer, intent(in) :: dim, per_side, k
    real(dp), intent(out) :: point(dim), weight
    real(dp) :: s(per_side), w(per_side)
    integer :: i, at, rest

    s = line_points(per_side, gauss_rule)
    w = line_weights(per_side, gauss_rule)
    weight = 1.0_dp
    rest = k - 1
    do i = 1, dim
      at = mod(rest, per_side) + 1
      rest = rest/per_side
      point(i) = s(at)
      weight = weight*w(at)
    end do
  end subroutine gauss_point

  !> Point k of a rule on a triangle of three or six nodes, next to node k or, as the seventh, in the middle, and its weight. Gauss:
  !> three points of degree 2 or seven of degree 5 (J. Radon, Monatshefte fuer Mathematik und Physik 52 (1948) 286). Newton-Cotes:
  !> the nodes, degree 1, or the nodes and the middle, degree 3.
  pure subroutine triangle_point(nodes, rule, k, parent, weight)
    integer, intent(in) :: nodes, rule, k
    real(dp), intent(out) :: parent(2)    !< area coordinates of nodes 2 and 3
    real(dp), intent(out) :: weight       !< their sum is 1/2
    real(dp), parameter :: root = sqrt(15.0_dp)
    real(dp), parameter :: inner(3) = [1.0_dp/6.0_dp, (6.0_dp - root)/21.0_dp, (6.0_dp + root)/21.0_dp]
    real(dp), parameter :: gauss(2) = [(155.0_dp - root)/2400.0_dp, (155.0_dp + root)/2400.0_dp]
    real(dp), parameter :: closed(2) = [1.0_dp/40.0_dp, 1.0_dp/15.0_dp]
    real(dp) :: near, area(3)
    integer :: corner

    if (k > 6) then
      parent = 1.0_dp/3.0_dp
      weight = merge(9.0_dp/80.0_dp, 9.0_dp/40.0_dp, rule == gauss_rule)
      return
    end if
    if (k <= 3) then
      ! two area coordinates are small and alike
      near = 0.0_dp
      if (rule == gauss_rule) near = merge(inner(1), inner(2), nodes == 3)
      corner = k
      weight = 1.0_dp/6.0_dp
      if (nodes == 6) weight = merge(gauss(1), closed(1), rule == gauss_rule)
    else
      ! node 4 is between nodes 1 and 2: across from corner 3
      near = merge(inner(3), 0.5_dp, rule == gauss_rule)
      corner = 1 + mod(k - 2, 3)
      weight = merge(gauss(2), closed(2), rule == gauss_rule)
    end if
    area = near
    area(corner) = 1.0_dp - 2.0_dp*near
    parent = area(2:3)
  end subroutine triangle_point

end module core_quadrature
