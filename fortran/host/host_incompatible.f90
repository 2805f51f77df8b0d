! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Incompatible modes of CPS4I, CPE4I and C3D8I, which let elements with straight edges bend. Their strains are those of
!> core_strains, and core_mode_search finds them.
module host_incompatible
  use core_small_matrix, only: determinant, invert
  use core_strains, only: mode_matrix
  use host_kinds, only: dp
  use host_shape, only: parent_place, rule_of, rule_t
  implicit none (type, external)
  private
  public :: mode_strains

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
end module host_incompatible
