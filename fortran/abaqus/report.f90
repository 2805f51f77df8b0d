! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Messages, and the end of the analysis: the only place where a kernel prints.
module abaqus_report
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: fatal, warn

contains

  !> Message through STDB_ABQERR, then XIT. If the host lets XIT return, so does this routine.
  subroutine fatal(jtype, jelem, text, integers, reals)
    integer, intent(in) :: jtype, jelem, integers(:)
    character(len=*), intent(in) :: text
    real(dp), intent(in) :: reals(:)
    external :: xit

    call send(-3, jtype, jelem, text, integers, reals)
    call xit()
  end subroutine fatal

  !> Message after which the analysis goes on.
  subroutine warn(jtype, jelem, text, integers, reals)
    integer, intent(in) :: jtype, jelem, integers(:)
    character(len=*), intent(in) :: text
    real(dp), intent(in) :: reals(:)

    call send(-1, jtype, jelem, text, integers, reals)
  end subroutine warn

  !> Message through STDB_ABQERR.
  subroutine send(severity, jtype, jelem, text, integers, reals)
    integer, intent(in) :: severity             !< -1 a warning, -3 an error that ends the analysis
    integer, intent(in) :: jtype                !< n of the element type Un
    integer, intent(in) :: jelem                !< element number
    character(len=*), intent(in) :: text        !< with %I and %R in place of the values
    integer, intent(in) :: integers(:)          !< values of %I, at most 6
    real(dp), intent(in) :: reals(:)            !< values of %R, at most 4
    character(len=500) :: string
    character(len=8) :: names(1)
    integer :: all_integers(8)
    real(dp) :: all_reals(4)
    external :: stdb_abqerr

    names(1) = ' '
    all_integers = 0
    all_integers(1) = jtype
    all_integers(2) = jelem
    all_integers(3:2 + size(integers)) = integers
    all_reals = 0.0_dp
    all_reals(1:size(reals)) = reals
    string = 'U%I element %I: ' // text
    call stdb_abqerr(severity, string, all_integers, all_reals, names)
  end subroutine send

end module abaqus_report
