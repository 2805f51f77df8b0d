! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Four-node bilinear quad in the plane, small strain: the contribution of a point to the element, and the points of a face.
!>
!> Faces are those of Abaqus: face 1 from node 1 to node 2, face 2 from 2 to 3, face 3 from 3 to 4, face 4 from 4 to 1.
!> A place on a face is t in (-1, 1) from its first to its second node.
module elements_quad4
  use core_kinds, only: dp
  use core_quadrature, only: gauss_abscissa
  implicit none(type, external)
  private
  public :: quad4_nodes, quad4_unknowns, quad4_points
  public :: quad4_area, quad4_strain, quad4_add_force, quad4_add_stiffness, face_point
  public :: face_nodes, gauss_of_face, face_places

  integer, parameter :: quad4_nodes = 4, quad4_unknowns = 2*quad4_nodes

  !> 2 x 2 Gauss points.
  integer, parameter :: quad4_points = 4

  !> First and second node of each face.
  integer, parameter :: face_nodes(2, 4) = reshape([1, 2, 2, 3, 3, 4, 4, 1], [2, 4])

  !> Gauss points next to the first and to the second node of each face.
  integer, parameter :: gauss_of_face(2, 4) = reshape([1, 2, 2, 4, 4, 3, 3, 1], [2, 4])

  !> Positions on a face where an interface may need the stress: ends, Gauss points, middle.
  real(dp), parameter :: face_places(5) = [-1.0_dp, -gauss_abscissa, 0.0_dp, gauss_abscissa, 1.0_dp]

contains

  !> Area; negative where the nodes run clockwise.
  pure function quad4_area(coordinates) result(area)
    real(dp), intent(in) :: coordinates(2, quad4_nodes)
    real(dp) :: area
    real(dp) :: diagonal_13(2), diagonal_24(2)

    diagonal_13 = coordinates(:, 3) - coordinates(:, 1)
    diagonal_24 = coordinates(:, 4) - coordinates(:, 2)
    area = 0.5_dp*(diagonal_13(1)*diagonal_24(2) - diagonal_13(2)*diagonal_24(1))
  end function quad4_area

  !> Strain (e11, e22, 2 e12) from the displacements (u1, v1, u2, ...) and the shape function derivatives.
  pure function quad4_strain(gradient, u) result(strain)
    real(dp), intent(in) :: gradient(2, quad4_nodes), u(quad4_unknowns)
    real(dp) :: strain(3)
    real(dp) :: along_x(quad4_nodes), along_y(quad4_nodes)

    along_x = u(1::2)
    along_y = u(2::2)
    strain(1) = dot_product(gradient(1, :), along_x)
    strain(2) = dot_product(gradient(2, :), along_y)
    strain(3) = dot_product(gradient(2, :), along_x) + dot_product(gradient(1, :), along_y)
  end function quad4_strain

  !> Subtracts the internal force of a point from the residual.
  pure subroutine quad4_add_force(gradient, weight, stress, residual)
    real(dp), intent(in) :: gradient(2, quad4_nodes)    !< shape function derivatives, 1/length
    real(dp), intent(in) :: weight            !< volume of the point
    real(dp), intent(in) :: stress(3)         !< s11, s22, s12
    real(dp), intent(inout) :: residual(quad4_unknowns)
    real(dp) :: gx, gy
    integer :: a

    do a = 1, quad4_nodes
      gx = weight*gradient(1, a)
      gy = weight*gradient(2, a)
      residual(2*a - 1) = residual(2*a - 1) - gx*stress(1) - gy*stress(3)
      residual(2*a) = residual(2*a) - gy*stress(2) - gx*stress(3)
    end do
  end subroutine quad4_add_force

  !> Adds the stiffness of a point to the tangent.
  pure subroutine quad4_add_stiffness(gradient, weight, stiffness, tangent)
    real(dp), intent(in) :: gradient(2, quad4_nodes)    !< shape function derivatives, 1/length
    real(dp), intent(in) :: weight            !< volume of the point
    real(dp), intent(in) :: stiffness(3, 3)   !< d(stress)/d(e11, e22, 2 e12); need not be symmetric
    real(dp), intent(inout) :: tangent(quad4_unknowns, quad4_unknowns)
    real(dp) :: by_u(3), by_v(3), gx(quad4_nodes), gy(quad4_nodes)
    integer :: a, b

    gx = weight*gradient(1, :)
    gy = weight*gradient(2, :)
    do b = 1, quad4_nodes
      by_u = stiffness(:, 1)*gradient(1, b) + stiffness(:, 3)*gradient(2, b)
      by_v = stiffness(:, 2)*gradient(2, b) + stiffness(:, 3)*gradient(1, b)
      do a = 1, quad4_nodes
        tangent(2*a - 1, 2*b - 1) = tangent(2*a - 1, 2*b - 1) + gx(a)*by_u(1) + gy(a)*by_u(3)
        tangent(2*a, 2*b - 1) = tangent(2*a, 2*b - 1) + gy(a)*by_u(2) + gx(a)*by_u(3)
        tangent(2*a - 1, 2*b) = tangent(2*a - 1, 2*b) + gx(a)*by_v(1) + gy(a)*by_v(3)
        tangent(2*a, 2*b) = tangent(2*a, 2*b) + gy(a)*by_v(2) + gx(a)*by_v(3)
      end do
    end do
  end subroutine quad4_add_stiffness

  !> Parent coordinates (xi, eta) of a place on a face.
  pure function face_point(face, t) result(point)
    integer, intent(in) :: face
    real(dp), intent(in) :: t
    real(dp) :: point(2)

    select case (face)
    case (1)
      point = [t, -1.0_dp]
    case (2)
      point = [1.0_dp, t]
    case (3)
      point = [-t, 1.0_dp]
    case default
      point = [-1.0_dp, -t]
    end select
  end function face_point

end module elements_quad4
