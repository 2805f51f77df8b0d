! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Traction-separation response of Abaqus' cohesive elements: linear elasticity, onset and evolution of a scalar damage.
!>
!> Written from the manual alone, independently of the project's own elements, for comparison with them: Abaqus Analysis User's
!> Guide, Defining the constitutive response of cohesive elements using a traction-separation description.
!>
!> Components are in the order (n, s, t), (n, s) in the plane. With g = (<delta_n>, delta_s, delta_t) the effective displacement is
!> delta = |g|. The onset criterion f(g) = 1 is homogeneous, so that the ray of g meets it at delta_o = delta/f with the effective
!> traction T_o = |K g|/f, and damage follows from delta, delta_o, T_o and from the fracture energy G. G depends on the mode mix of
!> the energies of "the current state of deformation only, not the deformation history" (Keywords Guide, *DAMAGE EVOLUTION, MODE
!> MIX RATIO=ENERGY, the default). This is the state at the start of the increment (inferred from jobs of Abaqus:
!> harness/uel/procedures/fidelity.md). The mode mix of g replaces it in two cases: the point has no deformation at the start, or G
!> of that mode mix is below the elastic energy at the onset. The manual leaves open how delta_o and T_o follow a mode mix that
!> changes during damage: here they are those of g. The damage is the largest so far, which along a straight path is the manual's
!> form in delta_max.
!>
!> A growing damage dissipates dD/2 sum K_i g_i**2. It grows on the curve of the law, on which delta is a function of D along a
!> direction, so that there the dissipated energy is one of D, and an increment of any size dissipates its difference: from intact
!> to failed the area under the curve, and never a negative energy.
module host_traction_separation
  use core_root, only: advance, root_search, search_between, searching
  use host_kinds, only: dp, i4
  use host_layout, only: j_traction_separation_criterion, j_traction_separation_evolution, j_traction_separation_mixed_mode, &
                         j_traction_separation_softening, p_traction_separation_evolution, p_traction_separation_max_degradation, &
                         p_traction_separation_modulus, p_traction_separation_onset, p_traction_separation_power, &
                         p_traction_separation_table, p_traction_separation_viscosity
  implicit none (type, external)
  private
  public :: cohesive_law, cohesive_point, read_law, update_point
  public :: fine, too_brittle

  integer(i4), parameter :: maxs = 1, quads = 2, maxe = 3, quade = 4       !< CRITERION=
  integer(i4), parameter :: by_displacement = 1, by_energy = 2             !< TYPE= of *DAMAGE EVOLUTION
  integer(i4), parameter :: exponential = 2, tabular = 3                   !< SOFTENING=; else linear
  integer(i4), parameter :: mode_independent = 0, benzeggagh_kenane = 1    !< MIXED MODE BEHAVIOR=; else the power law

  integer, parameter :: fine = 0
  integer, parameter :: too_brittle = 1   !< the fracture energy is below the elastic energy at the onset

  type :: cohesive_law
    real(dp) :: modulus(3) = 0       !< Enn, Ess, Ett, stress
    real(dp) :: onset(3) = 0         !< nominal stresses, or nominal strains, of the onset
    real(dp) :: evolution(3) = 0     !< Gn, Gs, Gt; or G; or displacement after onset and exponential law parameter
    real(dp) :: power = 1            !< POWER=
    real(dp) :: viscosity = 0        !< relaxation time of the damage
    real(dp) :: most = 1             !< MAX DEGRADATION=
    integer(i4) :: criterion = 0     !< one of the above; 0: no damage
    integer(i4) :: type = 0          !< likewise; 0: the onset is reported and nothing follows
    integer(i4) :: softening = 0
    integer(i4) :: mixed = 0
    real(dp), allocatable :: table(:, :)   !< (2, k) displacement after the onset, damage
  end type cohesive_law

  !> State of a point at the end of an increment; components in the order (n, s, t).
  type :: cohesive_point
    real(dp) :: separation(3) = 0
    real(dp) :: traction(3) = 0
    real(dp) :: damage = 0           !< that acts, SDEG
    real(dp) :: dissipated(3) = 0    !< by damage, energy/area
    real(dp) :: viscous = 0          !< by the viscous regularisation, energy/area
    real(dp) :: largest = 0          !< damage without the regularisation
    real(dp) :: criterion = 0        !< QUADSCRT and the like: largest so far, 1 from the onset on where damage evolves
  end type cohesive_point

  !> Onset criterion at the start of an increment below which a deformation is rounding alone.
  real(dp), parameter :: least = 1e-6_dp

  !> A quantity that depends on g, and its gradient.
  type :: varying
    real(dp) :: value = 0
    real(dp) :: by(3) = 0
  end type varying

  !> Softening curve in the direction of g.
  type :: softening_curve
    type(varying) :: onset      !< effective displacement there
    type(varying) :: failure    !< effective displacement there, without meaning for exponential softening by energy
    type(varying) :: energy     !< fracture energy, TYPE=ENERGY
    type(varying) :: stored     !< elastic energy at the onset, TYPE=ENERGY
  end type softening_curve

