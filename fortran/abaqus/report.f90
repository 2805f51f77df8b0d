! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Messages, and the end of the analysis: the only place where a kernel prints.
module abaqus_report
  use core_kinds, only: dp
  use abaqus_layout, only: elements
  implicit none(type, external)
  private
  public :: fatal, refuse_type, warn

contains

  !> Message through STDB_ABQERR, then XIT. If the host lets XIT return, so does this routine.
  subroutine fatal(itype, jelem, text, integers, reals)
    integer, intent(in) :: itype, jelem, integers(:)
    character(len=*), intent(in) :: text
    real(dp), intent(in) :: reals(:)
    external :: xit

    call send(-3, elements(itype)%jtype, jelem, text, integers, reals)
    call xit()
  end subroutine fatal

  !> The same for a type that is none of this file, or none for this routine.
  subroutine refuse_type(jtype, jelem, text)
    integer, intent(in) :: jtype, jelem
    character(len=*), intent(in) :: text
    external :: xit

    call send(-3, jtype, jelem, text, [integer ::], [real(dp) ::])
    call xit()
  end subroutine refuse_type

  !> Message after which the analysis goes on.
  subroutine warn(itype, jelem, text, integers, reals)
    integer, intent(in) :: itype, jelem, integers(:)
    character(len=*), intent(in) :: text
    real(dp), intent(in) :: reals(:)

    call send(-1, elements(itype)%jtype, jelem, text, integers, reals)
  end subroutine warn

  !> Message through STDB_ABQERR.
  subroutine send(severity, jtype, jelem, text, integers, reals)
    integer, intent(in) :: severity             !< -1 a warning, -3 an error that ends the analysis
    integer, intent(in) :: jtype                !< n of the element type Un
    integer, intent(in) :: jelem                !< element number
    character(len=*), intent(in) :: text        !< with %I and %R in place of the values
    integer, intent(in) :: integers(:)          !< values of %I, at most 8
    real(dp), intent(in) :: reals(:)            !< values of %R, at most 4
    character(len=500) :: string
    character(len=8) :: names(1)
    integer :: all_integers(10)
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
