! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Eight-node quad as the neighbour of an interface: traction from its displacements, area, local eigenvalue.
module elements_quad8
  use core_kinds, only: dp
  use core_quadrature, only: gauss_rule
  use core_quadratic_shape, only: quad8_gradient, three_points, three_weights
  use core_rotation, only: traction_operator
  use core_status, only: status_type, ok, inside_out
  use elements_face_eigenvalue, only: face_eigenvalue
  implicit none(type, external)
  private
  public :: quad8_traction, quad8_area, quad8_face_eigenvalue

contains

  !> Matrix that takes the 16 displacements of a quad to sigma.n in (tau, n) at a point (xi, eta).
  pure subroutine quad8_traction(coordinates, point, frame, stiffness, matrix, status)
    real(dp), intent(in) :: coordinates(2, 8), point(2)
    real(dp), intent(in) :: frame(2, 2)         !< rows tau and n
    real(dp), intent(in) :: stiffness(3, 3)     !< D, stress
    real(dp), intent(out) :: matrix(2, 16)
    type(status_type), intent(out) :: status    !< inside_out with the Jacobian
    real(dp) :: gradient(2, 8), jacobian

    call quad8_gradient(coordinates, point, gradient, jacobian)
    status = status_type(merge(ok, inside_out, jacobian > 0.0_dp), 0, jacobian, 0.0_dp)
    matrix = matmul(matmul(traction_operator(frame), stiffness), strain_matrix(gradient))
  end subroutine quad8_traction

  !> Area by 3 x 3 points.
  pure subroutine quad8_area(coordinates, area, status)
    real(dp), intent(in) :: coordinates(2, 8)
    real(dp), intent(out) :: area
    type(status_type), intent(out) :: status    !< inside_out with the Jacobian
    real(dp) :: energy(16, 16)
    real(dp), parameter :: nothing(3, 3) = 0.0_dp

    call integrate(coordinates, nothing, energy, area, status)
  end subroutine quad8_area

  !> lambda of the face eta = side (-1 or 1), see elements_face_eigenvalue; 3 points on the face and 3 x 3 in the quad.
  pure subroutine quad8_face_eigenvalue(coordinates, side, frames, lengths, stiffness, lambda, status)
    real(dp), intent(in) :: coordinates(2, 8), side
    real(dp), intent(in) :: frames(2, 2, 3)     !< of the Gauss points of the face, xi growing
    real(dp), intent(in) :: lengths(3)          !< length of the face that each of them stands for
    real(dp), intent(in) :: stiffness(3, 3)     !< D, stress
    real(dp), intent(out) :: lambda             !< stress/length
    type(status_type), intent(out) :: status    !< inside_out with the Jacobian
    real(dp) :: energy(16, 16), area, traction(6, 16), s(3)
    integer :: k

    lambda = 0.0_dp
    call integrate(coordinates, stiffness, energy, area, status)
    if (status%code /= ok) return
    s = three_points(gauss_rule)
    do k = 1, 3
      call quad8_traction(coordinates, [s(k), side], frames(:, :, k), stiffness, traction(2*k - 1:2*k, :), status)
      if (status%code /= ok) return
      traction(2*k - 1:2*k, :) = sqrt(lengths(k))*traction(2*k - 1:2*k, :)
    end do
    lambda = face_eigenvalue(coordinates, energy, traction)
  end subroutine quad8_face_eigenvalue

  !> Stiffness matrix for thickness 1, and area.
  pure subroutine integrate(coordinates, stiffness, energy, area, status)
    real(dp), intent(in) :: coordinates(2, 8), stiffness(3, 3)
    real(dp), intent(out) :: energy(16, 16), area
    type(status_type), intent(out) :: status
    real(dp) :: gradient(2, 8), jacobian, b(3, 16), s(3), w(3)
    integer :: i, j

    s = three_points(gauss_rule)
    w = three_weights(gauss_rule)
    energy = 0.0_dp
    area = 0.0_dp
    do j = 1, 3
      do i = 1, 3
        call quad8_gradient(coordinates, [s(i), s(j)], gradient, jacobian)
        if (.not. jacobian > 0.0_dp) then
          status = status_type(inside_out, 0, jacobian, 0.0_dp)
          return
        end if
        b = strain_matrix(gradient)
        area = area + w(i)*w(j)*jacobian
        energy = energy + (w(i)*w(j)*jacobian)*matmul(transpose(b), matmul(stiffness, b))
      end do
    end do
    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
  end subroutine integrate

  !> Matrix that takes the displacements to the strain (e11, e22, 2 e12).
  pure function strain_matrix(gradient) result(b)
    real(dp), intent(in) :: gradient(2, 8)
    real(dp) :: b(3, 16)

    b = 0.0_dp
    b(1, 1:15:2) = gradient(1, :)
    b(3, 1:15:2) = gradient(2, :)
    b(2, 2:16:2) = gradient(2, :)
    b(3, 2:16:2) = gradient(1, :)
  end function strain_matrix

end module elements_quad8
