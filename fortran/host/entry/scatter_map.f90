! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Where the entries of element matrices go in the values of a sparse matrix.
subroutine host_scatter_map(equations, indptr, indices, map, ndofel, m, n1, nnz)
  use host_kinds, only: i4
  implicit none (type, external)
  integer(i4), intent(in) :: ndofel, m, n1, nnz
  integer(i4), intent(in) :: equations(ndofel, m)     !< unknown, from 0
  integer(i4), intent(in) :: indptr(n1)               !< start of each row, from 0
  integer(i4), intent(in) :: indices(nnz)             !< columns, from 0, ascending in each row; all that the elements need
  integer(i4), intent(inout) :: map(ndofel, ndofel, m)   !< position of (row, column), from 0
  integer(i4) :: first, last, middle
  integer :: e, i, j
  do e = 1, m
    do j = 1, ndofel
      do i = 1, ndofel
        first = indptr(equations(i, e) + 1) + 1
        last = indptr(equations(i, e) + 2)
        do while (first < last)
          middle = (first + last)/2
          if (indices(middle) < equations(j, e)) then
            first = middle + 1
          else
            last = middle
          end if
        end do
        map(i, j, e) = first - 1
      end do
    end do
  end do
end subroutine host_scatter_map
