! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Small dense symmetric matrices: Cholesky factor, inverse, eigenvalues, without a library.
module core_symmetric
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: lower_factor, invert_definite, eigenvalues

contains

  !> Replaces a positive definite matrix L transpose(L) by its lower Cholesky factor L, zero above the diagonal.
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

  !> Inverse X of a positive definite matrix, by its Cholesky factor L: L transpose(L) X = I. It is symmetric, so that columns may
  !> stand for its rows, along the memory.
  pure subroutine invert_definite(matrix, inverse, good)
    real(dp), intent(in) :: matrix(:, :)
    real(dp), intent(out) :: inverse(size(matrix, 1), size(matrix, 1))   !< zero where the matrix is not positive definite
    logical, intent(out) :: good
    real(dp) :: l(size(matrix, 1), size(matrix, 1))
    integer :: i, k, n

    n = size(matrix, 1)
    l = matrix
    inverse = 0.0_dp
    call lower_factor(l, good)
    if (.not. good) return
    do i = 1, n
      inverse(i, i) = 1.0_dp
      do k = 1, i - 1
        inverse(:, i) = inverse(:, i) - l(i, k)*inverse(:, k)
      end do
      inverse(:, i) = inverse(:, i)/l(i, i)
    end do
    do i = n, 1, -1
      do k = i + 1, n
        inverse(:, i) = inverse(:, i) - l(k, i)*inverse(:, k)
      end do
      inverse(:, i) = inverse(:, i)/l(i, i)
    end do
  end subroutine invert_definite

  !> Eigenvalues of a symmetric matrix by cyclic Jacobi rotations (Golub, Van Loan, Matrix Computations, 8.5), not sorted.
  pure subroutine eigenvalues(matrix, values, good, vectors)
    real(dp), intent(in) :: matrix(:, :)
    real(dp), intent(out) :: values(size(matrix, 1))
    logical, intent(out) :: good                         !< false where the sweeps run out, or an entry is NaN or infinite
    real(dp), intent(out), optional :: vectors(:, :)     !< row i belongs to value i
    integer, parameter :: most_sweeps = 30   ! convergence is quadratic: about six suffice
    real(dp) :: a(size(matrix, 1), size(matrix, 1)), negligible
    integer :: sweep, p, q

    a = matrix
    ! rotations between equal eigenvalues, as of regular elements, leave rounding errors of this size in other entries, for ever
    negligible = 4.0_dp*size(a, 1)*epsilon(1.0_dp)*maxval(abs(a))
    if (present(vectors)) then
      vectors = 0.0_dp
      do p = 1, size(a, 1)
        vectors(p, p) = 1.0_dp
      end do
    end if
    do sweep = 1, most_sweeps
      good = all(abs(a) <= huge(1.0_dp))
      if (.not. good) exit
      do q = 2, size(a, 1)
        do p = 1, q - 1
          if (.not. abs(a(p, q)) > negligible) cycle
          call rotate(p, q, a, vectors)
          good = .false.
        end do
      end do
      if (good) exit
    end do
    do p = 1, size(a, 1)
      values(p) = a(p, p)
    end do
  end subroutine eigenvalues

  !> Rotation in the plane of axes p and q that makes a(p, q), which is not zero, vanish.
  pure subroutine rotate(p, q, a, vectors)
    integer, intent(in) :: p, q
    real(dp), intent(inout) :: a(:, :)
    real(dp), intent(inout), optional :: vectors(:, :)   !< rows that rotate along
    real(dp) :: cotangent, t, c, s

    ! of twice the angle; its square is finite, for a(p, q) is more than rounding errors
    cotangent = (a(q, q) - a(p, p))/(2.0_dp*a(p, q))
    t = sign(1.0_dp, cotangent)/(abs(cotangent) + sqrt(1.0_dp + cotangent**2))
    c = 1.0_dp/sqrt(1.0_dp + t**2)
    s = t*c
    call turn(c, s, a(:, p), a(:, q))
    call turn(c, s, a(p, :), a(q, :))
    if (present(vectors)) call turn(c, s, vectors(p, :), vectors(q, :))
  end subroutine rotate

  !> Rotates two vectors in their plane.
  pure subroutine turn(c, s, x, y)
    real(dp), intent(in) :: c, s   !< cosine and sine
    real(dp), intent(inout) :: x(:), y(:)
    real(dp) :: kept(size(x))

    kept = x
    x = c*kept - s*y
    y = s*kept + c*y
  end subroutine turn

end module core_symmetric
