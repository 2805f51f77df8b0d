! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Procedures Python calls (through f2py) to watch user elements; host/entry/elements.f90 has the others.

!> Address of a routine that calls UEL, or UELMAT, at an address and notes which inputs it changes.
subroutine host_watch(address, with_material, watched)
  use host_kinds, only: i4, i8
  use host_protect, only: watch
  implicit none (type, external)
  integer(i8), intent(in) :: address
  integer(i4), intent(in) :: with_material    !< 0 for UEL
  integer(i8), intent(out) :: watched
  watched = watch(address, with_material)
end subroutine host_watch

!> First entry of each argument that changed since the last query (0: none), and its values before and after.
subroutine host_take_changes(entries, values)
  use host_kinds, only: dp, i4
  use host_protect, only: take_changes
  implicit none (type, external)
  integer(i4), intent(out) :: entries(37)
  real(dp), intent(out) :: values(2, 37)
  call take_changes(entries, values)
end subroutine host_take_changes

!> From now on, watched calls find this number in the memory of their local variables (on /= 0), or no longer do.
subroutine host_fill_stack(on, number)
  use host_kinds, only: dp, i4
  use host_protect, only: fill_stack
  implicit none (type, external)
  integer(i4), intent(in) :: on
  real(dp), intent(in) :: number
  call fill_stack(on, number)
end subroutine host_fill_stack

!> Swap the values around an argument, counted from 0, that is not an array of the workspace, in watched calls.
subroutine host_exchange_around(argument, number)
  use host_kinds, only: dp, i4
  use host_protect, only: exchange_around
  implicit none (type, external)
  integer(i4), intent(in) :: argument
  real(dp), intent(inout) :: number(1)
  call exchange_around(argument, number(1))
end subroutine host_exchange_around

!> Whether something was written outside each argument since the last query, and the entry of the first such write.
subroutine host_take_outside(found, entries)
  use host_kinds, only: i4
  use host_protect, only: take_outside
  implicit none (type, external)
  integer(i4), intent(out) :: found(37), entries(37)
  call take_outside(found, entries)
end subroutine host_take_outside

!> Bytes that this process has allocated; negative if the C library does not tell.
subroutine host_allocated(bytes)
  use host_kinds, only: i8
  use host_protect, only: allocated_bytes
  implicit none (type, external)
  integer(i8), intent(out) :: bytes
  bytes = allocated_bytes()
end subroutine host_allocated

!> Whether calls of user routines stop at the operation that produces a NaN or an infinity (on /= 0).
subroutine host_trap(on, before)
  use host_kinds, only: i4
  use host_protect, only: trap
  implicit none (type, external)
  integer(i4), intent(in) :: on
  integer(i4), intent(out) :: before          !< what was asked for last
  before = trap(on)
end subroutine host_trap

!> Addresses of the calls that the last signal ended, innermost first, and their number; clears them.
subroutine host_take_frames(addresses, count)
  use host_kinds, only: i4, i8
  use host_protect, only: take_frames
  implicit none (type, external)
  integer(i8), intent(out) :: addresses(64)   !< most_frames: f2py takes no constant of a module, the compiler compares
  integer(i4), intent(out) :: count
  call take_frames(addresses, count)
end subroutine host_take_frames

!> Swap the minimum number of entries of the guard after each array of an element.
subroutine host_exchange_room(room)
  use host_driver, only: set_guard_room
  use host_kinds, only: i4
  implicit none (type, external)
  integer(i4), intent(inout) :: room(1)
  integer :: entries
  entries = room(1)
  call set_guard_room(entries)
  room(1) = int(entries, i4)
end subroutine host_exchange_room

!> 1 if the runtime of AddressSanitizer is in this process, else 0.
subroutine host_sanitizing(present)
  use host_kinds, only: i4
  use host_protect, only: sanitizing
  implicit none (type, external)
  integer(i4), intent(out) :: present
  present = sanitizing()
end subroutine host_sanitizing

!> From now on, a library built with AddressSanitizer is called (begins /= 0), or no longer.
subroutine host_sanitize(begins)
  use host_kinds, only: i4
  use host_protect, only: sanitize
  implicit none (type, external)
  integer(i4), intent(in) :: begins
  call sanitize(begins)
end subroutine host_sanitize
