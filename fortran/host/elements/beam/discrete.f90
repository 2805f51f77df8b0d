! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in springs, dashpots, masses and loads that follow their faces, as a procedure with the arguments of UEL. JTYPE:
!>
!> 2  SPRINGA: PROPS hold force and elongation in turn, ascending; SVARS elongation, force.
!> 3  SPRING1, SPRING2: the same between the first unknown and the second, or the ground; SVARS as SPRINGA.
!> 4  MASS: PROPS(1).
!> 5  load on a face of an element: PROPS thickness or 2 pi, direction of a traction; JPROPS family and integration points of
!>    the face (host_shape), 1 about an axis, outward as in add_pressure, 0 pressure, 1 traction, 2 shear traction, 3 a pressure at
!>    each point. The loads of the call are their magnitudes, with NLGEOM on the present face; ENERGY(8) is their work. Column 2 of
!>    RHS is the force of their increments.
!> 6  DASHPOTA, 7  DASHPOT1 and DASHPOT2: as springs, but with the rate of the elongation in place of the elongation in PROPS. In
!>    static steps it is the increment of the elongation over that of the time, in linear ones there is none; then the damping
!>    matrix that LFLAGS(7) asks for is the slope at rest.
!>
!> In dynamic analyses SVARS go on with the forces of the last two increments, those of loads on faces always.
module host_discrete
  use host_bar, only: bar_forces, bar_of, bar_t
  use host_inertia, only: is_dynamic, respond
  use host_kinds, only: dp, i4
  use host_messages, only: add_message
  use host_followers, only: add_pressure, add_traction
  use host_protect, only: escape
  use host_shape, only: rule_of, rule_t
  implicit none (type, external)
  private
  public :: discrete_uel

  integer(i4), parameter :: axial_spring = 2, spring = 3, mass_point = 4, face = 5, axial_dashpot = 6, dashpot = 7
  integer, parameter :: at_points = 3   !< JPROPS(5): a pressure at each point of the face

