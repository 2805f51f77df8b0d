! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> GETVRM: values of the material point for which UVARM or USDFLD is running, in the directions of *ORIENTATION. S, E and
!> LE (11, 22, 33, 12, 13, 23; those that the point does not have are zero, and N/A in flgray); PE (the same, then in place 7
!> the equivalent plastic strain); SINV (Mises, Tresca, pressure, third invariant); SDV; in USDFLD TEMP. jrcd = 1 if the point
!> does not have the variable.
subroutine getvrm(var, array, jarray, flgray, jrcd, jmac, jmatyp, matlayo, laccfla)
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_kinematics, only: rotated
  use host_tensors, only: eigen
  implicit none (type, external)
  character(len=*), intent(in) :: var
  real(dp), intent(inout) :: array(15)
  integer(i4), intent(inout) :: jarray(15)
  character(len=3), intent(inout) :: flgray(15)
  integer(i4), intent(out) :: jrcd
  integer(i4), intent(in) :: jmac(*), jmatyp(*), matlayo, laccfla
  integer :: n, shown
  real(dp) :: strain(6), stress(6)
  integer, allocatable :: place(:)
  jrcd = 1
  if (.not. associated(current%visible%values)) return
  array = 0
  jarray = 0
  flgray = 'YES'
  associate (visible => current%visible, values => current%visible%values)
    place = places(size(values), current%tensor)
    n = size(place)
    if (n == 0 .and. var /= 'SDV' .and. var /= 'TEMP') return
    strain = 0
    strain(place) = values(:n)
    stress = 0
    stress(place) = values(n + 1:2*n)
    jrcd = 0
    select case (var)
    case ('E', 'LE')
      call give(strain)
    case ('S')
      call give(stress)
    case ('SINV')
      array(:4) = invariants(stress)
    case ('PE')
      if (.not. visible%plastic) then
        jrcd = 1
      else if (n == 1 .and. size(values) > 2) then
        array([1, 7]) = values(3:4)
      else
        array(:6) = rotated(6, visible%history(:6), visible%axes, 2.0_dp)
        array(7) = visible%history(7)
      end if
    case ('SDV')
      shown = min(visible%statev, 15)
      if (shown > 0) array(:shown) = visible%history(visible%first:visible%first + shown - 1)
      if (shown == 0) jrcd = 1
    case ('TEMP')
      ! that at the start of the increment
      if (associated(visible%fields)) then
        array(1) = visible%fields(1, 1)
      else
        jrcd = 1
      end if
    case default
      jrcd = 1
    end select
  end associate

contains

  !> Which of the six components a point has, by the number of its values, and by that of its stresses in trusses and beams: of one
  !> direction, of beams with torsion, of plane stress in shells, of solids.
  pure function places(values, tensor) result(place)
    integer, intent(in) :: values, tensor
    integer, allocatable :: place(:)
    integer :: k
    select case (values)
    case (2, 4)
      place = [1]
      if (tensor == 2) place = [1, 4]
    case (6)
      place = [1, 2, 4]
    case default
      place = [(k, k=1, values/2)]
    end select
  end function places

  subroutine give(tensor)
    real(dp), intent(in) :: tensor(6)
    array(:6) = tensor
    flgray = 'N/A'
    flgray(place) = 'YES'
  end subroutine give

  !> Mises stress, Tresca stress, pressure, and the cube root of 27/2 times the determinant of the deviator.
  function invariants(stress) result(values)
    real(dp), intent(in) :: stress(6)
    real(dp) :: values(4), principal(3), directions(3, 3), third
    call eigen(stress, 1_i4, 3_i4, 3_i4, principal, directions)
    values(2) = maxval(principal) - minval(principal)
    values(3) = -sum(principal)/3
    principal = principal + values(3)
    values(1) = sqrt(1.5_dp*sum(principal**2))
    third = 13.5_dp*product(principal)
    values(4) = sign(abs(third)**(1.0_dp/3), third)
  end function invariants
end subroutine getvrm
