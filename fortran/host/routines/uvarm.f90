! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> UVARM (User Subroutines Guide) at a material point of built-in elements, at the end of an increment.
module host_uvarm
  use, intrinsic :: iso_c_binding, only: c_f_procpointer, c_funptr
  use host_context, only: current, visible_t
  use host_kinds, only: dp, i4
  use host_point, only: npt_of, point_t
  use host_umat, only: direct_components
  implicit none (type, external)
  private
  public :: user_output_t, call_uvarm, keep_uvar

  type :: user_output_t
    type(c_funptr) :: address
    character(len=80) :: material = ' ', orientation = ' '
    integer :: count = 0                 !< NUVARM
    integer :: width = 0                 !< values of the history for UVAR, if they are there: they come before those of room
    integer :: statev = 0                !< number of STATEV
    integer :: room = 0                  !< values at the end of the history of which STATEV are the first
    logical :: plastic = .false.         !< points have a plastic strain
  end type user_output_t

  abstract interface
    subroutine uvarm_procedure(uvar, direct, t, time, dtime, cmname, orname, nuvarm, noel, npt, layer, kspt, kstep, kinc, ndi, &
                               nshr, coord, jmac, jmatyp, matlayo, laccfla)
      import :: dp, i4
      real(dp) :: uvar(*), direct(*), t(*), time(*), dtime, coord(*)
      character(len=80) :: cmname, orname
      integer(i4) :: nuvarm, noel, npt, layer, kspt, kstep, kinc, ndi, nshr, jmac(*), jmatyp(*), matlayo, laccfla
    end subroutine uvarm_procedure
  end interface

contains

  !> UVAR of a point, with GETVRM for the values of the history.
  subroutine call_uvarm(user, ntens, point, axes, basis, local, values, uvar)
    type(user_output_t), intent(in) :: user
    integer, intent(in) :: ntens
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: axes(3, 3)                !< rows: directions of the material
    real(dp), intent(in) :: basis(3, 3)               !< the same along the directions of the element
    logical, intent(in) :: local                      !< the history is in them
    real(dp), intent(in), target :: values(:)         !< strain and stress; none of heat
    real(dp), intent(inout) :: uvar(:)
    procedure(uvarm_procedure), pointer :: uvarm
    real(dp) :: direct(3, 3), t(3, 3), time(2), dtime, coord(3)
    integer(i4) :: nuvarm, noel, npt, layer, kspt, kstep, kinc, ndi, nshr, jmac(1), jmatyp(1), matlayo, laccfla
    character(len=80) :: cmname, orname
    character(len=len(current%routine)) :: routine
    call c_f_procpointer(user%address, uvarm)
    direct = transpose(axes)
    t = transpose(basis)
    time = current%time
    dtime = current%dtime
    coord = point%place
    cmname = user%material
    orname = user%orientation
    nuvarm = size(uvar, kind=i4)
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
    current%routine = 'UVARM'
    current%point = npt
    current%visible = visible_t(values, axes, point%history, point%fields, size(point%history) - user%room + 1, user%statev, &
                                user%plastic)
    if (local) current%visible%axes = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])
    call uvarm(uvar, direct, t, time, dtime, cmname, orname, nuvarm, noel, npt, layer, kspt, kstep, kinc, ndi, nshr, coord, jmac, &
               jmatyp, matlayo, laccfla)
    nullify (current%visible%values)
    current%routine = routine
  end subroutine call_uvarm

  !> The same with UVAR in the history, whose tensors are in the directions of the point.
  subroutine keep_uvar(user, ntens, point, axes, basis, values)
    type(user_output_t), intent(in) :: user
    integer, intent(in) :: ntens
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: axes(3, 3), basis(3, 3)
    real(dp), intent(in), target :: values(:)
    associate (first => size(point%history_trial) - user%room - user%width + 1)
      call call_uvarm(user, ntens, point, axes, basis, .true., values, point%history_trial(first:first + user%count - 1))
    end associate
  end subroutine keep_uvar
end module host_uvarm
