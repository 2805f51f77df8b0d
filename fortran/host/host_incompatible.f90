! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Incompatible modes of CPS4I, CPE4I and C3D8I, which let elements with straight edges bend. Their strains are those of
!> core_strains.
!>
!> Each pass brings the modes to equilibrium and condenses out their forces.
module host_incompatible
  use core_small_matrix, only: determinant, invert, invert_general
  use core_strains, only: condense_by => condense, mode_matrix
  use host_kinds, only: dp
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
    real(dp) :: inverse(rule%dim, rule%dim), at_middle
    integer :: dim, p
    dim = rule%dim
    middle => rule_of(rule%family, 1)
    call invert(dim, matmul(x, middle%dn(:, :, 1)), inverse, at_middle)
    do p = 1, rule%points
      call mode_matrix(dim, modes, strains, parent_place(rule, p), inverse, &
                       at_middle/determinant(matmul(x, rule%dn(:, :, p))), b(:, :, p))
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
    integer :: n
    logical :: good
    n = size(force)
    call invert_general(all_stiffness(n + 1:, n + 1:), inverse, good)
    call condense_by(n, inverse, all_force, all_stiffness, force, stiffness)
  end subroutine condense
end module host_incompatible
