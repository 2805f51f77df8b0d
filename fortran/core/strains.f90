! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Strains of continuum elements by the displacements of their nodes, at a point. core_incompatible_modes has those by
!> incompatible modes, core_mean_dilatation the mean volume strain of an element (B-bar).
!>
!> Strains are 11, 22, 12 in the plane; 11, 22, 33, 12 in axisymmetric elements; 11, 22, 33, 12, 13, 23 in space (engineering
!> shear). `direct` is the number of direct strains by the displacements: 2 in the plane, else 3.
module core_strains
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: strain_matrix

contains

  !> Strains by displacements, transposed.
  pure subroutine strain_matrix(dim, direct, nodes, g, b)
    integer, intent(in) :: dim, direct, nodes
    real(dp), intent(in) :: g(nodes, direct)         !< derivatives of the shape functions; about an axis the third is n/r
    real(dp), intent(out) :: b(dim, nodes, direct + 2*dim - 3)
    integer, parameter :: first(3) = [1, 1, 2], second(3) = [2, 3, 3]
    integer :: i

    b = 0.0_dp
    do i = 1, dim
      b(i, :, i) = g(:, i)
    end do
    if (direct > dim) b(1, :, direct) = g(:, direct)
    do i = 1, 2*dim - 3
      b(first(i), :, direct + i) = g(:, second(i))
      b(second(i), :, direct + i) = g(:, first(i))
    end do
  end subroutine strain_matrix

end module core_strains
