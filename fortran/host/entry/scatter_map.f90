! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Where the entries of element matrices go in the values of a sparse matrix.
subroutine host_scatter_map(equations, indptr, indices, map, ndofel, m, n1, nnz)
  use host_kinds, only: i4
  use host_contact_assembly, only: position
  implicit none (type, external)
  integer(i4), intent(in) :: ndofel, m, n1, nnz
  integer(i4), intent(in) :: equations(ndofel, m)     !< unknown, from 0
  integer(i4), intent(in) :: indptr(n1)               !< start of each row, from 0
  integer(i4), intent(in) :: indices(nnz)             !< columns, from 0, ascending in each row; all that the elements need
  integer(i4), intent(inout) :: map(ndofel, ndofel, m)   !< position of (row, column), from 0
  integer(i4) :: start
  integer :: e, i, j
  do e = 1, m
    do j = 1, ndofel
      do i = 1, ndofel
        start = indptr(equations(i, e) + 1)
        map(i, j, e) = start - 1 + position(indices(start + 1:indptr(equations(i, e) + 2)), equations(j, e))
      end do
    end do
  end do
end subroutine host_scatter_map
