! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> A four- or eight-node quad next to an interface: traction from its displacements, area, local eigenvalue.
!>
!> The interface is the edge eta = 1 of the quad below it and eta = -1 of that above; xi grows along it.
module elements_bulk_quad
  use core_kinds, only: dp
  use core_quadrature, only: gauss_rule, line_points, line_weights
  use core_serendipity, only: quad8_gradient
  use core_rotation, only: traction_operator
  use core_shape_functions, only: quad_gradient
  use core_status, only: status_type, ok, inside_out
  use elements_face_eigenvalue, only: face_eigenvalue
  use elements_quad4, only: quad4_area
  implicit none(type, external)
  private
  public :: quad_traction, quad_area, quad_face_eigenvalue

contains

  !> Matrix that takes the displacements of a quad to sigma.n in (tau, n) at a point (xi, eta).
  pure subroutine quad_traction(nodes, coordinates, point, frame, stiffness, matrix, status)
    integer, intent(in) :: nodes                    !< 4 or 8
    real(dp), intent(in) :: coordinates(2, nodes), point(2)
    real(dp), intent(in) :: frame(2, 2)             !< rows tau and n
    real(dp), intent(in) :: stiffness(3, 3)         !< D, stress
    real(dp), intent(out) :: matrix(2, 2*nodes)
    type(status_type), intent(out) :: status        !< inside_out with the Jacobian
    real(dp) :: gradient(2, nodes), by_strain(2, 3)
    integer :: a

    call gradient_at(nodes, coordinates, point, gradient, status)
    by_strain = matmul(traction_operator(frame), stiffness)
    do a = 1, nodes
      matrix(:, 2*a - 1) = by_strain(:, 1)*gradient(1, a) + by_strain(:, 3)*gradient(2, a)
      matrix(:, 2*a) = by_strain(:, 2)*gradient(2, a) + by_strain(:, 3)*gradient(1, a)
    end do
  end subroutine quad_traction

  !> Area; with 3 x 3 points if there are eight nodes.
  pure subroutine quad_area(nodes, coordinates, area, status)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: coordinates(2, nodes)
    real(dp), intent(out) :: area
    type(status_type), intent(out) :: status        !< inside_out with the area or a Jacobian
    real(dp) :: gradient(2, nodes), s(3), w(3)
    integer :: i, j

    area = 0.0_dp
    if (nodes == 4) then
      area = quad4_area(coordinates(:, 1:4))
      status = status_type(merge(ok, inside_out, area > 0.0_dp), 0, area, 0.0_dp)
      return
    end if
    s = line_points(3, gauss_rule)
    w = line_weights(3, gauss_rule)
    do j = 1, 3
      do i = 1, 3
        call gradient_at(nodes, coordinates, [s(i), s(j)], gradient, status)
        if (status%code /= ok) return
        area = area + w(i)*w(j)*status%value
      end do
    end do
  end subroutine quad_area

  !> lambda of the edge eta = side, see elements_face_eigenvalue; as many points on the edge, and along xi and eta in the
  !> quad, as the edge has nodes.
  pure subroutine quad_face_eigenvalue(nodes, coordinates, side, points, frames, lengths, stiffness, lambda, status)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: coordinates(2, nodes)
    real(dp), intent(in) :: side                      !< eta of the edge, -1 or 1
    integer, intent(in) :: points                     !< nodes of the edge
    real(dp), intent(in) :: frames(2, 2, points)      !< at the Gauss points of the edge, xi growing
    real(dp), intent(in) :: lengths(points)           !< length of the edge that each of them stands for
    real(dp), intent(in) :: stiffness(3, 3)           !< D, stress
    real(dp), intent(out) :: lambda                   !< stress/length
    type(status_type), intent(out) :: status          !< inside_out with the Jacobian
    real(dp) :: energy(2*nodes, 2*nodes), traction(2*points, 2*nodes), s(points)
    integer :: k

    lambda = 0.0_dp
    call strain_energy(nodes, coordinates, points, stiffness, energy, status)
    if (status%code /= ok) return
    s = line_points(points, gauss_rule)
    do k = 1, points
      call quad_traction(nodes, coordinates, [s(k), side], frames(:, :, k), stiffness, traction(2*k - 1:2*k, :), status)
      if (status%code /= ok) return
      traction(2*k - 1:2*k, :) = sqrt(lengths(k))*traction(2*k - 1:2*k, :)
    end do
    call face_eigenvalue(coordinates, energy, traction, lambda, status)
  end subroutine quad_face_eigenvalue

  !> Stiffness matrix for thickness 1.
  pure subroutine strain_energy(nodes, coordinates, points, stiffness, energy, status)
    integer, intent(in) :: nodes, points
    real(dp), intent(in) :: coordinates(2, nodes), stiffness(3, 3)
    real(dp), intent(out) :: energy(2*nodes, 2*nodes)
    type(status_type), intent(out) :: status
    real(dp) :: gradient(2, nodes), b(3, 2*nodes), s(points), w(points)
    integer :: i, j

    s = line_points(points, gauss_rule)
    w = line_weights(points, gauss_rule)
    energy = 0.0_dp
    b = 0.0_dp
    do j = 1, points
      do i = 1, points
        call gradient_at(nodes, coordinates, [s(i), s(j)], gradient, status)
        if (status%code /= ok) return
        b(1, 1::2) = gradient(1, :)
        b(3, 1::2) = gradient(2, :)
        b(2, 2::2) = gradient(2, :)
        b(3, 2::2) = gradient(1, :)
        energy = energy + (w(i)*w(j)*status%value)*matmul(transpose(b), matmul(stiffness, b))
      end do
    end do
  end subroutine strain_energy

  !> Derivatives of the shape functions by x and y; the value of the status is the Jacobian.
  pure subroutine gradient_at(nodes, coordinates, point, gradient, status)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: coordinates(2, nodes), point(2)
    real(dp), intent(out) :: gradient(2, nodes)
    type(status_type), intent(out) :: status
    real(dp) :: jacobian

    if (nodes == 4) then
      call quad_gradient(coordinates, point, gradient, jacobian)
    else
      call quad8_gradient(coordinates, point, gradient, jacobian)
    end if
    status = status_type(merge(ok, inside_out, jacobian > 0.0_dp), 0, jacobian, 0.0_dp)
  end subroutine gradient_at

end module elements_bulk_quad
