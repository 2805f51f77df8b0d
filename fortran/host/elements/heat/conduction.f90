! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Conduction and storage of heat in continuum elements, and heat transfer elements (DC2D4, DCAX4, DC3D8, ...).
!>
!> The equations are those of Abaqus' Theory Guide (Uncoupled heat transfer analysis): the internal energy changes over time by
!> backward differences, with the mass before any displacement; heat flows through the present shape. Elements with straight edges
!> store heat at their corners, by the tables of the material. UMATHT gives the energy at the integration points: there each corner
!> has its share, to which DUDT adds what the corner has warmed more than the point. So does Abaqus 2023 (CAX4RT, C3D8T;
!> harness/uel/procedures/fidelity.md), as far as DUDT is constant. In elements with fewer points for stresses than for heat,
!> UMATHT has the STATEV of the stress point that stands for the place.
!>
!> Heat transfer elements: values of PROPS and JPROPS as flow in built_in.toml; SVARS the heat flux of each point, then the energies
!> per mass of UMATHT.
module host_conduction
  use core_small_matrix, only: invert
  use host_adapter, only: element_t
  use host_context, only: initial_stresses
  use host_coupling, only: interpolate_fields
  use host_kinds, only: dp, i4
  use host_kinematics, only: gradients, point_position, size_of
  use host_layout, only: j_flow_direct, j_flow_family, j_flow_points, p_flow_depth
  use host_materials, only: material_t
  use host_point, only: heat_t, move_to, point_t
  use host_shape, only: is_quadratic, rule_of, rule_t
  use host_usdfld, only: call_usdfld
  use host_thermal, only: call_hetval, call_umatht, conductivity_at, energy_taken, flow_t
  implicit none (type, external)
  private
  public :: body_t, conduct, heat_transfer, is_steady, add_flow, add_product, unit

  !> An element whose corners, or nodes, have temperatures.
  type :: body_t
    type(rule_t), pointer :: geometry => null(), field => null()   !< points of the shape and of the temperatures
    integer :: direct = 0              !< as host_kinematics has it
    real(dp) :: depth = 1              !< thickness, or 2 pi
    real(dp) :: dtime = 0              !< 0: heat is not stored
    logical :: generates = .false.     !< HETVAL and USDFLD are called here, not with the stresses
    integer :: states = 0              !< points that have STATEV: those of the stresses, if there are any
    !> The matrix leaves out what the conductivity and the specific heat change by, as that of Abaqus does without displacements:
    !> printed residuals of a public job (harness/uel/procedures/fidelity.md). The former would make it unsymmetric.
    logical :: modified = .false.
  end type body_t

