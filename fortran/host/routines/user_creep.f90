! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Creep whose law CREEP gives (User Subroutines Guide, CREEP): backward Euler, as in host_creep. The equivalent creep strain may
!> depend on the Mises stress, on itself at the end of the increment and on the pressure; swelling is not there.
module host_user_creep
  use, intrinsic :: iso_c_binding, only: c_f_procpointer, c_funptr
  use core_root, only: advance, root_search, search_between, searching
  use host_context, only: current
  use host_creep, only: creep_values, crept_t, relax, trial_of, trial_t
  use host_guarded, only: guarded_t, lay_out_guarded, warn_of_writes
  use host_kinds, only: dp, i4
  use host_messages, only: add_message
  use host_point, only: fields_at_end, npt_of, point_t
  use host_protect, only: escape
  implicit none (type, external)
  private
  public :: user_creep_t, user_creep_solid, user_creep_values, outputs

  !> Of the history: those of host_creep, time in steps where materials creep, pressure.
  integer, parameter :: user_creep_values = creep_values + 2

  !> Arrays that CREEP writes to.
  integer, parameter :: outputs = 3
  character(len=6), parameter :: names(outputs) = [character(len=6) :: 'DECRA', 'DESWA', 'STATEV']
  character(len=7), parameter :: sizes(outputs) = [character(len=7) :: '5', '5', '*DEPVAR']
  type(guarded_t), save, target :: work   ! each thread has its own
  !$omp threadprivate(work)

  type :: user_creep_t
    type(c_funptr) :: address
    character(len=80) :: name = ' '             !< of the material
    integer :: statev = 0                       !< number of STATEV, the last values of the history
    logical, pointer :: reported(:) => null()   !< (outputs) a write outside the array is; then: swelling is
  end type user_creep_t

  !> DECRA.
  type :: law_t
    real(dp) :: increment = 0                   !< of the equivalent creep strain
    real(dp) :: by_strain = 0, by_pressure = 0, by_stress = 0
  end type law_t

  abstract interface
    subroutine creep_procedure(decra, deswa, statev, serd, ec, esw, p, qtild, temp, dtemp, predef, dpred, time, dtime, cmname, &
                               leximp, lend, coords, nstatv, noel, npt, layer, kspt, kstep, kinc)
      import :: dp, i4
      real(dp) :: decra(*), deswa(*), statev(*), serd, ec(*), esw(*), p, qtild, temp, dtemp, predef(*), dpred(*), time(*), dtime, &
                  coords(*)
      character(len=80) :: cmname
      integer(i4) :: leximp, lend, nstatv, noel, npt, layer, kspt, kstep, kinc
    end subroutine creep_procedure
  end interface

