! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Onset of damage and fracture energy in mixed mode, for the laws that soften from a point of onset; (tau, n).
!>
!> In the direction c of the separation w = lambda c the traction is t_i = tau ratio_i c_i, so the share of component i in
!> the energy is B_i = ratio_i c_i**2/rho with rho = sum_i ratio_i c_i**2. A law needs two measures of the direction:
!>
!>   f = sqrt(sum_i (ratio_i c_i/strength_i)**2), the quadratic stress criterion: onset at tau f = 1, (10) of the paper
!>   e = rho/(2 G_c(B)): the area under the curve of tau over lambda must be 1/(2 e), and a straight line ends at lambda = f/e
!>
!> G_c follows Benzeggagh and Kenane, G_Ic + (G_IIc - G_Ic) B_tau**eta, or the power law
!> (B_n/G_Ic)**p + (B_tau/G_IIc)**p = 1/G_c**p, with p = 1 the linear criterion, (11). These and the onset are what Abaqus'
!> cohesive elements offer by *DAMAGE INITIATION, CRITERION=QUADS and *DAMAGE EVOLUTION, TYPE=ENERGY, MIXED MODE
!> BEHAVIOR=BK or POWER LAW, MODE MIX RATIO=ENERGY, where the energies are those of the present separation (Abaqus Analysis
!> User's Guide, Defining the constitutive response of cohesive elements using a traction-separation description).
module cohesive_mode_mix
  use core_kinds, only: dp
  use core_status, only: status_type, ok, too_brittle, too_brittle_mixed
  use cohesive_parameters, only: law_parameters
  implicit none(type, external)
  private
  public :: measure_onset, measure_energy, measure_share, direction_of_share, check_mode_mix, least_reserve, least_of_mixes

  abstract interface
    !> A quantity at a share of mode II in the energy.
    pure function mix_measure(law, share) result(value)
      import :: dp, law_parameters
      implicit none(type, external)
      type(law_parameters), intent(in) :: law
      real(dp), intent(in) :: share
      real(dp) :: value
    end function mix_measure
  end interface

contains

  !> f and its derivatives by c.
  pure subroutine measure_onset(law, direction, f, slope)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: direction(2)   !< c, not zero
    real(dp), intent(out) :: f             !< 1/stress
    real(dp), intent(out) :: slope(2)      !< by c, its components taken as independent

    slope = law%ratio*direction/law%strength
    f = sqrt(slope(1)**2 + slope(2)**2)
    slope = slope*(law%ratio/law%strength)/f
  end subroutine measure_onset

  !> e and its derivatives by c.
  pure subroutine measure_energy(law, direction, e, slope)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: direction(2)   !< c, not zero
    real(dp), intent(out) :: e             !< area/energy
    real(dp), intent(out) :: slope(2)      !< by c, its components taken as independent

    if (law%eta > 0.0_dp) then
      call benzeggagh_kenane(law, direction, e, slope)
    else if (is_linear(law)) then
      slope = law%ratio*direction/law%toughness
      e = 0.5_dp*(slope(1)*direction(1) + slope(2)*direction(2))
    else
      call power_law(law, direction, e, slope)
    end if
  end subroutine measure_energy

  !> True for the power law with the exponent 1.
  pure function is_linear(law) result(linear)
    type(law_parameters), intent(in) :: law
    logical :: linear

    linear = .not. law%eta > 0.0_dp .and. abs(law%power - 1.0_dp) <= 0.0_dp
  end function is_linear

  !> e = (sum_i (ratio_i c_i**2/(2 G_i))**p)**(1/p).
  pure subroutine power_law(law, direction, e, slope)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: direction(2)
    real(dp), intent(out) :: e, slope(2)
    real(dp) :: part(2), largest
    integer :: i

    slope = law%ratio*direction/law%toughness
    part = 0.5_dp*slope*direction
    largest = max(part(1), part(2))
    part = part/largest
    e = (part(1)**law%power + part(2)**law%power)**(1.0_dp/law%power)
    do i = 1, 2
      ! with p < 1 the power alone is infinite where its factor vanishes
      if (part(i) > 0.0_dp) slope(i) = slope(i)*(part(i)/e)**(law%power - 1.0_dp)
    end do
    e = e*largest
  end subroutine power_law

  !> e = rho/(2 (G_Ic + (G_IIc - G_Ic) B_tau**eta)).
  pure subroutine benzeggagh_kenane(law, direction, e, slope)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: direction(2)
    real(dp), intent(out) :: e, slope(2)
    real(dp) :: weighted(2), rho, share, rise, toughness, by_direction(2)

    weighted = law%ratio*direction
    rho = weighted(1)*direction(1) + weighted(2)*direction(2)
    share = weighted(1)*direction(1)/rho
    rise = law%toughness(1) - law%toughness(2)
    toughness = law%toughness(2) + rise*share**law%eta
    e = 0.5_dp*rho/toughness
    ! of the fracture energy; with eta < 1 its first factor is infinite when the last one vanishes
    by_direction = 0.0_dp
    if (share > 0.0_dp) by_direction = rise*law%eta*share**(law%eta - 1.0_dp) &
      *(2.0_dp/rho)*[(1.0_dp - share)*weighted(1), -share*weighted(2)]
    slope = (weighted - e*by_direction)/toughness
  end subroutine benzeggagh_kenane

  !> Demands that the separation at failure exceeds that at the onset in every mode mix.
  pure subroutine check_mode_mix(law, status)
    type(law_parameters), intent(in) :: law
    type(status_type), intent(out) :: status   !< too_brittle: item 1 for mode I, 2 for mode II, value and bound of G_c;
                                               !< too_brittle_mixed: per cent of mode II in the energy, alpha_n and bound
    real(dp) :: least(2), reserve, share

    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    least = 0.5_dp*law%strength**2*law%flexibility/law%ratio
    if (.not. law%toughness(2) > least(2)) then
      status = status_type(too_brittle, 1, law%toughness(2), least(2))
    else if (.not. law%toughness(1) > least(1)) then
      status = status_type(too_brittle, 2, law%toughness(1), least(1))
    else if (.not. below_reserve(law) > law%flexibility) then
      call least_reserve(law, reserve, share)
      if (.not. reserve > law%flexibility) status = status_type(too_brittle_mixed, nint(100.0_dp*share), &
        1.0_dp/law%flexibility, 1.0_dp/reserve)
    end if
  end subroutine check_mode_mix

  !> A lower bound of the reserve, and nearly always enough, since interfaces are stiff: the smallest fracture energy times the
  !> minimum of the linear function in `least_reserve`.
  pure function below_reserve(law) result(bound)
    type(law_parameters), intent(in) :: law
    real(dp) :: bound

    bound = 2.0_dp*minval(law%toughness)*minval(law%ratio/law%strength**2)
    ! for exponents below 1 the power law dips below both pure modes, for equal ones by 2**(1 - 1/p)
    if (.not. law%eta > 0.0_dp) bound = bound*min(1.0_dp, 2.0_dp**(1.0_dp - 1.0_dp/law%power))
  end function below_reserve

  !> Share of mode II in the energy, and its derivatives by c.
  pure subroutine measure_share(law, direction, share, slope)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: direction(2)   !< c, not zero
    real(dp), intent(out) :: share
    real(dp), intent(out) :: slope(2)      !< by c, its components taken as independent
    real(dp) :: weighted(2), rho

    weighted = law%ratio*direction
    rho = weighted(1)*direction(1) + weighted(2)*direction(2)
    share = weighted(1)*direction(1)/rho
    slope = (2.0_dp/rho)*[(1.0_dp - share)*weighted(1), -share*weighted(2)]
  end subroutine measure_share

  !> A direction with a share of mode II in the energy: rho is 1 and not the length of c, which cancels in f**2/e.
  pure function direction_of_share(law, share) result(direction)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: share
    real(dp) :: direction(2)

    direction = sqrt([share, 1.0_dp - share]/law%ratio)
  end function direction_of_share

  !> Minimum of f**2/e over all mode mixes, and the share of mode II in the energy at which it occurs.
  !>
  !> It must exceed the flexibility: the separations at failure and onset are f/e and flexibility/f. As a function of the
  !> share it is 2 G_c(B) sum_i B_i ratio_i/strength_i**2, which for the linear criterion lies between its values in the
  !> pure modes.
  pure subroutine least_reserve(law, reserve, share)
    type(law_parameters), intent(in) :: law
    real(dp), intent(out) :: reserve   !< length/stress
    real(dp), intent(out) :: share

    if (.not. is_linear(law)) then
      call least_of_mixes(law, reserve_at, reserve, share)
      return
    end if
    share = 0.0_dp
    reserve = reserve_at(law, share)
    if (reserve_at(law, 1.0_dp) < reserve) then
      share = 1.0_dp
      reserve = reserve_at(law, share)
    end if
  end subroutine least_reserve

  !> Minimum of a quantity over all mode mixes, and the share of mode II in the energy at which it occurs.
  !>
  !> A scan finds the valley, and a golden section its floor: after so many cuts the share is right to 6e-5, and the quantity, which
  !> is flat there, to the square of it.
  pure subroutine least_of_mixes(law, measure, least, share)
    type(law_parameters), intent(in) :: law
    procedure(mix_measure) :: measure
    real(dp), intent(out) :: least
    real(dp), intent(out) :: share
    integer, parameter :: pieces = 16, cuts = 16
    real(dp), parameter :: golden = 0.6180339887498949_dp
    real(dp) :: left, right, inner(2), values(0:pieces)
    integer :: i

    do i = 0, pieces
      values(i) = measure(law, real(i, dp)/pieces)
    end do
    i = minloc(values, 1) - 1
    share = real(i, dp)/pieces
    least = values(i)

    left = max(0.0_dp, share - 1.0_dp/pieces)
    right = min(1.0_dp, share + 1.0_dp/pieces)
    do i = 1, cuts
      inner = [right - golden*(right - left), left + golden*(right - left)]
      if (measure(law, inner(1)) < measure(law, inner(2))) then
        right = inner(2)
      else
        left = inner(1)
      end if
    end do
    inner = 0.5_dp*(left + right)
    if (measure(law, inner(1)) < least) then
      share = inner(1)
      least = measure(law, share)
    end if
  end subroutine least_of_mixes

  !> f**2/e at a share of mode II in the energy.
  pure function reserve_at(law, share) result(reserve)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: share
    real(dp) :: reserve
    real(dp) :: direction(2), f, e, slope(2)

    direction = direction_of_share(law, share)
    call measure_onset(law, direction, f, slope)
    call measure_energy(law, direction, e, slope)
    reserve = f**2/e
  end function reserve_at

end module cohesive_mode_mix
