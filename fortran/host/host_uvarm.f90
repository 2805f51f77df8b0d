! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> UVARM at every material point of a block of built-in elements, at the end of an increment.
module host_uvarm
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_f_procpointer, c_funloc, c_funptr, c_loc, c_ptr
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_materials, only: history_values
  use host_protect, only: begin_call, protect
  use host_kinematics, only: point_position
  use host_shape, only: rule_of
  use host_umat, only: direct_components
  implicit none (type, external)
  private
  public :: uvarm_pass_t, run_uvarm

  abstract interface
    subroutine uvarm_procedure(uvar, direct, t, time, dtime, cmname, orname, nuvarm, noel, npt, layer, kspt, kstep, kinc, ndi, &
                               nshr, coord, jmac, jmatyp, matlayo, laccfla)
      import :: dp, i4
      real(dp) :: uvar(*), direct(*), t(*), time(*), dtime, coord(*)
      character(len=80) :: cmname, orname
      integer(i4) :: nuvarm, noel, npt, layer, kspt, kstep, kinc, ndi, nshr, jmac(*), jmatyp(*), matlayo, laccfla
    end subroutine uvarm_procedure
  end interface

  !> One pass over a block. Arrays belong to the caller.
  type :: uvarm_pass_t
    type(c_funptr) :: address
    character(len=80) :: material = ' ', orientation = ' '
    integer(i4) :: tensor = 0, statev = 0, kstep = 0, kinc = 0
    integer :: family = 0                 !< of the elements (host_shape)
    real(dp) :: time(2) = 0, dtime = 0    !< start of the increment
    integer(i4), pointer, contiguous :: labels(:) => null()
    real(dp), pointer, contiguous :: coords(:, :, :) => null()     !< (mcrd, nnode, m)
    logical :: local = .false.            !< the history is in the directions of the points
    real(dp), pointer, contiguous :: axes(:, :, :, :) => null()    !< (3, 3, points or 1, m or 1) rows: directions of the material
    real(dp), pointer, contiguous :: svars(:, :, :) => null()      !< (variables, points, m)
    real(dp), pointer, contiguous :: history(:, :, :) => null()    !< (values, points, m)
    real(dp), pointer, contiguous :: uvar(:, :, :) => null()       !< (NUVARM, points, m)
  end type uvarm_pass_t

contains

  !> left = 1 if the routine ended the analysis, at current%element.
  subroutine run_uvarm(pass, left)
    type(uvarm_pass_t), intent(in), target :: pass
    integer(i4), intent(out) :: left
    current%routine = 'UVARM'
    current%step = pass%kstep
    current%increment = pass%kinc
    current%time = pass%time
    current%dtime = pass%dtime
    ! backstresses may follow the plastic strain
    associate (head => size(pass%history, 1) - pass%statev)
      current%first = head + 1
      current%plastic = head >= history_values .and. mod(head - history_values, 6) == 0
    end associate
    current%statev = pass%statev
    left = int(protect(c_funloc(all_points), c_loc(pass)), i4)
    nullify (current%values, current%history)
    if (left == 0) current%element = 0
  end subroutine run_uvarm

  subroutine all_points(context) bind(c, name='uel_host_uvarm_points')
    type(c_ptr), value :: context
    type(uvarm_pass_t), pointer :: pass
    integer(i4) :: e, point
    call c_f_pointer(context, pass)
    do e = 1, size(pass%labels, kind=i4)
      current%element = pass%labels(e)
      current%history => pass%history(:, :, e)
      do point = 1, size(pass%uvar, 2, kind=i4)
        current%point = point
        current%column = point
        call begin_call(0_i4, current%element)
        current%values => pass%svars(:, point, e)
        ! a point for heat has neither strain nor stress
        if (pass%tensor == 0) current%values => pass%svars(:0, point, e)
        call call_uvarm(pass, point, pass%coords(:, :, e), &
                        pass%axes(:, :, min(int(point), size(pass%axes, 3)), min(int(e), size(pass%axes, 4))), &
                        pass%uvar(:, point, e))
      end do
    end do
  end subroutine all_points

  subroutine call_uvarm(pass, point, x, axes, uvar)
    type(uvarm_pass_t), intent(in) :: pass
    integer(i4), intent(in) :: point
    real(dp), intent(in) :: x(:, :), axes(3, 3)
    real(dp), intent(inout) :: uvar(:)
    procedure(uvarm_procedure), pointer :: uvarm
    real(dp) :: direct(3, 3), t(3, 3), time(2), dtime, coord(3)
    integer(i4) :: nuvarm, noel, npt, layer, kspt, kstep, kinc, ndi, nshr, jmac(1), jmatyp(1), matlayo, laccfla
    character(len=80) :: cmname, orname
    call c_f_procpointer(pass%address, uvarm)
    direct = transpose(axes)
    current%axes = axes
    if (pass%local) current%axes = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])
    t = direct
    time = pass%time
    dtime = pass%dtime
    coord = point_position(rule_of(pass%family, size(pass%uvar, 2)), int(point), x)
    cmname = pass%material
    orname = pass%orientation
    nuvarm = size(uvar, kind=i4)
    noel = current%element
    npt = point
    layer = 1
    kspt = 1
    kstep = pass%kstep
    kinc = pass%kinc
    ndi = direct_components(int(pass%tensor))
    nshr = pass%tensor - ndi
    jmac = 0
    jmatyp = 0
    matlayo = 0
    laccfla = 0
    call uvarm(uvar, direct, t, time, dtime, cmname, orname, nuvarm, noel, npt, layer, kspt, kstep, kinc, ndi, nshr, coord, jmac, &
               jmatyp, matlayo, laccfla)
  end subroutine call_uvarm
end module host_uvarm
