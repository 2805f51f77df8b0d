! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Bound of the traction on a face by the elastic energy of its quad: the local eigenvalue problem that gives the stabilisation
!> (Griebel, Schweitzer 2003; Annavarapu, Hautefeuille, Dolbow 2012), for any quad.
!>
!> lambda is the largest value of (integral of |sigma.n|^2 over the face)/(integral of eps:D:eps over the quad) over all
!> displacements except rigid motions. For a constant strain it is |D| meas(Gamma)/meas(Omega) at most, which makes
!> equation (21) of 2 (gamma_1^2 lambda_1 + gamma_2^2 lambda_2).
module elements_face_eigenvalue
  use core_kinds, only: dp
  use core_status, only: status_type, ok, no_root, not_positive_definite
  use core_symmetric, only: lower_factor, eigenvalues
  implicit none(type, external)
  private
  public :: face_eigenvalue

contains

  !> Largest eigenvalue of transpose(traction) traction v = lambda energy v, rigid displacements excluded.
  !>
  !> Neither matrix sees the rigid displacements R, so energy may be replaced by energy + c R transpose(R), which is
  !> positive definite; with L its Cholesky factor and W = inverse(L) transpose(traction), lambda is the largest
  !> eigenvalue of transpose(W) W, which only has the size of the face.
  pure subroutine face_eigenvalue(coordinates, energy, traction, lambda, status)
    real(dp), intent(in) :: coordinates(:, :)   !< (2, nodes), length
    real(dp), intent(in) :: energy(:, :)        !< stiffness matrix of the quad
    real(dp), intent(in) :: traction(:, :)      !< (2*points, 2*nodes) sigma.n sqrt(weight) of the points of the face
    real(dp), intent(out) :: lambda
    type(status_type), intent(out) :: status    !< not_positive_definite, or no_root
    real(dp) :: rigid(size(energy, 1), 3), shifted(size(energy, 1), size(energy, 1)), shift
    real(dp) :: w(size(energy, 1), size(traction, 1)), values(size(traction, 1)), centre(2)
    integer :: i, n
    logical :: good

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
    lambda = 0.0_dp
    status = status_type(not_positive_definite, 0, 0.0_dp, 0.0_dp)
    call lower_factor(shifted, good)
    if (.not. good) return
    w = transpose(traction)
    do i = 1, n
      w(i, :) = (w(i, :) - matmul(shifted(i, 1:i - 1), w(1:i - 1, :)))/shifted(i, i)
    end do
    call eigenvalues(matmul(transpose(w), w), values, good)
    lambda = maxval(values)
    status = status_type(merge(ok, no_root, good), 0, 0.0_dp, 0.0_dp)
  end subroutine face_eigenvalue

end module elements_face_eigenvalue
