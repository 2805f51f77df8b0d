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
  public :: creep_t, creep_solid, creep_values

  integer, parameter :: creep_values = 9    !< of the history

  type :: creep_t
    logical :: by_time = .false.   !< time hardening
    real(dp) :: factor = 0, stress_power = 0, time_power = 0   !< A, n, m
  end type creep_t

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
    real(dp) :: shear, bulk, mean, q, x, theta, by_q, grown, slope, at_start, elastic(n)
    type(root_search) :: search
    integer :: i, j
    shear = young/(2*(1 + poisson))
    bulk = young/(3*(1 - 2*poisson))
    new = old
    elastic = strain - old(1:n)
    mean = sum(elastic(1:3))/3
    stress(1:3) = 2*shear*(elastic(1:3) - mean)
    stress(4:n) = shear*elastic(4:n)
    q = sqrt(1.5_dp*(sum(stress(1:3)**2) + 2*sum(stress(4:n)**2)))
    theta = 1
    by_q = 0
    new(8) = 0
    solved = .true.
    if (q > 0 .and. times(2) > times(1)) then
      search = search_between(0.0_dp, q/(3*shear), 0.0_dp, geometric=.false.)
      do while (searching(search))
        call creep(law, times, old(7), q - 3*shear*search%x, grown, slope)
        call advance(search, search%x - grown, 1 + 3*shear*slope)
      end do
      solved = search%found
      if (solved) then
        x = search%x
        theta = 1 - 3*shear*x/q
        call creep(law, times, old(7), theta*q, grown, slope)
        call creep(law, times, old(7), old(9), at_start, by_q)
        by_q = (slope/(1 + 3*shear*slope) - x/q)*(3*shear/q)**2
        new(1:3) = old(1:3) + 1.5_dp*x*stress(1:3)/q
        new(4:n) = old(4:n) + 3*x*stress(4:n)/q
        new(7) = old(7) + x
        new(8) = abs(grown - at_start)
      end if
    end if
    new(9) = theta*q
    do j = 1, n
      do i = 1, n
        tangent(i, j) = -by_q*stress(i)*stress(j)
        if (i == j) tangent(i, j) = tangent(i, j) + merge(2*shear*theta, shear*theta, i <= 3)
        if (i <= 3 .and. j <= 3) tangent(i, j) = tangent(i, j) + bulk - 2*shear*theta/3
      end do
    end do
    stress = theta*stress
    stress(1:3) = stress(1:3) + 3*bulk*mean
  end subroutine creep_solid

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
