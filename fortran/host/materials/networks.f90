! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Viscoelastic networks in parallel (Abaqus Analysis User's Guide, Parallel rheological framework).
!>
!> Each network has the strain energy of *HYPERELASTIC times its ratio, of the elastic part of F = Fe Fcr; Fcr preserves the volume,
!> so that all share the change of volume J. With s the deviator of the Kirchhoff stress of a network, q = sqrt(3/2 s : s) and c the
!> equivalent creep strain, Fcr flows by D = 3/2 dc/dt s/q. Backward Euler with the exponential map (J.C. Simo, Computer Methods in
!> Applied Mechanics and Engineering 99 (1992) 61): in the directions of the trial state, whose logarithmic elastic stretches are
!> t, those of the end are e with
!>
!>     e + 3/2 f s(e) = t,    f q - dc(c, q, ...) = 0
!>
!> f is sought by core_root, e for each f by Newton's method. Creep laws are given by the increment dc, those of the host
!> integrated in closed form at the q of the end, so that rates that are infinite at c = 0 do no harm.
!>
!> History of a point: creep time, I1 - 3 and I2 - 3 of F without its change of volume, J - 1, largest change of a creep rate in the
!> increment times its length; then of each network: inverse of Ccr = transpose(Fcr) Fcr less 1 (11, 22, 33, 12, 13, 23; axes of
!> the material at the start of the job), c, q, tr Ccr - 3, Kirchhoff pressure. All zero at the start.
module host_networks
  use core_root, only: advance, root_search, search_between, searching
  use core_small_matrix, only: determinant, invert, invert_general
  use core_symmetric, only: lower_factor
  use host_hyperelastic, only: add_principal, energy_at, hyperelastic_t, outer, principal, shape_energy, symmetric_dyad, &
                               volume_energy
  use host_kinds, only: dp, i4
  use host_messages, only: add_message
  use host_network_routines, only: call_network_routine, network_routine_t
  use host_point, only: point_t
  use host_protect, only: escape
  implicit none (type, external)
  private
  public :: network_t, networks_t, calls_routine, network_stress, common_values, network_values, power_law, hyperbolic, &
            bergstrom_boyce, by_user

  integer, parameter :: common_values = 5, network_values = 10   !< of the history

  !> Creep laws, in the order of CreepLaw in harness/uel/model/properties.py.
  integer, parameter :: power_law = 1, hyperbolic = 2, bergstrom_boyce = 3, by_user = 4

  type :: network_t
    real(dp) :: ratio = 0
    integer :: law = power_law
    real(dp) :: constants(5) = 0      !< q0, n, m, a, rate; A, B, n; A, m, C, E
    type(network_routine_t), allocatable :: user    !< UCREEPNETWORK
    type(network_routine_t), allocatable :: shift   !< UTRSNETWORK
  end type network_t

  type :: networks_t
    type(network_t), allocatable :: items(:)
    real(dp) :: equilibrium = 0       !< ratio of the network that does not creep
    integer :: statev = 0             !< number of STATEV
  end type networks_t

  !> What a creep law depends on: of the start of the increment or of its end.
  type :: arguments_t
    real(dp) :: creep, q, i1_creep, i1, i2, j, pressure
  end type arguments_t

  !> Constants of an increment at a point.
  type :: increment_t
    real(dp) :: creep_time            !< at its end
    real(dp) :: length                !< its reduced time
    type(arguments_t) :: start
  end type increment_t

  !> Places of the output of UCREEPNETWORK: the increment and its derivatives.
  integer, parameter :: increment = 1, by_creep = 2, by_q = 3, by_i1_creep = 4, by_i1 = 5, by_i2 = 6, by_j = 7, by_pressure = 8

  !> State of a network in the directions of its trial state.
  type :: state_t
    real(dp) :: e(3), s(3), ss(3, 3)  !< logarithmic elastic stretches, s, derivatives of s by e
    real(dp) :: inverse(3, 3)         !< of compliant
    real(dp) :: q, by_e(3)            !< and its derivatives by e
    real(dp) :: i1_creep, by_stretch(3)   !< and its derivatives by e
  end type state_t

  integer, parameter :: most_passes = 100
  real(dp), parameter :: close = 1e-9_dp        !< step of a quadratic iteration whose next one would be rounding
  real(dp), parameter :: longest = 0.5_dp       !< step in logarithmic stretches
  real(dp), parameter :: largest = 300          !< exponent whose exponential has a square
  real(dp), parameter :: equal = 1e-5_dp        !< as in host_hyperelastic
  real(dp), parameter :: identity(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])