contains

  !> Plane strain (n = 4) and three dimensions (n = 6); STATEV that the last call has left go to the trial history of the point.
  subroutine user_creep_solid(law, young, poisson, elapsed, point, statev, n, old, strain, stress, tangent, new, solved)
    type(user_creep_t), intent(in) :: law
    real(dp), intent(in) :: young, poisson
    real(dp), intent(in) :: elapsed               !< zero: no creep
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: statev(:)             !< at the start of the increment
    integer, intent(in) :: n
    real(dp), intent(in) :: old(:), strain(n)
    real(dp), intent(out) :: stress(n), tangent(n, n), new(:)
    logical, intent(out) :: solved
    type(trial_t) :: trial
    type(crept_t) :: crept
    type(law_t) :: start, now
    type(root_search) :: search
    real(dp) :: stiffness, pressure, slope
    trial = trial_of(young, poisson, n, old, strain)
    stiffness = 3*trial%shear
    pressure = -3*trial%bulk*trial%mean
    solved = .true.
    if (elapsed > 0) then
      call call_creep(law, point, statev, old, 0.0_dp, old(9), old(11), 0_i4, start)
      search = search_between(0.0_dp, trial%mises/stiffness, 0.0_dp, geometric=.false.)
      call call_creep(law, point, statev, old, 0.0_dp, trial%mises, pressure, 1_i4, now)
      ! without a stress there is no direction to creep along
      do while (searching(search) .and. trial%mises > 0)
        slope = 1 + stiffness*now%by_stress - now%by_strain
        call advance(search, search%x - now%increment, slope)
        call call_creep(law, point, statev, old, search%x, trial%mises - stiffness*search%x, pressure, 1_i4, now)
      end do
      solved = search%found .or. .not. trial%mises > 0
      if (solved .and. trial%mises > 0) then
        slope = 1 + stiffness*now%by_stress - now%by_strain
        crept%increment = search%x
        crept%by_stress = now%by_stress/slope
        crept%by_pressure = now%by_pressure/slope
        crept%change = abs(now%increment - start%increment)
      end if
    end if
    call relax(trial, crept, n, old, stress, tangent, new)
    new(10) = old(10) + elapsed
    new(11) = pressure
  end subroutine user_creep_solid

  !> DECRA after an increment of the equivalent creep strain. Leaves the pass if it is no number, or negative where nothing has
  !> relaxed yet.
  subroutine call_creep(law, point, start, old, increment, mises, pressure, lend, found)
    type(user_creep_t), intent(in) :: law
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: start(:), old(:), increment, mises, pressure
    integer(i4), intent(in) :: lend               !< 0: the values are those of the start of the increment, 1: of its end
    type(law_t), intent(out) :: found
    procedure(creep_procedure), pointer :: creep
    real(dp) :: serd, ec(2), esw(2), p, qtild, temp, dtemp, time(3), dtime, coords(3)
    real(dp), allocatable :: predef(:), dpred(:)
    integer(i4) :: leximp, at_end, nstatv, noel, npt, layer, kspt, kstep, kinc
    character(len=80) :: cmname
    character(len=len(current%routine)) :: routine
    character(len=120) :: text
    logical :: good, swells
    call c_f_procpointer(law%address, creep)
    nstatv = int(law%statev, i4)
    call lay_out_guarded(work, [5, 5, law%statev])
    serd = 0
    ec = old(7) + [0.0_dp, increment]
    esw = 0
    p = pressure
    qtild = mises
    call fields_at_end(point, temp, dtemp, predef, dpred)
    dtime = current%dtime
    ! all at the end of the increment, the last one in steps where materials creep
    time = [current%time, old(10)] + dtime
    leximp = 1
    at_end = lend
    coords = point%place
    noel = current%element
    npt = npt_of(point)
    layer = point%layer
    kspt = point%kspt
    kstep = current%step
    kinc = current%increment
    cmname = law%name
    routine = current%routine
    current%routine = 'CREEP'
    current%point = npt
    associate (x => work%memory, s => work%start)
      x(s(1):s(1) + 4) = 0
      x(s(2):s(2) + 4) = 0
      x(s(3):s(3) + nstatv - 1) = start
      call creep(x(s(1)), x(s(2)), x(s(3)), serd, ec, esw, p, qtild, temp, dtemp, predef, dpred, time, dtime, cmname, leximp, &
                 at_end, coords, nstatv, noel, npt, layer, kspt, kstep, kinc)
      call warn_of_writes(work, names, sizes, current%point, law%reported)
      found = law_t(x(s(1)), x(s(1) + 1), x(s(1) + 3), x(s(1) + 4))
      good = all(abs(x(s(1):s(1) + 4)) <= huge(p))
      if (good .and. lend == 1 .and. .not. increment > 0) good = found%increment >= 0
      swells = any(abs(x(s(2):s(2) + 4)) > 0)
      if (nstatv > 0) point%history_trial(size(point%history_trial) - nstatv + 1:) = x(s(3):s(3) + nstatv - 1)
    end associate
    if (swells .and. .not. law%reported(outputs + 1)) then
      law%reported(outputs + 1) = .true.
      call add_message(-1_i4, 'CREEP gives DESWA, which has no effect without *SWELLING')
    end if
    if (.not. good) then
      write (text, '(a,es10.3,a,es10.3)') 'CREEP gives DECRA(1) = ', found%increment, ' at QTILD = ', mises
      call add_message(-3_i4, trim(text)//'; expected 0 or more, and numbers in DECRA')
      call escape()
    end if
    current%routine = routine
  end subroutine call_creep
end module host_user_creep
