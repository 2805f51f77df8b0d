! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Mises plasticity whose yield stress UHARD gives (User Subroutines Guide, UHARD), which may depend on the rate: backward Euler.
!> Tables and the return with a known increment: host_mises.
module host_uhard
  use, intrinsic :: iso_c_binding, only: c_f_procpointer, c_funptr
  use core_limit, only: exceeds
  use core_root, only: advance, root_search, search_between, searching
  use host_context, only: current
  use host_guarded, only: guarded_t, lay_out_guarded, warn_of_writes
  use host_kinds, only: dp, i4
  use host_messages, only: add_message
  use host_mises, only: returned_solid, trial_mises
  use host_point, only: point_t
  use host_protect, only: escape
  implicit none (type, external)
  private
  public :: user_hardening_t, user_solid, outputs

  !> Arrays that UHARD writes to.
  integer, parameter :: outputs = 3
  character(len=6), parameter :: names(outputs) = [character(len=6) :: 'SYIELD', 'HARD', 'STATEV']
  character(len=7), parameter :: sizes(outputs) = [character(len=7) :: '1', '3', '*DEPVAR']
  type(guarded_t), save, target :: work   ! each thread has its own
  !$omp threadprivate(work)

  type :: user_hardening_t
    type(c_funptr) :: uhard
    character(len=80) :: name = ' '             !< of the material
    real(dp), allocatable :: constants(:)       !< PROPS
    integer :: statev = 0                       !< number of STATEV, the last values of the history
    logical, pointer :: reported(:) => null()   !< (outputs) a write outside the array is
  end type user_hardening_t

  abstract interface
    subroutine uhard_procedure(syield, hard, eqplas, eqplasrt, time, dtime, temp, dtemp, noel, npt, layer, kspt, kstep, kinc, &
                               cmname, nstatv, statev, numfieldv, predef, dpred, numprops, props)
      import :: dp, i4
      real(dp) :: syield, hard(*), eqplas, eqplasrt, time(*), dtime, temp, dtemp, statev(*), predef(*), dpred(*), props(*)
      integer(i4) :: noel, npt, layer, kspt, kstep, kinc, nstatv, numfieldv, numprops
      character(len=80) :: cmname
    end subroutine uhard_procedure
  end interface

contains

  !> Plane strain (n = 4) and three dimensions (n = 6); STATEV that the last call has left go to the trial history of the point.
  subroutine user_solid(law, young, poisson, point, statev, n, old, strain, stress, tangent, new, solved)
    type(user_hardening_t), intent(in) :: law
    real(dp), intent(in) :: young, poisson, statev(:), old(7)   !< statev: at the start of the increment
    type(point_t), intent(inout) :: point
    integer, intent(in) :: n
    real(dp), intent(in) :: strain(n)
    real(dp), intent(out) :: stress(n), tangent(n, n), new(7)
    logical, intent(out) :: solved
    type(root_search) :: search
    real(dp) :: q, stiffness, flow, slope, softening, multiplier
    stiffness = 3*young/(2*(1 + poisson))
    q = trial_mises(young, poisson, n, old, strain)
    multiplier = 0
    slope = 0
    point%heat%stress_by_temperature = 0
    solved = .true.
    call call_uhard(law, point, statev, old(7), 0.0_dp, flow, slope, softening)
    ! nothing flows in no time, as in the calls for initial accelerations, though a yield stress by the rate may be less than q
    if (exceeds(q, flow) .and. current%dtime > 0) then
      search = search_between(0.0_dp, q/stiffness, min((q - flow)/max(stiffness + slope, stiffness), q/stiffness), &
                              geometric=.false.)
      do while (searching(search))
        call call_uhard(law, point, statev, old(7), search%x, flow, slope, softening)
        call advance(search, stiffness*search%x + flow - q, stiffness + slope)
      end do
      multiplier = search%x
      solved = search%found
    end if
    call returned_solid(young, poisson, n, old, strain, multiplier, slope, stress, tangent, new)
    if (multiplier > 0) then
      ! the yield surface shrinks with the temperature, and the plastic strain grows
      associate (by_temperature => point%heat%stress_by_temperature)
        by_temperature(:n) = stress/(q - stiffness*multiplier)*softening*stiffness/(stiffness + slope)
        by_temperature(:3) = by_temperature(:3) - sum(by_temperature(:3))/3
      end associate
    end if
  end subroutine user_solid

  !> Yield stress after an increment of the equivalent plastic strain, and its derivatives by it and by the temperature. Leaves the
  !> pass if the yield stress is no positive number.
  subroutine call_uhard(law, point, start, plastic, increment, flow, slope, softening)
    type(user_hardening_t), intent(in) :: law
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: start(:), plastic, increment
    real(dp), intent(out) :: flow, slope, softening
    procedure(uhard_procedure), pointer :: uhard
    real(dp) :: eqplas, eqplasrt, time(2), dtime, temp, dtemp, constants(size(law%constants))
    real(dp), allocatable :: predef(:), dpred(:)
    integer(i4) :: noel, npt, layer, kspt, kstep, kinc, nstatv, numfieldv, numprops
    character(len=80) :: cmname
    character(len=len(current%routine)) :: routine
    character(len=120) :: text
    call c_f_procpointer(law%uhard, uhard)
    nstatv = int(law%statev, i4)
    call lay_out_guarded(work, [1, 3, law%statev])
    time = current%time
    dtime = current%dtime
    eqplas = plastic + increment
    eqplasrt = 0
    if (increment > 0) eqplasrt = increment/dtime
    temp = 0
    dtemp = 0
    if (associated(point%fields)) then
      temp = point%fields(1, 1)
      dtemp = point%fields(1, 2)
      predef = point%fields(2:, 1)
      dpred = point%fields(2:, 2)
    else
      allocate (predef(0), dpred(0))
    end if
    numfieldv = size(predef, kind=i4)
    constants = law%constants
    numprops = size(constants, kind=i4)
    noel = current%element
    npt = point%number
    layer = 1
    kspt = 1
    kstep = current%step
    kinc = current%increment
    cmname = law%name
    routine = current%routine
    current%routine = 'UHARD'
    current%point = point%number
    associate (x => work%memory, s => work%start)
      x(s(1)) = 0
      x(s(2):s(2) + 2) = 0
      x(s(3):s(3) + nstatv - 1) = start
      call uhard(x(s(1)), x(s(2)), eqplas, eqplasrt, time, dtime, temp, dtemp, noel, npt, layer, kspt, kstep, kinc, cmname, &
                 nstatv, x(s(3)), numfieldv, predef, dpred, numprops, constants)
      call warn_of_writes(work, names, sizes, point%number, law%reported)
      flow = x(s(1))
      slope = x(s(2))
      if (dtime > 0) slope = slope + x(s(2) + 1)/dtime
      softening = x(s(2) + 2)
      if (nstatv > 0) point%history_trial(size(point%history_trial) - nstatv + 1:) = x(s(3):s(3) + nstatv - 1)
    end associate
    if (.not. (flow > 0 .and. flow <= huge(flow) .and. max(abs(slope), abs(softening)) <= huge(slope))) then
      write (text, '(a,es10.3,a,es10.3)') 'UHARD gives SYIELD = ', flow, ' at EQPLAS = ', plastic + increment
      call add_message(-3_i4, trim(text)//'; expected a positive number, and numbers in HARD')
      call escape()
    end if
    current%routine = routine
  end subroutine call_uhard
end module host_uhard
