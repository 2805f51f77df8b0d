! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The thermal side of a material: *CONDUCTIVITY, *SPECIFIC HEAT and *LATENT HEAT, or UMATHT in their place, and HETVAL (User
!> Subroutines Guide, UMATHT, HETVAL).
!>
!> Conductivity and specific heat are linear between the temperatures of their tables and constant beyond them; latent heat is
!> taken up evenly between solidus and liquidus. STATEV of both routines are those of UMAT: the last values of the history of the
!> point, as the routines before have left them. In elements with displacements UMAT comes first, at all points of the element.
module host_thermal
  use, intrinsic :: iso_c_binding, only: c_f_procpointer, c_funptr
  use host_context, only: current
  use host_guarded, only: guarded_t, lay_out_guarded, warn_of_no_numbers, warn_of_writes
  use host_kinds, only: dp, i4
  use host_point, only: point_t
  implicit none (type, external)
  private
  public :: thermal_t, user_thermal_t, flow_t, call_hetval, call_umatht, conductivity_at, energy_taken, heat_outputs, flow_outputs

  !> Arrays that HETVAL and UMATHT write to.
  integer, parameter :: heat_outputs = 2, flow_outputs = 5
  character(len=6), parameter :: heat_names(heat_outputs) = [character(len=6) :: 'FLUX', 'STATEV']
  character(len=13), parameter :: heat_sizes(heat_outputs) = [character(len=13) :: '2', '*DEPVAR']
  character(len=6), parameter :: flow_names(flow_outputs) = [character(len=6) :: 'DUDG', 'FLUX', 'DFDT', 'DFDG', 'STATEV']
  character(len=13), parameter :: flow_sizes(flow_outputs) = [character(len=13) :: &
    'NTGRD', 'NTGRD', 'NTGRD', 'NTGRD x NTGRD', '*DEPVAR']
  type(guarded_t), save, target :: heat_work, flow_work   ! each thread has its own
  !$omp threadprivate(heat_work, flow_work)

  !> HETVAL or UMATHT of a material.
  type :: user_thermal_t
    type(c_funptr) :: address
    character(len=80) :: material = ' '
    integer :: statev = 0                       !< number of STATEV, the last values of the history
    real(dp), allocatable :: constants(:)       !< PROPS of UMATHT
    logical, pointer :: reported(:) => null()   !< a write outside each array is
    logical, pointer :: spoilt(:) => null()     !< NaN in each array is
  end type user_thermal_t

  type :: thermal_t
    real(dp) :: density = 0
    real(dp), allocatable :: conductivity(:, :)    !< (2, k) conductivity, temperature
    real(dp), allocatable :: specific_heat(:, :)   !< (2, k) specific heat, temperature; k = 0: none
    real(dp), allocatable :: latent_heat(:, :)     !< (3, k) heat per mass, solidus, liquidus
    type(user_thermal_t), allocatable :: source    !< HETVAL
    type(user_thermal_t), allocatable :: flow      !< UMATHT, in place of the tables
  end type thermal_t

  !> What UMATHT gives; on entry energy and flux are those of the start of the increment.
  type :: flow_t
    real(dp) :: energy = 0, energy_by_temperature = 0, energy_by_gradient(3) = 0
    real(dp) :: flux(3) = 0, flux_by_temperature(3) = 0, flux_by_gradient(3, 3) = 0
  end type flow_t

  abstract interface
    subroutine hetval_procedure(cmname, temp, time, dtime, statev, flux, predef, dpred)
      import :: dp
      character(len=80) :: cmname
      real(dp) :: temp(*), time(*), dtime, statev(*), flux(*), predef(*), dpred(*)
    end subroutine hetval_procedure

    subroutine umatht_procedure(u, dudt, dudg, flux, dfdt, dfdg, statev, temp, dtemp, dtemdx, time, dtime, predef, dpred, cmname, &
                                ntgrd, nstatv, props, nprops, coords, pnewdt, noel, npt, layer, kspt, kstep, kinc)
      import :: dp, i4
      real(dp) :: u, dudt, dudg(*), flux(*), dfdt(*), dfdg(*), statev(*), temp, dtemp, dtemdx(*), time(*), dtime, predef(*), &
                  dpred(*), props(*), coords(*), pnewdt
      character(len=80) :: cmname
      integer(i4) :: ntgrd, nstatv, nprops, noel, npt, layer, kspt, kstep, kinc
    end subroutine umatht_procedure
  end interface

