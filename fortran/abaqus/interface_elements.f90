! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> From the arrays of a UEL call to the interface kernels and back.
module abaqus_interface_elements
  use core_kinds, only: dp
  use core_status, only: status_type, ok, sentence
  use core_cells, only: corners_of, is_linear
  use materials_linear_elasticity, only: engineering_constants, plane_stiffness, solid_stiffness, plane_expansion, solid_expansion
  use cohesive_parameters, only: law_parameters, load_cycles
  use cohesive_initial_crack, only: open_crack
  use cohesive_temperature, only: suit_temperature
  use cohesive_law, only: prepare_law
  use elements_bulk_solid, only: solid_type
  use elements_interface_bulk, only: stabilisation_type
  use elements_interface_faces, only: central_frame
  use elements_interface_kernel, only: integrate_interface, interface_forces
  use elements_interface_point, only: interface_options, interface_point
  use abaqus_layout, only: elements, faces, reals, law_properties_of, own_variables, interface_variables, surface_variables, &
    standard, standard_3d, stabilised, next_to_quads, next_to_bricks, o_betan, o_betat, o_gamman, o_gammat, o_temp0_bottom, &
    o_temp0_top, p_thickness, p_blend, p_betan, p_betat, p_gammabot, &
    p_e1_bottom, p_e2_bottom, p_e3_bottom, p_nu12_bottom, p_nu13_bottom, p_nu23_bottom, p_g12_bottom, p_g13_bottom, &
    p_g23_bottom, p_angle_bottom, p_e1_top, p_e2_top, p_e3_top, p_nu12_top, p_nu13_top, p_nu23_top, p_g12_top, p_g13_top, &
    p_g23_top, p_angle_top, p_expansion1_bottom, p_expansion2_bottom, p_expansion3_bottom, p_expansion1_top, p_expansion2_top, &
    p_expansion3_top, p_direction1, p_direction2, p_direction3, p_initialn, p_initials, p_initialt, p_damagejump, &
    j_law, j_integration, j_tangent, j_sampling, j_plane, j_closure, &
    j_formulation_bottom, j_formulation_top, j_cracked, j_pacing, j_fatigue, &
    v_x, v_y, v_sepn, v_sept, v_tn, v_tt, v_damage, v_dissi, v_dissii, v_sn, v_st, v_dmax, v_dissv, v_wn, v_wt, v_dissf, &
    v_maxn, v_maxt, v_spent, v_relsep, v_dddn, v_cycles, w_x, w_y, w_z, w_sepn, w_seps, w_sept, w_tn, w_ts, w_tt, &
    w_damage, w_dissi, w_dissii, w_sn, w_st, w_dmax, w_dissv, w_wn, w_ws, w_wt, w_dissf, w_maxn, w_maxt, w_spent, w_relsep, &
    w_dddn, w_cycles
  use abaqus_properties, only: face_nodes, nodes_of_face, real_position, variables_of_points, by_eigenvalues, complete_closure, &
    paper_closure
  use abaqus_check, only: report_status
  use abaqus_long_elements, only: warn_if_long
  use abaqus_temperatures, only: expands
  use abaqus_raised_beta, only: warn_if_raised
  use abaqus_report, only: fatal
  use abaqus_neighbours, only: stress_of_neighbours
  implicit none(type, external)
  private
  public :: evaluate_interface, interface_forces_at

  !> With PACING, least ratio of VISCOSITY to the next increment. A softening slope -k is stable whatever the structure if the
  !> overstress adds k, a ratio of 1; structures take most of it, and 0.3 is enough in the specimens of fortran/newton.md.
  real(dp), parameter :: least_damping = 0.3_dp
  !> Growth of an increment that needs no limit: Abaqus' own after two easy increments, 1.5, is not more.
  real(dp), parameter :: usual_growth = 1.5_dp
  !> Growth in place of none: only a PNEWDT above 1 counts.
  real(dp), parameter :: no_growth = 1.000001_dp

  !> Damage by the cycles of an increment that DAMAGEJUMP = 0 stands for.
  real(dp), parameter :: usual_jump = 0.02_dp
  !> Share of it at which the next increment aims: the rate of damage changes from one to the next.
  real(dp), parameter :: aim = 0.9_dp

  !> Positions of the variables of a point: vectors by the components (s, n, t), pairs (tau, n).
  type :: point_positions
    integer :: count
    integer :: position(3), jump(3), traction(3), separation(3)
    integer :: stabilisation(2), dissipated(2), largest(2)
    integer :: damage, damage_max, viscous, friction_work, spent, relative, rate, cycles
  end type point_positions

  type(point_positions), parameter :: positions(2:3) = [ &
    point_positions(interface_variables, [v_x, v_y, 0], [v_sept, v_sepn, 0], [v_tt, v_tn, 0], [v_wt, v_wn, 0], &
      [v_st, v_sn], [v_dissii, v_dissi], [v_maxt, v_maxn], v_damage, v_dmax, v_dissv, v_dissf, v_spent, v_relsep, v_dddn, &
      v_cycles), &
    point_positions(surface_variables, [w_x, w_y, w_z], [w_seps, w_sepn, w_sept], [w_ts, w_tn, w_tt], [w_ws, w_wn, w_wt], &
      [w_st, w_sn], [w_dissii, w_dissi], [w_maxt, w_maxn], w_damage, w_dmax, w_dissv, w_dissf, w_spent, w_relsep, &
      w_dddn, w_cycles)]

