! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> GETVRM: values of the material point for which UVARM or USDFLD is running, in the directions of *ORIENTATION. S, E and
!> LE (direct components, then shear); PE (the same, then in place 7 the equivalent plastic strain); SINV (Mises, Tresca,
!> pressure, third invariant); SDV. jrcd = 1 if the point does not have the variable.
subroutine getvrm(var, array, jarray, flgray, jrcd, jmac, jmatyp, matlayo, laccfla)
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_kinematics, only: rotated
  use host_materials, only: history_values
  use host_tensors, only: eigen
  implicit none (type, external)
  character(len=*), intent(in) :: var
  real(dp), intent(inout) :: array(15)
  integer(i4), intent(inout) :: jarray(15)
  character(len=3), intent(inout) :: flgray(15)
  integer(i4), intent(out) :: jrcd
  integer(i4), intent(in) :: jmac(*), jmatyp(*), matlayo, laccfla
  integer :: n, head, shown
  jrcd = 1
  if (.not. associated(current%values)) return
  array = 0
  jarray = 0
  flgray = 'YES'
  n = size(current%values)/2
  head = 0
  if (associated(current%history)) head = size(current%history, 1) - current%statev
  jrcd = 0
  select case (var)
  case ('E', 'LE')
    array(:n) = current%values(:n)
  case ('S')
    array(:n) = current%values(n + 1:)
  case ('SINV')
    array(:4) = invariants(n, current%values(n + 1:))
  case ('PE')
    ! backstresses may follow
    if (head >= history_values .and. mod(head - history_values, 6) == 0) then
      array(:6) = rotated(6, current%history(:6, current%point), current%axes, 2.0_dp)
      array(7) = current%history(7, current%point)
    else
      jrcd = 1
    end if
  case ('SDV')
    shown = min(current%statev, 15)
    if (shown > 0) array(:shown) = current%history(head + 1:head + shown, current%point)
    if (shown == 0) jrcd = 1
  case default
    jrcd = 1
  end select

contains

  !> Mises stress, Tresca stress, pressure, and the cube root of 27/2 times the determinant of the deviator.
  function invariants(n, stress) result(values)
    integer, intent(in) :: n
    real(dp), intent(in) :: stress(n)
    real(dp) :: values(4), principal(3), directions(3, 3), third
    call eigen(stress, 1_i4, 3_i4, int(n - 3, i4), principal, directions)
    values(2) = maxval(principal) - minval(principal)
    values(3) = -sum(principal)/3
    principal = principal + values(3)
    values(1) = sqrt(1.5_dp*sum(principal**2))
    third = 13.5_dp*product(principal)
    values(4) = sign(abs(third)**(1.0_dp/3), third)
  end function invariants
end subroutine getvrm
