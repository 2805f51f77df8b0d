! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Consistent mass of continuum elements, and what every built-in element returns for each LFLAGS(3) from its forces, stiffness and
!> mass. Shells and beams form their own mass, in shell.f90 and beam.f90.
!>
!> In dynamic steps the operator of Hilber, Hughes and Taylor needs the forces of the last two increments: they are kept as state
!> variables, as in the UEL example of the Abaqus User Subroutines Guide.
module host_inertia
  use core_small_matrix, only: determinant
  use host_context, only: initial_stresses
  use host_kinds, only: dp, i4
  use host_shape, only: is_quadratic, radius_of, rule_t
  implicit none (type, external)
  private
  public :: is_dynamic, mass_matrix, respond

contains

  !> LFLAGS(1) of a dynamic step.
  elemental logical function is_dynamic(procedure_code)
    integer(i4), intent(in) :: procedure_code
    is_dynamic = procedure_code == 11 .or. procedure_code == 12
  end function is_dynamic

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

  !> RHS and AMATRX, which hold internal force and stiffness on entry. mass is used by dynamic steps and where it is asked
  !> for; old: forces of the last two increments, changed where the call keeps state; kinetic: ENERGY(1).
  pure subroutine respond(n, lflags, params, dtime, v, a, mass, old, rhs, amatrx, kinetic)
    integer, intent(in) :: n
    integer(i4), intent(in) :: lflags(3)
    real(dp), intent(in) :: params(3), dtime, v(n), a(n), mass(n, n)
    real(dp), intent(inout) :: old(n, 2), rhs(n), amatrx(n, n), kinetic
    real(dp) :: force(n), alpha
    logical :: dynamic
    dynamic = is_dynamic(lflags(1))
    if (any(lflags(3) == [1_i4, 6_i4, initial_stresses])) then
      old(:, 2) = merge(rhs, old(:, 1), lflags(3) == 6)
      force = old(:, 1)
      old(:, 1) = rhs
    else
      force = 0.5_dp*(old(:, 1) + old(:, 2))
    end if
    if (dynamic .and. any(lflags(3) == [1, 5])) then
      alpha = params(1)
      rhs = -matmul(mass, a) - (1 + alpha)*rhs + alpha*force
      if (lflags(3) == 1) amatrx = (1 + alpha)*amatrx + mass/(params(2)*dtime**2)
    else
      rhs = -rhs
    end if
    if (lflags(3) == 3) amatrx = 0
    if (any(lflags(3) == [4, 6])) amatrx = mass
    if (dynamic) kinetic = 0.5_dp*dot_product(v, matmul(mass, v))
  end subroutine respond
end module host_inertia