contains

  !> The law of the properties of a block or of a pair of surfaces: values as traction_separation in built_in.toml.
  pure function read_law(reals, integers) result(law)
    real(dp), intent(in) :: reals(:)
    integer(i4), intent(in) :: integers(:)
    type(cohesive_law) :: law
    law%modulus = reals(p_traction_separation_modulus)
    law%onset = reals(p_traction_separation_onset)
    law%evolution = reals(p_traction_separation_evolution)
    law%power = reals(p_traction_separation_power)
    law%viscosity = reals(p_traction_separation_viscosity)
    law%most = reals(p_traction_separation_max_degradation)
    law%criterion = integers(j_traction_separation_criterion)
    law%type = integers(j_traction_separation_evolution)
    law%softening = integers(j_traction_separation_softening)
    law%mixed = integers(j_traction_separation_mixed_mode)
    if (law%softening == tabular) then
      associate (table => reals(p_traction_separation_table:))
        law%table = reshape(table, [2, size(table)/2])
      end associate
    end if
  end function read_law

  !> State of a point at the end of an increment and the derivative of the traction by the separation.
  !> If status is too_brittle, `fault` is the amount by which the fracture energy falls short of its bound.
  pure subroutine update_point(law, thickness, dtime, separation, old, new, tangent, status, fault)
    type(cohesive_law), intent(in) :: law
    real(dp), intent(in) :: thickness        !< constitutive thickness: strain = separation/thickness
    real(dp), intent(in) :: dtime            !< duration of the increment
    real(dp), intent(in) :: separation(3)    !< opening positive; the third is zero in the plane
    type(cohesive_point), intent(in) :: old
    type(cohesive_point), intent(out) :: new
    real(dp), intent(out) :: tangent(3, 3)
    integer, intent(out) :: status
    real(dp), intent(out) :: fault
    real(dp) :: stiffness(3), secant(3), g(3), slope(3), share
    type(varying) :: damage, f
    type(softening_curve) :: curve
    integer :: j
    status = fine
    fault = 0
    stiffness = law%modulus/thickness
    new = old
    new%separation = separation
    g = opening_part(separation)
    slope = 0
    if (law%criterion > 0) then
      f = onset(law, thickness, g)
      new%criterion = max(old%criterion, merge(f%value**2, f%value, any(law%criterion == [quads, quade])))
      if (law%type > 0) then
        new%criterion = min(new%criterion, 1.0_dp)
        if (f%value > 1) then
          call curve_along(law, stiffness, mode_at_start(law, thickness, old), g, f, curve, status, fault)
          if (status /= fine) return
          damage = damage_at(law, g, curve)
          if (damage%value > old%largest) then
            new%largest = damage%value
            slope = damage%by
          end if
        end if
        new%damage = new%largest
        if (law%viscosity > 0) then
          share = dtime/(law%viscosity + dtime)
          new%damage = old%damage + share*(new%largest - old%damage)
          slope = share*slope
        end if
      end if
    end if
    secant = (1 - new%damage)*stiffness
    ! compression is not damaged
    if (separation(1) < 0) secant(1) = stiffness(1)
    new%traction = secant*separation
    do j = 1, 3
      tangent(:, j) = -stiffness*g*slope(j)
      tangent(j, j) = tangent(j, j) + secant(j)
    end do
    if (new%largest > old%largest .or. new%damage > old%damage) call dissipate(law, thickness, stiffness, old, new)
  end subroutine update_point

  !> g of a separation: compression does no damage.
  pure function opening_part(separation) result(g)
    real(dp), intent(in) :: separation(3)
    real(dp) :: g(3)
    g = [max(0.0_dp, separation(1)), separation(2:3)]
  end function opening_part

  !> g at the start of the increment, zero for a point that has no deformation then.
  pure function mode_at_start(law, thickness, old) result(g0)
    type(cohesive_law), intent(in) :: law
    real(dp), intent(in) :: thickness
    type(cohesive_point), intent(in) :: old
    real(dp) :: g0(3)
    type(varying) :: f0
    g0 = opening_part(old%separation)
    f0 = onset(law, thickness, g0)
    if (f0%value < least) g0 = 0
  end function mode_at_start

  !> Onset criterion, 1 at the onset, homogeneous of degree one.
  pure function onset(law, thickness, g) result(f)
    type(cohesive_law), intent(in) :: law
    real(dp), intent(in) :: thickness, g(3)
    type(varying) :: f
    real(dp) :: limit(3)
    integer :: i
    limit = thickness*law%onset
    if (any(law%criterion == [maxs, quads])) limit = limit/law%modulus
    if (any(law%criterion == [quads, quade])) then
      f%value = norm2(g/limit)
      if (f%value > 0) f%by = g/limit**2/f%value
    else
      i = maxloc(abs(g)/limit, dim=1)
      f%value = abs(g(i))/limit(i)
      f%by(i) = sign(1/limit(i), g(i))
    end if
  end function onset

  !> Softening curve in the direction of g; g0 is g at the start of the increment, which has the mode mix of the fracture energy.
  pure subroutine curve_along(law, stiffness, g0, g, f, curve, status, fault)
    type(cohesive_law), intent(in) :: law
    real(dp), intent(in) :: stiffness(3), g0(3), g(3)
    type(varying), intent(in) :: f           !< onset criterion of g
    type(softening_curve), intent(out) :: curve
    integer, intent(out) :: status
    real(dp), intent(out) :: fault
    type(varying) :: traction
    status = fine
    fault = 0
    curve%onset = ratio(length_of(g), f)
    if (law%type == by_displacement) then
      curve%failure = varying(curve%onset%value + law%evolution(1), curve%onset%by)
      return
    end if
    traction%value = norm2(stiffness*g)
    traction%by = stiffness**2*g/traction%value
    traction = ratio(traction, f)
    curve%stored = varying(0.5_dp*traction%value*curve%onset%value, &
                           0.5_dp*(traction%by*curve%onset%value + traction%value*curve%onset%by))
    if (norm2(g0) > 0) then
      curve%energy = fracture_energy(law, stiffness, g0)
      curve%energy%by = 0
    end if
    if (.not. curve%energy%value > curve%stored%value) curve%energy = fracture_energy(law, stiffness, g)
    if (.not. curve%energy%value > curve%stored%value) then
      status = too_brittle
      fault = curve%stored%value - curve%energy%value
      return
    end if
    curve%failure = ratio(varying(2*curve%energy%value, 2*curve%energy%by), traction)
  end subroutine curve_along

  !> Damage beyond the onset, without history, up to MAX DEGRADATION.
  pure function damage_at(law, g, curve) result(damage)
    type(cohesive_law), intent(in) :: law
    real(dp), intent(in) :: g(3)
    type(softening_curve), intent(in) :: curve
    type(varying) :: damage, delta
    delta = length_of(g)
    if (law%softening == tabular) then
      damage = in_table(law%table, delta, curve%onset)
    else if (law%softening /= exponential) then
      damage = linear(delta, curve%onset, curve%failure)
    else if (law%type == by_displacement) then
      damage = exponential_in_displacement(law%evolution(2), law%evolution(1), delta, curve%onset)
    else
      damage = exponential_in_energy(delta, curve)
    end if
    if (damage%value >= law%most) damage = varying(law%most)
  end function damage_at

  !> Fracture energy at the mode mix of g, by the energies K_i g_i**2.
  pure function fracture_energy(law, stiffness, g) result(energy)
    type(cohesive_law), intent(in) :: law
    real(dp), intent(in) :: stiffness(3), g(3)
    type(varying) :: energy
    real(dp) :: whole, share(3), of_share, total
    integer :: i
    energy%value = law%evolution(1)
    if (law%mixed == mode_independent) return
    whole = sum(stiffness*g**2)
    share = stiffness*g**2/whole
    if (law%mixed == benzeggagh_kenane) then
      total = share(2) + share(3)
      energy%value = law%evolution(1) + (law%evolution(2) - law%evolution(1))*total**law%power
      ! with POWER < 1 the derivative by the share is infinite in pure mode I, where the share has an extremum
      if (.not. total > 0) return
      of_share = (law%evolution(2) - law%evolution(1))*law%power*total**(law%power - 1)
      energy%by = of_share*2*stiffness*g*([0, 1, 1] - total)/whole
    else
      total = sum((share/law%evolution)**law%power)
      energy%value = total**(-1/law%power)
      do i = 1, 3
        if (.not. share(i) > 0) cycle
        of_share = -energy%value/total*(share(i)/law%evolution(i))**law%power/share(i)
        energy%by = energy%by - of_share*2*stiffness*g*share(i)/whole
        energy%by(i) = energy%by(i) + of_share*2*stiffness(i)*g(i)/whole
      end do
    end if
  end function fracture_energy

  !> SOFTENING=LINEAR: D = delta_f (delta - delta_o)/(delta (delta_f - delta_o)).
  pure function linear(delta, at_onset, failure) result(damage)
    type(varying), intent(in) :: delta, at_onset, failure
    type(varying) :: damage
    real(dp) :: above, below
    if (delta%value >= failure%value) then
      damage%value = 1
      return
    end if
    above = at_onset%value*(failure%value - delta%value)
    below = delta%value*(failure%value - at_onset%value)
    damage%value = 1 - above/below
    damage%by = (above/below*(delta%by*(failure%value - at_onset%value) + delta%value*(failure%by - at_onset%by)) &
                 - at_onset%by*(failure%value - delta%value) - at_onset%value*(failure%by - delta%by))/below
  end function linear

  !> SOFTENING=TABULAR, TYPE=DISPLACEMENT: linear between the entries, constant beyond the last.
  pure function in_table(table, delta, at_onset) result(damage)
    real(dp), intent(in) :: table(:, :)
    type(varying), intent(in) :: delta, at_onset
    type(varying) :: damage
    real(dp) :: x, slope
    integer :: k
    x = delta%value - at_onset%value
    k = count(table(1, :) <= x)
    if (k == size(table, 2)) then
      damage%value = table(2, k)
      return
    end if
    slope = (table(2, k + 1) - table(2, k))/(table(1, k + 1) - table(1, k))
    damage%value = table(2, k) + slope*(x - table(1, k))
    damage%by = slope*(delta%by - at_onset%by)
  end function in_table

  !> SOFTENING=EXPONENTIAL, TYPE=DISPLACEMENT; a law parameter of zero is the linear law.
  pure function exponential_in_displacement(alpha, range, delta, at_onset) result(damage)
    real(dp), intent(in) :: alpha, range   !< law parameter; displacement between onset and failure
    type(varying), intent(in) :: delta, at_onset
    type(varying) :: damage
    real(dp) :: x, left, slope
    x = (delta%value - at_onset%value)/range
    if (x >= 1) then
      damage%value = 1
      return
    end if
    call decay(alpha, x, left, slope)
    damage%value = 1 - at_onset%value/delta%value*left
    damage%by = (at_onset%value/delta%value*delta%by - at_onset%by)*left/delta%value &
      - at_onset%value/delta%value*slope*(delta%by - at_onset%by)/range
  end function exponential_in_displacement

  !> Effective traction over that at the onset for SOFTENING=EXPONENTIAL, TYPE=DISPLACEMENT, and its derivative.
  pure subroutine decay(alpha, x, left, slope)
    real(dp), intent(in) :: alpha    !< law parameter
    real(dp), intent(in) :: x        !< 0 at the onset, 1 at failure
    real(dp), intent(out) :: left, slope
    if (abs(alpha) > 0) then
      left = 1 - (1 - exp(-alpha*x))/(1 - exp(-alpha))
      slope = -alpha*exp(-alpha*x)/(1 - exp(-alpha))
    else
      left = 1 - x
      slope = -1
    end if
  end subroutine decay

  !> SOFTENING=EXPONENTIAL, TYPE=ENERGY: D is the integral of T_eff/(G - G_o) over the effective displacement from the onset
  !> on, with T_eff = (1 - D) T_o delta/delta_o, so 1 - D = exp(-(delta**2/delta_o**2 - 1) G_o/(G - G_o)).
  pure function exponential_in_energy(delta, curve) result(damage)
    type(varying), intent(in) :: delta
    type(softening_curve), intent(in) :: curve
    type(varying) :: damage, part, stretch
    part = ratio(curve%stored, varying(curve%energy%value - curve%stored%value, curve%energy%by - curve%stored%by))
    stretch = ratio(delta, curve%onset)
    damage%value = 1 - exp(-part%value*(stretch%value**2 - 1))
    damage%by = (1 - damage%value)*(part%by*(stretch%value**2 - 1) + 2*part%value*stretch%value*stretch%by)
  end function exponential_in_energy

  !> Effective displacement of g.
  pure function length_of(g) result(delta)
    real(dp), intent(in) :: g(3)
    type(varying) :: delta
    delta%value = norm2(g)
    delta%by = g/delta%value
  end function length_of

  !> a/b
  elemental function ratio(a, b) result(c)
    type(varying), intent(in) :: a, b
    type(varying) :: c
    c%value = a%value/b%value
    c%by = (a%by - c%value*b%by)/b%value
  end function ratio

  !> Energies up to the end of an increment in which damage grows, per area.
  !>
  !> Where a mode mix that has changed makes the damage of the curve at the start larger than it was, the traction in excess of
  !> the curve is taken to vanish linearly until the end of the increment, or until failure. Where g turns meanwhile, the direction
  !> half-way is taken, with an error of second order.
  !>
  !> With viscosity the damage lags behind. All that is dissipated is then the work less the change of the stored energy, with the
  !> work of the overstress by the trapezoidal rule. Damage has of it what the law dissipates up to its damage, at most, and the
  !> overstress the rest.
  pure subroutine dissipate(law, thickness, stiffness, old, new)
    type(cohesive_law), intent(in) :: law
    real(dp), intent(in) :: thickness, stiffness(3)
    type(cohesive_point), intent(in) :: old
    type(cohesive_point), intent(inout) :: new
    type(softening_curve) :: curve
    type(varying) :: f, damage
    real(dp), dimension(3) :: g0, g1, mode, direction, squares, work
    real(dp) :: reached, starts, part, total, most, fault
    integer :: status
    mode = mode_at_start(law, thickness, old)
    g0 = abs(opening_part(old%separation))
    g1 = abs(opening_part(new%separation))
    reached = 0
    f = onset(law, thickness, g0)
    if (f%value > 1) then
      call curve_along(law, stiffness, mode, g0, f, curve, status, fault)
      if (status == fine) then
        damage = damage_at(law, g0, curve)
        reached = damage%value
      end if
    end if
    starts = min(new%largest, max(old%largest, reached))
    work = 0
    if (starts > old%largest) then
      work = 0.5_dp*stiffness*g0*g1*min(1.0_dp, curve%failure%value/norm2(g1))*(starts - old%largest)
    end if
    part = 0
    if (new%largest > starts .and. starts > reached) part = (starts - reached)/(new%largest - reached)
    direction = g0 + g1 + part*(g1 - g0)
    if (.not. norm2(direction) > 0) return
    f = onset(law, thickness, direction)
    call curve_along(law, stiffness, mode, direction, f, curve, status, fault)
    if (status /= fine) then
      direction = g1
      f = onset(law, thickness, direction)
      call curve_along(law, stiffness, mode, direction, f, curve, status, fault)
    end if
    squares = 0.5_dp*stiffness*(direction/norm2(direction))**2
    work = work + squares*max(0.0_dp, area_over_damage(law, curve, new%largest) - area_over_damage(law, curve, starts))
    if (law%viscosity > 0) then
      work = work + 0.5_dp*stiffness*opening_part(old%separation)*opening_part(new%separation) &
             *(new%damage - old%damage - (new%largest - old%largest))
      total = max(0.0_dp, sum(work))
      most = max(0.0_dp, sum(squares)*area_over_damage(law, curve, new%largest) - sum(old%dissipated))
      new%viscous = old%viscous + max(0.0_dp, total - most)
      work = squares/sum(squares)*min(total, most)
    end if
    new%dissipated = old%dissipated + work
  end subroutine dissipate

  !> Integral of the square of the effective displacement over the damage, from zero on.
  pure function area_over_damage(law, curve, damage) result(area)
    type(cohesive_law), intent(in) :: law
    type(softening_curve), intent(in) :: curve
    real(dp), intent(in) :: damage
    real(dp) :: area
    real(dp) :: onset, failure, left
    onset = curve%onset%value
    failure = curve%failure%value
    left = 1 - damage
    if (law%softening == tabular) then
      area = table_area(law%table, onset, damage)
    else if (law%softening /= exponential) then
      area = onset*damage*onset*failure/(left*failure + damage*onset)
    else if (law%type == by_displacement) then
      area = exponential_area(law%evolution(2), law%evolution(1), onset, left)
    else
      ! delta**2 = delta_o**2 (1 - log(1 - D) (G - G_o)/G_o)
      area = damage
      if (left > 0) area = damage + left*log(left)
      area = onset**2*(damage + area*(curve%energy%value - curve%stored%value)/curve%stored%value)
    end if
  end function area_over_damage

  !> SOFTENING=TABULAR: delta is linear in D between the entries; the first of them may be a damage that comes with the onset.
  pure function table_area(table, onset, damage) result(area)
    real(dp), intent(in) :: table(:, :), onset, damage
    real(dp) :: area
    real(dp) :: a, b, growth, part
    integer :: k
    area = onset**2*min(damage, table(2, 1))
    do k = 1, size(table, 2) - 1
      growth = min(damage, table(2, k + 1)) - table(2, k)
      if (.not. growth > 0) cycle
      part = growth/(table(2, k + 1) - table(2, k))
      a = onset + table(1, k)
      b = a + part*(table(1, k + 1) - table(1, k))
      area = area + growth*(a**2 + a*b + b**2)/3
    end do
  end function table_area

  !> SOFTENING=EXPONENTIAL, TYPE=DISPLACEMENT. With `left` = 1 - D = delta_o l(x)/delta, where l is the decay and
  !> delta = delta_o + range x, integration by parts leaves delta_o**2 (1 - l) + delta_o range (2 int l dx - x l).
  pure function exponential_area(alpha, range, onset, left) result(area)
    real(dp), intent(in) :: alpha, range, onset, left
    real(dp) :: area
    type(root_search) :: search
    real(dp) :: x, l, slope
    x = 1
    if (left > 0) then
      search = search_between(0.0_dp, 1.0_dp, merge(0.0_dp, 1.0_dp, alpha > 0), geometric=.false.)
      do while (searching(search))
        call decay(alpha, search%x, l, slope)
        call advance(search, left*(onset + range*search%x) - onset*l, left*range - onset*slope)
      end do
      x = search%x
    end if
    call decay(alpha, x, l, slope)
    area = onset**2*(1 - l) + onset*range*(2*area_of_decay(alpha, x) - x*l)
  end function exponential_area

  !> Integral of the decay from 0 to x.
  pure function area_of_decay(alpha, x) result(area)
    real(dp), intent(in) :: alpha, x
    real(dp) :: area
    real(dp) :: z, rest, term
    integer :: k
    if (.not. abs(alpha) > 0) then
      area = x - 0.5_dp*x**2
      return
    end if
    z = alpha*x
    rest = z - 1 + exp(-z)
    if (abs(z) < 1) then
      ! the series, where the difference would cancel
      rest = 0
      term = -z
      do k = 2, 18
        term = -term*z/k
        rest = rest + term
      end do
    end if
    area = x - rest/(alpha*(1 - exp(-alpha)))
  end function area_of_decay
end module host_traction_separation
