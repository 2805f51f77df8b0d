! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Mean dilatation (B-bar) of elements such as CPE4 and C3D8, which would lock where the volume is preserved: the volume strain of
!> each point is its mean over the element.
!>
!> b is the strain matrix of core_strains, transposed: (unknowns, strains) of a point. `direct` is the number of direct strains.
module core_mean_dilatation
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: mean_volume_strain, set_volume_strain

contains

  !> Mean of the volume strain over an element, by its unknowns.
  pure function mean_volume_strain(direct, n, strains, points, volume, b) result(mean)
    integer, intent(in) :: direct, n, strains, points
    real(dp), intent(in) :: volume(points), b(n, strains, points)
    real(dp) :: mean(n)
    integer :: p

    mean = 0.0_dp
    do p = 1, points
      mean = mean + volume(p)*sum(b(:, :direct, p), dim=2)
    end do
    mean = mean/sum(volume)
  end function mean_volume_strain

  !> Replaces the volume strain of a point by the mean one, with equal parts of the difference in each direction (Abaqus Theory
  !> Guide, Solid isoparametric quadrilaterals and hexahedra). There are three of them in axisymmetric elements (S.A. Chester,
  !> C.V. Di Leo, L. Anand, Int. J. of Solids and Structures 52 (2015) 1).
  pure subroutine set_volume_strain(direct, n, strains, mean, b)
    integer, intent(in) :: direct, n, strains
    real(dp), intent(in) :: mean(n)
    real(dp), intent(inout) :: b(n, strains)
    real(dp) :: change(n)
    integer :: i

    change = (mean - sum(b(:, :direct), dim=2))/direct
    do i = 1, direct
      b(:, i) = b(:, i) + change
    end do
  end subroutine set_volume_strain

end module core_mean_dilatation
