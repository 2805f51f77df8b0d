! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> How large the traction on a face can be for the elastic energy of its quad: the local eigenvalue problem from which
!> the stabilisation follows (Griebel, Schweitzer 2003; Annavarapu, Hautefeuille, Dolbow 2012), for any quad.
!>
!> lambda is the largest value of (integral of |sigma.n|^2 over the face)/(integral of eps:D:eps over the quad) over all
!> displacements but the rigid ones. For a constant strain it is |D| meas(Gamma)/meas(Omega) at most, which makes
!> equation (21) of 2 (gamma_1^2 lambda_1 + gamma_2^2 lambda_2).
module elements_face_eigenvalue
  use core_kinds, only: dp
  use core_quadrature, only: quad_points, gauss_rule, line_points
  use core_rotation, only: line_frame, traction_operator
  use core_shape_functions, only: quad_gradient
  use core_status, only: status_type, ok, inside_out
  use core_symmetric, only: lower_factor, largest_eigenvalue
  use elements_quad4, only: face_nodes, face_point, quad4_add_stiffness
  implicit none(type, external)
  private
  public :: quad4_face_eigenvalue, face_eigenvalue

contains

  !> lambda of a face of a four-node quad with 2 x 2 points.
  pure subroutine quad4_face_eigenvalue(coordinates, face, stiffness, lambda, status)
    real(dp), intent(in) :: coordinates(2, 4)   !< length
    integer, intent(in) :: face
    real(dp), intent(in) :: stiffness(3, 3)     !< D, stress
    real(dp), intent(out) :: lambda             !< stress/length
    type(status_type), intent(out) :: status    !< inside_out with the Jacobian
    real(dp) :: gradient(2, 4), jacobian, energy(8, 8), traction(4, 8), frame(2, 2), length, s(2)
    real(dp) :: by_strain(2, 3)
    integer :: k, a

    lambda = 0.0_dp
    energy = 0.0_dp
    do k = 1, 4
      call quad_gradient(coordinates, quad_points(:, k), gradient, jacobian)
      if (.not. jacobian > 0.0_dp) then
        status = status_type(inside_out, 0, jacobian, 0.0_dp)
        return
      end if
      call quad4_add_stiffness(gradient, jacobian, stiffness, energy)
    end do
    call line_frame(coordinates(:, face_nodes(1, face)), coordinates(:, face_nodes(2, face)), frame, length)
    by_strain = sqrt(0.5_dp*length)*matmul(traction_operator(frame), stiffness)
    s = line_points(gauss_rule)
    do k = 1, 2
      call quad_gradient(coordinates, face_point(face, s(k)), gradient, jacobian)
      if (.not. jacobian > 0.0_dp) then
        status = status_type(inside_out, 0, jacobian, 0.0_dp)
        return
      end if
      do a = 1, 4
        traction(2*k - 1:2*k, 2*a - 1) = by_strain(:, 1)*gradient(1, a) + by_strain(:, 3)*gradient(2, a)
        traction(2*k - 1:2*k, 2*a) = by_strain(:, 2)*gradient(2, a) + by_strain(:, 3)*gradient(1, a)
      end do
    end do
    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    lambda = face_eigenvalue(coordinates, energy, traction)
  end subroutine quad4_face_eigenvalue

  !> Largest eigenvalue of transpose(traction) traction v = lambda energy v with the rigid displacements left out.
  !>
  !> Neither matrix sees the rigid displacements R, so energy may be replaced by energy + c R transpose(R), which is
  !> positive definite; with L its Cholesky factor and W = inverse(L) transpose(traction), lambda is the largest
  !> eigenvalue of transpose(W) W, which has but the size of the face.
  pure function face_eigenvalue(coordinates, energy, traction) result(lambda)
    real(dp), intent(in) :: coordinates(:, :)   !< (2, nodes), length
    real(dp), intent(in) :: energy(:, :)        !< stiffness matrix of the quad
    real(dp), intent(in) :: traction(:, :)      !< (2*points, 2*nodes) sigma.n sqrt(weight) of the points of the face
    real(dp) :: lambda
    real(dp) :: rigid(size(energy, 1), 3), shifted(size(energy, 1), size(energy, 1)), shift
    real(dp) :: w(size(energy, 1), size(traction, 1)), centre(2)
    integer :: i, n

    n = size(energy, 1)
    centre = sum(coordinates, 2)/real(size(coordinates, 2), dp)
    rigid = 0.0_dp
    rigid(1:n:2, 1) = 1.0_dp
    rigid(2:n:2, 2) = 1.0_dp
    rigid(1:n:2, 3) = centre(2) - coordinates(2, :)
    rigid(2:n:2, 3) = coordinates(1, :) - centre(1)
    shift = 0.0_dp
    do i = 1, n
      shift = shift + energy(i, i)/real(n, dp)
    end do
    shifted = energy
    do i = 1, 3
      rigid(:, i) = rigid(:, i)/norm2(rigid(:, i))
      shifted = shifted + shift*matmul(rigid(:, i:i), transpose(rigid(:, i:i)))
    end do
    shifted = lower_factor(shifted)
    w = transpose(traction)
    do i = 1, n
      w(i, :) = (w(i, :) - matmul(shifted(i, 1:i - 1), w(1:i - 1, :)))/shifted(i, i)
    end do
    lambda = largest_eigenvalue(matmul(transpose(w), w))
  end function face_eigenvalue

end module elements_face_eigenvalue