contains

  subroutine heat_transfer(element)
    type(element_t), intent(inout) :: element
    type(body_t) :: body
    integer :: fluxes
    if (.not. element%has_forces .or. element%request == initial_stresses) return
    associate (jprops => element%jprops, dim => element%mcrd)
      body%geometry => rule_of(int(jprops(j_flow_family)), int(jprops(j_flow_points)))
      body%field => body%geometry
      body%direct = jprops(j_flow_direct)
      body%depth = merge(element%props(p_flow_depth), 1.0_dp, dim == 2)
      body%dtime = merge(0.0_dp, element%dtime, is_steady(element%procedure_code))
      body%generates = .true.
      body%modified = .true.
      body%states = body%geometry%points
      fluxes = dim*body%geometry%points
      call conduct(body, element%material, element%coords, element%coords, element%fields, element%predef, element%u, element%du, &
                   element%svars(:fluxes), element%svars(fluxes + 1:), element%rhs, element%amatrx)
      element%rhs = -element%rhs
    end associate
  end subroutine heat_transfer

  !> LFLAGS(1) of a step without storage of heat, or of a diffusing material.
  elemental logical function is_steady(procedure_code)
    integer(i4), intent(in) :: procedure_code
    is_steady = any(procedure_code == [31_i4, 71_i4, 131_i4])
  end function is_steady

  !> Add the heat that flows into the corners, or nodes, and minus its derivative by their temperatures.
  subroutine conduct(body, material, x, x_start, fields, predef, t, dt, flux, energy, heat, tangent)
    type(body_t), intent(in) :: body
    type(material_t), intent(in) :: material
    real(dp), dimension(body%geometry%dim, body%geometry%nodes), intent(in) :: x, x_start   !< now, and before any displacement
    integer, intent(in) :: fields
    real(dp), intent(in) :: predef(2, fields, body%geometry%nodes)
    real(dp), dimension(body%field%nodes), intent(in) :: t, dt      !< temperatures at the end of the increment, increments
    !> Heat flux, and energy of UMATHT, at the start of the increment, then at its end.
    real(dp), intent(inout) :: flux(body%geometry%dim, body%geometry%points), energy(body%geometry%points)
    real(dp), intent(inout) :: heat(body%field%nodes), tangent(body%field%nodes, body%field%nodes)
    real(dp) :: g(body%field%nodes, body%geometry%dim), unused(body%geometry%nodes, body%direct), mass(body%field%nodes), &
                gradient(body%geometry%dim), inverse(body%geometry%dim, body%geometry%dim), determinant, volume, start_volume, old
    real(dp), target :: nothing(0)     ! strain and stress
    type(flow_t) :: flow
    type(point_t) :: point
    integer :: dim, p
    dim = body%geometry%dim
    mass = 0
    do p = 1, body%geometry%points
      associate (n => body%field%n(:, p))
        call move_to(point, state_of(body, p))
        point%number = int(p, i4)
        call gradients(body%geometry, body%direct, p, x, unused, volume)
        call invert(dim, matmul(x, body%geometry%dn(:, :, p)), inverse, determinant)
        g = matmul(body%field%dn(:, :, p), inverse)
        gradient = matmul(t, g)
        if (allocated(material%thermal%flow) .or. body%generates .and. asks(material)) then
          point%place = point_position(body%geometry, p, x)
          call interpolate_fields(body%geometry, p, fields, predef, material%variables, point)
          point%fields(1, 2) = dot_product(dt, n)
          point%fields(1, 1) = dot_product(t, n) - point%fields(1, 2)
          if (body%generates .and. allocated(material%user_field)) then
            point%length = length_of(body%geometry, body%direct, x)
            call call_usdfld(material%user_field, 0, point, material%axes, material%axes, .false., nothing)
          end if
        end if
        old = energy(p)
        call flow_at(material, point, dot_product(t, n), gradient, flux(:, p), energy(p), flow)
        if (body%modified .and. .not. allocated(material%thermal%flow)) flow%flux_by_temperature = 0
        call add_flow(body%depth*volume, n, g, flow, heat, tangent)
        if (body%generates .and. allocated(material%thermal%source)) then
          point%heat = heat_t()
          call call_hetval(material%thermal%source, point)
          heat = heat + body%depth*volume*point%heat%source*n
          call add_product(-body%depth*volume*point%heat%source_by_temperature, n, n, tangent)
        end if
        if (body%dtime > 0) then
          call gradients(body%geometry, body%direct, p, x_start, unused, start_volume)
          associate (weight => material%thermal%density*body%depth*start_volume/body%dtime)
            if (allocated(material%thermal%flow)) then
              heat = heat - weight*(flow%energy - old)*n
              call add_product(weight, n, n*flow%energy_by_temperature + matmul(g, flow%energy_by_gradient(:dim)), tangent)
              if (.not. is_quadratic(body%geometry)) call store_at_corners(weight*flow%energy_by_temperature, n, dt, heat, tangent)
            else if (is_quadratic(body%geometry)) then
              call store(body, material, weight, dot_product(t - dt, n), dot_product(t, n), n, heat, tangent)
            else
              mass = mass + weight*n
            end if
          end associate
        end if
      end associate
    end do
    do p = 1, merge(body%field%nodes, 0, any(mass > 0))
      call store(body, material, mass(p), t(p) - dt(p), t(p), unit(p, body%field%nodes), heat, tangent)
    end do
  end subroutine conduct

  !> Whether HETVAL or USDFLD is called.
  pure logical function asks(material)
    type(material_t), intent(in) :: material
    asks = allocated(material%thermal%source) .or. allocated(material%user_field)
  end function asks

  !> CELENT of an element.
  real(dp) function length_of(rule, direct, x)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: direct
    real(dp), intent(in) :: x(rule%dim, rule%nodes)
    real(dp) :: unused(rule%nodes, direct), volume(rule%points)
    integer :: p
    do p = 1, rule%points
      call gradients(rule, direct, p, x, unused, volume(p))
    end do
    length_of = size_of(rule, direct, x, volume)
  end function length_of

  !> The point that has the STATEV of a point: itself, or the only one of the element or, in a wedge, of its layer.
  pure integer function state_of(body, point)
    type(body_t), intent(in) :: body
    integer, intent(in) :: point
    state_of = (point - 1)*body%states/body%geometry%points + 1
  end function state_of

  !> Heat flux of a point by the tables of the material or by UMATHT, and the energy that UMATHT gives; both are kept.
  subroutine flow_at(material, point, temperature, gradient, flux, energy, flow)
    type(material_t), intent(in) :: material
    type(point_t), intent(in) :: point
    real(dp), intent(in) :: temperature, gradient(:)
    real(dp), intent(inout) :: flux(:), energy
    type(flow_t), intent(out) :: flow
    real(dp) :: conductivity, slope
    integer :: i, n
    n = size(gradient)
    if (allocated(material%thermal%flow)) then
      flow%energy = energy
      flow%flux(:n) = flux
      call call_umatht(material%thermal%flow, point, gradient, flow)
      energy = flow%energy
    else
      call conductivity_at(material%thermal, temperature, conductivity, slope)
      flow%flux(:n) = -conductivity*gradient
      flow%flux_by_temperature(:n) = -slope*gradient
      do i = 1, n
        flow%flux_by_gradient(i, i) = -conductivity
      end do
    end if
    flux = flow%flux(:n)
  end subroutine flow_at

  !> Heat that a flux through a point brings to the nodes.
  pure subroutine add_flow(volume, n, g, flow, heat, tangent)
    real(dp), intent(in) :: volume, n(:), g(:, :)
    type(flow_t), intent(in) :: flow
    real(dp), intent(inout) :: heat(:), tangent(:, :)
    integer :: dim
    dim = size(g, 2)
    heat = heat + volume*matmul(g, flow%flux(:dim))
    tangent = tangent - volume*matmul(matmul(g, flow%flux_by_gradient(:dim, :dim)), transpose(g))
    call add_product(-volume, matmul(g, flow%flux_by_temperature(:dim)), n, tangent)
  end subroutine add_flow

  !> Move heat between the corners: it is stored where they have warmed by dt, in place of the point, which has warmed by dt n.
  pure subroutine store_at_corners(capacity, n, dt, heat, tangent)
    real(dp), intent(in) :: capacity, n(:), dt(:)      !< capacity: over the time increment
    real(dp), intent(inout) :: heat(:), tangent(:, :)
    integer :: k
    heat = heat - capacity*n*(dt - dot_product(n, dt))
    call add_product(-capacity, n, n, tangent)
    do k = 1, size(n)
      tangent(k, k) = tangent(k, k) + capacity*n(k)
    end do
  end subroutine store_at_corners

  !> Heat that a mass over the time increment takes, whose temperature is given by n.
  pure subroutine store(body, material, mass, from, to, n, heat, tangent)
    type(body_t), intent(in) :: body
    type(material_t), intent(in) :: material
    real(dp), intent(in) :: mass, from, to, n(:)
    real(dp), intent(inout) :: heat(:), tangent(:, :)
    real(dp) :: energy, slope
    call energy_taken(material%thermal, from, to, .not. body%modified, energy, slope)
    heat = heat - mass*energy*n
    call add_product(mass*slope, n, n, tangent)
  end subroutine store

  !> matrix + factor left right^T
  pure subroutine add_product(factor, left, right, matrix)
    real(dp), intent(in) :: factor, left(:), right(:)
    real(dp), intent(inout) :: matrix(:, :)
    integer :: j
    do j = 1, size(right)
      matrix(:, j) = matrix(:, j) + factor*right(j)*left
    end do
  end subroutine add_product

  !> Entry k of n is one.
  pure function unit(k, n) result(vector)
    integer, intent(in) :: k, n
    real(dp) :: vector(n)
    vector = 0
    vector(k) = 1
  end function unit
end module host_conduction
