! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Traction-separation response of Abaqus' cohesive elements: linear elasticity, onset and evolution of a scalar damage.
!>
!> Written from the manual alone, independently of the project's own elements, for comparison with them: Abaqus Analysis User's
!> Guide, Defining the constitutive response of cohesive elements using a traction-separation description.
!>
!> Components are in the order (n, s, t), (n, s) in the plane. With g = (<delta_n>, delta_s, delta_t) the effective
!> displacement is delta = |g|. The onset criterion f(g) = 1 is homogeneous, so that the ray of g meets it at
!> delta_o = delta/f with the effective traction T_o = |K g|/f, and damage follows from delta, delta_o, T_o and from the
!> fracture energy G. Its mode mix is that of the energies of "the current state of deformation only, not the deformation
!> history" (Keywords Guide, *DAMAGE EVOLUTION, MODE MIX RATIO=ENERGY, the default), at the start of the increment, as
!> harness/procedures/fidelity.md infers from jobs of Abaqus; that of g while a point has no deformation then, and where its G
!> would be too small for the onset. The manual leaves open how delta_o and T_o follow a mode mix that changes during damage: here
!> they are those of g. The damage is the largest so far, which along a straight path is the manual's form in delta_max.
module host_traction_separation
  use host_kinds, only: dp, i4
  implicit none (type, external)
  private
  public :: cohesive_law, cohesive_point, read_law, update_point
  public :: fine, too_brittle, n_law_reals, n_law_integers

  integer(i4), parameter :: maxs = 1, quads = 2, maxe = 3, quade = 4       !< CRITERION=
  integer(i4), parameter :: by_displacement = 1, by_energy = 2             !< TYPE= of *DAMAGE EVOLUTION
  integer(i4), parameter :: exponential = 2, tabular = 3                   !< SOFTENING=; else linear
  integer(i4), parameter :: mode_independent = 0, benzeggagh_kenane = 1    !< MIXED MODE BEHAVIOR=; else the power law

  integer, parameter :: fine = 0
  integer, parameter :: too_brittle = 1   !< the fracture energy is below the elastic energy at the onset

  integer, parameter :: n_law_reals = 12, n_law_integers = 4

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

