! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Small dense symmetric matrices: what the local eigenvalue problem needs, without a library.
module core_symmetric
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: lower_factor, largest_eigenvalue

contains

  !> Lower Cholesky factor L of a positive definite matrix L transpose(L); what lies above the diagonal is zero.
  !> A matrix that is not positive definite has a factor with a zero on the diagonal.
  pure function lower_factor(matrix) result(factor)
    real(dp), intent(in) :: matrix(:, :)
    real(dp) :: factor(size(matrix, 1), size(matrix, 1))
    integer :: i, j

    factor = 0.0_dp
    do j = 1, size(matrix, 1)
      factor(j, j) = matrix(j, j) - sum(factor(j, 1:j - 1)**2)
      if (.not. factor(j, j) > 0.0_dp) then
        factor(j, j) = 0.0_dp
        return
      end if
      factor(j, j) = sqrt(factor(j, j))
      do i = j + 1, size(matrix, 1)
        factor(i, j) = (matrix(i, j) - dot_product(factor(i, 1:j - 1), factor(j, 1:j - 1)))/factor(j, j)
      end do
    end do
  end function lower_factor

  !> Largest eigenvalue of a symmetric matrix by cyclic Jacobi rotations (Golub, Van Loan, Matrix Computations, 8.5).
  pure function largest_eigenvalue(matrix) result(value)
    real(dp), intent(in) :: matrix(:, :)
    real(dp) :: value
    integer, parameter :: most_sweeps = 30   ! convergence is quadratic: six or so do
    real(dp) :: a(size(matrix, 1), size(matrix, 1)), negligible
    integer :: sweep, p, q
    logical :: rotated

    a = matrix
    negligible = epsilon(1.0_dp)*maxval(abs(a))
    do sweep = 1, most_sweeps
      rotated = .false.
      do q = 2, size(a, 1)
        do p = 1, q - 1
          if (.not. abs(a(p, q)) > negligible) cycle
          call rotate(p, q, a)
          rotated = .true.
        end do
      end do
      if (.not. rotated) exit
    end do
    value = a(1, 1)
    do p = 2, size(a, 1)
      value = max(value, a(p, p))
    end do
  end function largest_eigenvalue

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
