! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Bounds of the tractions on a face by the elastic energy of its element: the local eigenvalue problem that gives the stabilisation
!> (Griebel, Schweitzer 2003; Annavarapu, Hautefeuille, Dolbow 2012), for any element and each mode.
!>
!> lambda is the largest value of (integral of |t|^2 over the face)/(integral of eps:D:eps over the element) over all
!> displacements except rigid motions, where t is the shear or the normal component of sigma.n. For a constant strain it is
!> |D| meas(Gamma)/meas(Omega) at most: with this bound, beta = 2 (gamma_1^2 lambda_1 + gamma_2^2 lambda_2) becomes equation (21).
!> fortran/laws.md derives which beta suffices.
!>
!> Both modes draw on one energy: the sum of (integral of |t|^2)/lambda over the modes is at most `joint` times the energy, where
!> joint is from 1 to 2.
module elements_face_eigenvalue
  use core_kinds, only: dp
  use core_status, only: status_type, ok, no_root, not_positive_definite
  use core_symmetric, only: lower_factor, eigenvalues
  implicit none(type, external)
  private
  public :: face_eigenvalue

contains

  !> Largest eigenvalue of transpose(t) t v = lambda energy v for the shears and for the normal traction, rigid displacements
  !> excluded.
  !>
  !> Neither matrix sees the rigid displacements R, so energy may be replaced by energy + c R transpose(R), which is
  !> positive definite; with L its Cholesky factor and W = inverse(L) transpose(t), lambda is the largest
  !> eigenvalue of transpose(W) W, which only has the size of the face.
  !>
  !> Elements with few integration points have more displacements without energy, which leave no traction either: a small
  !> multiple of the unit matrix makes their energy positive. It changes lambda by no more than its share of the stiffness.
  pure subroutine face_eigenvalue(coordinates, energy, traction, hourglass, lambda, joint, status)
    real(dp), intent(in) :: coordinates(:, :)   !< (2 or 3, nodes), length
    real(dp), intent(in) :: energy(:, :)        !< stiffness matrix of the element
    real(dp), intent(in) :: traction(:, :)      !< (dim*points, unknowns) sigma.n sqrt(weight) of the points of the face;
                                                !< the second one of each point is normal
    logical, intent(in) :: hourglass            !< there may be such displacements
    real(dp), intent(out) :: lambda(2)          !< (tau, n)
    real(dp), intent(out) :: joint              !< of both
    type(status_type), intent(out) :: status    !< not_positive_definite, or no_root
    real(dp) :: rigid(size(energy, 1), 3*(size(coordinates, 1) - 1)), shifted(size(energy, 1), size(energy, 1)), shift
    real(dp) :: w(size(energy, 1), size(traction, 1)), gram(size(traction, 1), size(traction, 1))
    real(dp) :: scale(size(traction, 1))
    integer :: i, n, dim, rows(size(traction, 1))
    logical :: normal(size(traction, 1))
    logical :: good

    n = size(energy, 1)
    rigid = rigid_motions(coordinates)
    shift = 0.0_dp
    do i = 1, n
      shift = shift + energy(i, i)/real(n, dp)
    end do
    shifted = energy
    do i = 1, size(rigid, 2)
      rigid(:, i) = rigid(:, i)/norm2(rigid(:, i))
      shifted = shifted + shift*matmul(rigid(:, i:i), transpose(rigid(:, i:i)))
    end do
    do i = 1, merge(n, 0, hourglass)
      shifted(i, i) = shifted(i, i) + 1.0e-12_dp*shift
    end do
    lambda = 0.0_dp
    joint = 2.0_dp
    status = status_type(not_positive_definite, 0, 0.0_dp, 0.0_dp)
    call lower_factor(shifted, good)
    if (.not. good) return
    w = transpose(traction)
    do i = 1, n
      w(i, :) = (w(i, :) - matmul(shifted(i, 1:i - 1), w(1:i - 1, :)))/shifted(i, i)
    end do
    gram = matmul(transpose(w), w)
    dim = size(coordinates, 1)
    rows = [(i, i=1, size(rows))]
    normal = mod(rows - 1, dim) == 1
    do i = 1, 2
      call largest_eigenvalue(gram, pack(rows, normal .eqv. (i == 2)), lambda(i), good)
      if (.not. good) exit
    end do
    if (good .and. minval(lambda) > 0.0_dp) then
      scale = 1.0_dp/sqrt(merge(lambda(2), lambda(1), normal))
      do i = 1, size(rows)
        gram(:, i) = gram(:, i)*scale(i)*scale
      end do
      call largest_eigenvalue(gram, rows, joint, good)
    end if
    status = status_type(merge(ok, no_root, good), 0, 0.0_dp, 0.0_dp)
  end subroutine face_eigenvalue

  !> Largest eigenvalue of some rows and columns of a symmetric matrix.
  pure subroutine largest_eigenvalue(matrix, rows, largest, good)
    real(dp), intent(in) :: matrix(:, :)
    integer, intent(in) :: rows(:)
    real(dp), intent(out) :: largest
    logical, intent(out) :: good
    real(dp) :: values(size(rows))

    call eigenvalues(matrix(rows, rows), values, good)
    largest = maxval(values)
  end subroutine largest_eigenvalue

  !> Displacements of the nodes in the translations and the rotations about their centre, a column each.
  pure function rigid_motions(coordinates) result(rigid)
    real(dp), intent(in) :: coordinates(:, :)
    real(dp) :: rigid(size(coordinates), 3*(size(coordinates, 1) - 1))
    integer, parameter :: first(3) = [1, 1, 2], second(3) = [2, 3, 3]
    real(dp) :: from_centre(size(coordinates, 1), size(coordinates, 2))
    integer :: i, j, dim

    dim = size(coordinates, 1)
    rigid = 0.0_dp
    do i = 1, dim
      from_centre(i, :) = coordinates(i, :) - sum(coordinates(i, :))/real(size(coordinates, 2), dp)
      rigid(i::dim, i) = 1.0_dp
    end do
    do i = 1, size(rigid, 2) - dim
      j = dim + i
      rigid(first(i)::dim, j) = -from_centre(second(i), :)
      rigid(second(i)::dim, j) = from_centre(first(i), :)
    end do
  end function rigid_motions

end module elements_face_eigenvalue
