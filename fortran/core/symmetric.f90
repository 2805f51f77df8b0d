! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Small dense symmetric matrices: what the local eigenvalue problem needs, without a library.
module core_symmetric
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: lower_factor, largest_eigenvalue

contains

  !> Puts the lower Cholesky factor L of a positive definite matrix L transpose(L) in its place, zero above the diagonal.
  pure subroutine lower_factor(matrix, good)
    real(dp), intent(inout) :: matrix(:, :)
    logical, intent(out) :: good   !< false where the matrix is not positive definite
    integer :: i, j

    good = .false.
    do j = 1, size(matrix, 1)
      matrix(j, j) = matrix(j, j) - sum(matrix(j, 1:j - 1)**2)
      if (.not. matrix(j, j) > 0.0_dp) return
      matrix(j, j) = sqrt(matrix(j, j))
      do i = j + 1, size(matrix, 1)
        matrix(i, j) = (matrix(i, j) - dot_product(matrix(i, 1:j - 1), matrix(j, 1:j - 1)))/matrix(j, j)
        matrix(j, i) = 0.0_dp
      end do
    end do
    good = .true.
  end subroutine lower_factor

  !> Largest eigenvalue of a symmetric matrix by cyclic Jacobi rotations (Golub, Van Loan, Matrix Computations, 8.5).
  pure subroutine largest_eigenvalue(matrix, value, good)
    real(dp), intent(in) :: matrix(:, :)
    real(dp), intent(out) :: value
    logical, intent(out) :: good             !< false where the sweeps have run out
    integer, parameter :: most_sweeps = 30   ! convergence is quadratic: six or so do
    real(dp) :: a(size(matrix, 1), size(matrix, 1)), negligible
    integer :: sweep, p, q

    a = matrix
    negligible = epsilon(1.0_dp)*maxval(abs(a))
    do sweep = 1, most_sweeps
      good = .true.
      do q = 2, size(a, 1)
        do p = 1, q - 1
          if (.not. abs(a(p, q)) > negligible) cycle
          call rotate(p, q, a)
          good = .false.
        end do
      end do
      if (good) exit
    end do
    value = a(1, 1)
    do p = 2, size(a, 1)
      value = max(value, a(p, p))
    end do
  end subroutine largest_eigenvalue

  !> Rotation in the plane of axes p and q that makes a(p, q), which is not zero, vanish.
  pure subroutine rotate(p, q, a)
    integer, intent(in) :: p, q
    real(dp), intent(inout) :: a(:, :)
    real(dp) :: cotangent, t, c, s, kept(size(a, 1))

    cotangent = (a(q, q) - a(p, p))/(2.0_dp*a(p, q))   ! of twice the angle
    t = sign(1.0_dp, cotangent)/(abs(cotangent) + hypot(cotangent, 1.0_dp))
    c = 1.0_dp/hypot(t, 1.0_dp)
    s = t*c
    kept = a(:, p)
    a(:, p) = c*kept - s*a(:, q)
    a(:, q) = s*kept + c*a(:, q)
    kept = a(p, :)
    a(p, :) = c*kept - s*a(q, :)
    a(q, :) = s*kept + c*a(q, :)
  end subroutine rotate

end module core_symmetric