contains

  !> Whether a network calls a user routine.
  pure logical function calls_routine(networks)
    type(networks_t), intent(in) :: networks
    integer :: k
    calls_routine = any([(allocated(networks%items(k)%user) .or. allocated(networks%items(k)%shift), &
                          k=1, size(networks%items))])
  end function calls_routine

  !> Cauchy stress, tangent as that of hyperelastic_stress, strain energy of the point and what it dissipates in the increment.
  subroutine network_stress(networks, law, n, point, elapsed, old, statev, stress, tangent, new, good)
    type(networks_t), intent(in) :: networks
    type(hyperelastic_t), intent(in) :: law
    integer, intent(in) :: n                      !< 4 or 6
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: elapsed               !< time in which networks creep; 0: none does
    real(dp), intent(in) :: old(:)
    real(dp), intent(inout) :: statev(:)
    real(dp), intent(out) :: stress(n), tangent(n, n), new(:)
    logical, intent(out) :: good
    real(dp) :: j, bar(3, 3), b(3, 3), u(0:2), e(3), directions(3, 3), w, h(3), hh(3, 3), s(3), ss(3, 3), by_pressures(6)
    type(arguments_t) :: now
    type(increment_t) :: step
    integer :: k, first
    stress = 0
    tangent = 0
    point%energy = 0
    point%dissipated = 0
    new = old
    j = determinant(point%deformation(:, :, 2))
    good = j > 0
    if (.not. good) return
    bar = point%deformation(:, :, 2)/j**(1.0_dp/3)
    b = matmul(bar, transpose(bar))
    if (point%hybrid) then
      ! the tangent at the given mean stress
      u = [energy_at(law, point%mean_stress), point%mean_stress, 0.0_dp]
    else
      u = volume_energy(law, j)
    end if
    stress(:3) = u(1)
    tangent(:3, :3) = u(1) + j*u(2)
    point%energy = u(0)/j
    call principal(law, point%deformation(:, :, 2), e, directions, w, good)
    if (.not. good) return
    call shape_energy(law, e - sum(e)/3, w, h, hh)
    call deviators(networks%equilibrium, h, hh, s, ss)
    call add_principal(n, j, e, directions, s, ss, stress, tangent)
    point%energy = point%energy + networks%equilibrium*w/j
    now%i1 = b(1, 1) + b(2, 2) + b(3, 3)
    now%i2 = (now%i1**2 - sum(b*b))/2
    now%j = j
    new(:5) = [old(1) + elapsed, now%i1 - 3, now%i2 - 3, j - 1, 0.0_dp]
    step%creep_time = new(1)
    do k = 1, size(networks%items)
      first = common_values + network_values*(k - 1) + 1
      associate (item => networks%items(k), before => old(first:first + network_values - 1), &
                 after => new(first:first + network_values - 1))
        step%start = arguments_t(before(7), before(8), before(9) + 3, old(2) + 3, old(3) + 3, old(4) + 1, before(10))
        step%length = 0
        if (elapsed > 0) step%length = reduced_time(item, point, step, elapsed, statev)
        now%pressure = -item%ratio*j*u(1)
        ! along the volume
        by_pressures = 0
        by_pressures(:3) = -item%ratio*(j*u(1) + j**2*u(2))
        call one_network(item, law, point, step, elapsed > 0, n, bar, b, now, by_pressures, before, statev, stress, tangent, &
                         after, new(5), good)
      end associate
      if (.not. good) return
    end do
  end subroutine network_stress

  !> Add what one network gives.
  subroutine one_network(item, law, point, step, flows, n, bar, b, now, by_pressures, old, statev, stress, tangent, new, change, &
                         good)
    type(network_t), intent(in) :: item
    type(hyperelastic_t), intent(in) :: law
    type(point_t), intent(inout) :: point
    type(increment_t), intent(in) :: step
    logical, intent(in) :: flows
    integer, intent(in) :: n
    real(dp), intent(in) :: bar(3, 3), b(3, 3)    !< b: of bar, F without its change of volume
    type(arguments_t), intent(inout) :: now
    real(dp), intent(in) :: by_pressures(6)       !< derivatives of the Kirchhoff pressure by the strains
    real(dp), intent(in) :: old(network_values)
    real(dp), intent(inout) :: statev(:), stress(:), tangent(:, :), change
    real(dp), intent(out) :: new(network_values)
    logical, intent(out) :: good
    type(state_t) :: state
    real(dp) :: inverse_creep(3, 3), lower(3, 3), t(3), directions(3, 3), j, flow, at_end(8), at_start(8), left(size(statev))
    real(dp) :: stretch(3, 3), back(3, 3), w, h(3), hh(3, 3)
    integer :: a
    inverse_creep = matmul(point%turn, matmul(full(old(:6)) + identity, transpose(point%turn)))
    lower = inverse_creep
    new = old
    call lower_factor(lower, good)
    if (.not. good) return
    call principal(law, matmul(point%deformation(:, :, 2), lower), t, directions, j, good)
    if (.not. good) return
    t = t - sum(t)/3
    stretch = matmul(directions, matmul(b, transpose(directions)))
    flow = 0
    at_end = 0
    if (flows) then
      left = statev
      call creep(item, point, step, 0_i4, step%start, left, at_start)
      call find_flow(item, law, point, step, t, [(stretch(a, a), a=1, 3)], now, statev, flow, state, at_end, good)
      if (.not. good) return
      change = max(change, abs(at_end(increment) - at_start(increment)))
    else
      call elastic_state(item%ratio, law, t, [(stretch(a, a), a=1, 3)], 0.0_dp, state, good)
      if (.not. good) return
    end if
    call add_network(n, now%j, b, stretch, t, directions, flow, state, at_end, by_pressures, now%i1, stress, tangent)
    call shape_energy(law, state%e, w, h, hh)
    point%energy = point%energy + item%ratio*w/now%j
    point%dissipated = point%dissipated + flow*state%q**2/now%j
    if (flow > 0) then
      call invert(3, bar, back, j)
      lower = 0
      do a = 1, 3
        lower = lower + exp(2*state%e(a))*outer(directions(a, :), directions(a, :))
      end do
      inverse_creep = matmul(back, matmul(lower, transpose(back)))
      new(:6) = packed(matmul(transpose(point%turn), matmul(inverse_creep, point%turn)) - identity)
    end if
    new(7:) = [old(7) + flow*state%q, state%q, state%i1_creep - 3, now%pressure]
  end subroutine one_network

  !> Length of the increment in the reduced time of a network: the logarithm of the shift changes linearly (Abaqus Theory Guide,
  !> Viscoelasticity). Leaves the pass if the shift is no positive number.
  real(dp) function reduced_time(item, point, step, elapsed, statev)
    type(network_t), intent(in) :: item
    type(point_t), intent(inout) :: point
    type(increment_t), intent(in) :: step
    real(dp), intent(in) :: elapsed
    real(dp), intent(inout) :: statev(:)
    real(dp) :: shift(2), ratio
    integer(i4) :: none(0)
    real(dp) :: nothing(0)
    character(len=120) :: text
    reduced_time = elapsed
    if (.not. allocated(item%shift)) return
    call call_network_routine(item%shift, point, none, [step%creep_time, elapsed], nothing, statev, shift)
    if (.not. (minval(shift) > 0 .and. maxval(shift) <= huge(shift))) then
      write (text, '(a,es10.3,a,es10.3)') 'UTRSNETWORK gives the shifts ', shift(1), ' and ', shift(2)
      call add_message(-3_i4, trim(text)//'; expected positive numbers')
      call escape()
    end if
    ratio = shift(1)/shift(2)
    reduced_time = elapsed/shift(1)
    if (abs(ratio - 1) > equal) then
      reduced_time = reduced_time*(ratio - 1)/log(ratio)
    else
      reduced_time = reduced_time*(1 + ratio)/2
    end if
  end function reduced_time

  !> The flow f, and the state with it.
  subroutine find_flow(item, law, point, step, t, stretch, now, statev, flow, state, output, good)
    type(network_t), intent(in) :: item
    type(hyperelastic_t), intent(in) :: law
    type(point_t), intent(inout) :: point
    type(increment_t), intent(in) :: step
    real(dp), intent(in) :: t(3), stretch(3)
    type(arguments_t), intent(inout) :: now
    real(dp), intent(inout) :: statev(:)          !< of the start, then of the end of the increment
    real(dp), intent(out) :: flow, output(8)
    type(state_t), intent(out) :: state
    logical, intent(out) :: good
    type(root_search) :: search
    real(dp) :: value, slope, upper, start(size(statev))
    integer :: pass
    start = statev
    flow = 0
    call residual(0.0_dp)
    ! without a stress there is no direction
    if (.not. (good .and. state%q > 0 .and. output(increment) > 0)) then
      output = 0
      return
    end if
    upper = output(increment)/state%q
    do pass = 1, most_passes
      call residual(upper)
      if (.not. good) return
      if (value >= 0) exit
      upper = 4*upper
    end do
    search = search_between(upper*1e-100_dp, upper, upper, geometric=.true.)
    do while (searching(search))
      call residual(search%x)
      if (.not. good) return
      call advance(search, value, slope)
    end do
    flow = search%x
    good = search%found
  contains
    !> f q - dc at f = x, and its derivative.
    subroutine residual(x)
      real(dp), intent(in) :: x
      real(dp) :: e(3), by_flow
      call elastic_state(item%ratio, law, t, stretch, x, state, good)
      if (.not. good) return
      now%creep = step%start%creep + x*state%q
      now%q = state%q
      now%i1_creep = state%i1_creep
      statev = start
      call creep(item, point, step, 1_i4, now, statev, output)
      e = -1.5_dp*matmul(state%inverse, state%s)
      by_flow = dot_product(state%by_e, e)
      value = x*state%q - output(increment)
      slope = (1 - output(by_creep))*(state%q + x*by_flow) - output(by_q)*by_flow &
              - output(by_i1_creep)*dot_product(state%by_stretch, e)
    end subroutine residual
  end subroutine find_flow

  !> Elastic stretches e at a flow f, and what depends on them.
  pure subroutine elastic_state(ratio, law, t, stretch, flow, state, good)
    real(dp), intent(in) :: ratio
    type(hyperelastic_t), intent(in) :: law
    real(dp), intent(in) :: t(3), stretch(3), flow   !< stretch: b along the directions
    type(state_t), intent(out) :: state
    logical, intent(out) :: good
    real(dp) :: w, h(3), hh(3, 3), step(3)
    logical :: last
    integer :: pass
    state%e = t
    last = .false.
    do pass = 1, most_passes
      call shape_energy(law, state%e, w, h, hh)
      call deviators(ratio, h, hh, state%s, state%ss)
      call invert_general(compliant(flow, state%ss), state%inverse, good)
      if (last .or. .not. good) exit
      step = matmul(state%inverse, t - state%e - 1.5_dp*flow*state%s)
      if (.not. any(abs(step) > 0)) exit
      state%e = state%e + step*min(1.0_dp, longest/maxval(abs(step)))
      last = maxval(abs(step)) <= close
    end do
    good = good .and. pass <= most_passes
    state%q = sqrt(1.5_dp*sum(state%s**2))
    state%by_e = 0
    if (state%q > 0) state%by_e = 1.5_dp*matmul(state%ss, state%s)/state%q
    state%by_stretch = -2*exp(-2*state%e)*stretch
    state%i1_creep = -sum(state%by_stretch)/2
  end subroutine elastic_state

  !> Add the stress of a network and its tangent to those of the others, times J: of the Jaumann rate, over J.
  pure subroutine add_network(n, j, b, stretch, t, directions, flow, state, output, by_pressures, i1, stress, tangent)
    integer, intent(in) :: n
    real(dp), intent(in) :: j, b(3, 3), stretch(3, 3), t(3), directions(3, 3)   !< stretch: b in the directions
    real(dp), intent(in) :: flow, output(8), by_pressures(6), i1
    type(state_t), intent(in) :: state
    real(dp), intent(inout) :: stress(:), tangent(:, :)
    real(dp) :: slope(3, 3), by_trial(3, 3), weight(3), along(3), gradient(6), direction(6), change(3, 3), own
    logical :: good
    integer :: a, c
    if (.not. flow*state%q > 0) then
      ! elastic, or relaxed up to rounding: then there is no direction of the flow
      slope = matmul(state%ss, state%inverse)
      call add_principal(n, j, t, directions, state%s, slope, stress, tangent)
      return
    end if
    own = (1 - output(by_creep))*state%q
    along = ((1 - output(by_creep))*flow - output(by_q))*state%by_e - output(by_i1_creep)*state%by_stretch
    call invert_general(compliant(flow, state%ss) - 1.5_dp*outer(state%s, along)/own, by_trial, good)
    slope = matmul(state%ss, by_trial)
    direction = 0
    do a = 1, 3
      direction = direction - 1.5_dp/own*dot_product(slope(a, :), state%s)*symmetric_dyad(directions(a, :), directions(a, :))
    end do
    slope = slope - spread(sum(slope, 2)/3, 2, 3)
    call add_principal(n, j, t, directions, state%s, slope, stress, tangent)
    ! how the increment of the creep strain depends on F besides t
    weight = exp(-2*state%e)
    do c = 1, 3
      do a = 1, 3
        if (abs(t(a) - t(c)) > equal) then
          change(a, c) = (weight(a) - weight(c))/tanh(t(a) - t(c))
        else
          change(a, c) = -weight(a)*(by_trial(a, a) + by_trial(c, c) - by_trial(a, c) - by_trial(c, a))
        end if
        if (a == c) change(a, c) = 0
        change(a, c) = stretch(a, c)*(weight(a) + weight(c) + change(a, c))
      end do
    end do
    gradient = output(by_i1_creep)*packed(matmul(transpose(directions), matmul(change, directions)) - 2*state%i1_creep/3*identity) &
               + 2*packed(deviator(output(by_i1)*b + output(by_i2)*(i1*b - matmul(b, b))) + 0.5_dp*output(by_j)*j*identity) &
               + output(by_pressure)*by_pressures
    tangent = tangent + outer(direction(:n), gradient(:n))/j
  end subroutine add_network

  !> Increment of the equivalent creep strain and its derivatives.
  subroutine creep(item, point, step, lend, of, statev, output)
    type(network_t), intent(in) :: item
    type(point_t), intent(inout) :: point
    type(increment_t), intent(in) :: step
    integer(i4), intent(in) :: lend               !< 1: at the end of the increment, 0: at its start
    type(arguments_t), intent(in) :: of
    real(dp), intent(inout) :: statev(:)
    real(dp), intent(out) :: output(8)
    real(dp) :: x, limit
    output = 0
    associate (c => item%constants)
      select case (item%law)
      case (by_user)
        call call_network_routine(item%user, point, [lend], [step%creep_time, step%length], &
                                  [of%creep, of%q, of%i1_creep, of%i1, of%i2, of%j, of%pressure], statev, output)
      case (hyperbolic)
        limit = largest/max(c(3), 1.0_dp)
        x = min(c(2)*of%q, limit)
        if (.not. x > 0) return
        output(increment) = c(1)*sinh(x)**c(3)*step%length
        output(by_q) = output(increment)*c(3)*c(2)/tanh(x)
      case (bergstrom_boyce)
        if (.not. of%q > 0) return
        x = sqrt(max(of%i1_creep, 3.0_dp)/3)
        output(increment) = c(1)*(x - 1 + c(4))**c(3)*of%q**c(2)*step%length
        output(by_q) = output(increment)*c(2)/of%q
        output(by_i1_creep) = output(increment)*c(3)/((x - 1 + c(4))*6*x)
      case default
        call creep_of_power(c, step, of, output)
      end select
    end associate
  end subroutine creep

  !> c^(1/(m + 1)) grows linearly at a constant q.
  pure subroutine creep_of_power(c, step, of, output)
    real(dp), intent(in) :: c(5)                  !< q0, n, m, a, rate
    type(increment_t), intent(in) :: step
    type(arguments_t), intent(in) :: of
    real(dp), intent(inout) :: output(8)
    real(dp) :: power, strength, grown, root
    if (.not. of%q > 0) return
    power = c(3) + 1
    strength = c(1) + c(4)*max(of%pressure, 0.0_dp)
    grown = c(5)*step%length*((of%q/strength)**c(2)/power)**(1/power)
    if (.not. grown > 0) return
    root = step%start%creep**(1/power)
    output(increment) = increase(root, grown, power)
    output(by_q) = (root + grown)**c(3)*grown*c(2)/of%q
    if (of%pressure > 0) output(by_pressure) = -(root + grown)**c(3)*grown*c(2)*c(4)/strength
  end subroutine creep_of_power

  !> (x + y)^p - x^p of positive numbers.
  pure real(dp) function increase(x, y, p)
    real(dp), intent(in) :: x, y, p
    real(dp) :: z
    if (x > 1e3_dp*y) then
      z = y/x
      increase = x**p*p*z*(1 + (p - 1)*z/2*(1 + (p - 2)*z/3*(1 + (p - 3)*z/4*(1 + (p - 4)*z/5))))
    else
      increase = (x + y)**p - x**p
    end if
  end function increase

  !> 1 + 3/2 f ss for changes whose sum is zero; others, which do not occur, get a stiffness too, lest it be singular for a large f.
  pure function compliant(flow, ss) result(matrix)
    real(dp), intent(in) :: flow, ss(3, 3)
    real(dp) :: matrix(3, 3)
    matrix = identity + 1.5_dp*flow*(ss + (ss(1, 1) + ss(2, 2) + ss(3, 3))/6)
  end function compliant

  !> Deviator of the principal Kirchhoff stresses of a network and its derivatives, from those of the energy.
  pure subroutine deviators(ratio, h, hh, s, ss)
    real(dp), intent(in) :: ratio, h(3), hh(3, 3)
    real(dp), intent(out) :: s(3), ss(3, 3)
    s = ratio*(h - sum(h)/3)
    ss = ratio*(hh - spread(sum(hh, 1), 1, 3)/3 - spread(sum(hh, 2), 2, 3)/3 + sum(hh)/9)
  end subroutine deviators

  pure function deviator(matrix) result(part)
    real(dp), intent(in) :: matrix(3, 3)
    real(dp) :: part(3, 3)
    part = matrix - (matrix(1, 1) + matrix(2, 2) + matrix(3, 3))/3*identity
  end function deviator

  !> A symmetric matrix from its components 11, 22, 33, 12, 13, 23.
  pure function full(components) result(matrix)
    real(dp), intent(in) :: components(6)
    real(dp) :: matrix(3, 3)
    matrix = reshape(components([1, 4, 5, 4, 2, 6, 5, 6, 3]), [3, 3])
  end function full

  !> And back.
  pure function packed(matrix) result(components)
    real(dp), intent(in) :: matrix(3, 3)
    real(dp) :: components(6)
    components = [matrix(1, 1), matrix(2, 2), matrix(3, 3), matrix(1, 2), matrix(1, 3), matrix(2, 3)]
  end function packed
end module host_networks