contains

  !> Conductivity and its derivative.
  pure subroutine conductivity_at(material, temperature, value, slope)
    type(thermal_t), intent(in) :: material
    real(dp), intent(in) :: temperature
    real(dp), intent(out) :: value, slope
    call interpolate(material%conductivity, temperature, value, slope)
  end subroutine conductivity_at

  !> Value of a table (value, temperature) and its slope, which is zero beyond the ends.
  pure subroutine interpolate(table, temperature, value, slope)
    real(dp), intent(in) :: table(:, :), temperature
    real(dp), intent(out) :: value, slope
    integer :: k, n
    n = size(table, 2)
    slope = 0
    value = table(1, 1)
    if (temperature < table(2, 1)) return
    value = table(1, n)
    do k = 1, n - 1
      if (temperature >= table(2, k + 1)) cycle
      slope = (table(1, k + 1) - table(1, k))/(table(2, k + 1) - table(2, k))
      value = table(1, k) + slope*(temperature - table(2, k))
      return
    end do
  end subroutine interpolate

  !> Heat per mass that warming from one temperature to another takes, and its derivative by the latter, as a whole or without
  !> that of the specific heat.
  !>
  !> The specific heat at the end of the increment holds for all of it, as in Abaqus: residuals and iterations of a public job
  !> (harness/uel/procedures/fidelity.md).
  pure subroutine energy_taken(material, from, to, whole, energy, slope)
    type(thermal_t), intent(in) :: material
    real(dp), intent(in) :: from, to
    logical, intent(in) :: whole
    real(dp), intent(out) :: energy, slope
    real(dp) :: change
    integer :: k
    call interpolate(material%specific_heat, to, slope, change)
    energy = slope*(to - from)
    if (whole) slope = slope + change*(to - from)
    do k = 1, size(material%latent_heat, 2)
      associate (heat => material%latent_heat(1, k), solidus => material%latent_heat(2, k), liquidus => material%latent_heat(3, k))
        energy = energy + heat*(molten(to, solidus, liquidus) - molten(from, solidus, liquidus))
        if (to >= solidus .and. to < liquidus) slope = slope + heat/(liquidus - solidus)
      end associate
    end do
  end subroutine energy_taken

  !> Fraction that is liquid.
  pure real(dp) function molten(temperature, solidus, liquidus)
    real(dp), intent(in) :: temperature, solidus, liquidus
    molten = min(max((temperature - solidus)/(liquidus - solidus), 0.0_dp), 1.0_dp)
  end function molten

  !> Add the heat that HETVAL generates to that of the point. Its TIME is that at the end of the increment; TEMP and PREDEF are
  !> values at the end, and increments.
  subroutine call_hetval(user, point)
    type(user_thermal_t), intent(in) :: user
    type(point_t), intent(inout) :: point
    procedure(hetval_procedure), pointer :: hetval
    real(dp) :: temp(2), time(2), dtime
    real(dp) :: predef(max(size(point%fields, 1) - 1, 1)), dpred(max(size(point%fields, 1) - 1, 1))
    character(len=80) :: cmname
    character(len=len(current%routine)) :: routine
    call c_f_procpointer(user%address, hetval)
    call lay_out_guarded(heat_work, [2, user%statev])
    temp = [sum(point%fields(1, :)), point%fields(1, 2)]
    time = current%time + current%dtime
    dtime = current%dtime
    call fields_of_point(point, .true., predef, dpred)
    cmname = user%material
    routine = current%routine
    current%routine = 'HETVAL'
    current%point = point%number
    associate (x => heat_work%memory, s => heat_work%start)
      x(s(1):s(1) + 1) = 0
      call take_statev(point, user%statev, x(s(2):s(2) + user%statev - 1))
      call hetval(cmname, temp, time, dtime, x(s(2)), x(s(1)), predef, dpred)
      call warn_of_writes(heat_work, heat_names, heat_sizes, point%number, user%reported)
      call warn_of_no_numbers(heat_work, heat_names, point%number, user%spoilt)
      point%heat%source = point%heat%source + x(s(1))
      point%heat%source_by_temperature = point%heat%source_by_temperature + x(s(1) + 1)
      call keep_statev(point, user%statev, x(s(2):s(2) + user%statev - 1))
    end associate
    current%routine = routine
  end subroutine call_hetval

  !> Energy and heat flux that UMATHT gives at a point. Its TIME is that at the end of the increment; TEMP and PREDEF
  !> are values at its start.
  subroutine call_umatht(user, point, gradient, flow)
    type(user_thermal_t), intent(in) :: user
    type(point_t), intent(in) :: point
    real(dp), intent(in) :: gradient(:)             !< of the temperature, at the end of the increment
    type(flow_t), intent(inout) :: flow
    procedure(umatht_procedure), pointer :: umatht
    real(dp) :: u, dudt, temp, dtemp, dtemdx(size(gradient)), time(2), dtime, constants(size(user%constants)), coords(3), pnewdt
    real(dp) :: predef(max(size(point%fields, 1) - 1, 1)), dpred(max(size(point%fields, 1) - 1, 1))
    character(len=80) :: cmname
    character(len=len(current%routine)) :: routine
    integer(i4) :: ntgrd, nstatv, nprops, noel, npt, layer, kspt, kstep, kinc
    integer :: n
    call c_f_procpointer(user%address, umatht)
    n = size(gradient)
    call lay_out_guarded(flow_work, [n, n, n, n**2, user%statev])
    u = flow%energy
    dudt = 0
    temp = point%fields(1, 1)
    dtemp = point%fields(1, 2)
    dtemdx = gradient
    time = current%time + current%dtime
    dtime = current%dtime
    call fields_of_point(point, .false., predef, dpred)
    cmname = user%material
    ntgrd = int(n, i4)
    nstatv = int(user%statev, i4)
    constants = user%constants
    nprops = size(constants, kind=i4)
    coords = point%place
    pnewdt = current%pnewdt
    noel = current%element
    npt = point%number
    layer = 1
    kspt = 1
    kstep = current%step
    kinc = current%increment
    routine = current%routine
    current%routine = 'UMATHT'
    current%point = point%number
    associate (x => flow_work%memory, s => flow_work%start)
      x(s(1):s(1) + n - 1) = 0
      x(s(2):s(2) + n - 1) = flow%flux(:n)
      x(s(3):s(3) + n - 1) = 0
      x(s(4):s(4) + n**2 - 1) = 0
      call take_statev(point, user%statev, x(s(5):s(5) + user%statev - 1))
      call umatht(u, dudt, x(s(1)), x(s(2)), x(s(3)), x(s(4)), x(s(5)), temp, dtemp, dtemdx, time, dtime, predef, dpred, cmname, &
                  ntgrd, nstatv, constants, nprops, coords, pnewdt, noel, npt, layer, kspt, kstep, kinc)
      call warn_of_writes(flow_work, flow_names, flow_sizes, point%number, user%reported)
      call warn_of_no_numbers(flow_work, flow_names, point%number, user%spoilt)
      flow%energy = u
      flow%energy_by_temperature = dudt
      flow%energy_by_gradient(:n) = x(s(1):s(1) + n - 1)
      flow%flux(:n) = x(s(2):s(2) + n - 1)
      flow%flux_by_temperature(:n) = x(s(3):s(3) + n - 1)
      flow%flux_by_gradient(:n, :n) = reshape(x(s(4):s(4) + n**2 - 1), [n, n])
      call keep_statev(point, user%statev, x(s(5):s(5) + user%statev - 1))
    end associate
    current%routine = routine
    current%pnewdt = min(current%pnewdt, pnewdt)
  end subroutine call_umatht

  !> PREDEF, at the end of the increment or at its start, and DPRED of the point; at least one entry, which may be zero.
  subroutine fields_of_point(point, at_end, predef, dpred)
    type(point_t), intent(in) :: point
    logical, intent(in) :: at_end
    real(dp), intent(out) :: predef(:), dpred(:)
    integer :: k, n
    predef = 0
    dpred = 0
    n = size(point%fields, 1) - 1
    do k = 1, n
      predef(k) = point%fields(k + 1, 1)
      dpred(k) = point%fields(k + 1, 2)
    end do
    if (at_end) predef = predef + dpred
  end subroutine fields_of_point

  !> STATEV of a point, as the last routine has left them.
  subroutine take_statev(point, n, statev)
    type(point_t), intent(in) :: point
    integer, intent(in) :: n
    real(dp), intent(out) :: statev(n)
    integer :: first
    if (n == 0) return
    first = size(point%history_trial) - n + 1
    statev = point%history_trial(first:)
  end subroutine take_statev

  !> Keep them for the next routine and for the end of the increment.
  subroutine keep_statev(point, n, statev)
    type(point_t), intent(in) :: point
    integer, intent(in) :: n
    real(dp), intent(in) :: statev(n)
    integer :: first
    if (n == 0) return
    first = size(point%history_trial) - n + 1
    point%history_trial(first:) = statev
  end subroutine keep_statev
end module host_thermal
