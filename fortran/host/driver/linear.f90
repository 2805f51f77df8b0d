! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Forces of linear elements from their matrices.
module host_linear
  use host_kinds, only: dp, i4
  implicit none (type, external)
  private
  public :: add_linear_forces

contains

  !> See host_linear_pass.
  subroutine add_linear_forces(ndofel, m, matrices, equations, first, u, floor, residual, flux, energy)
    integer(i4), intent(in) :: ndofel, m
    real(dp), intent(in) :: matrices(ndofel, ndofel, m)
    integer(i4), intent(in) :: equations(ndofel, m), first(ndofel)
    real(dp), intent(in) :: u(*), floor(ndofel)
    real(dp), intent(inout) :: residual(*), flux(ndofel, 3), energy
    ! a compiler makes more of loops whose length it knows: quads of four nodes, bricks of eight
    select case (ndofel)
    case (8)
      call add_all(8_i4, m, matrices, equations, first, u, floor, residual, flux, energy)
    case (24)
      call add_all(24_i4, m, matrices, equations, first, u, floor, residual, flux, energy)
    case default
      call add_all(ndofel, m, matrices, equations, first, u, floor, residual, flux, energy)
    end select
  end subroutine add_linear_forces

  !> The same with its size.
  subroutine add_all(n, m, matrices, equations, first, u, floor, residual, flux, energy)
    integer(i4), value :: n
    integer(i4), intent(in) :: m
    real(dp), intent(in) :: matrices(n, n, m)
    integer(i4), intent(in) :: equations(n, m), first(n)
    real(dp), intent(in) :: u(*), floor(n)
    real(dp), intent(inout) :: residual(*), flux(n, 3), energy
    real(dp) :: force(n), at(n)
    integer :: e, j
    do e = 1, m
      force = 0
      at = u(equations(:, e))
      do j = n, 1, -1
        if (first(j) > 0) at(j) = at(j) - at(first(j))
        force = force - at(j)*matrices(:, j, e)
      end do
      energy = energy - 0.5_dp*dot_product(force, at)
      do j = 1, n
        residual(equations(j, e)) = residual(equations(j, e)) + force(j)
      end do
      flux(:, 1) = flux(:, 1) + abs(force)
      flux(:, 2) = flux(:, 2) + merge(1.0_dp, 0.0_dp, abs(force) > floor)
      flux(:, 3) = max(flux(:, 3), abs(force))
    end do
  end subroutine add_all
end module host_linear
