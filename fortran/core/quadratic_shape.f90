! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Shape functions of the eight-node serendipity quad. Nodes: corners counter-clockwise, then the middles of the edges 1-2,
!> 2-3, 3-4 and 4-1.
module core_quadratic_shape
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: quad8_gradient

  real(dp), parameter :: xi_of_node(8) = [-1.0_dp, 1.0_dp, 1.0_dp, -1.0_dp, 0.0_dp, 1.0_dp, 0.0_dp, -1.0_dp]
  real(dp), parameter :: eta_of_node(8) = [-1.0_dp, -1.0_dp, 1.0_dp, 1.0_dp, -1.0_dp, 0.0_dp, 1.0_dp, 0.0_dp]

contains

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
