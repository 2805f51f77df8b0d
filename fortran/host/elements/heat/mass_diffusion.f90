! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Heat transfer elements (DC2D4, DCAX4, DC3D8, ...) in *MASS DIFFUSION: their unknowns are normalized concentrations.
!>
!> The concentration of the diffusing material changes over time by backward differences; elements with straight edges store it at
!> their corners, others at their integration points, as heat is (host_conduction). Predefined fields: the first is the temperature,
!> the last but one the equivalent pressure stress.
!>
!> Values of PROPS and JPROPS: flow in built_in.toml. SVARS of each point: the flux of the concentration, the concentration, the
!> amount of solute and the volume.
module host_mass_diffusion
  use host_adapter, only: element_t
  use host_conduction, only: add_flow, add_product, is_steady, unit
  use host_context, only: initial_stresses
  use host_diffusion, only: diffusion_t, diffusive_flow, driven_t, solubility_at
  use host_kinds, only: dp, i4
  use host_kinematics, only: gradients
  use host_layout, only: j_flow_direct, j_flow_family, j_flow_points, p_flow_depth
  use host_messages, only: add_message
  use host_protect, only: escape
  use host_shape, only: is_quadratic, rule_of, rule_t
  use host_thermal, only: flow_t
  implicit none (type, external)
  private
  public :: mass_diffusion

contains

  subroutine mass_diffusion(element)
    type(element_t), intent(inout) :: element
    type(rule_t), pointer :: rule
    real(dp) :: pressure(element%nodes)
    if (.not. element%has_forces .or. element%request == initial_stresses) return
    rule => rule_of(int(element%jprops(j_flow_family)), int(element%jprops(j_flow_points)))
    pressure = 0
    if (element%fields > 2) pressure = element%predef(1, element%fields - 1, :)
    call diffuse(rule, int(element%jprops(j_flow_direct)), element%material%diffusion, &
                 merge(element%props(p_flow_depth), 1.0_dp, element%mcrd == 2), &
                 merge(0.0_dp, element%dtime, is_steady(element%procedure_code)), element%coords, element%predef(:, 1, :), &
                 pressure, element%u, element%du, element%svars, element%rhs, element%amatrx)
    element%rhs = -element%rhs
  end subroutine mass_diffusion

  !> Add the solute that flows into the nodes, and minus its derivative by their normalized concentrations.
  subroutine diffuse(rule, direct, law, depth, dtime, x, temperature, pressure, phi, dphi, state, inflow, tangent)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: direct
    type(diffusion_t), intent(in) :: law
    real(dp), intent(in) :: depth, dtime                         !< dtime 0: nothing is stored
    real(dp), intent(in) :: x(rule%dim, rule%nodes)
    real(dp), intent(in) :: temperature(2, rule%nodes)           !< at the end of the increment, increments
    real(dp), dimension(rule%nodes), intent(in) :: pressure, phi, dphi
    real(dp), intent(out) :: state(rule%dim + 3, rule%points)
    real(dp), intent(inout) :: inflow(rule%nodes), tangent(rule%nodes, rule%nodes)
    real(dp) :: g(rule%nodes, direct), volumes(rule%nodes), volume, solubility, unused
    type(driven_t) :: point
    type(flow_t) :: flow
    integer :: dim, p, k
    logical :: good
    dim = rule%dim
    volumes = 0
    do p = 1, rule%points
      associate (n => rule%n(:, p))
        call gradients(rule, direct, p, x, g, volume)
        volume = depth*volume
        point%normalized = dot_product(phi, n)
        point%temperature = dot_product(temperature(1, :), n)
        point%gradient(:dim) = matmul(phi, g(:, :dim))
        point%warming(:dim) = matmul(temperature(1, :), g(:, :dim))
        point%pressing(:dim) = matmul(pressure, g(:, :dim))
        call diffusive_flow(law, dim, point, flow, good)
        if (.not. good) call refuse_temperature(law, point%temperature, p)
        call add_flow(volume, n, g(:, :dim), flow, inflow, tangent)
        call solubility_at(law, point%temperature, solubility, unused)
        state(:dim, p) = matmul(law%axes(:dim, :dim), flow%flux(:dim))
        state(dim + 1:, p) = [solubility*point%normalized, solubility*point%normalized*volume, volume]
        if (dtime > 0 .and. is_quadratic(rule)) then
          call store(law, volume/dtime, matmul(temperature, n), point%normalized, dot_product(dphi, n), n, inflow, tangent)
        end if
        volumes = volumes + volume*n
      end associate
    end do
    if (dtime <= 0 .or. is_quadratic(rule)) return
    do k = 1, rule%nodes
      call store(law, volumes(k)/dtime, temperature(:, k), phi(k), dphi(k), unit(k, rule%nodes), inflow, tangent)
    end do
  end subroutine diffuse

  !> Solute that a volume over the time increment takes, whose normalized concentration is given by n.
  pure subroutine store(law, volume, temperature, phi, dphi, n, inflow, tangent)
    type(diffusion_t), intent(in) :: law
    real(dp), intent(in) :: volume, temperature(2), phi, dphi, n(:)
    real(dp), intent(inout) :: inflow(:), tangent(:, :)
    real(dp) :: before, now, unused
    call solubility_at(law, temperature(1) - temperature(2), before, unused)
    call solubility_at(law, temperature(1), now, unused)
    inflow = inflow - volume*(now*phi - before*(phi - dphi))*n
    call add_product(volume*now, n, n, tangent)
  end subroutine store

  !> End the pass.
  subroutine refuse_temperature(law, temperature, point)
    type(diffusion_t), intent(in) :: law
    real(dp), intent(in) :: temperature
    integer, intent(in) :: point
    character(len=200) :: text
    write (text, '(a,es11.3,a,i0,a,es11.3,a)') '*KAPPA, TYPE=TEMP: the temperature', temperature, ' at integration point ', point, &
      ' is not above absolute zero,', law%absolute_zero, ' (*PHYSICAL CONSTANTS)'
    call add_message(-3_i4, trim(text))
    call escape()
  end subroutine refuse_temperature
end module host_mass_diffusion
