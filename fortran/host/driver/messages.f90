! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Messages that user routines send with STDB_ABQERR, kept until Python fetches them.
module host_messages
  use, intrinsic :: iso_c_binding, only: c_char, c_int32_t, c_null_char
  use host_kinds, only: dp, i4
  use host_context, only: current, names_cut
  use host_protect, only: go_alone
  implicit none (type, external)
  private
  public :: message_t, add_message, pass_name, take_message, substitute

  integer, parameter :: text_length = 2048

  type :: message_t
    integer(i4) :: level = 0      !< LOP of STDB_ABQERR: 1, -1, -2, -3
    integer(i4) :: element = 0
    integer(i4) :: step = 0
    integer(i4) :: increment = 0
    character(len=text_length) :: text = ' '
  end type message_t

  type(message_t), allocatable, save :: queue(:)
  integer, save :: first = 1, last = 0

contains

  !> Append a message; the element, step and increment are those of the current call. One thread of several does not return from
  !> here: its strip is repeated on one.
  subroutine add_message(level, text)
    integer(i4), intent(in) :: level
    character(len=*), intent(in) :: text
    type(message_t), allocatable :: larger(:)
    call go_alone()
    if (.not. allocated(queue)) allocate (queue(16))
    if (last == size(queue)) then
      allocate (larger(2*size(queue)))
      larger(:last) = queue
      call move_alloc(larger, queue)
    end if
    last = last + 1
    queue(last) = message_t(level, current%element, current%step, current%increment, text)
  end subroutine add_message

  !> The same for C (stops.c).
  subroutine note(level, text, length) bind(c, name='uel_host_note')
    integer(c_int32_t), value :: level, length
    character(kind=c_char), intent(in) :: text(length)
    character(len=length) :: string
    string = transfer(text, string)
    call add_message(int(level, i4), string)
  end subroutine note

  !> What ended the running call, for C (protect.c); text ends with a null character.
  subroutine fault(text) bind(c, name='uel_host_fault')
    character(kind=c_char), intent(in) :: text(*)
    integer :: length
    length = 0
    do while (text(length + 1) /= c_null_char)
      length = length + 1
    end do
    call add_message(-3_i4, 'in '//trim(current%routine)//': '//transfer(text(:length), repeat(' ', length)))
  end subroutine fault

  !> Routine, which is filled up with blanks, element, step, increment and iteration of the running call, for C.
  subroutine get_place(routine, place) bind(c, name='uel_host_place')
    character(kind=c_char), intent(out) :: routine(len(current%routine))
    integer(c_int32_t), intent(out) :: place(4)
    routine = transfer(current%routine, routine)
    place = [current%element, current%step, current%increment, current%iteration]
  end subroutine get_place

  !> A name for a user routine, truncated to the length of its variable (CHARACTER*256 in Abaqus), and its length; a warning if it
  !> is truncated, once for each of names_cut.
  subroutine pass_name(number, what, name, variable, length)
    integer, intent(in) :: number
    character(len=*), intent(in) :: what, name
    character(len=*), intent(out) :: variable
    integer(i4), intent(out) :: length
    character(len=240) :: text
    variable = name
    length = int(min(len_trim(name), len(variable)), i4)
    if (len_trim(name) <= len(variable) .or. names_cut(number)) return
    write (text, '(2a,i0,a,i0,a)') what, ' has ', len_trim(name), ' characters, but the variable holds ', len(variable), &
      ' (CHARACTER*256 in Abaqus); the truncated name leads elsewhere'
    call add_message(-1_i4, trim(text))
    names_cut(number) = .true.
  end subroutine pass_name

  !> Oldest message not yet taken; level 0 when there is none.
  subroutine take_message(message)
    type(message_t), intent(out) :: message
    if (first > last) return
    message = queue(first)
    first = first + 1
    if (first > last) then
      first = 1
      last = 0
    end if
  end subroutine take_message

  !> Text of STDB_ABQERR with %I, %R and %S replaced, in order, by the entries of intv, realv and charv.
  function substitute(string, intv, realv, charv) result(text)
    character(len=*), intent(in) :: string
    integer(i4), intent(in) :: intv(*)
    real(dp), intent(in) :: realv(*)
    character(len=*), intent(in) :: charv(*)
    character(len=:), allocatable :: text
    character(len=32) :: number
    integer :: i, integers, reals, words
    integers = 0
    reals = 0
    words = 0
    i = 1
    text = ''
    do while (i <= len_trim(string))
      if (string(i:i) == '%' .and. i < len(string)) then
        i = i + 1
        select case (string(i:i))
        case ('I', 'i')
          integers = integers + 1
          write (number, '(i0)') intv(integers)
          text = text//trim(number)
        case ('R', 'r')
          reals = reals + 1
          write (number, '(1pg14.6)') realv(reals)
          text = text//trim(adjustl(number))
        case ('S', 's')
          words = words + 1
          text = text//trim(charv(words))
        case default
          text = text//string(i - 1:i)
        end select
      else
        text = text//string(i:i)
      end if
      i = i + 1
    end do
  end function substitute
end module host_messages
