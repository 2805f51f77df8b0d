! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Memory that a user element writes to: its arrays one after the other, each between guards.
!>
!> A write outside an array changes a guard. The guards are checked once per block; only if one has changed does the driver run the
!> block again and check after each element, so detection costs next to nothing.
module host_workspace
  use, intrinsic :: iso_c_binding, only: c_int64_t, c_intptr_t, c_loc
  use host_kinds, only: dp, guard_bits, i4, i8, unset_bits
  use host_protect, only: fence, open_fences
  implicit none (type, external)
  private
  public :: workspace_t, arrays, n_arrays, lay_out, exchange_guard_values, arm_guards, find_damage, fill, same_bits
  public :: all_finite, first_difference, set_room, take_guards
  public :: i_rhs, i_amatrx, i_svars, i_energy, i_props, i_coords, i_u, i_du, i_v, i_a, i_predef

  integer, parameter :: n_arrays = 11
  integer, parameter :: i_rhs = 1, i_amatrx = 2, i_svars = 3, i_energy = 4, i_props = 5, i_coords = 6, i_u = 7, i_du = 8, &
                        i_v = 9, i_a = 10, i_predef = 11
  character(len=6), parameter :: arrays(n_arrays) = [character(len=6) :: &
    'RHS', 'AMATRX', 'SVARS', 'ENERGY', 'PROPS', 'COORDS', 'U', 'DU', 'V', 'A', 'PREDEF']

  !> Entries of a guard that belong to the array after it. As many as the array before it has, within limits, belong to that one, so
  !> a routine that assumes an array twice as large hits the guard and not the next array. A check may ask for more.
  integer, parameter :: before = 100, least = 100, most = 20000
  !> Space after the last array: a write beyond all guards does no harm to this process.
  integer, parameter :: spare = 20480
  !> Entries of a cache line: each array starts on one; otherwise its position would affect the speed of an element.
  integer, parameter :: line = 8

  type :: workspace_t
    real(dp), allocatable :: memory(:)
    integer :: length(n_arrays) = 0   !< entries of each array
    integer :: start(n_arrays) = 0    !< position of the first entry of each array
    integer :: behind(n_arrays) = 0   !< entries of its guard behind it, up to those that belong to the next array
    integer :: room = least           !< fewest of them
    integer(i8) :: guard(n_arrays) = guard_bits   !< what the guards of each array hold
    integer(i8) :: unset = unset_bits             !< what RHS and AMATRX hold before a call
  end type workspace_t

