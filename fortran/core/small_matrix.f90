! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Determinants and inverses of small matrices.
module core_small_matrix
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: add_product, add_combination, determinant, cofactors, invert, invert_general

contains

  !> Adds a transpose(b) to a matrix: loops, since for so few entries matmul costs more than the products.
  pure subroutine add_product(n, m, terms, a, b, matrix)
    integer, intent(in) :: n, m, terms
    real(dp), intent(in) :: a(n, terms), b(m, terms)
    real(dp), intent(inout) :: matrix(n, m)

    ! a compiler makes more of loops whose length it knows
    select case (n)
    case (8)
      call add_columns(8, m, terms, a, b, matrix)
    case (12)
      call add_columns(12, m, terms, a, b, matrix)
    case (16)
      call add_columns(16, m, terms, a, b, matrix)
    case (24)
      call add_columns(24, m, terms, a, b, matrix)
    case (37)   ! bricks with incompatible modes
      call add_columns(37, m, terms, a, b, matrix)
    case (48)
      call add_columns(48, m, terms, a, b, matrix)
    case default
      call add_columns(n, m, terms, a, b, matrix)
    end select
  end subroutine add_product

  !> `add_product` with its sizes as values, which a call with constants makes known to the compiler.
  pure subroutine add_columns(n, m, terms, a, b, matrix)
    integer, value :: n, m, terms
    real(dp), intent(in) :: a(n, terms), b(m, terms)
    real(dp), intent(inout) :: matrix(n, m)
    integer :: j, k, whole

    whole = 4*(terms/4)
    do j = 1, m
      do k = 1, whole, 4
        matrix(:, j) = matrix(:, j) + a(:, k)*b(j, k) + a(:, k + 1)*b(j, k + 1) + a(:, k + 2)*b(j, k + 2) &
          + a(:, k + 3)*b(j, k + 3)
      end do
      k = whole + 1
      select case (terms - whole)
      case (1)
        matrix(:, j) = matrix(:, j) + a(:, k)*b(j, k)
      case (2)
        matrix(:, j) = matrix(:, j) + a(:, k)*b(j, k) + a(:, k + 1)*b(j, k + 1)
      case (3)
        matrix(:, j) = matrix(:, j) + a(:, k)*b(j, k) + a(:, k + 1)*b(j, k + 1) + a(:, k + 2)*b(j, k + 2)
      case default   ! none is left
      end select
    end do
  end subroutine add_columns

  !> Adds the product of a matrix and a vector: a combination of its columns.
  pure subroutine add_combination(n, terms, a, x, vector)
    integer, intent(in) :: n, terms
    real(dp), intent(in) :: a(n, terms), x(terms)
    real(dp), intent(inout) :: vector(n)
    integer :: k

    do k = 1, terms
      vector = vector + x(k)*a(:, k)
    end do
  end subroutine add_combination

  !> Determinant of a matrix of two or three rows.
  pure function determinant(a) result(value)
    real(dp), intent(in) :: a(:, :)
    real(dp) :: value

    if (size(a, 1) == 2) then
      value = a(1, 1)*a(2, 2) - a(1, 2)*a(2, 1)
    else
      value = a(1, 1)*(a(2, 2)*a(3, 3) - a(2, 3)*a(3, 2)) &
        - a(1, 2)*(a(2, 1)*a(3, 3) - a(2, 3)*a(3, 1)) &
        + a(1, 3)*(a(2, 1)*a(3, 2) - a(2, 2)*a(3, 1))
    end if
  end function determinant

  !> Cofactors of a 3 x 3 matrix: the inverse is their transpose over the determinant.
  pure function cofactors(a) result(c)
    real(dp), intent(in) :: a(3, 3)
    real(dp) :: c(3, 3)
    integer :: i, k, i1, i2, k1, k2

    do k = 1, 3
      do i = 1, 3
        i1 = mod(i, 3) + 1
        i2 = mod(i + 1, 3) + 1
        k1 = mod(k, 3) + 1
        k2 = mod(k + 1, 3) + 1
        c(i, k) = a(i1, k1)*a(i2, k2) - a(i1, k2)*a(i2, k1)
      end do
    end do
  end function cofactors

  !> Inverse and determinant; of a singular matrix both are zero.
  pure subroutine invert(n, a, inverse, value)
    integer, intent(in) :: n               !< 2 or 3
    real(dp), intent(in) :: a(n, n)
    real(dp), intent(out) :: inverse(n, n)
    real(dp), intent(out) :: value         !< determinant

    if (n == 2) then
      inverse(:, 1) = [a(2, 2), -a(2, 1)]
      inverse(:, 2) = [-a(1, 2), a(1, 1)]
    else
      inverse = transpose(cofactors(a))
    end if
    value = dot_product(a(1, :), inverse(:, 1))
    if (abs(value) > 0.0_dp) then
      inverse = inverse/value
    else
      inverse = 0.0_dp
    end if
  end subroutine invert

  !> Inverse of a matrix of any size, by Gauss and Jordan with row pivots.
  pure subroutine invert_general(matrix, inverse, good)
    real(dp), intent(in) :: matrix(:, :)
    real(dp), intent(out) :: inverse(size(matrix, 1), size(matrix, 1))   !< zero where the matrix is singular
    logical, intent(out) :: good                                         !< false where it is, or an entry is NaN
    real(dp) :: a(size(matrix, 1), 2*size(matrix, 1)), row(2*size(matrix, 1))
    integer :: i, k, n, pivot

    n = size(matrix, 1)
    a = 0.0_dp
    a(:, :n) = matrix
    do i = 1, n
      a(i, n + i) = 1.0_dp
    end do
    inverse = 0.0_dp
    do k = 1, n
      pivot = k - 1 + maxloc(abs(a(k:, k)), dim=1)
      good = abs(a(pivot, k)) > 0.0_dp
      if (.not. good) return
      row = a(pivot, :)/a(pivot, k)
      a(pivot, :) = a(k, :)
      a(k, :) = row
      do i = 1, n
        if (i /= k) a(i, :) = a(i, :) - a(i, k)*row
      end do
    end do
    inverse = a(:, n + 1:)
  end subroutine invert_general

end module core_small_matrix
