! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in springs, dashpots, masses and loads that follow their faces. JTYPE:
!>
!> 2  SPRINGA: SVARS hold elongation, force.
!> 3  SPRING1, SPRING2: the same between the first unknown and the second, or the ground.
!> 4  MASS.
!> 5  load on a face of an element. The loads of the call are their magnitudes, with NLGEOM on the present face; ENERGY(8) is their
!>    work. Column 2 of RHS is the force of their increments.
!> 6  DASHPOTA, 7  DASHPOT1 and DASHPOT2: as springs, but the force depends on the rate of the elongation. In static steps it is the
!>    increment of the elongation over that of the time, in linear ones there is none; then the damping matrix that LFLAGS(7) asks
!>    for is the slope at rest.
!>
!> Values of PROPS and JPROPS: spring (also of dashpots), mass and face in built_in.toml. In dynamic analyses SVARS go on with the
!> forces of the last two increments, those of loads on faces always.
module host_discrete
  use host_adapter, only: element_t, keep_forces
  use host_bar, only: bar_forces, bar_of, bar_t
  use host_kinds, only: dp, i4
  use host_layout, only: j_face_axisymmetric, j_face_family, j_face_outward, j_face_points, j_face_traction, p_face_depth, &
                         p_face_direction, p_mass_value, p_spring_table
  use host_messages, only: add_message
  use host_followers, only: add_pressure, add_traction
  use host_protect, only: escape
  use host_shape, only: rule_of, rule_t
  implicit none (type, external)
  private
  public :: discrete

  integer(i4), parameter :: axial_spring = 2, spring = 3, mass_point = 4, face = 5, axial_dashpot = 6, dashpot = 7
  integer, parameter :: at_points = 3   !< traction: a pressure at each point of the face