contains

  !> Allocate the arrays; `length` entries each, zero. A workspace with these lengths and intact guards is kept.
  subroutine lay_out(work, length)
    type(workspace_t), intent(inout), target :: work
    integer, intent(in) :: length(n_arrays)
    integer :: k, needed, total
    if (allocated(work%memory) .and. all(work%length == length)) then
      do k = 1, n_arrays
        work%memory(work%start(k):work%start(k) + length(k) - 1) = 0
      end do
      call fence_arrays(work)
      return
    end if
    work%behind = max(min(max(length, least), most), work%room)
    needed = sum(length + work%behind) + (n_arrays + 1)*(before + line)
    if (allocated(work%memory)) then
      if (size(work%memory) < needed + spare) deallocate (work%memory)
    end if
    if (.not. allocated(work%memory)) allocate (work%memory(needed + spare))
    call open_fences()
    work%memory(:needed) = 0
    ! entries from the beginning of the memory to its first cache line, and whole lines before the first array
    total = int(modulo(-transfer(c_loc(work%memory), 0_c_intptr_t)/8, int(line, c_intptr_t)))
    total = total + before + modulo(-before, line)
    do k = 1, n_arrays
      work%start(k) = total + 1
      work%behind(k) = work%behind(k) + modulo(-length(k) - work%behind(k) - before, line)
      total = total + length(k) + work%behind(k) + before
    end do
    work%length = length
    call arm_guards(work)
  end subroutine lay_out

  !> The guards and the space behind them are out of bounds for AddressSanitizer, where it is used.
  subroutine fence_arrays(work)
    type(workspace_t), intent(in) :: work
    integer :: behind, k
    do k = 1, n_arrays
      behind = work%behind(k)
      if (k == n_arrays) behind = size(work%memory) - (work%start(k) + work%length(k) - 1)
      call fence(int(k - 1, i4), arrays(k), work%memory(work%start(k)), int(work%length(k), i4), int(before, i4), &
                 int(behind, i4))
    end do
  end subroutine fence_arrays

  !> Swap the values of the guards of each array and, last, that of unset entries.
  subroutine exchange_guard_values(work, values)
    type(workspace_t), intent(inout) :: work
    real(dp), intent(inout) :: values(n_arrays + 1)
    integer(i8) :: given(n_arrays + 1)
    given = transfer(values, given)
    values = transfer([work%guard, work%unset], values)
    work%guard = given(:n_arrays)
    work%unset = given(n_arrays + 1)
    if (allocated(work%memory)) call arm_guards(work)
  end subroutine exchange_guard_values

  !> Swap the minimum number of entries of the guard after each array.
  subroutine set_room(work, room)
    type(workspace_t), intent(inout) :: work
    integer, intent(inout) :: room
    integer :: asked
    asked = max(room, least)
    room = work%room
    work%room = asked
    if (allocated(work%memory)) deallocate (work%memory)
  end subroutine set_room

  !> Guards as those of another workspace.
  subroutine take_guards(work, from)
    type(workspace_t), intent(inout) :: work
    type(workspace_t), intent(in) :: from
    if (all(work%guard == from%guard) .and. work%unset == from%unset .and. work%room == from%room) return
    work%guard = from%guard
    work%unset = from%unset
    work%room = from%room
    if (allocated(work%memory)) deallocate (work%memory)
  end subroutine take_guards

  !> Write the patterns of the guards: entries not in the guard after an array belong to the next array.
  subroutine arm_guards(work)
    type(workspace_t), intent(inout) :: work
    integer :: k, free
    call open_fences()
    free = 1
    do k = 1, n_arrays
      call fill(int(work%start(k) - free, c_int64_t), work%guard(k), work%memory(free))
      free = work%start(k) + work%length(k)
      call fill(int(work%behind(k), c_int64_t), work%guard(k), work%memory(free))
      free = free + work%behind(k)
    end do
    call fence_arrays(work)
  end subroutine arm_guards

  !> First array with a changed guard, and the index written, counted from the array's first entry (1);
  !> array 0 if all is well.
  subroutine find_damage(work, array, index)
    type(workspace_t), intent(in) :: work
    integer, intent(out) :: array, index
    ! without optimisation the host copies entries by memcpy, which AddressSanitizer watches
    call open_fences()
    call compare_guards(work, array, index)
    call fence_arrays(work)
  end subroutine find_damage

  !> The same, while guards may be read.
  pure subroutine compare_guards(work, array, index)
    type(workspace_t), intent(in) :: work
    integer, intent(out) :: array, index
    integer :: k, position, front
    ! everything that is not in a cache line with the first array lies before it
    front = work%start(1) - 1
    do k = 1, n_arrays
      position = first_difference(work%behind(k), work%guard(k), work%memory(work%start(k) + work%length(k)))
      array = k
      index = work%length(k) + position
      if (position > 0) return
      position = first_difference(front, work%guard(k), work%memory(work%start(k) - front))
      index = position - front
      if (position > 0) return
      front = before
    end do
    array = 0
    index = 0
  end subroutine compare_guards

  !> x(:) = the number with these bits. Eight entries at a time vectorise, and the last eight may overlap with those before. For
  !> calls.c as well.
  subroutine fill(n, bits, x) bind(c, name='uel_host_fill')
    integer(c_int64_t), value :: n, bits
    real(dp), intent(inout) :: x(n)
    real(dp) :: value
    integer(c_int64_t) :: i
    value = transfer(bits, value)
    if (n < 8) then
      do i = 1, n
        x(i) = value
      end do
      return
    end if
    do i = 1, n - 8, 8
      x(i:i + 7) = value
    end do
    x(n - 7:n) = value
  end subroutine fill

  !> Index of the first entry that has other bits, 0 if none has.
  pure integer function first_difference(n, bits, x)
    integer, intent(in) :: n
    integer(i8), intent(in) :: bits
    real(dp), intent(in) :: x(n)
    integer(i8) :: difference
    integer :: i
    first_difference = 0
    ! without an exit the loop vectorises, and usually there is nothing to find
    difference = 0
    do i = 1, n
      difference = ior(difference, ieor(transfer(x(i), 1_i8), bits))
    end do
    if (difference == 0) return
    do i = 1, n
      first_difference = i
      if (.not. same_bits(x(i), bits)) return
    end do
  end function first_difference

  !> True where x has exactly these bits (NaN compares unequal to itself).
  elemental logical function same_bits(x, bits)
    real(dp), intent(in) :: x
    integer(i8), intent(in) :: bits
    same_bits = transfer(x, 1_i8) == bits
  end function same_bits

  !> True unless an entry is NaN or infinite (or so large that sums overflow). Eight sums at a time vectorise, and the last eight
  !> entries may count twice.
  pure logical function all_finite(n, x)
    integer, intent(in) :: n
    real(dp), intent(in) :: x(n)
    real(dp) :: s(8)
    integer :: i
    if (n < 8) then
      all_finite = abs(sum(x)) <= huge(1.0_dp)
      return
    end if
    s = x(n - 7:n)
    do i = 1, n - 8, 8
      s = s + x(i:i + 7)
    end do
    all_finite = abs(sum(s)) <= huge(1.0_dp)
  end function all_finite
end module host_workspace
