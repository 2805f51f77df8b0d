! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Shape functions of lines with two or three nodes and of the bilinear quad, nodes counter-clockwise.
module core_shape_functions
  use core_kinds, only: dp
  use core_small_matrix, only: invert
  implicit none(type, external)
  private
  public :: line_shape, line_slope, quad_shape, quad_slope, quad_gradient, to_position

  real(dp), parameter :: xi_of_node(4) = [-1.0_dp, 1.0_dp, 1.0_dp, -1.0_dp]
  real(dp), parameter :: eta_of_node(4) = [-1.0_dp, -1.0_dp, 1.0_dp, 1.0_dp]

contains

  !> Shape functions of a line with two nodes (its ends) or three (the middle one last), at s in (-1, 1).
  pure function line_shape(nodes, s) result(shape)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: s
    real(dp) :: shape(nodes)

    if (nodes == 2) then
      shape = [0.5_dp*(1.0_dp - s), 0.5_dp*(1.0_dp + s)]
    else
      shape = [0.5_dp*s*(s - 1.0_dp), 0.5_dp*s*(s + 1.0_dp), 1.0_dp - s*s]
    end if
  end function line_shape

  !> Their derivatives by s.
  pure function line_slope(nodes, s) result(slope)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: s
    real(dp) :: slope(nodes)

    if (nodes == 2) then
      slope = [-0.5_dp, 0.5_dp]
    else
      slope = [s - 0.5_dp, s + 0.5_dp, -2.0_dp*s]
    end if
  end function line_slope

  !> Shape functions of the four nodes at (xi, eta).
  pure function quad_shape(point) result(shape)
    real(dp), intent(in) :: point(2)
    real(dp) :: shape(4)

    shape = 0.25_dp*(1.0_dp + xi_of_node*point(1))*(1.0_dp + eta_of_node*point(2))
  end function quad_shape

  !> Their derivatives by xi and eta.
  pure function quad_slope(point) result(slope)
    real(dp), intent(in) :: point(2)
    real(dp) :: slope(4, 2)

    slope(:, 1) = 0.25_dp*xi_of_node*(1.0_dp + eta_of_node*point(2))
    slope(:, 2) = 0.25_dp*eta_of_node*(1.0_dp + xi_of_node*point(1))
  end function quad_slope

  !> Derivatives of the shape functions by x and y, and the Jacobian, at (xi, eta).
  !> Where the Jacobian is not positive the derivatives are zero.
  pure subroutine quad_gradient(coordinates, point, gradient, jacobian)
    real(dp), intent(in) :: coordinates(2, 4)  !< nodes, length
    real(dp), intent(in) :: point(2)           !< (xi, eta)
    real(dp), intent(out) :: gradient(2, 4)    !< dN/dx, dN/dy of each node, 1/length
    real(dp), intent(out) :: jacobian          !< d(x, y)/d(xi, eta), area

    call to_position(2, 4, coordinates, quad_slope(point), gradient, jacobian)
  end subroutine quad_gradient

  !> Derivatives of shape functions by position from those by the parent coordinates, and the Jacobian.
  !> Where the Jacobian is not positive the derivatives are zero.
  pure subroutine to_position(dim, nodes, coordinates, by_parent, gradient, jacobian)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: coordinates(dim, nodes)   !< nodes, length
    real(dp), intent(in) :: by_parent(nodes, dim)     !< derivatives of each node's function
    real(dp), intent(out) :: gradient(dim, nodes)     !< 1/length
    real(dp), intent(out) :: jacobian                 !< area or volume
    real(dp) :: by_xi(2), by_eta(2), by_all(3, 3), inverse(3, 3)
    integer :: a, i

    if (dim == 3) then
      by_all = 0.0_dp
      do i = 1, 3
        do a = 1, nodes
          by_all(:, i) = by_all(:, i) + coordinates(:, a)*by_parent(a, i)
        end do
      end do
      call invert(3, by_all, inverse, jacobian)
      do a = 1, nodes
        gradient(:, a) = by_parent(a, 1)*inverse(1, :) + by_parent(a, 2)*inverse(2, :) + by_parent(a, 3)*inverse(3, :)
      end do
      if (.not. jacobian > 0.0_dp) gradient = 0.0_dp
      return
    end if
    by_xi = 0.0_dp
    by_eta = 0.0_dp
    do a = 1, nodes
      by_xi = by_xi + coordinates(1:2, a)*by_parent(a, 1)
      by_eta = by_eta + coordinates(1:2, a)*by_parent(a, 2)
    end do
    jacobian = by_xi(1)*by_eta(2) - by_xi(2)*by_eta(1)
    if (jacobian > 0.0_dp) then
      gradient(1, :) = (by_eta(2)*by_parent(:, 1) - by_xi(2)*by_parent(:, 2))/jacobian
      gradient(2, :) = (by_xi(1)*by_parent(:, 2) - by_eta(1)*by_parent(:, 1))/jacobian
    else
      gradient = 0.0_dp
    end if
  end subroutine to_position

end module core_shape_functions
