! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Units 6 and 7, to which user routines print: the host's own statements on them.
!> A call that was left inside a WRITE keeps the lock of its unit, so these statements may not return.
module host_units
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_funloc, c_loc, c_ptr
  use host_kinds, only: i4
  use host_protect, only: attempt
  implicit none (type, external)
  private
  public :: connect_units, flush_units

  type :: files_t
    character(len=2048) :: names(6:7) = ' '
    integer(i4) :: status = 0
    logical :: finish = .false.
  end type files_t

contains

  !> Connect them to two files; status is 0, IOSTAT of the OPEN that failed, or -1 if an earlier job has them locked.
  subroutine connect_units(file6, file7, status)
    character(len=2048), intent(in) :: file6, file7
    integer(i4), intent(out) :: status
    type(files_t), target :: files
    files%names(6) = file6
    files%names(7) = file7
    if (attempt(c_funloc(connect), c_loc(files)) /= 0) files%status = -1
    status = files%status
  end subroutine connect_units

  !> Flush them, and close them with `finish`; lost is 1 if that is not possible, else 0.
  subroutine flush_units(finish, lost)
    logical, intent(in) :: finish
    integer(i4), intent(out) :: lost
    type(files_t), target :: files
    files%finish = finish
    lost = int(attempt(c_funloc(write_out), c_loc(files)), i4)
  end subroutine flush_units

  subroutine connect(context) bind(c)
    type(c_ptr), value :: context
    type(files_t), pointer :: files
    integer :: unit
    call c_f_pointer(context, files)
    ! an earlier job in this process may have had the same files
    close (6)
    close (7)
    do unit = 6, 7
      open (unit=unit, file=trim(files%names(unit)), status='replace', action='readwrite', iostat=files%status)
      if (files%status /= 0) return
    end do
  end subroutine connect

  subroutine write_out(context) bind(c)
    type(c_ptr), value :: context
    type(files_t), pointer :: files
    integer :: unit
    logical :: is_open
    call c_f_pointer(context, files)
    do unit = 6, 7
      inquire (unit=unit, opened=is_open)
      if (.not. is_open) cycle
      if (files%finish) then
        close (unit)
      else
        flush (unit)
      end if
    end do
  end subroutine write_out
end module host_units
