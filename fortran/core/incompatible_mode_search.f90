! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The search for incompatible modes that leave no force: Newton's method, with a line search where a material yields on the way.
module core_incompatible_mode_search
  use core_kinds, only: dp
  use core_small_matrix, only: invert_general
  implicit none(type, external)
  private
  public :: mode_search, find_modes, most_passes

  !> Passes after which a search is given up.
  integer, parameter :: most_passes = 50

  !> Modes of C3D8I, the most of any element.
  integer, parameter :: most_modes = 13

  !> Work of the forces on the modes that counts as zero, relative to that of all forces.
  real(dp), parameter :: no_work = 1.0e-20_dp

  !> Smallest share of a change that is tried.
  real(dp), parameter :: least_share = 0.01_dp

  !> A search on its way.
  type :: mode_search
    private
    real(dp) :: start(most_modes) = 0.0_dp, change(most_modes) = 0.0_dp
    real(dp) :: share = 0.0_dp          !< of the change that the modes have now
    real(dp) :: first_slope = 0.0_dp    !< of the energy along the change, at its start
  end type mode_search

contains

  !> The modes of the next pass, by their force and stiffness in this one. If the force does no work they stay, and `settled` is
  !> true; if the stiffness is singular they stay, and `good` is false.
  pure subroutine find_modes(this, force, stiffness, all_work, modes, inverse, settled, good)
    type(mode_search), intent(inout) :: this
    real(dp), intent(in) :: force(:), stiffness(:, :)
    real(dp), intent(in) :: all_work                !< of all forces, as a measure
    real(dp), intent(inout) :: modes(:)
    real(dp), intent(inout) :: inverse(:, :)        !< of the stiffness, that of this pass once the modes are settled
    logical, intent(out) :: settled, good
    real(dp) :: slope
    integer :: n

    n = size(modes)
    settled = .false.
    good = .true.
    slope = dot_product(this%change(:n), force)
    if (this%share > least_share .and. slope > 0.5_dp*abs(this%first_slope)) then
      ! too far: to where a straight line between both slopes is zero
      this%share = this%share*max(0.1_dp, abs(this%first_slope)/(abs(this%first_slope) + slope))
    else
      call invert_general(stiffness, inverse, good)
      this%change(:n) = -matmul(inverse, force)
      this%first_slope = dot_product(this%change(:n), force)
      settled = abs(this%first_slope) <= no_work*all_work
      if (settled .or. .not. good) return
      this%start(:n) = modes
      this%share = 1.0_dp
    end if
    modes = this%start(:n) + this%share*this%change(:n)
  end subroutine find_modes

end module core_incompatible_mode_search
