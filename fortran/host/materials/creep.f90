! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Creep of metals by a power law of the Mises stress q (Abaqus Analysis User's Guide, Rate-dependent plasticity: creep and
!> swelling), small strains, q of the end of the increment in all of it.
!>
!> Time hardening: rate A q^n t^m of the equivalent creep strain e, t the total time. Strain hardening: rate
!> (A q^n ((m + 1) e)^m)^(1/(m + 1)). Both are integrated over the increment in closed form, so that a rate that is infinite at its
!> start (m < 0) does no harm. The direction of flow is that of the trial stress, as in host_mises.
!>
!> History of a point: creep strain 11, 22, 33, 12, 13, 23 (engineering shear), equivalent creep strain, its increment with q of the
!> end less that with q of the start, q.
module host_creep
  use core_root, only: advance, root_search, search_between, searching
  use host_kinds, only: dp
  implicit none (type, external)
  private
  public :: creep_t, creep_solid, creep_values, crept_t, relax, trial_of, trial_t

  integer, parameter :: creep_values = 9    !< of the history

  type :: creep_t
    logical :: by_time = .false.   !< time hardening
    real(dp) :: factor = 0, stress_power = 0, time_power = 0   !< A, n, m
  end type creep_t

  !> A point without any creep in the increment.
  type :: trial_t
    real(dp) :: shear = 0, bulk = 0
    real(dp) :: deviator(6) = 0, mean = 0    !< of the stress; of the elastic strain
    real(dp) :: mises = 0
  end type trial_t

  !> Creep of the increment: equivalent strain, its derivatives by the Mises stress and the pressure of trial_t, and how
  !> far it is from that of the stress of the start.
  type :: crept_t
    real(dp) :: increment = 0, by_stress = 0, by_pressure = 0, change = 0
  end type crept_t

contains

  !> Plane strain (n = 4) and three dimensions (n = 6). If the return does not converge, the stress is the trial stress.
  pure subroutine creep_solid(law, young, poisson, times, n, old, strain, stress, tangent, new, solved)
    type(creep_t), intent(in) :: law
    real(dp), intent(in) :: young, poisson
    real(dp), intent(in) :: times(2)           !< start and end of the increment; the same: no creep
    integer, intent(in) :: n
    real(dp), intent(in) :: old(:), strain(n)
    real(dp), intent(out) :: stress(n), tangent(n, n), new(:)
    logical, intent(out) :: solved
    type(trial_t) :: trial
    type(crept_t) :: crept
    type(root_search) :: search
    real(dp) :: stiffness, grown, slope, at_start, unused
    trial = trial_of(young, poisson, n, old, strain)
    stiffness = 3*trial%shear
    solved = .true.
    if (trial%mises > 0 .and. times(2) > times(1)) then
      search = search_between(0.0_dp, trial%mises/stiffness, 0.0_dp, geometric=.false.)
      do while (searching(search))
        call creep(law, times, old(7), trial%mises - stiffness*search%x, grown, slope)
        call advance(search, search%x - grown, 1 + stiffness*slope)
      end do
      solved = search%found
      if (solved) then
        call creep(law, times, old(7), trial%mises - stiffness*search%x, grown, slope)
        call creep(law, times, old(7), old(9), at_start, unused)
        crept = crept_t(search%x, slope/(1 + stiffness*slope), 0.0_dp, abs(grown - at_start))
      end if
    end if
    call relax(trial, crept, n, old, stress, tangent, new)
  end subroutine creep_solid

  !> A point without any creep in the increment.
  pure function trial_of(young, poisson, n, old, strain) result(trial)
    real(dp), intent(in) :: young, poisson
    integer, intent(in) :: n
    real(dp), intent(in) :: old(:), strain(n)
    type(trial_t) :: trial
    real(dp) :: elastic(n)
    trial%shear = young/(2*(1 + poisson))
    trial%bulk = young/(3*(1 - 2*poisson))
    elastic = strain - old(1:n)
    trial%mean = sum(elastic(1:3))/3
    trial%deviator(1:3) = 2*trial%shear*(elastic(1:3) - trial%mean)
    trial%deviator(4:n) = trial%shear*elastic(4:n)
    trial%mises = sqrt(1.5_dp*(sum(trial%deviator(1:3)**2) + 2*sum(trial%deviator(4:n)**2)))
  end function trial_of

  !> Stress, tangent and history after the creep of an increment.
  pure subroutine relax(trial, crept, n, old, stress, tangent, new)
    type(trial_t), intent(in) :: trial
    type(crept_t), intent(in) :: crept
    integer, intent(in) :: n
    real(dp), intent(in) :: old(:)
    real(dp), intent(out) :: stress(n), tangent(n, n), new(:)
    real(dp) :: theta, by_q, by_volume
    integer :: i, j
    theta = 1
    by_q = 0
    by_volume = 0
    new = old
    new(8) = crept%change
    associate (s => trial%deviator, q => trial%mises, x => crept%increment, stiffness => 3*trial%shear)
      if (q > 0) then
        theta = 1 - stiffness*x/q
        by_q = (crept%by_stress - x/q)*(stiffness/q)**2
        by_volume = stiffness*crept%by_pressure*trial%bulk/q
        new(1:3) = old(1:3) + 1.5_dp*x*s(1:3)/q
        new(4:n) = old(4:n) + 3*x*s(4:n)/q
        new(7) = old(7) + x
      end if
      new(9) = theta*q
      do j = 1, n
        do i = 1, n
          tangent(i, j) = -by_q*s(i)*s(j)
          if (i == j) tangent(i, j) = tangent(i, j) + merge(2*trial%shear*theta, trial%shear*theta, i <= 3)
          if (i <= 3 .and. j <= 3) tangent(i, j) = tangent(i, j) + trial%bulk - 2*trial%shear*theta/3
          if (j <= 3) tangent(i, j) = tangent(i, j) + by_volume*s(i)
        end do
      end do
      stress = theta*s(:n)
      stress(1:3) = stress(1:3) + 3*trial%bulk*trial%mean
    end associate
  end subroutine relax

  !> Increment of the equivalent creep strain at a constant Mises stress, and its derivative by it.
  pure subroutine creep(law, times, start, q, grown, slope)
    type(creep_t), intent(in) :: law
    real(dp), intent(in) :: times(2), start, q
    real(dp), intent(out) :: grown, slope
    real(dp) :: power, root, rate
    grown = 0
    slope = 0
    if (q <= 0) return
    power = law%time_power + 1
    if (law%by_time .or. abs(law%time_power) <= 0) then
      grown = law%factor*q**law%stress_power*(times(2)**power - times(1)**power)/power
      slope = law%stress_power*grown/q
    else
      ! e^(1/(m + 1)) grows linearly
      root = start**(1/power)
      rate = (law%factor*q**law%stress_power/power)**(1/power)*(times(2) - times(1))
      grown = (root + rate)**power - start
      slope = power*(root + rate)**law%time_power*rate*law%stress_power/(power*q)
    end if
  end subroutine creep
end module host_creep