contains

  !> Evaluates every type but U1 and U9; `good` is false after a message. SVARS and ENERGY come back with their end values:
  !> ENERGY(2) is what the law and, in the
  !> complete form, the gap store, ENERGY(4) what damage and friction have dissipated, ENERGY(5) what the viscous overstress has.
  subroutine evaluate_interface(itype, jelem, values, options, coords, u, temperatures, dtime, cycles, finite, with_tangent, &
    svars, energy, residual, tangent, growth, good)
    integer, intent(in) :: itype, jelem
    real(dp), intent(in) :: values(:)              !< properties by their rows in the layout
    integer, intent(in) :: options(:)
    real(dp), intent(in) :: coords(:, :)           !< (2 or 3, nodes)
    real(dp), intent(in) :: u(:)
    real(dp), intent(in) :: temperatures(:, :)     !< (2, nodes) at the end of the increment, and its change
    real(dp), intent(in) :: dtime
    type(load_cycles), intent(in) :: cycles        !< of the increment
    logical, intent(in) :: finite                  !< large rotations
    logical, intent(in) :: with_tangent
    real(dp), intent(inout) :: svars(*), energy(8)
    real(dp), intent(out) :: residual(:)
    real(dp), contiguous, intent(inout) :: tangent(:, :)   !< zero on entry; it stays so without, but not where a message was sent
    real(dp), intent(out) :: growth                !< largest ratio of the next increment to this one; huge without a limit
    logical, intent(out) :: good
    type(law_parameters) :: law
    type(interface_options) :: choice
    type(stabilisation_type) :: stabilisation
    type(interface_point), dimension(elements(itype)%points) :: old, new
    type(status_type) :: status
    real(dp) :: energies(3), stress(3, 3, elements(itype)%points), original(elements(itype)%dimension, size(coords, 2))
    real(dp) :: thickness
    integer :: nodes(nodes_of_face(itype), 2), n, dim

    growth = huge(growth)
    call prepare_law(options(j_law), law_properties_of(values), law, status)
    law%paced = options(j_pacing) == 1
    law%fatigue = options(j_fatigue) > 0
    law%cycles = cycles
    good = status%code == ok
    if (.not. good) then
      call report_status(itype, jelem, status)
      return
    end if
    call suit_temperature(law, sum(temperatures(1, :))/size(temperatures, 2))
    choice = chosen(itype, values, options, finite)
    stabilisation = stabilisation_of(values, choice%complete)
    dim = elements(itype)%dimension
    original = coords(1:dim, :)
    thickness = thickness_of(itype, values)
    n = elements(itype)%points
    nodes = face_nodes(itype)
    old = points_from(svars, n, dim)
    if (options(j_cracked) == 1) call open_crack(law, old%history)
    select case (elements(itype)%family)
    case (standard, standard_3d)
      call integrate_interface(dim, n, nodes, law, choice, thickness, original, u, dtime, with_tangent, old, new, residual, &
        tangent, energies, status)
    case (next_to_quads, next_to_bricks)
      call stress_of_neighbours(itype, jelem, dim, n, options, choice, original, reshape(u, [dim, size(u)/dim]), stabilisation, &
        stress, good)
      if (.not. good) return
      call integrate_interface(dim, n, nodes, law, choice, thickness, original, u, dtime, with_tangent, old, new, residual, &
        tangent, energies, status, stabilisation, neighbours=stress)
    case default
      call integrate_with_solids(itype, jelem, values, options, law, choice, original, nodes, u, temperatures, dtime, &
        with_tangent, svars(variables_of_points(itype) + 1:variables_of_points(itype) + own_variables), old, new, stabilisation, &
        residual, tangent, energies, status, good)
      if (.not. good) return
    end select
    good = status%code == ok
    if (good) then
      call warn_if_raised(itype, jelem, stabilisation%estimate, stabilisation%beta)
      growth = min(paced_growth(law, dtime, old%history%damage, new%history%damage), &
        jump_growth(values(p_damagejump), maxval(new%history%cycled%grown)))
      call write_state(new, dim, svars)
      energy = 0.0_dp
      energy([2, 4, 5]) = energies
    else
      call report_status(itype, jelem, status)
    end if
  end subroutine evaluate_interface

  !> The kernel of an element with solids of its own; `good` is false after a message.
  subroutine integrate_with_solids(itype, jelem, values, options, law, choice, coordinates, nodes, u, temperatures, dtime, &
    with_tangent, own, old, new, stabilisation, residual, tangent, energies, status, good)
    integer, intent(in) :: itype, jelem
    real(dp), intent(in) :: values(:)                       !< properties by their rows in the layout
    integer, intent(in) :: options(:)
    type(law_parameters), intent(in) :: law
    type(interface_options), intent(in) :: choice
    real(dp), intent(in) :: coordinates(:, :), u(:)
    integer, intent(in) :: nodes(:, :)                      !< of the bottom and the top face, a column each
    real(dp), intent(in) :: temperatures(:, :)              !< (2, nodes) at the end of the increment, and its change
    real(dp), intent(in) :: dtime
    logical, intent(in) :: with_tangent
    real(dp), intent(inout) :: own(own_variables)           !< SVARS of the element
    type(interface_point), intent(in) :: old(:)
    type(interface_point), intent(out) :: new(:)
    type(stabilisation_type), intent(inout) :: stabilisation
    real(dp), intent(out) :: residual(:), energies(3)
    real(dp), contiguous, intent(inout) :: tangent(:, :)
    type(status_type), intent(out) :: status
    logical, intent(out) :: good
    type(engineering_constants) :: materials(2)
    type(solid_type) :: solids(2)
    real(dp) :: initial(2)

    call find_initial(itype, jelem, own, temperatures(1, :) - temperatures(2, :), values, initial, good)
    if (.not. good) return
    materials = materials_of_solids(values)
    call find_solids(itype, jelem, materials, options, choice%direction, coordinates(:, nodes(:, 1)), coordinates(:, nodes(:, 2)), &
      temperatures(1, :), initial, solids, good)
    if (.not. good) return
    ! a crack that is there from the start does not fail, and has no process zone
    if (options(j_cracked) == 0) call warn_if_long(itype, jelem, nodes, coordinates, choice%direction, materials, law, old)
    if (stabilisation%local) call recall(own, stabilisation)
    call integrate_interface(size(coordinates, 1), size(old), nodes, law, choice, thickness_of(itype, values), coordinates, u, &
      dtime, with_tangent, old, new, residual, tangent, energies, status, stabilisation, solids)
    own([o_betat, o_betan]) = stabilisation%beta
    own([o_gammat, o_gamman]) = stabilisation%gamma_bottom
    own([o_temp0_bottom, o_temp0_top]) = initial
  end subroutine integrate_with_solids

  !> Largest ratio of the next increment to this one that PACING asks for where damage grows.
  pure function paced_growth(law, dtime, old, new) result(growth)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: dtime
    real(dp), intent(in) :: old(:), new(:)   !< damage of the points at the ends of the increment
    real(dp) :: growth

    growth = huge(growth)
    if (.not. (law%paced .and. law%viscosity > 0.0_dp .and. dtime > 0.0_dp .and. any(new > old))) return
    if (law%viscosity < usual_growth*least_damping*dtime) growth = max(no_growth, law%viscosity/(least_damping*dtime))
  end function paced_growth

  !> Largest ratio of the next increment to this one that DAMAGEJUMP asks for: below 1, this increment is to be repeated.
  pure function jump_growth(given, grown) result(growth)
    real(dp), intent(in) :: given   !< DAMAGEJUMP
    real(dp), intent(in) :: grown   !< damage by the cycles of the increment, the largest of the points
    real(dp) :: growth
    real(dp) :: most

    growth = huge(growth)
    most = merge(given, usual_jump, given > 0.0_dp)
    if (grown > most) then
      growth = aim*most/grown
    else if (usual_growth*grown > aim*most) then
      growth = max(no_growth, aim*most/grown)
    end if
  end function jump_growth

  !> RHS of the tractions in SVARS, at the displacements to which they belong: of the start of an increment; `good` is false after a
  !> message.
  subroutine interface_forces_at(itype, jelem, values, options, coords, u, temperatures, finite, svars, residual, good)
    integer, intent(in) :: itype, jelem
    real(dp), intent(in) :: values(:)              !< properties by their rows in the layout
    integer, intent(in) :: options(:)
    real(dp), intent(in) :: coords(:, :)           !< (2 or 3, nodes)
    real(dp), intent(in) :: u(:), temperatures(:)  !< temperatures: of the nodes
    logical, intent(in) :: finite                  !< large rotations
    real(dp), intent(in) :: svars(*)
    real(dp), intent(out) :: residual(:)
    logical, intent(out) :: good
    type(interface_options) :: choice
    type(stabilisation_type) :: stabilisation
    type(status_type) :: status
    type(solid_type) :: solids(2)
    real(dp) :: original(elements(itype)%dimension, size(coords, 2))
    integer :: nodes(nodes_of_face(itype), 2)

    choice = chosen(itype, values, options, finite)
    stabilisation = stabilisation_of(values, choice%complete)
    nodes = face_nodes(itype)
    associate (dim => elements(itype)%dimension, points => elements(itype)%points, n => variables_of_points(itype))
      original = coords(1:dim, :)
      good = .true.
      if (choice%complete) then
        call find_solids(itype, jelem, materials_of_solids(values), options, choice%direction, original(:, nodes(:, 1)), &
          original(:, nodes(:, 2)), temperatures, svars(n + [o_temp0_bottom, o_temp0_top]), solids, good)
        if (good) call recall(svars(n + 1:n + own_variables), stabilisation)
        ! before the first increment that is kept there are neither tractions nor displacements
        choice%complete = stabilisation%known
      end if
      if (.not. good) return
      call interface_forces(dim, points, nodes, choice, thickness_of(itype, values), original, u, points_from(svars, points, dim), &
        residual, status, stabilisation, solids)
    end associate
    good = status%code == ok
    if (.not. good) call report_status(itype, jelem, status)
  end subroutine interface_forces_at

  !> Options of the kernel.
  pure function chosen(itype, values, options, finite) result(choice)
    integer, intent(in) :: itype
    real(dp), intent(in) :: values(:)
    integer, intent(in) :: options(:)
    logical, intent(in) :: finite
    type(interface_options) :: choice

    choice = interface_options(options(j_integration), options(j_sampling), options(j_closure) /= paper_closure, &
      options(j_closure) == complete_closure, merge(1.0_dp, values(p_blend), options(j_tangent) == 1), finite, &
      iand(elements(itype)%family, stabilised) == 0, options(j_cracked) == 1, &
      values([p_direction1, p_direction2, p_direction3]), &
      merge([values(p_initialt), values(p_initialn), 0.0_dp], values([p_initials, p_initialn, p_initialt]), &
        elements(itype)%dimension == 2))
  end function chosen

  !> Beta and gamma as the deck has them.
  pure function stabilisation_of(values, complete) result(stabilisation)
    real(dp), intent(in) :: values(:)
    logical, intent(in) :: complete
    type(stabilisation_type) :: stabilisation
    integer, parameter :: betas(2) = [p_betat, p_betan]

    stabilisation = stabilisation_type(max(0.0_dp, values(betas)), values([p_gammabot, p_gammabot]), &
      any(abs(values(betas) - by_eigenvalues) <= 0.0_dp), complete, given=values(betas) > 0.0_dp)
  end function stabilisation_of

  !> Thickness out of the plane; 1 in space.
  pure function thickness_of(itype, values) result(thickness)
    integer, intent(in) :: itype
    real(dp), intent(in) :: values(:)
    real(dp) :: thickness

    thickness = merge(values(p_thickness), 1.0_dp, elements(itype)%dimension == 2)
  end function thickness_of

  !> Takes beta and gamma that an earlier increment has left: the eigenvalue problem takes longer than all the rest, and they do not
  !> change.
  pure subroutine recall(own, stabilisation)
    real(dp), intent(in) :: own(:)
    type(stabilisation_type), intent(inout) :: stabilisation

    stabilisation%known = minval(own([o_betat, o_betan, o_gammat, o_gamman])) > 0.0_dp
    if (.not. stabilisation%known) return
    stabilisation%beta = own([o_betat, o_betan])
    stabilisation%gamma_bottom = own([o_gammat, o_gamman])
  end subroutine recall

  !> Materials of the bottom and the top element of a self-contained interface.
  pure function materials_of_solids(values) result(materials)
    real(dp), intent(in) :: values(:)
    type(engineering_constants) :: materials(2)

    materials = [ &
      engineering_constants(e1=values(p_e1_bottom), e2=values(p_e2_bottom), e3=values(p_e3_bottom), nu12=values(p_nu12_bottom), &
        nu13=values(p_nu13_bottom), nu23=values(p_nu23_bottom), g12=values(p_g12_bottom), angle=values(p_angle_bottom), &
        g13=values(p_g13_bottom), g23=values(p_g23_bottom), &
        expansion=values([p_expansion1_bottom, p_expansion2_bottom, p_expansion3_bottom])), &
      engineering_constants(e1=values(p_e1_top), e2=values(p_e2_top), e3=values(p_e3_top), nu12=values(p_nu12_top), &
        nu13=values(p_nu13_top), nu23=values(p_nu23_top), g12=values(p_g12_top), angle=values(p_angle_top), &
        g13=values(p_g13_top), g23=values(p_g23_top), &
        expansion=values([p_expansion1_top, p_expansion2_top, p_expansion3_top]))]
  end function materials_of_solids

  !> The solids with these materials; `good` is false after a message.
  subroutine find_solids(itype, jelem, materials, options, direction, bottom, top, temperatures, initial, solids, good)
    integer, intent(in) :: itype, jelem
    type(engineering_constants), intent(in) :: materials(2)
    integer, intent(in) :: options(:)
    real(dp), intent(in) :: direction(3)                !< for s, in space; zero: none
    real(dp), intent(in) :: bottom(:, :), top(:, :)     !< original coordinates of the faces
    real(dp), intent(in) :: temperatures(:)             !< of all nodes
    real(dp), intent(in) :: initial(2)                  !< temperatures of the solids
    type(solid_type), intent(out) :: solids(2)
    logical, intent(out) :: good
    integer, parameter :: ratio(2) = [p_nu12_bottom, p_nu12_top], formulation(2) = [j_formulation_bottom, j_formulation_top]
    type(status_type) :: status
    real(dp) :: frame(3, 3)
    integer :: side, at(2)

    if (size(bottom, 1) == 3) then
      call central_frame(size(bottom, 2), bottom, top, direction, frame, status)
      good = status%code == ok
      if (.not. good) then
        call report_status(itype, jelem, status)
        return
      end if
    end if
    do side = 1, 2
      associate (solid => solids(side))
        solid%nodes = faces(itype)%solids(side)
        solid%formulation = options(formulation(side))
        solid%plane = options(j_plane)
        if (size(bottom, 1) == 2) then
          call plane_stiffness(materials(side), solid%plane, solid%stiffness(1:3, 1:3), status)
          solid%expansion(1:3) = plane_expansion(materials(side), solid%plane)
        else
          call solid_stiffness(materials(side), frame, solid%stiffness, status)
          solid%expansion = solid_expansion(materials(side), frame)
        end if
        at = corners_of_solid(itype, side)
        solid%heating(1:at(2) - at(1) + 1) = temperatures(at(1):at(2)) - initial(side)
      end associate
      good = status%code == ok
      if (.not. good) then
        call fatal(itype, jelem, 'PROPS(%I) ' // trim(reals(ratio(side))%name) // ' = %R and its neighbours: ' // &
          trim(sentence(status%code)) // '; %R must be positive', &
          [real_position(itype, ratio(side))], [materials(side)%nu12, status%value])
        return
      end if
    end do
  end subroutine find_solids

  !> First and last corner of the solid on a side among the nodes of the element.
  pure function corners_of_solid(itype, side) result(at)
    integer, intent(in) :: itype, side
    integer :: at(2)

    associate (solids => faces(itype)%solids)
      at(1) = merge(1, 1 + solids(1), side == 1)
      at(2) = at(1) + corners_of(elements(itype)%dimension, solids(side)) - 1
    end associate
  end function corners_of_solid

  !> Initial temperatures of the solids: those that an earlier increment has left or, in the first one, the means of the corners at
  !> its start; `good` is false after a message.
  subroutine find_initial(itype, jelem, own, start, values, initial, good)
    integer, intent(in) :: itype, jelem
    real(dp), intent(in) :: own(:)           !< SVARS of the element
    real(dp), intent(in) :: start(:)         !< temperatures of all nodes at the start of the increment
    real(dp), intent(in) :: values(:)
    real(dp), intent(out) :: initial(2)
    logical, intent(out) :: good
    integer :: side, at(2)

    good = .true.
    initial = own([o_temp0_bottom, o_temp0_top])
    if (own(o_betan) > 0.0_dp) return
    do side = 1, 2
      at = corners_of_solid(itype, side)
      associate (at_corners => start(at(1):at(2)))
        initial(side) = sum(at_corners)/size(at_corners)
        if (is_linear(elements(itype)%dimension, faces(itype)%solids(side)) .or. .not. expands(values)) cycle
        good = maxval(abs(at_corners - initial(side))) <= sqrt(epsilon(1.0_dp))*maxval(abs(at_corners))
        if (good) cycle
        call fatal(itype, jelem, 'initial temperatures from %R to %R at the corners of one of its solids: expected one for ' // &
          'all corners of a solid with midside nodes', [integer ::], [minval(at_corners), maxval(at_corners)])
        return
      end associate
    end do
  end subroutine find_initial

  !> Committed state of n points.
  pure function points_from(svars, n, dim) result(points)
    real(dp), intent(in) :: svars(*)
    integer, intent(in) :: n, dim
    type(interface_point) :: points(n)
    type(point_positions) :: at
    integer :: k, first

    at = positions(dim)
    do k = 1, n
      first = (k - 1)*at%count
      points(k)%history%separation(1:dim) = svars(first + at%separation(1:dim))
      points(k)%traction(1:dim) = svars(first + at%traction(1:dim))
      points(k)%history%damage = svars(first + at%damage)
      points(k)%history%damage_max = svars(first + at%damage_max)
      points(k)%history%dissipated = svars(first + at%dissipated)
      points(k)%history%viscous = svars(first + at%viscous)
      points(k)%history%friction_work = svars(first + at%friction_work)
      points(k)%history%spent = svars(first + at%spent)
      points(k)%history%largest = svars(first + at%largest)
      points(k)%history%cycled%relative = svars(first + at%relative)
      points(k)%history%cycled%cycles = svars(first + at%cycles)
    end do
  end function points_from

  !> Writes the state of the points to SVARS.
  pure subroutine write_state(points, dim, svars)
    type(interface_point), intent(in) :: points(:)
    integer, intent(in) :: dim
    real(dp), intent(inout) :: svars(*)
    type(point_positions) :: at
    integer :: k, first

    at = positions(dim)
    do k = 1, size(points)
      first = (k - 1)*at%count
      svars(first + at%position(1:dim)) = points(k)%position(1:dim)
      svars(first + at%jump(1:dim)) = points(k)%jump(1:dim)
      svars(first + at%traction(1:dim)) = points(k)%traction(1:dim)
      svars(first + at%separation(1:dim)) = points(k)%history%separation(1:dim)
      svars(first + at%stabilisation) = points(k)%stabilisation
      svars(first + at%dissipated) = points(k)%history%dissipated
      svars(first + at%largest) = points(k)%history%largest
      svars(first + at%damage) = points(k)%history%damage
      svars(first + at%damage_max) = points(k)%history%damage_max
      svars(first + at%viscous) = points(k)%history%viscous
      svars(first + at%friction_work) = points(k)%history%friction_work
      svars(first + at%spent) = points(k)%history%spent
      svars(first + at%relative) = points(k)%history%cycled%relative
      svars(first + at%rate) = points(k)%history%cycled%rate
      svars(first + at%cycles) = points(k)%history%cycled%cycles
    end do
  end subroutine write_state

end module abaqus_interface_elements
