! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> SDVINI for all elements of a block, at the start of the analysis (User Subroutines Guide, SDVINI): for each material
!> point of built-in elements, once for each user element, with the middle of its nodes as COORDS.
module host_sdvini
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_f_procpointer, c_funloc, c_funptr, c_loc, c_ptr
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_kinematics, only: point_position
  use host_protect, only: begin_call, protect
  use host_shape, only: rule_of
  implicit none (type, external)
  private
  public :: sdvini_pass_t, run_sdvini

  abstract interface
    subroutine sdvini_procedure(statev, coords, nstatv, ncrds, noel, npt, layer, kspt)
      import :: dp, i4
      real(dp) :: statev(*), coords(*)
      integer(i4) :: nstatv, ncrds, noel, npt, layer, kspt
    end subroutine sdvini_procedure
  end interface

  !> One pass over a block. Arrays belong to the caller.
  type :: sdvini_pass_t
    type(c_funptr) :: address
    integer :: family = 0                                          !< of built-in elements (host_shape), else 0
    integer(i4), pointer, contiguous :: labels(:) => null()
    real(dp), pointer, contiguous :: coords(:, :, :) => null()     !< (mcrd, nnode, m)
    real(dp), pointer, contiguous :: statev(:, :, :) => null()     !< (NSTATV, points, m)
  end type sdvini_pass_t

contains

  !> left = 1 if the routine ended the analysis, at current%element.
  subroutine run_sdvini(pass, left)
    type(sdvini_pass_t), intent(in), target :: pass
    integer(i4), intent(out) :: left
    current%routine = 'SDVINI'
    current%step = 1
    current%increment = 0
    left = int(protect(c_funloc(all_points), c_loc(pass)), i4)
    if (left == 0) current%element = 0
  end subroutine run_sdvini

  subroutine all_points(context) bind(c, name='uel_host_sdvini_points')
    type(c_ptr), value :: context
    type(sdvini_pass_t), pointer :: pass
    procedure(sdvini_procedure), pointer :: sdvini
    integer(i4) :: e, point, nstatv, ncrds, noel, npt, layer, kspt
    real(dp) :: coords(3)
    call c_f_pointer(context, pass)
    call c_f_procpointer(pass%address, sdvini)
    do e = 1, size(pass%labels, kind=i4)
      current%element = pass%labels(e)
      do point = 1, size(pass%statev, 2, kind=i4)
        current%point = point
        call begin_call(0_i4, current%element)
        coords = 0
        if (pass%family > 0) then
          coords = point_position(rule_of(pass%family, size(pass%statev, 2)), int(point), pass%coords(:, :, e))
        else
          coords(:size(pass%coords, 1)) = sum(pass%coords(:, :, e), dim=2)/size(pass%coords, 2)
        end if
        nstatv = size(pass%statev, 1, kind=i4)
        ncrds = size(pass%coords, 1, kind=i4)
        noel = current%element
        npt = point
        layer = 1
        kspt = 1
        call sdvini(pass%statev(:, point, e), coords, nstatv, ncrds, noel, npt, layer, kspt)
      end do
    end do
  end subroutine all_points
end module host_sdvini
