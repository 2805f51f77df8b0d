! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> UHYPER at a material point, with the arguments of Abaqus (User Subroutines Guide, UHYPER).
module host_uhyper
  use, intrinsic :: iso_c_binding, only: c_f_procpointer, c_funptr
  use host_context, only: current
  use host_guarded, only: guarded_t, lay_out_guarded, warn_of_no_numbers, warn_of_writes
  use host_kinds, only: dp, i4
  use host_point, only: fields_at_end, point_t
  implicit none (type, external)
  private
  public :: user_potential_t, call_uhyper, outputs

  !> Arrays that UHYPER writes to.
  integer, parameter :: outputs = 5
  character(len=6), parameter :: names(outputs) = [character(len=6) :: 'U', 'UI1', 'UI2', 'UI3', 'STATEV']
  character(len=7), parameter :: sizes(outputs) = [character(len=7) :: '2', '3', '6', '6', '*DEPVAR']
  type(guarded_t), save, target :: work   ! each thread has its own
  !$omp threadprivate(work)

  type :: user_potential_t
    type(c_funptr) :: uhyper
    character(len=80) :: name = ' '             !< of the material
    real(dp), allocatable :: constants(:)       !< PROPS
    integer :: statev = 0
    logical, pointer :: reported(:) => null()   !< (outputs) a write outside the array is
    logical, pointer :: spoilt(:) => null()     !< (outputs) NaN in the array is
  end type user_potential_t

  abstract interface
    subroutine uhyper_procedure(bi1, bi2, aj, u, ui1, ui2, ui3, temp, noel, cmname, incmpflag, numstatev, statev, numfieldv, &
                                fieldv, fieldvinc, numprops, props)
      import :: dp, i4
      real(dp) :: bi1, bi2, aj, u(*), ui1(*), ui2(*), ui3(*), temp, statev(*), fieldv(*), fieldvinc(*), props(*)
      integer(i4) :: noel, incmpflag, numstatev, numfieldv, numprops
      character(len=80) :: cmname
    end subroutine uhyper_procedure
  end interface

contains

  !> Strain energy per initial volume and its derivatives by I1 and I2, both without the change of volume, and J.
  subroutine call_uhyper(potential, point, i1, i2, j, statev, energy, first, second)
    type(user_potential_t), intent(in) :: potential
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: i1, i2, j
    real(dp), intent(inout) :: statev(:)           !< STATEV at the start of the increment, then at its end
    real(dp), intent(out) :: energy, first(3), second(3, 3)
    procedure(uhyper_procedure), pointer :: uhyper
    real(dp) :: invariants(3), temp, unused, constants(size(potential%constants))
    real(dp), allocatable :: fieldv(:), fieldvinc(:)
    integer(i4) :: noel, incmpflag, numstatev, numfieldv, numprops
    character(len=80) :: cmname
    character(len=len(current%routine)) :: routine
    call c_f_procpointer(potential%uhyper, uhyper)
    numstatev = size(statev, kind=i4)
    call lay_out_guarded(work, [2, 3, 6, 6, int(numstatev)])
    invariants = [i1, i2, j]
    call fields_at_end(point, temp, unused, fieldv, fieldvinc)
    numfieldv = size(fieldv, kind=i4)
    constants = potential%constants
    numprops = size(constants, kind=i4)
    noel = current%element
    cmname = potential%name
    ! then a hybrid element gives the mean stress
    incmpflag = merge(1_i4, 0_i4, point%hybrid)
    routine = current%routine
    current%routine = 'UHYPER'
    current%point = point%number
    associate (x => work%memory, s => work%start)
      x(s(1):s(1) + 1) = 0
      x(s(2):s(2) + 2) = 0
      x(s(3):s(3) + 5) = 0
      x(s(4):s(4) + 5) = 0
      x(s(5):s(5) + numstatev - 1) = statev
      call uhyper(invariants(1), invariants(2), invariants(3), x(s(1)), x(s(2)), x(s(3)), x(s(4)), temp, noel, cmname, incmpflag, &
                  numstatev, x(s(5)), numfieldv, fieldv, fieldvinc, numprops, constants)
      call warn_of_writes(work, names, sizes, point%number, potential%reported)
      call warn_of_no_numbers(work, names, point%number, potential%spoilt)
      energy = x(s(1))
      first = x(s(2):s(2) + 2)
      associate (second_of => x(s(3):s(3) + 5))
        second(:, 1) = second_of([1, 4, 5])
        second(:, 2) = second_of([4, 2, 6])
        second(:, 3) = second_of([5, 6, 3])
      end associate
      statev = x(s(5):s(5) + numstatev - 1)
    end associate
    current%routine = routine
  end subroutine call_uhyper
end module host_uhyper
