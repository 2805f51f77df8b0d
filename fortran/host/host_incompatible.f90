! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Incompatible modes of CPS4I, CPE4I and C3D8I, which let elements with straight edges bend.
!>
!> The gradient of the displacements is enhanced, not the displacements (J.C. Simo, M.S. Rifai, Int. J. for Numerical
!> Methods in Engineering 29 (1990) 1595; Abaqus Theory Guide, Continuum elements with incompatible modes): with the parent
!> coordinate xi_a, its gradient in the middle of the element and the Jacobians j there and at the point
!>
!>     H = sum over a of alpha_a (x) (j0/j) xi_a grad xi_a,
!>
!> one vector alpha_a for each direction. In plane strain and in space the volume has its own modes, beta (j0/j) times the products
!> of two and three parent coordinates, in equal parts in each direction, which keep nearly incompressible elements from locking.
!> These are 4, 5 and 13 modes, as many as CPS4I, CPE4I and C3D8I have in Abaqus. Their mean is zero, so a constant strain needs
!> none of them, whatever the shape.
!>
!> Each pass brings the modes to equilibrium and condenses out their forces.
module host_incompatible
  use core_small_matrix, only: determinant, invert, invert_general
  use host_kinds, only: dp
  use host_kinematics, only: strain_matrix
  use host_shape, only: parent_place, rule_of, rule_t
  implicit none (type, external)
  private
  public :: mode_strains, find_change, condense

  !> Work of the forces on the modes that counts as zero, relative to that of all forces, taken absolutely.
  real(dp), parameter :: no_work = 1e-20_dp

contains

  !> Strains by the modes at all points, transposed.
  subroutine mode_strains(rule, x, modes, strains, b)
    type(rule_t), intent(in) :: rule
    real(dp), intent(in) :: x(rule%dim, rule%nodes)
    integer, intent(in) :: modes, strains
    real(dp), intent(out) :: b(modes, strains, rule%points)
    type(rule_t), pointer :: middle
    real(dp) :: xi(rule%dim), inverse(rule%dim, rule%dim), at_middle, ratio, products(4)
    integer :: dim, i, k, p
    dim = rule%dim
    middle => rule_of(rule%family, 1)
    call invert(dim, matmul(x, middle%dn(:, :, 1)), inverse, at_middle)
    do p = 1, rule%points
      xi = parent_place(rule, p)
      ratio = at_middle/determinant(matmul(x, rule%dn(:, :, p)))
      ! a direction acts on the strain like a node
      call strain_matrix(dim, dim, dim, reshape([(ratio*xi*inverse(:, i), i=1, dim)], [dim, dim]), b(:dim**2, :, p))
      products = xi(1)*xi(2)
      if (dim == 3) products(2:) = [xi(2)*xi(3), xi(3)*xi(1), product(xi)]
      do k = dim**2 + 1, modes
        b(k, :dim, p) = ratio*products(k - dim**2)/dim
        b(k, dim + 1:, p) = 0
      end do
    end do
  end subroutine mode_strains

  !> Change of the modes, the last unknowns, by Newton's method; `settled` if it does no work. Zero, with `good` false, if their
  !> stiffness is singular.
  pure subroutine find_change(unknowns, force, stiffness, change, settled, good)
    real(dp), intent(in) :: unknowns(:), force(:), stiffness(:, :)
    real(dp), intent(out) :: change(:)
    logical, intent(out) :: settled, good
    real(dp) :: inverse(size(change), size(change))
    integer :: n
    n = size(unknowns) - size(change)
    call invert_general(stiffness(n + 1:, n + 1:), inverse, good)
    change = -matmul(inverse, force(n + 1:))
    settled = abs(dot_product(change, force(n + 1:))) <= no_work*dot_product(abs(unknowns), matmul(abs(stiffness), abs(unknowns)))
  end subroutine find_change

  !> Force and stiffness of the nodes, whose unknowns come first, if the modes follow them.
  pure subroutine condense(all_force, all_stiffness, force, stiffness)
    real(dp), intent(in) :: all_force(:), all_stiffness(:, :)
    real(dp), intent(out) :: force(:), stiffness(size(force), size(force))
    real(dp) :: inverse(size(all_force) - size(force), size(all_force) - size(force))
    real(dp) :: across(size(force), size(all_force) - size(force))
    integer :: n
    logical :: good
    n = size(force)
    call invert_general(all_stiffness(n + 1:, n + 1:), inverse, good)
    across = matmul(all_stiffness(:n, n + 1:), inverse)
    force = all_force(:n) - matmul(across, all_force(n + 1:))
    stiffness = all_stiffness(:n, :n) - matmul(across, all_stiffness(n + 1:, :n))
  end subroutine condense
end module host_incompatible
