! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Exponential softening; components in the order (tau, n).
!>
!> With the measures f and e of `cohesive_mode_mix`, softening starts at tau f = 1, lambda = flexibility/f, and follows
!> tau = exp(-x)/f, x = 2 e (f lambda - flexibility)/(f**2 - e flexibility): the decay at which the area under the curve,
!> with the triangle before the onset, is 1/(2 e).
!>
!> For infinite stiffness it is the law of Wells and Sluys, Int. J. for Numerical Methods in Engineering 50 (2001) 2667-2682,
!> t = strength exp(-strength w/G_c). The damage tends to 1 but never reaches it.
module cohesive_exponential
  use core_kinds, only: dp
  use core_root, only: root_search, search_between, searching, advance
  use cohesive_parameters, only: law_parameters
  use cohesive_mode_mix, only: measure_onset, measure_energy, least_reserve
  implicit none(type, external)
  private
  public :: exponential_softening, exponential_steepest, exponential_loss

  !> Bound of -x before the onset, where the curve only has to lie above the elastic line.
  real(dp), parameter :: largest_rise = 100.0_dp

contains

  !> Softening curve in a direction with the measures f and e, and its derivatives.
  pure subroutine exponential_softening(law, separation, f, e, traction, by_separation, by_f, by_e)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: separation       !< lambda, length
    real(dp), intent(in) :: f, e             !< 1/stress, area/energy
    real(dp), intent(out) :: traction        !< tau, stress
    real(dp), intent(out) :: by_separation   !< stress/length
    real(dp), intent(out) :: by_f, by_e
    real(dp) :: below, beyond, x

    below = f**2 - e*law%flexibility
    beyond = f*separation - law%flexibility
    x = 2.0_dp*e*beyond/below
    traction = exp(-max(x, -largest_rise))/f
    by_separation = -traction*2.0_dp*e*f/below
    by_f = -traction*(1.0_dp/f + 2.0_dp*(e*separation - x*f)/below)
    by_e = -traction*(2.0_dp*beyond + x*law%flexibility)/below
  end subroutine exponential_softening

  !> Largest softening slope, 2/(f**2/e - flexibility) at the onset in the steepest direction.
  pure function exponential_steepest(law) result(slope)
    type(law_parameters), intent(in) :: law
    real(dp) :: slope   !< stress/length
    real(dp) :: reserve, share

    call least_reserve(law, reserve, share)
    slope = 2.0_dp/(reserve - law%flexibility)
  end function exponential_steepest

  !> Area of `loss` in a direction where 1/K - flexibility = lost/stiff: 1/(2 e) at failure.
  !>
  !> With h = (f**2/e - flexibility)/2, lambda = (flexibility + h x)/f, and x follows from (flexibility + h x) exp(x) = 1/K.
  pure function exponential_loss(law, direction, stiff, lost) result(loss)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: direction(2)     !< c, not negative, of unit length
    real(dp), intent(in) :: stiff, lost      !< not negative, not both zero
    real(dp) :: loss                         !< stress times length
    type(root_search) :: search
    real(dp) :: f, e, h, more, upper, length, remainder, slope(2)

    call measure_onset(law, direction, f, slope)
    call measure_energy(law, direction, e, slope)
    loss = 0.5_dp/e
    h = 0.5_dp*(f**2/e - law%flexibility)
    ! a secant that has all but vanished, which 1/K could not hold
    if (.not. stiff > tiny(1.0_dp)*(lost/h + 1.0_dp)) return
    more = lost/stiff
    loss = 0.0_dp
    if (.not. more > 0.0_dp) return
    ! exp(x) >= 1, and flexibility + h x >= flexibility + h for x >= 1
    upper = min(more/h, max(1.0_dp, log((law%flexibility + more)/(law%flexibility + h))))
    search = search_between(0.0_dp, upper, upper, geometric=.false.)
    do while (searching(search))
      length = law%flexibility + h*search%x
      remainder = (law%flexibility + more)*exp(-search%x)
      call advance(search, length - remainder, h + remainder)
    end do
    remainder = exp(-search%x)
    loss = 0.5_dp*((law%flexibility + h)*(1.0_dp - remainder) + h*(1.0_dp - remainder - search%x*remainder))/f**2
  end function exponential_loss

end module cohesive_exponential
