! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Constants of a material that depend on variables, by a table.
!>
!> They are linear in each variable between the values of the table and constant beyond them (Abaqus Analysis User's Guide,
!> Material data definition).
module host_tables
  use host_kinds, only: dp
  implicit none (type, external)
  private
  public :: interpolate

contains

  !> Constants where the variables have these values, the last variable first, and their derivatives by the first variable; at a
  !> value of the table that above it.
  pure recursive subroutine interpolate(constants, variables, table, at, values, slopes)
    integer, intent(in) :: constants, variables
    real(dp), intent(in) :: table(:, :), at(:)      !< (constants, then variables, k); more of at than the table has are left out
    real(dp), intent(out) :: values(constants), slopes(constants)
    real(dp) :: x(size(table, 2)), below, above, part, upper(constants), upper_slopes(constants)
    integer :: k
    integer :: rows(size(table, 2))
    slopes = 0
    if (variables == 0) then
      values = table(:constants, 1)
      return
    end if
    x = table(constants + variables, :)
    rows = [(k, k=1, size(rows))]
    below = minval(x)
    if (any(x <= at(variables))) below = maxval(x, x <= at(variables))
    above = below
    if (below <= at(variables) .and. any(x > at(variables))) above = minval(x, x > at(variables))
    call interpolate(constants, variables - 1, table(:, pack(rows, abs(x - below) <= 0)), at, values, slopes)
    if (above <= below) return
    call interpolate(constants, variables - 1, table(:, pack(rows, abs(x - above) <= 0)), at, upper, upper_slopes)
    part = (at(variables) - below)/(above - below)
    if (variables == 1) then
      slopes = (upper - values)/(above - below)
    else
      slopes = slopes + part*(upper_slopes - slopes)
    end if
    values = values + part*(upper - values)
  end subroutine interpolate
end module host_tables