contains

  subroutine discrete(element)
    type(element_t), intent(inout) :: element
    real(dp) :: pull, slope, rates(element%n), by_change
    type(bar_t) :: bar
    integer :: i
    call keep_forces(element, merge(1, 3, element%jtype == face), size(element%svars) + 1)
    if (element%has_mass .and. element%jtype == mass_point) then
      do i = 1, element%n
        element%mass(i, i) = element%props(p_mass_value)
      end do
    end if
    if (element%has_damping .and. any(element%jtype == [axial_dashpot, dashpot])) then
      rates = 0
      call resist(element, rates, 1.0_dp)
    end if
    if (.not. element%has_forces) return
    associate (n => element%n, u => element%u, svars => element%svars, energy => element%energy)
      select case (element%jtype)
      case (axial_spring)
        bar = bar_of(element%mcrd, element%finite, element%coords, u)
        call look_up(element%props(p_spring_table:), bar%elongation, pull, slope)
        call keep_state(bar%elongation, pull, svars, energy(2))
        call bar_forces(element%mcrd, bar, element%request, pull, slope, element%added, element%rhs, element%amatrx)
      case (spring)
        call look_up(element%props(p_spring_table:), difference(n, u), pull, slope)
        call keep_state(difference(n, u), pull, svars, energy(2))
        call dof_forces(n, pull, slope, element%rhs, element%amatrx)
      case (axial_dashpot, dashpot)
        call rates_of(element, rates, by_change)
        call resist(element, rates, by_change)
      case (face)
        call follow(element)
      case (mass_point)   ! has no force of its own
      case default
        call add_message(-3_i4, 'discrete elements of this kind are not known to the host')
        call escape()
      end select
    end associate
  end subroutine discrete

  !> Forces of a dashpot at its rates, and their derivatives: by_change is that of a rate.
  subroutine resist(element, rates, by_change)
    type(element_t), intent(inout) :: element
    real(dp), intent(in) :: rates(element%n), by_change
    real(dp) :: pull, slope
    type(bar_t) :: bar
    associate (n => element%n, dim => element%mcrd, energy => element%energy)
      if (element%jtype == axial_dashpot) then
        bar = bar_of(dim, element%finite, element%coords, element%u)
        call look_up(element%props(p_spring_table:), dot_product(bar%along(:dim), rates(dim + 1:) - rates(:dim)), pull, slope)
        call keep_state(bar%elongation, pull, element%svars, energy(5))
        call bar_forces(dim, bar, element%request, pull, slope*by_change, element%added, element%rhs, element%amatrx)
      else
        call look_up(element%props(p_spring_table:), difference(n, rates), pull, slope)
        call keep_state(difference(n, element%u), pull, element%svars, energy(5))
        call dof_forces(n, pull, slope*by_change, element%rhs, element%amatrx)
      end if
    end associate
  end subroutine resist

  !> Forces of a load on a face, and of its increment.
  subroutine follow(element)
    type(element_t), intent(inout) :: element
    real(dp) :: unused(element%n, element%n)
    type(rule_t), pointer :: rule
    associate (rhs => element%rhs, loads => element%ndload)
      rule => rule_of(int(element%jprops(j_face_family)), int(element%jprops(j_face_points)))
      call load_face(rule, element, element%adlmag(:loads), rhs(:, 1), element%amatrx)
      if (size(rhs, 2) == 2) then
        call load_face(rule, element, element%ddlmag(:loads), rhs(:, 2), unused)
        ! the driver takes what holds a load, which `respond` turns around, for column 1 alone
        rhs(:, 2) = -rhs(:, 2)
      end if
      element%energy(8) = -0.5_dp*dot_product(rhs(:, 1) + element%old(:, 1), element%added)
    end associate
  end subroutine follow

  !> Rates of the unknowns, and their derivative by these.
  pure subroutine rates_of(element, rates, by_change)
    type(element_t), intent(in) :: element
    real(dp), intent(out) :: rates(element%n), by_change
    rates = 0
    by_change = 0
    if (element%perturbation) return
    if (element%dynamic) then
      rates = element%v
      if (element%dtime > 0) by_change = element%params(3)/(element%params(2)*element%dtime)
    else if (element%dtime > 0) then
      rates = element%du/element%dtime
      by_change = 1/element%dtime
    end if
  end subroutine rates_of

  !> Force and stiffness of a load on a face: in small displacements on the initial one.
  pure subroutine load_face(rule, element, magnitudes, force, stiffness)
    type(rule_t), intent(in) :: rule
    type(element_t), intent(in) :: element
    real(dp), intent(in) :: magnitudes(:)
    real(dp), intent(inout) :: force(element%n), stiffness(element%n, element%n)
    real(dp) :: start(element%n), x(element%n), pressures(rule%points)
    logical :: axisymmetric
    start = reshape(element%coords, [element%n])
    x = start
    if (element%finite) x = start + element%u
    axisymmetric = element%jprops(j_face_axisymmetric) /= 0
    associate (outward => int(element%jprops(j_face_outward)), kind => element%jprops(j_face_traction), &
               depth => element%props(p_face_depth), direction => element%props(p_face_direction:))
      pressures = sum(magnitudes)
      if (kind == at_points .and. size(magnitudes) > 0) pressures = magnitudes
      if (kind == 0 .or. kind == at_points) then
        call add_pressure(rule, axisymmetric, outward, depth, pressures, x, force, stiffness)
      else
        call add_traction(rule, axisymmetric, kind == 2, depth, sum(magnitudes), direction, start, x, force, stiffness)
      end if
    end associate
    if (.not. element%finite) stiffness = 0
  end subroutine load_face

  !> Force and its derivative by the elongation, or the rate: proportional where the table is one number, else along the table of
  !> force and elongation, constant outside it.
  pure subroutine look_up(table, elongation, pull, slope)
    real(dp), intent(in) :: table(:), elongation
    real(dp), intent(out) :: pull, slope
    integer :: k, n
    n = size(table)
    slope = 0
    if (n == 1) then
      slope = table(1)
      pull = slope*elongation
    else if (elongation <= table(2)) then
      pull = table(1)
    else
      pull = table(n - 1)
      do k = 2, n - 2, 2
        if (elongation > table(k + 2)) cycle
        slope = (table(k + 1) - table(k - 1))/(table(k + 2) - table(k))
        pull = table(k - 1) + slope*(elongation - table(k))
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