contains

  !> The law of the properties of a block, in the order of `cohesive_properties` in harness/elements/cohesive.py.
  pure function read_law(reals, integers) result(law)
    real(dp), intent(in) :: reals(:)            !< a table of damage goes on behind n_law_reals
    integer(i4), intent(in) :: integers(n_law_integers)
    type(cohesive_law) :: law
    law = cohesive_law(reals(1:3), reals(4:6), reals(7:9), reals(10), reals(11), reals(12), &
                       integers(1), integers(2), integers(3), integers(4))
    if (law%softening == tabular) then
      law%table = reshape(reals(n_law_reals + 1:), [2, (size(reals) - n_law_reals)/2])
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
    real(dp) :: stiffness(3), secant(3), g(3), g0(3), slope(3), share
    type(varying) :: damage, f, f0
    integer :: j
    status = fine
    fault = 0
    stiffness = law%modulus/thickness
    new = old
    new%separation = separation
    g = [max(0.0_dp, separation(1)), separation(2:3)]
    slope = 0
    if (law%criterion > 0) then
      f = onset(law, thickness, g)
      new%criterion = max(old%criterion, merge(f%value**2, f%value, any(law%criterion == [quads, quade])))
      if (law%type > 0) then
        new%criterion = min(new%criterion, 1.0_dp)
        if (f%value > 1) then
          g0 = [max(0.0_dp, old%separation(1)), old%separation(2:3)]
          f0 = onset(law, thickness, g0)
          if (f0%value < least) g0 = 0
          call damage_at(law, stiffness, g0, g, f, damage, status, fault)
          if (status /= fine) return
          if (damage%value >= law%most) damage = varying(law%most)
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
    call dissipate(stiffness, old, new)
  end subroutine update_point

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

  !> Damage beyond the onset, without history but that of the mode mix: g0 is g at the start of the increment.
  pure subroutine damage_at(law, stiffness, g0, g, f, damage, status, fault)
    type(cohesive_law), intent(in) :: law
    real(dp), intent(in) :: stiffness(3), g0(3), g(3)
    type(varying), intent(in) :: f
    type(varying), intent(out) :: damage
    integer, intent(out) :: status
    real(dp), intent(out) :: fault
    type(varying) :: delta, traction, at_onset, failure, energy, stored
    status = fine
    fault = 0
    delta%value = norm2(g)
    delta%by = g/delta%value
    at_onset = ratio(delta, f)
    if (law%type == by_displacement) then
      failure = varying(at_onset%value + law%evolution(1), at_onset%by)
    else
      traction%value = norm2(stiffness*g)
      traction%by = stiffness**2*g/traction%value
      traction = ratio(traction, f)
      stored = varying(0.5_dp*traction%value*at_onset%value, &
                       0.5_dp*(traction%by*at_onset%value + traction%value*at_onset%by))
      if (norm2(g0) > 0) then
        energy = fracture_energy(law, stiffness, g0)
        energy%by = 0
      end if
      if (.not. energy%value > stored%value) energy = fracture_energy(law, stiffness, g)
      if (.not. energy%value > stored%value) then
        status = too_brittle
        fault = stored%value - energy%value
        return
      end if
      failure = ratio(varying(2*energy%value, 2*energy%by), traction)
    end if
    if (law%softening == tabular) then
      damage = in_table(law%table, delta, at_onset)
    else if (law%softening /= exponential) then
      damage = linear(delta, at_onset, failure)
    else if (law%type == by_displacement) then
      damage = exponential_in_displacement(law%evolution(2), law%evolution(1), delta, at_onset)
    else
      damage = exponential_in_energy(delta, at_onset, energy, stored)
    end if
  end subroutine damage_at

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
    if (abs(alpha) > 0) then
      left = 1 - (1 - exp(-alpha*x))/(1 - exp(-alpha))
      slope = -alpha*exp(-alpha*x)/(1 - exp(-alpha))
    else
      left = 1 - x
      slope = -1
    end if
    damage%value = 1 - at_onset%value/delta%value*left
    damage%by = (at_onset%value/delta%value*delta%by - at_onset%by)*left/delta%value &
      - at_onset%value/delta%value*slope*(delta%by - at_onset%by)/range
  end function exponential_in_displacement

  !> SOFTENING=EXPONENTIAL, TYPE=ENERGY: D is the integral of T_eff/(G - G_o) over the effective displacement from the onset
  !> on, with T_eff = (1 - D) T_o delta/delta_o, so 1 - D = exp(-(delta**2/delta_o**2 - 1) G_o/(G - G_o)).
  pure function exponential_in_energy(delta, at_onset, energy, stored) result(damage)
    type(varying), intent(in) :: delta, at_onset, energy, stored
    type(varying) :: damage, part, stretch
    part = ratio(stored, varying(energy%value - stored%value, energy%by - stored%by))
    stretch = ratio(delta, at_onset)
    damage%value = 1 - exp(-part%value*(stretch%value**2 - 1))
    damage%by = (1 - damage%value)*(part%by*(stretch%value**2 - 1) + 2*part%value*stretch%value*stretch%by)
  end function exponential_in_energy

  !> a/b
  elemental function ratio(a, b) result(c)
    type(varying), intent(in) :: a, b
    type(varying) :: c
    c%value = a%value/b%value
    c%by = (a%by - c%value*b%by)/b%value
  end function ratio

  !> Energies up to the end of the increment, per area: the work by the trapezoidal rule less the change of the stored
  !> energy, of which `viscous` is the work of the overstress of the regularisation.
  pure subroutine dissipate(stiffness, old, new)
    real(dp), intent(in) :: stiffness(3)
    type(cohesive_point), intent(in) :: old
    type(cohesive_point), intent(inout) :: new
    real(dp), dimension(3) :: g0, g1, overstress
    g0 = [max(0.0_dp, old%separation(1)), old%separation(2:3)]
    g1 = [max(0.0_dp, new%separation(1)), new%separation(2:3)]
    overstress = 0.5_dp*stiffness*(g1 - g0)*((old%largest - old%damage)*g0 + (new%largest - new%damage)*g1)
    new%viscous = old%viscous + sum(overstress)
    new%dissipated = old%dissipated + 0.5_dp*stiffness*g0*g1*(new%damage - old%damage) - overstress
  end subroutine dissipate
end module host_traction_separation
