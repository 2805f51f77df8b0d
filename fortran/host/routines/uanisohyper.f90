! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> UANISOHYPER_INV at a material point, with the arguments of Abaqus (User Subroutines Guide, UANISOHYPER_INV).
module host_uanisohyper
  use, intrinsic :: iso_c_binding, only: c_f_procpointer, c_funptr
  use host_context, only: current
  use host_guarded, only: guarded_t, lay_out_guarded, warn_of_no_numbers, warn_of_writes
  use host_kinds, only: dp, i4
  use host_point, only: fields_at_end, point_t
  implicit none (type, external)
  private
  public :: user_invariants_t, call_uanisohyper, outputs

  !> Arrays that UANISOHYPER_INV writes to.
  integer, parameter :: outputs = 5
  character(len=6), parameter :: names(outputs) = [character(len=6) :: 'UA', 'UI1', 'UI2', 'UI3', 'STATEV']
  character(len=15), parameter :: pairs_of_ninv = 'NINV*(NINV+1)/2'
  character(len=15), parameter :: sizes(outputs) = [character(len=15) :: '2', 'NINV', pairs_of_ninv, pairs_of_ninv, '*DEPVAR']
  type(guarded_t), save, target :: work   ! each thread has its own
  !$omp threadprivate(work)

  type :: user_invariants_t
    type(c_funptr) :: uanisohyper
    character(len=80) :: name = ' '             !< of the material
    real(dp), allocatable :: constants(:)       !< PROPS
    integer :: statev = 0
    logical, pointer :: reported(:) => null()   !< (outputs) a write outside the array is
    logical, pointer :: spoilt(:) => null()     !< (outputs) NaN in the array is
  end type user_invariants_t

  abstract interface
    subroutine uanisohyper_procedure(ainv, ua, zeta, nfibers, ninv, ui1, ui2, ui3, temp, noel, cmname, incmpflag, ihybflag, &
                                     numstatev, statev, numfieldv, fieldv, fieldvinc, numprops, props)
      import :: dp, i4
      real(dp) :: ainv(*), ua(*), zeta(*), ui1(*), ui2(*), ui3(*), temp, statev(*), fieldv(*), fieldvinc(*), props(*)
      integer(i4) :: nfibers, ninv, noel, incmpflag, ihybflag, numstatev, numfieldv, numprops
      character(len=80) :: cmname
    end subroutine uanisohyper_procedure
  end interface

contains

  !> Strain energy per initial volume and its derivatives by the invariants.
  subroutine call_uanisohyper(potential, point, invariants, cosines, statev, energy, first, second)
    type(user_invariants_t), intent(in) :: potential
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: invariants(:), cosines(:)         !< AINV and ZETA
    real(dp), intent(inout) :: statev(:)                      !< STATEV at the start of the increment, then at its end
    real(dp), intent(out) :: energy, first(size(invariants)), second(size(invariants), size(invariants))
    procedure(uanisohyper_procedure), pointer :: uanisohyper
    real(dp) :: ainv(size(invariants)), zeta(size(cosines)), temp, unused, constants(size(potential%constants))
    real(dp), allocatable :: fieldv(:), fieldvinc(:)
    integer(i4) :: nfibers, ninv, noel, incmpflag, ihybflag, numstatev, numfieldv, numprops
    integer :: i, k, pairs
    character(len=80) :: cmname
    character(len=len(current%routine)) :: routine
    call c_f_procpointer(potential%uanisohyper, uanisohyper)
    ninv = size(invariants, kind=i4)
    nfibers = 0
    do while (3 + nfibers*(nfibers + 1) < ninv)
      nfibers = nfibers + 1_i4
    end do
    pairs = ninv*(ninv + 1)/2
    numstatev = size(statev, kind=i4)
    call lay_out_guarded(work, [2, int(ninv), pairs, pairs, int(numstatev)])
    ainv = invariants
    zeta = cosines
    call fields_at_end(point, temp, unused, fieldv, fieldvinc)
    numfieldv = size(fieldv, kind=i4)
    constants = potential%constants
    numprops = size(constants, kind=i4)
    noel = current%element
    cmname = potential%name
    ! then a hybrid element gives the mean stress
    incmpflag = merge(1_i4, 0_i4, point%hybrid)
    ihybflag = incmpflag
    routine = current%routine
    current%routine = 'UANISOHYPER_INV'
    current%point = point%number
    associate (x => work%memory, s => work%start)
      do k = 1, outputs - 1
        x(s(k):s(k) + work%length(k) - 1) = 0
      end do
      x(s(5):s(5) + numstatev - 1) = statev
      call uanisohyper(ainv, x(s(1)), zeta, nfibers, ninv, x(s(2)), x(s(3)), x(s(4)), temp, noel, cmname, incmpflag, ihybflag, &
                       numstatev, x(s(5)), numfieldv, fieldv, fieldvinc, numprops, constants)
      call warn_of_writes(work, names, sizes, point%number, potential%reported)
      call warn_of_no_numbers(work, names, point%number, potential%spoilt)
      energy = x(s(1))
      first = x(s(2):s(2) + ninv - 1)
      ! UI2(i + k (k - 1)/2) with i <= k
      do k = 1, ninv
        do i = 1, k
          second(i, k) = x(s(3) + i + k*(k - 1)/2 - 1)
          second(k, i) = second(i, k)
        end do
      end do
      statev = x(s(5):s(5) + numstatev - 1)
    end associate
    current%routine = routine
  end subroutine call_uanisohyper
end module host_uanisohyper
