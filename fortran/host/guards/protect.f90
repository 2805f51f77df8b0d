! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Fortran view of protect.c, frames.c, sanitizer.c, sma_arrays.c, inputs.c and stack.c.
module host_protect
  use, intrinsic :: iso_c_binding, only: c_char, c_double, c_funptr, c_int, c_int32_t, c_int64_t, c_ptr
  implicit none (type, external)
  private
  public :: protect, escape, clear_arrays, begin_call, limit_calls, trap, take_frames, watch, take_changes, &
            fill_stack, exchange_around, take_outside, allocated_bytes, attempt, share, loading, sanitizing, sanitize, fence, &
            open_fences, most_seats, on_seat, on_threads, go_alone

  integer, parameter :: most_frames = 64   !< as in frames.c
  integer, parameter :: most_seats = 64    !< threads, as in protect.c

  interface
    !> A user routine is about to be called for this element (0: for none); this tells the clock that it is a new call.
    subroutine begin_call(thread, element) bind(c, name='uel_host_begin')
      import :: c_int32_t
      integer(c_int32_t), value :: thread, element   !< thread: from 0
    end subroutine begin_call

    !> Run routine(context); 0 if it returned, 1 if it was left through escape or a signal, 2 if a call did not return.
    function protect(routine, context) bind(c, name='uel_host_protect') result(left)
      import :: c_funptr, c_int, c_ptr
      type(c_funptr), value :: routine
      type(c_ptr), value :: context
      integer(c_int) :: left
    end function protect

    !> Run routine(context), which calls user routines on several threads, each through on_seat.
    subroutine on_threads(routine, context) bind(c, name='uel_host_on_threads')
      import :: c_funptr, c_ptr
      type(c_funptr), value :: routine
      type(c_ptr), value :: context
    end subroutine on_threads

    !> Run routine(context) on this thread, numbered from 0; 0 if it returned, 1 if it was left.
    function on_seat(thread, routine, context) bind(c, name='uel_host_on_seat') result(left)
      import :: c_funptr, c_int, c_int32_t, c_ptr
      integer(c_int32_t), value :: thread
      type(c_funptr), value :: routine
      type(c_ptr), value :: context
      integer(c_int) :: left
    end function on_seat

    !> What follows needs the host to itself: leaves the routine where several threads run, else returns.
    subroutine go_alone() bind(c, name='uel_host_go_alone')
    end subroutine go_alone

    !> Run routine(context), statements on units 6 and 7; 1 if a call that was left has them locked, else 0.
    function attempt(routine, context) bind(c, name='uel_host_attempt') result(lost)
      import :: c_funptr, c_int, c_ptr
      type(c_funptr), value :: routine
      type(c_ptr), value :: context
      integer(c_int) :: lost
    end function attempt

    !> Let another process, which has the file open, see where user code is; 1 if that is not possible, else 0.
    function share(file) bind(c, name='uel_host_share') result(failed)
      import :: c_int
      integer(c_int), value :: file
      integer(c_int) :: failed
    end function share

    !> The library of user routines is loaded from now on (begins /= 0), or has been.
    subroutine loading(begins) bind(c, name='uel_host_loading')
      import :: c_int
      integer(c_int), value :: begins
    end subroutine loading

    !> Leave the running protect; does not return.
    subroutine escape() bind(c, name='uel_host_escape')
    end subroutine escape

    !> Time that one call of a user routine may take; 0: any.
    subroutine limit_calls(seconds) bind(c, name='uel_host_limit')
      import :: c_double
      real(c_double), value :: seconds
    end subroutine limit_calls

    !> Whether calls of user routines stop at the operation that produces a NaN or an infinity (on /= 0); returns the old setting.
    function trap(on) bind(c, name='uel_host_trap') result(before)
      import :: c_int32_t
      integer(c_int32_t), value :: on
      integer(c_int32_t) :: before
    end function trap

    !> Addresses of the calls that the last signal ended, innermost first; clears them.
    subroutine take_frames(address, count) bind(c, name='uel_host_take_frames')
      import :: c_int32_t, c_int64_t, most_frames
      integer(c_int64_t), intent(out) :: address(most_frames)
      integer(c_int32_t), intent(out) :: count
    end subroutine take_frames

    !> 1 if the runtime of AddressSanitizer is in this process, else 0.
    function sanitizing() bind(c, name='uel_host_sanitizing') result(present)
      import :: c_int32_t
      integer(c_int32_t) :: present
    end function sanitizing

    !> From now on, a library built with AddressSanitizer is called (begins /= 0), or no longer.
    subroutine sanitize(begins) bind(c, name='uel_host_sanitize')
      import :: c_int32_t
      integer(c_int32_t), value :: begins
    end subroutine sanitize

    !> Such a library must not touch the entries before and after an array, which has a number from 0.
    subroutine fence(slot, name, array, entries, before, behind) bind(c, name='uel_host_fence')
      import :: c_char, c_double, c_int32_t
      integer(c_int32_t), value :: slot, entries, before, behind
      character(kind=c_char), intent(in) :: name(6)
      real(c_double), intent(in) :: array(*)
    end subroutine fence

    !> Let the host read and write the guards.
    subroutine open_fences() bind(c, name='uel_host_open_fences')
    end subroutine open_fences

    !> Drop the arrays of SMAIntArrayCreate and its like.
    subroutine clear_arrays() bind(c, name='uel_host_clear_arrays')
    end subroutine clear_arrays

    !> Address of a routine that calls UEL, or UELMAT, at an address and notes which inputs it changes.
    function watch(address, with_material) bind(c, name='uel_host_watch') result(watched)
      import :: c_int32_t, c_int64_t
      integer(c_int64_t), value :: address
      integer(c_int32_t), value :: with_material   !< 0 for UEL
      integer(c_int64_t) :: watched
    end function watch

    !> First entry of each argument that changed since the last query (0: none), and its values before and after.
    subroutine take_changes(entries, values) bind(c, name='uel_host_take_changes')
      import :: c_double, c_int32_t
      integer(c_int32_t), intent(out) :: entries(37)
      real(c_double), intent(out) :: values(2, 37)
    end subroutine take_changes

    !> Swap the values around an argument, counted from 0, in watched calls.
    subroutine exchange_around(argument, number) bind(c, name='uel_host_around')
      import :: c_double, c_int32_t
      integer(c_int32_t), value :: argument
      real(c_double), intent(inout) :: number
    end subroutine exchange_around

    !> Whether something was written outside each argument since the last query, and the entry of the first such write.
    subroutine take_outside(found, entries) bind(c, name='uel_host_take_outside')
      import :: c_int32_t
      integer(c_int32_t), intent(out) :: found(37), entries(37)
    end subroutine take_outside

    !> Bytes that this process has allocated; negative if the C library does not tell.
    function allocated_bytes() bind(c, name='uel_host_allocated') result(bytes)
      import :: c_int64_t
      integer(c_int64_t) :: bytes
    end function allocated_bytes

    !> From now on, a watched call finds this number in the memory of its local variables (on /= 0), or no longer does.
    subroutine fill_stack(on, number) bind(c, name='uel_host_fill_stack')
      import :: c_double, c_int32_t
      integer(c_int32_t), value :: on
      real(c_double), value :: number
    end subroutine fill_stack
  end interface
end module host_protect