contains

  subroutine discrete_uel(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                          v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                          lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period)
    integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                   lflags(*), mlvarx, mdload, jprops(*), njprop
    real(dp) :: rhs(*), amatrx(*), svars(*), energy(*), props(*), coords(*), u(*), du(*), v(*), a(*), time(*), dtime, &
                params(*), adlmag(*), predef(*), ddlmag(*), pnewdt, period
    real(dp) :: mass(ndofel, ndofel), old(ndofel, 2)
    real(dp) :: pull, slope, rates(ndofel), by_change, damping(ndofel**2)
    type(bar_t) :: bar
    integer :: i, n, states
    logical :: resists
    n = ndofel
    states = merge(0, 2, jtype == face)
    rhs(1:n*nrhs) = 0
    amatrx(1:n*n) = 0
    mass = 0
    do i = 1, n
      if (jtype == mass_point) mass(i, i) = props(1)
    end do
    old = 0
    if (nsvars >= states + 2*n) old = reshape(svars(states + 1:states + 2*n), [n, 2])
    if (lflags(3) /= 3 .and. lflags(3) /= 4) then
      select case (jtype)
      case (axial_spring)
        bar = bar_of(int(mcrd), lflags(2) /= 0, coords, u)
        call look_up(int(nprops), props, bar%elongation, pull, slope)
        call keep_state(bar%elongation, pull, svars, energy(2))
        call bar_forces(int(mcrd), bar, lflags(3), pull, slope, du, rhs, amatrx)
      case (spring)
        call look_up(int(nprops), props, difference(n, u), pull, slope)
        call keep_state(difference(n, u), pull, svars, energy(2))
        call dof_forces(n, pull, slope, rhs, amatrx)
      case (axial_dashpot, dashpot)
        call rates_of(n, lflags, params, dtime, v, du, rates, by_change)
        call resist(by_change)
      case (face)
        call load_face(rule_of(int(jprops(1)), int(jprops(2))), n, lflags(2) /= 0, jprops(3) /= 0, int(jprops(4:5)), &
                       props(1:1 + mcrd), adlmag(1:ndload), coords, u, rhs, amatrx)
        if (nrhs == 2) then
          call load_face(rule_of(int(jprops(1)), int(jprops(2))), n, lflags(2) /= 0, jprops(3) /= 0, int(jprops(4:5)), &
                         props(1:1 + mcrd), ddlmag(1:ndload), coords, u, rhs(n + 1), mass)
          ! the driver takes what holds a load, which `respond` turns around, for column 1 alone
          rhs(n + 1:2*n) = -rhs(n + 1:2*n)
          mass = 0
        end if
        energy(8) = -0.5_dp*dot_product(rhs(1:n) + old(:, 1), du(1:n))
      case (mass_point)   ! has no force of its own
      case default
        call add_message(-3_i4, 'discrete elements of this kind are not known to the host')
        call escape()
      end select
    end if
    resists = any(jtype == [axial_dashpot, dashpot]) .and. lflags(3) == 3
    if (resists) resists = lflags(7) == 1
    if (resists) then
      rates = 0
      call resist(1.0_dp)
      damping = amatrx(1:n**2)
    end if
    call respond(n, lflags, params, dtime, v, a, mass, old, rhs, amatrx, energy(1))
    if (resists) amatrx(1:n**2) = damping
    if (nsvars >= states + 2*n) svars(states + 1:states + 2*n) = reshape(old, [2*n])
  contains

    !> Forces of a dashpot at its rates, and their derivatives: by_change is that of a rate.
    subroutine resist(by_change)
      real(dp), intent(in) :: by_change
      if (jtype == axial_dashpot) then
        bar = bar_of(int(mcrd), lflags(2) /= 0, coords, u)
        call look_up(int(nprops), props, dot_product(bar%along(:mcrd), rates(mcrd + 1:) - rates(:mcrd)), pull, slope)
        call keep_state(bar%elongation, pull, svars, energy(5))
        call bar_forces(int(mcrd), bar, lflags(3), pull, slope*by_change, du, rhs, amatrx)
      else
        call look_up(int(nprops), props, difference(n, rates), pull, slope)
        call keep_state(difference(n, u), pull, svars, energy(5))
        call dof_forces(n, pull, slope*by_change, rhs, amatrx)
      end if
    end subroutine resist
  end subroutine discrete_uel

  !> Rates of the unknowns, and their derivative by these.
  pure subroutine rates_of(n, lflags, params, dtime, v, du, rates, by_change)
    integer, intent(in) :: n
    integer(i4), intent(in) :: lflags(4)
    real(dp), intent(in) :: params(3), dtime, v(n), du(n)
    real(dp), intent(out) :: rates(n), by_change
    rates = 0
    by_change = 0
    if (lflags(4) /= 0) return
    if (is_dynamic(lflags(1))) then
      rates = v
      if (dtime > 0) by_change = params(3)/(params(2)*dtime)
    else if (dtime > 0) then
      rates = du/dtime
      by_change = 1/dtime
    end if
  end subroutine rates_of

  !> Force and stiffness of a load on a face: in small displacements on the initial one.
  pure subroutine load_face(rule, n, finite, axisymmetric, kind, props, magnitudes, start, u, force, stiffness)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: n, kind(2)     !< n: number of displacements
    logical, intent(in) :: finite, axisymmetric
    real(dp), intent(in) :: props(:), magnitudes(:), start(n), u(n)
    real(dp), intent(inout) :: force(n), stiffness(n, n)
    real(dp) :: x(n), pressures(rule%points)
    x = start
    if (finite) x = start + u
    pressures = sum(magnitudes)
    if (kind(2) == at_points .and. size(magnitudes) > 0) pressures = magnitudes
    if (kind(2) == 0 .or. kind(2) == at_points) then
      call add_pressure(rule, axisymmetric, kind(1), props(1), pressures, x, force, stiffness)
    else
      call add_traction(rule, axisymmetric, kind(2) == 2, props(1), sum(magnitudes), props(2:), start, x, force, stiffness)
    end if
    if (.not. finite) stiffness = 0
  end subroutine load_face

  !> Force and its derivative by the elongation, or the rate: proportional where PROPS is one number, else along the table of force
  !> and elongation, constant outside it.
  pure subroutine look_up(n, props, elongation, pull, slope)
    integer, intent(in) :: n
    real(dp), intent(in) :: props(n), elongation
    real(dp), intent(out) :: pull, slope
    integer :: k
    slope = 0
    if (n == 1) then
      slope = props(1)
      pull = slope*elongation
    else if (elongation <= props(2)) then
      pull = props(1)
    else
      pull = props(n - 1)
      do k = 2, n - 2, 2
        if (elongation > props(k + 2)) cycle
        slope = (props(k + 1) - props(k - 1))/(props(k + 2) - props(k))
        pull = props(k - 1) + slope*(elongation - props(k))
        exit
      end do
    end if
  end subroutine look_up

  !> Keep elongation and force, and add their work to an energy.
  pure subroutine keep_state(elongation, pull, state, energy)
    real(dp), intent(in) :: elongation, pull
    real(dp), intent(inout) :: state(2), energy
    energy = energy + 0.5_dp*(pull + state(2))*(elongation - state(1))
    state = [elongation, pull]
  end subroutine keep_state

  !> The first value less the second, or that of the ground.
  pure real(dp) function difference(n, values)
    integer, intent(in) :: n
    real(dp), intent(in) :: values(n)
    difference = values(1)
    if (n == 2) difference = values(1) - values(2)
  end function difference

  !> Of a spring or a dashpot between a dof and another, or the ground.
  pure subroutine dof_forces(n, pull, slope, force, stiffness)
    integer, intent(in) :: n
    real(dp), intent(in) :: pull, slope
    real(dp), intent(inout) :: force(n), stiffness(n, n)
    force(1) = pull
    stiffness(1, 1) = slope
    if (n == 1) return
    force(2) = -pull
    stiffness(2, 2) = slope
    stiffness(1, 2) = -slope
    stiffness(2, 1) = -slope
  end subroutine dof_forces
end module host_discrete
