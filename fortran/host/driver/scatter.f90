! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Results of elements into the sums of the system.
module host_scatter
  use host_kinds, only: dp, i4
  implicit none (type, external)
  private
  public :: add_energy, add_residual, add_magnitude, add_matrix, add_own_residual, add_own_matrix, keep_matrix, sum_by_field

contains

  !> Add ENERGY of an element to the sums.
  subroutine add_energy(energy, sums)
    real(dp), intent(in) :: energy(8)
    real(dp), intent(inout) :: sums(8)
    sums = sums + energy
  end subroutine add_energy

  !> Scatter a column of RHS.
  subroutine add_residual(n, rhs, equations, residual)
    integer, intent(in) :: n
    real(dp), intent(in) :: rhs(n)
    integer(i4), intent(in) :: equations(n)
    real(dp), intent(inout) :: residual(*)
    integer :: i
    do i = 1, n
      residual(equations(i)) = residual(equations(i)) + rhs(i)
    end do
  end subroutine add_residual

  !> Add |x| to the sums of magnitudes, count those above the floor, in reals, for then it vectorises, and keep the largest ones.
  subroutine add_magnitude(n, x, floor, sums, terms, largest)
    integer, intent(in) :: n
    real(dp), intent(in) :: x(n), floor(n)
    real(dp), intent(inout) :: sums(n), terms(n), largest(n)
    integer :: i
    do i = 1, n
      sums(i) = sums(i) + abs(x(i))
      terms(i) = terms(i) + merge(1.0_dp, 0.0_dp, abs(x(i)) > floor(i))
      largest(i) = max(largest(i), abs(x(i)))
    end do
  end subroutine add_magnitude

  !> Sums, terms and largest magnitudes by unknown, as add_magnitude leaves them, taken together by field.
  subroutine sum_by_field(n, field, by_unknown, fields, flux)
    integer(i4), intent(in) :: n, fields
    integer(i4), intent(in) :: field(n)             !< of each unknown, from 1; 0: none
    real(dp), intent(in) :: by_unknown(n, 3)
    real(dp), intent(out) :: flux(fields, 3)
    integer :: i
    flux = 0
    do i = 1, n
      if (field(i) == 0) cycle
      flux(field(i), :2) = flux(field(i), :2) + by_unknown(i, :2)
      flux(field(i), 3) = max(flux(field(i), 3), by_unknown(i, 3))
    end do
  end subroutine sum_by_field

  !> Scatter AMATRX, or its symmetric part, into the values of the sparse matrix.
  subroutine add_matrix(n, a, map, symmetric, matrix)
    integer, intent(in) :: n
    real(dp), intent(in) :: a(n, n)
    integer(i4), intent(in) :: map(n, n)
    logical, intent(in) :: symmetric
    real(dp), intent(inout) :: matrix(*)
    real(dp) :: mean
    integer :: i, j
    if (.not. symmetric) then
      do j = 1, n
        do i = 1, n
          matrix(map(i, j)) = matrix(map(i, j)) + a(i, j)
        end do
      end do
      return
    end if
    do j = 1, n
      matrix(map(j, j)) = matrix(map(j, j)) + a(j, j)
      do i = j + 1, n
        mean = 0.5_dp*(a(i, j) + a(j, i))
        matrix(map(i, j)) = matrix(map(i, j)) + mean
        matrix(map(j, i)) = matrix(map(j, i)) + mean
      end do
    end do
  end subroutine add_matrix

  !> The entries of a column of RHS that belong to a thread.
  subroutine add_own_residual(n, own, rhs, equations, residual)
    integer, intent(in) :: n
    logical, intent(in) :: own(n)          !< by unknown
    real(dp), intent(in) :: rhs(n)
    integer(i4), intent(in) :: equations(n)
    real(dp), intent(inout) :: residual(*)
    integer :: i
    do i = 1, n
      if (own(i)) residual(equations(i)) = residual(equations(i)) + rhs(i)
    end do
  end subroutine add_own_residual

  !> Keep AMATRX, or its symmetric part, for add_own_matrix; while it is in the cache of the thread that called the element.
  subroutine keep_matrix(n, a, symmetric, kept)
    integer, intent(in) :: n
    real(dp), intent(in) :: a(n, n)
    logical, intent(in) :: symmetric
    real(dp), intent(out) :: kept(n, n)
    integer :: i, j
    if (.not. symmetric) then
      kept = a
      return
    end if
    do j = 1, n
      do i = 1, n
        kept(i, j) = 0.5_dp*(a(i, j) + a(j, i))
      end do
    end do
  end subroutine keep_matrix

  !> The columns that belong to a thread of what keep_matrix has kept; to the bit what add_matrix adds.
  subroutine add_own_matrix(n, own, a, map, matrix)
    integer, intent(in) :: n
    logical, intent(in) :: own(n)          !< by unknown
    real(dp), intent(in) :: a(n, n)
    integer(i4), intent(in) :: map(n, n)
    real(dp), intent(inout) :: matrix(*)
    integer :: i, j
    do j = 1, n
      if (.not. own(j)) cycle
      do i = 1, n
        matrix(map(i, j)) = matrix(map(i, j)) + a(i, j)
      end do
    end do
  end subroutine add_own_matrix
end module host_scatter
