! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Mass matrix of continuum elements and continuum shells. Shells, membranes and beams form their own, in their files.
module host_solid_mass
  use core_small_matrix, only: determinant
  use host_kinds, only: dp
  use host_shape, only: is_quadratic, radius_of, rule_t
  implicit none (type, external)
  private
  public :: mass_matrix

contains

  !> Mass matrix, always fully integrated.
  pure subroutine mass_matrix(rule, axisymmetric, density, x, mass)
    type(rule_t), intent(in) :: rule   !< that integrates it fully
    logical, intent(in) :: axisymmetric
    real(dp), intent(in) :: density    !< per volume; in the plane per area; in axisymmetric elements times 2 pi
    real(dp), intent(in) :: x(rule%dim, rule%nodes)
    real(dp), intent(out) :: mass(rule%dim*rule%nodes, rule%dim*rule%nodes)
    real(dp) :: at_nodes(rule%nodes, rule%nodes)
    integer :: i
    call scalar_mass(rule, axisymmetric, density, x, at_nodes)
    mass = 0
    do i = 1, rule%dim
      mass(i::rule%dim, i::rule%dim) = at_nodes
    end do
  end subroutine mass_matrix

  !> The same for one unknown per node: lumped in elements with straight edges, consistent in those with middle nodes, as in Abaqus.
  pure subroutine scalar_mass(rule, axisymmetric, density, x, mass)
    type(rule_t), intent(in) :: rule
    logical, intent(in) :: axisymmetric
    real(dp), intent(in) :: density               !< as in mass_matrix
    real(dp), intent(in) :: x(rule%dim, rule%nodes)
    real(dp), intent(out) :: mass(rule%nodes, rule%nodes)
    real(dp) :: weight
    integer :: k, p
    mass = 0
    do p = 1, rule%points
      weight = density*rule%weight(p)*determinant(matmul(x, rule%dn(:, :, p)))*radius_of(rule, p, axisymmetric, x)
      do k = 1, rule%nodes
        if (is_quadratic(rule)) then
          mass(:, k) = mass(:, k) + weight*rule%n(k, p)*rule%n(:, p)
        else
          mass(k, k) = mass(k, k) + weight*rule%n(k, p)
        end if
      end do
    end do
  end subroutine scalar_mass
end module host_solid_mass
