! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> One message in a job about estimates of beta that the consistent law does not allow, and that an element has raised.
!>
!> As in `abaqus_long_elements`, several threads may send it once each, and the flag is set after the message.
module abaqus_raised_beta
  use core_kinds, only: dp
  use abaqus_layout, only: reals, p_betan, p_betat
  use abaqus_properties, only: real_position
  use abaqus_report, only: warn
  implicit none(type, external)
  private
  public :: warn_if_raised, forget_raised_beta

  logical :: told = .false.

contains

  !> The message, if the element is the first one of the job that calls for it.
  subroutine warn_if_raised(itype, jelem, estimate, beta)
    integer, intent(in) :: itype, jelem
    real(dp), intent(in) :: estimate(2)    !< (tau, n), stress/length; 0 where beta has not been raised
    real(dp), intent(in) :: beta(2)        !< that acts
    integer, parameter :: rows(2) = [p_betat, p_betan]
    integer :: i

    if (told) return
    do i = 2, 1, -1
      if (.not. estimate(i) > 0.0_dp) cycle
      call warn(itype, jelem, 'PROPS(%I) ' // trim(reals(rows(i))%name) // ': the estimate of beta is %R, too small for ' // &
        'the softening slope of the law; raised to %R. Elements that fail should be shorter. Told once in a job', &
        [real_position(itype, rows(i))], [estimate(i), beta(i)])
      told = .true.
      return
    end do
  end subroutine warn_if_raised

  !> At the start and the end of an analysis.
  subroutine forget_raised_beta()
    told = .false.
  end subroutine forget_raised_beta

end module abaqus_raised_beta
