! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Quadratic line and eight-node serendipity quad: shape functions, and the rules of three points.
!>
!> Nodes of the line: both ends, then the middle. Nodes of the quad: corners counter-clockwise, then the middles of the
!> edges 1-2, 2-3, 3-4 and 4-1.
module core_quadratic_shape
  use core_kinds, only: dp
  use core_quadrature, only: gauss_rule
  implicit none(type, external)
  private
  public :: line3_shape, line3_slope, quad8_gradient, three_points, three_weights, outer_abscissa

  !> Outer Gauss points of the rule of three.
  real(dp), parameter :: outer_abscissa = 0.774596669241483377035853079956480_dp

  real(dp), parameter :: xi_of_node(8) = [-1.0_dp, 1.0_dp, 1.0_dp, -1.0_dp, 0.0_dp, 1.0_dp, 0.0_dp, -1.0_dp]
  real(dp), parameter :: eta_of_node(8) = [-1.0_dp, -1.0_dp, 1.0_dp, 1.0_dp, -1.0_dp, 0.0_dp, 1.0_dp, 0.0_dp]

contains

  !> The three points of a line rule on (-1, 1): Gauss, or Newton-Cotes (the nodes: Simpson's rule).
  pure function three_points(rule) result(points)
    integer, intent(in) :: rule
    real(dp) :: points(3)

    points = [-1.0_dp, 0.0_dp, 1.0_dp]
    if (rule == gauss_rule) points = outer_abscissa*points
  end function three_points

  !> Their weights.
  pure function three_weights(rule) result(weights)
    integer, intent(in) :: rule
    real(dp) :: weights(3)

    if (rule == gauss_rule) then
      weights = [5.0_dp, 8.0_dp, 5.0_dp]/9.0_dp
    else
      weights = [1.0_dp, 4.0_dp, 1.0_dp]/3.0_dp
    end if
  end function three_weights

  !> Shape functions of the line at s.
  pure function line3_shape(s) result(shape)
    real(dp), intent(in) :: s
    real(dp) :: shape(3)

    shape = [0.5_dp*s*(s - 1.0_dp), 0.5_dp*s*(s + 1.0_dp), 1.0_dp - s*s]
  end function line3_shape

  !> Their derivatives by s.
  pure function line3_slope(s) result(slope)
    real(dp), intent(in) :: s
    real(dp) :: slope(3)

    slope = [s - 0.5_dp, s + 0.5_dp, -2.0_dp*s]
  end function line3_slope

  !> Derivatives of the shape functions of the quad by x and y, and the Jacobian, at (xi, eta).
  !> Where the Jacobian is not positive the derivatives are zero.
  pure subroutine quad8_gradient(coordinates, point, gradient, jacobian)
    real(dp), intent(in) :: coordinates(2, 8)  !< nodes, length
    real(dp), intent(in) :: point(2)           !< (xi, eta)
    real(dp), intent(out) :: gradient(2, 8)    !< dN/dx, dN/dy of each node, 1/length
    real(dp), intent(out) :: jacobian          !< d(x, y)/d(xi, eta), area
    real(dp) :: along_xi(8), along_eta(8), by_xi(2), by_eta(2), a, b
    integer :: i

    do i = 1, 8
      a = xi_of_node(i)*point(1)
      b = eta_of_node(i)*point(2)
      if (i <= 4) then
        ! (1 + a)(1 + b)(a + b - 1)/4
        along_xi(i) = 0.25_dp*xi_of_node(i)*(1.0_dp + b)*(2.0_dp*a + b)
        along_eta(i) = 0.25_dp*eta_of_node(i)*(1.0_dp + a)*(a + 2.0_dp*b)
      else if (mod(i, 2) == 1) then
        ! (1 - xi^2)(1 + b)/2
        along_xi(i) = -point(1)*(1.0_dp + b)
        along_eta(i) = 0.5_dp*eta_of_node(i)*(1.0_dp - point(1)**2)
      else
        along_xi(i) = 0.5_dp*xi_of_node(i)*(1.0_dp - point(2)**2)
        along_eta(i) = -point(2)*(1.0_dp + a)
      end if
    end do
    by_xi = matmul(coordinates, along_xi)
    by_eta = matmul(coordinates, along_eta)
    jacobian = by_xi(1)*by_eta(2) - by_xi(2)*by_eta(1)
    if (jacobian > 0.0_dp) then
      gradient(1, :) = (by_eta(2)*along_xi - by_xi(2)*along_eta)/jacobian
      gradient(2, :) = (by_xi(1)*along_eta - by_eta(1)*along_xi)/jacobian
    else
      gradient = 0.0_dp
    end if
  end subroutine quad8_gradient

end module core_quadratic_shape
