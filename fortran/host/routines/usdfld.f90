! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> USDFLD (User Subroutines Guide): field variables of a material point of built-in elements, from what GETVRM returns for the start
!> of the increment, in each call of the element.
module host_usdfld
  use, intrinsic :: iso_c_binding, only: c_f_procpointer, c_funptr
  use host_context, only: current, visible_t
  use host_kinds, only: dp, i4
  use host_messages, only: add_message
  use host_point, only: npt_of, point_t
  use host_protect, only: escape
  use host_umat, only: direct_components
  implicit none (type, external)
  private
  public :: user_field_t, call_usdfld

  type :: user_field_t
    type(c_funptr) :: address
    character(len=80) :: material = ' ', orientation = ' '
    integer :: statev = 0                !< number of STATEV
    integer :: room = 0                  !< values at the end of the history of which STATEV are the first
    logical :: plastic = .false.         !< points have a plastic strain
  end type user_field_t

  abstract interface
    subroutine usdfld_procedure(field, statev, pnewdt, direct, t, celent, time, dtime, cmname, orname, nfield, nstatv, noel, &
                                npt, layer, kspt, kstep, kinc, ndi, nshr, coord, jmac, jmatyp, matlayo, laccfla)
      import :: dp, i4
      real(dp) :: field(*), statev(*), pnewdt, direct(*), t(*), celent, time(*), dtime, coord(*)
      character(len=80) :: cmname, orname
      integer(i4) :: nfield, nstatv, noel, npt, layer, kspt, kstep, kinc, ndi, nshr, jmac(*), jmatyp(*), matlayo, laccfla
    end subroutine usdfld_procedure
  end interface

contains

  !> Set the fields of the point, and STATEV in its trial history.
  subroutine call_usdfld(user, ntens, point, axes, basis, local, values)
    type(user_field_t), intent(in) :: user
    integer, intent(in) :: ntens
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: axes(3, 3)                !< rows: directions of the material
    real(dp), intent(in) :: basis(3, 3)               !< the same along the directions of the element
    logical, intent(in) :: local                      !< the history is in them
    real(dp), intent(in), target :: values(:)         !< strain and stress at the start of the increment; none of heat
    procedure(usdfld_procedure), pointer :: usdfld
    real(dp) :: field(size(point%fields, 1) - 1), statev(max(user%statev, 1)), direct(3, 3), t(3, 3), time(2), dtime, pnewdt, &
                celent, coord(3)
    character(len=80) :: cmname, orname
    character(len=len(current%routine)) :: routine
    integer(i4) :: nfield, nstatv, noel, npt, layer, kspt, kstep, kinc, ndi, nshr, jmac(1), jmatyp(1), matlayo, laccfla
    integer :: first
    first = 0
    call c_f_procpointer(user%address, usdfld)
    field = point%fields(2:, 1) + point%fields(2:, 2)
    statev = 0
    ! without STATEV, a material need not have a history
    if (user%statev > 0) then
      first = size(point%history) - user%room + 1
      statev(:user%statev) = point%history(first:first + user%statev - 1)
    end if
    direct = transpose(axes)
    t = transpose(basis)
    time = current%time
    dtime = current%dtime
    pnewdt = current%pnewdt
    celent = point%length
    coord = point%place
    cmname = user%material
    orname = user%orientation
    nfield = size(field, kind=i4)
    nstatv = int(user%statev, i4)
    noel = current%element
    npt = npt_of(point)
    layer = point%layer
    kspt = point%kspt
    kstep = current%step
    kinc = current%increment
    ndi = direct_components(ntens)
    nshr = int(ntens, i4) - ndi
    jmac = 0
    jmatyp = 0
    matlayo = 0
    laccfla = 0
    routine = current%routine
    current%routine = 'USDFLD'
    current%point = npt
    current%visible = visible_t(values, axes, point%history, point%fields, first, user%statev, user%plastic)
    if (local) current%visible%axes = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])
    call usdfld(field, statev, pnewdt, direct, t, celent, time, dtime, cmname, orname, nfield, nstatv, noel, npt, layer, kspt, &
                kstep, kinc, ndi, nshr, coord, jmac, jmatyp, matlayo, laccfla)
    nullify (current%visible%values)
    if (.not. all(abs(field) <= huge(field))) then
      call add_message(-3_i4, 'USDFLD sets a field variable to NaN or infinity')
      call escape()
    end if
    current%routine = routine
    current%pnewdt = min(current%pnewdt, pnewdt)
    point%fields(2:, 2) = field - point%fields(2:, 1)
    if (user%statev > 0) point%history_trial(first:first + user%statev - 1) = statev
  end subroutine call_usdfld
end module host_usdfld
