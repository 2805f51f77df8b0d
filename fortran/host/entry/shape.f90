! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Procedures Python calls (through f2py) for shape functions and integration points; host/entry/elements.f90 has the others.

!> Shape functions and integration points of a family; known is 0 if there are none, or if their sizes differ.
subroutine host_rule(family, weight, n, dn, known, points, nodes, dim)
  use host_kinds, only: dp, i4
  use host_shape, only: find_rule, rule_t
  implicit none (type, external)
  integer(i4), intent(in) :: family, points, nodes, dim
  real(dp), intent(inout) :: weight(points), n(nodes, points), dn(nodes, dim, points)
  integer(i4), intent(out) :: known
  type(rule_t), pointer :: rule
  known = 0
  call find_rule(int(family), int(points), rule)
  if (.not. associated(rule)) return
  if (rule%nodes /= nodes .or. rule%dim /= dim) return
  known = 1
  weight = rule%weight
  n = rule%n
  dn = rule%dn
end subroutine host_rule

!> Make a rule of a family known; returns the number of the family that has it.
subroutine host_define_rule(family, parent, weight, reduced, number, points, dim)
  use host_kinds, only: dp, i4
  use host_shape, only: define_rule
  implicit none (type, external)
  integer(i4), intent(in) :: family, points, dim
  real(dp), intent(in) :: parent(dim, points), weight(points)   !< parent coordinates and weights
  integer(i4), intent(in) :: reduced          !< 0 or 1, as rule_t has it
  integer(i4), intent(out) :: number
  number = int(define_rule(int(family), parent, weight, reduced /= 0), i4)
end subroutine host_define_rule

!> Derivatives of the shape functions of a surface (nodes, 2, place) by its parent coordinates, at its nodes.
subroutine host_slopes_at_nodes(family, slopes, nodes)
  use host_kinds, only: dp, i4
  use host_shape, only: slopes_at_nodes
  implicit none (type, external)
  integer(i4), intent(in) :: family, nodes
  real(dp), intent(inout) :: slopes(nodes, 2, nodes)
  slopes = slopes_at_nodes(int(family))
end subroutine host_slopes_at_nodes
