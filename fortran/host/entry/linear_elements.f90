! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Elements that are linear, from their matrices: what a pass over them would add, without calling them.

!> Add the forces -K u of all elements to the residual, and measure them as the element loop does. Where a translation causes no
!> force, that of the first node is taken out before: it would only cost digits. The energy is that which the elements store.
subroutine host_linear_pass(matrices, equations, first, u, floor, field, residual, flux, energy, ndofel, m, n, fluxes)
  use host_kinds, only: dp, i4
  use host_linear, only: add_linear_forces
  use host_scatter, only: sum_by_field
  implicit none (type, external)
  integer(i4), intent(in) :: ndofel, m, n
  integer(i4), intent(in) :: fluxes                     !< number of fields
  real(dp), intent(in) :: matrices(ndofel, ndofel, m)   !< K of each element
  integer(i4), intent(in) :: equations(ndofel, m)       !< unknown, from 1
  integer(i4), intent(in) :: first(ndofel)              !< the entry of u to be taken out of this one, from 1; 0: none
  real(dp), intent(in) :: u(n), floor(ndofel)           !< |force| above which an entry counts as a term
  real(dp), intent(inout) :: residual(n)
  integer(i4), intent(in) :: field(ndofel)              !< of each unknown, from 1; 0: none
  real(dp), intent(out) :: flux(fluxes, 3)              !< sum of |force|, number of terms, the largest one
  real(dp), intent(out) :: energy                       !< sum of u.K u/2
  real(dp) :: by_unknown(ndofel, 3)
  by_unknown = 0
  energy = 0
  call add_linear_forces(ndofel, m, matrices, equations, first, u, floor, residual, by_unknown, energy)
  call sum_by_field(ndofel, field, by_unknown, fluxes, flux)
end subroutine host_linear_pass

!> Scatter the matrices of elements into the values of the sparse matrix.
subroutine host_add_matrices(matrices, map, matrix, ndofel, m, nnz)
  use host_kinds, only: dp, i4
  implicit none (type, external)
  integer(i4), intent(in) :: ndofel, m, nnz
  real(dp), intent(in) :: matrices(ndofel, ndofel, m)
  integer(i4), intent(in) :: map(ndofel, ndofel, m)     !< position in matrix, from 1
  real(dp), intent(inout) :: matrix(nnz)
  integer :: e, i, j
  do e = 1, m
    do j = 1, ndofel
      do i = 1, ndofel
        matrix(map(i, j, e)) = matrix(map(i, j, e)) + matrices(i, j, e)
      end do
    end do
  end do
end subroutine host_add_matrices
