! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> UVARM at every material point of a block of elements whose shape functions give the places of their points. Others call it
!> themselves, when asked for output_variables (host_context).
module host_uvarm_pass
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_funloc, c_loc, c_ptr
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_protect, only: begin_call, protect
  use host_kinematics, only: point_position
  use host_point, only: point_t
  use host_shape, only: rule_of
  use host_uvarm, only: call_uvarm, user_output_t
  implicit none (type, external)
  private
  public :: uvarm_pass_t, run_uvarm

  !> One pass over a block. Arrays belong to the caller.
  type :: uvarm_pass_t
    type(user_output_t) :: user
    integer(i4) :: tensor = 0, kstep = 0, kinc = 0
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
    current%step = pass%kstep
    current%increment = pass%kinc
    current%time = pass%time
    current%dtime = pass%dtime
    current%tensor = pass%tensor
    left = int(protect(c_funloc(all_points), c_loc(pass)), i4)
    nullify (current%visible%values)
    if (left == 0) current%element = 0
  end subroutine run_uvarm

  subroutine all_points(context) bind(c, name='uel_host_uvarm_points')
    type(c_ptr), value :: context
    type(uvarm_pass_t), pointer :: pass
    type(point_t) :: point
    integer(i4) :: e, k
    integer :: values
    call c_f_pointer(context, pass)
    ! a point for heat has neither strain nor stress
    values = merge(size(pass%svars, 1), 0, pass%tensor > 0)
    do e = 1, size(pass%labels, kind=i4)
      current%element = pass%labels(e)
      do k = 1, size(pass%uvar, 2, kind=i4)
        call begin_call(0_i4, current%element)
        point%number = k
        point%history => pass%history(:, k, e)
        point%place = point_position(rule_of(pass%family, size(pass%uvar, 2)), int(k), pass%coords(:, :, e))
        associate (axes => pass%axes(:, :, min(int(k), size(pass%axes, 3)), min(int(e), size(pass%axes, 4))))
          call call_uvarm(pass%user, int(pass%tensor), point, axes, axes, pass%local, pass%svars(:values, k, e), pass%uvar(:, k, e))
        end associate
      end do
    end do
  end subroutine all_points
end module host_uvarm_pass
