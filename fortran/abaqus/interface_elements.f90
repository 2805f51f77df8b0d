! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> From the arrays of a UEL call to the interface kernels and back.
module abaqus_interface_elements
  use core_kinds, only: dp
  use core_status, only: status_type, ok, sentence
  use materials_linear_elasticity, only: engineering_constants, plane_stiffness, solid_stiffness
  use cohesive_parameters, only: law_parameters, bilinear_law, ppr_law
  use cohesive_ppr, only: prepare_ppr
  use elements_interface_bulk, only: stabilisation_type
  use elements_interface_faces, only: central_frame
  use elements_interface_kernel, only: integrate_interface, interface_forces
  use elements_interface_point, only: interface_options, interface_point
  use abaqus_layout, only: elements, faces, reals, own_variables, interface_variables, surface_variables, &
    standard, standard_3d, next_to_quads, next_to_bricks, o_betan, o_betat, o_gamman, o_gammat, &
    p_thickness, p_alphan, p_alphat, p_sigmamax, p_taumax, p_gic, p_giic, p_viscosity, p_eta, p_power, &
    p_shapen, p_shapet, p_blend, p_betan, p_betat, p_gammabot, p_friction, &
    p_e1_bottom, p_e2_bottom, p_e3_bottom, p_nu12_bottom, p_nu13_bottom, p_nu23_bottom, p_g12_bottom, p_g13_bottom, &
    p_g23_bottom, p_angle_bottom, p_e1_top, p_e2_top, p_e3_top, p_nu12_top, p_nu13_top, p_nu23_top, p_g12_top, p_g13_top, &
    p_g23_top, p_angle_top, &
    j_law, j_integration, j_tangent, j_sampling, j_plane, j_closure, &
    v_x, v_y, v_sepn, v_sept, v_tn, v_tt, v_damage, v_dissi, v_dissii, v_sn, v_st, v_dmax, v_dissv, v_wn, v_wt, v_dissf, &
    v_maxn, v_maxt, w_x, w_y, w_z, w_sepn, w_seps, w_sept, w_tn, w_ts, w_tt, w_damage, w_dissi, w_dissii, w_sn, w_st, w_dmax, &
    w_dissv, w_wn, w_ws, w_wt, w_dissf, w_maxn, w_maxt
  use abaqus_properties, only: face_nodes, nodes_of_face, real_position, variables_of_points, by_eigenvalues, complete_closure, &
    paper_closure
  use abaqus_check, only: report_status
  use abaqus_long_elements, only: warn_if_long
  use abaqus_raised_beta, only: warn_if_raised
  use abaqus_report, only: fatal
  use abaqus_neighbours, only: stress_of_neighbours
  implicit none(type, external)
  private
  public :: evaluate_interface, interface_forces_at

  !> Positions of the variables of a point: vectors by the components (s, n, t), pairs (tau, n).
  type :: point_positions
    integer :: count
    integer :: position(3), jump(3), traction(3), separation(3)
    integer :: stabilisation(2), dissipated(2), largest(2)
    integer :: damage, damage_max, viscous, friction_work
  end type point_positions

  type(point_positions), parameter :: positions(2:3) = [ &
    point_positions(interface_variables, [v_x, v_y, 0], [v_sept, v_sepn, 0], [v_tt, v_tn, 0], [v_wt, v_wn, 0], &
      [v_st, v_sn], [v_dissii, v_dissi], [v_maxt, v_maxn], v_damage, v_dmax, v_dissv, v_dissf), &
    point_positions(surface_variables, [w_x, w_y, w_z], [w_seps, w_sepn, w_sept], [w_ts, w_tn, w_tt], [w_ws, w_wn, w_wt], &
      [w_st, w_sn], [w_dissii, w_dissi], [w_maxt, w_maxn], w_damage, w_dmax, w_dissv, w_dissf)]

contains

  !> Evaluates every type but U1 and U9; `good` is false after a message. SVARS and ENERGY come back with their end values:
  !> ENERGY(2) is what the law and, in the
  !> complete form, the gap store, ENERGY(4) what damage and friction have dissipated, ENERGY(5) what the viscous overstress has.
  subroutine evaluate_interface(jtype, jelem, values, options, coords, u, dtime, finite, with_tangent, svars, energy, residual, &
    tangent, good)
    integer, intent(in) :: jtype, jelem
    real(dp), intent(in) :: values(:)              !< properties by their rows in the layout
    integer, intent(in) :: options(:)
    real(dp), intent(in) :: coords(:, :)           !< (2 or 3, nodes)
    real(dp), intent(in) :: u(:)
    real(dp), intent(in) :: dtime
    logical, intent(in) :: finite                  !< large rotations
    logical, intent(in) :: with_tangent            !< else it is zero
    real(dp), intent(inout) :: svars(*), energy(8)
    real(dp), intent(out) :: residual(:), tangent(:, :)
    logical, intent(out) :: good
    type(law_parameters) :: law
    type(interface_options) :: choice
    type(stabilisation_type) :: stabilisation
    type(interface_point), dimension(elements(jtype)%points) :: old, new
    type(engineering_constants) :: materials(2)
    type(status_type) :: status
    real(dp) :: energies(3), stress(3, 3, elements(jtype)%points), original(elements(jtype)%dimension, size(coords, 2))
    real(dp), dimension(3*(elements(jtype)%dimension - 1), 3*(elements(jtype)%dimension - 1), 2) :: stiffness
    real(dp) :: thickness
    integer :: nodes(nodes_of_face(jtype), 2), n, dim

    call prepare_law(values, options, law, status)
    good = status%code == ok
    if (.not. good) then
      call report_status(jtype, jelem, status)
      return
    end if
    choice = chosen(values, options, finite)
    stabilisation = stabilisation_of(values, choice%complete)
    dim = elements(jtype)%dimension
    original = coords(1:dim, :)
    thickness = thickness_of(jtype, values)
    n = elements(jtype)%points
    nodes = face_nodes(jtype)
    old = points_from(svars, n, dim)
    associate (solid => faces(jtype)%solid)
      select case (elements(jtype)%family)
      case (standard, standard_3d)
        call integrate_interface(dim, n, nodes, solid, law, choice, thickness, original, u, dtime, with_tangent, old, new, &
          residual, tangent, energies, status)
      case (next_to_quads, next_to_bricks)
        call stress_of_neighbours(jtype, jelem, dim, n, options, choice, original, reshape(u, [dim, size(u)/dim]), stabilisation, &
          stress, good)
        if (.not. good) return
        call integrate_interface(dim, n, nodes, solid, law, choice, thickness, original, u, dtime, with_tangent, old, new, &
          residual, tangent, energies, status, stabilisation, neighbours=stress)
      case default
        materials = materials_of_solids(values)
        call elasticity_of_solids(jtype, jelem, materials, options(j_plane), original(:, nodes(:, 1)), original(:, nodes(:, 2)), &
          stiffness, good)
        if (.not. good) return
        call warn_if_long(jtype, jelem, nodes, original, materials, law, old)
        associate (own => svars(variables_of_points(jtype) + 1:variables_of_points(jtype) + own_variables))
          if (stabilisation%local) call recall(own, stabilisation)
          call integrate_interface(dim, n, nodes, solid, law, choice, thickness, original, u, dtime, with_tangent, old, new, &
            residual, tangent, energies, status, stabilisation, stiffness)
          own([o_betat, o_betan]) = stabilisation%beta
          own([o_gammat, o_gamman]) = stabilisation%gamma_bottom
        end associate
      end select
    end associate
    good = status%code == ok
    if (good) then
      call warn_if_raised(jtype, jelem, stabilisation%estimate, stabilisation%beta)
      call write_state(new, dim, svars)
      energy = 0.0_dp
      energy([2, 4, 5]) = energies
    else
      call report_status(jtype, jelem, status)
    end if
  end subroutine evaluate_interface

  !> RHS of the tractions in SVARS, at the displacements to which they belong: of the start of an increment; `good` is false after a
  !> message.
  subroutine interface_forces_at(jtype, jelem, values, options, coords, u, finite, svars, residual, good)
    integer, intent(in) :: jtype, jelem
    real(dp), intent(in) :: values(:)              !< properties by their rows in the layout
    integer, intent(in) :: options(:)
    real(dp), intent(in) :: coords(:, :)           !< (2 or 3, nodes)
    real(dp), intent(in) :: u(:)
    logical, intent(in) :: finite                  !< large rotations
    real(dp), intent(in) :: svars(*)
    real(dp), intent(out) :: residual(:)
    logical, intent(out) :: good
    type(interface_options) :: choice
    type(stabilisation_type) :: stabilisation
    type(status_type) :: status
    real(dp), dimension(3*(elements(jtype)%dimension - 1), 3*(elements(jtype)%dimension - 1), 2) :: stiffness
    real(dp) :: original(elements(jtype)%dimension, size(coords, 2))
    integer :: nodes(nodes_of_face(jtype), 2)

    choice = chosen(values, options, finite)
    stabilisation = stabilisation_of(values, choice%complete)
    nodes = face_nodes(jtype)
    associate (dim => elements(jtype)%dimension, points => elements(jtype)%points, n => variables_of_points(jtype))
      original = coords(1:dim, :)
      good = .true.
      if (choice%complete) then
        call elasticity_of_solids(jtype, jelem, materials_of_solids(values), options(j_plane), original(:, nodes(:, 1)), &
          original(:, nodes(:, 2)), stiffness, good)
        if (good) call recall(svars(n + 1:n + own_variables), stabilisation)
        ! before the first increment that is kept there are neither tractions nor displacements
        choice%complete = stabilisation%known
      end if
      if (.not. good) return
      call interface_forces(dim, points, nodes, faces(jtype)%solid, choice, thickness_of(jtype, values), original, u, &
        points_from(svars, points, dim), residual, status, stabilisation, stiffness)
    end associate
    good = status%code == ok
    if (.not. good) call report_status(jtype, jelem, status)
  end subroutine interface_forces_at

  !> Options of the kernel.
  pure function chosen(values, options, finite) result(choice)
    real(dp), intent(in) :: values(:)
    integer, intent(in) :: options(:)
    logical, intent(in) :: finite
    type(interface_options) :: choice

    choice = interface_options(options(j_integration), options(j_sampling), options(j_closure) /= paper_closure, &
      options(j_closure) == complete_closure, merge(1.0_dp, values(p_blend), options(j_tangent) == 1), finite)
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
  pure function thickness_of(jtype, values) result(thickness)
    integer, intent(in) :: jtype
    real(dp), intent(in) :: values(:)
    real(dp) :: thickness

    thickness = merge(values(p_thickness), 1.0_dp, elements(jtype)%dimension == 2)
  end function thickness_of

  !> Takes beta and gamma that an earlier increment has left: the eigenvalue problem takes longer than all the rest, and they do not
  !> change.
  pure subroutine recall(own, stabilisation)
    real(dp), intent(in) :: own(:)
    type(stabilisation_type), intent(inout) :: stabilisation

    stabilisation%known = minval(own) > 0.0_dp
    if (.not. stabilisation%known) return
    stabilisation%beta = own([o_betat, o_betan])
    stabilisation%gamma_bottom = own([o_gammat, o_gamman])
  end subroutine recall

  !> The cohesive law; an initial stiffness of 0 stands for an infinite one.
  pure subroutine prepare_law(values, options, law, status)
    real(dp), intent(in) :: values(:)
    integer, intent(in) :: options(:)
    type(law_parameters), intent(out) :: law
    type(status_type), intent(out) :: status

    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    law%kind = options(j_law)
    law%flexibility = 0.0_dp
    law%ratio = 1.0_dp
    if (values(p_alphan) > 0.0_dp) then
      law%flexibility = 1.0_dp/values(p_alphan)
      law%ratio = [values(p_alphat)/values(p_alphan), 1.0_dp]
    end if
    law%strength = [values(p_taumax), values(p_sigmamax)]
    law%toughness = [values(p_giic), values(p_gic)]
    law%viscosity = values(p_viscosity)
    law%friction = values(p_friction)
    if (law%kind == bilinear_law) return
    if (law%kind == ppr_law) then
      if (values(p_shapet) > 0.0_dp) law%shape(1) = values(p_shapet)
      if (values(p_shapen) > 0.0_dp) law%shape(2) = values(p_shapen)
      call prepare_ppr(law, status)
      return
    end if
    law%eta = values(p_eta)
    if (values(p_power) > 0.0_dp) law%power = values(p_power)
  end subroutine prepare_law

  !> Materials of the bottom and the top element of a self-contained interface.
  pure function materials_of_solids(values) result(materials)
    real(dp), intent(in) :: values(:)
    type(engineering_constants) :: materials(2)

    materials = [ &
      engineering_constants(e1=values(p_e1_bottom), e2=values(p_e2_bottom), e3=values(p_e3_bottom), nu12=values(p_nu12_bottom), &
        nu13=values(p_nu13_bottom), nu23=values(p_nu23_bottom), g12=values(p_g12_bottom), angle=values(p_angle_bottom), &
        g13=values(p_g13_bottom), g23=values(p_g23_bottom)), &
      engineering_constants(e1=values(p_e1_top), e2=values(p_e2_top), e3=values(p_e3_top), nu12=values(p_nu12_top), &
        nu13=values(p_nu13_top), nu23=values(p_nu23_top), g12=values(p_g12_top), angle=values(p_angle_top), &
        g13=values(p_g13_top), g23=values(p_g23_top))]
  end function materials_of_solids

  !> Their stiffness; `good` is false after a message.
  subroutine elasticity_of_solids(jtype, jelem, materials, plane, bottom, top, stiffness, good)
    integer, intent(in) :: jtype, jelem
    type(engineering_constants), intent(in) :: materials(2)
    integer, intent(in) :: plane
    real(dp), intent(in) :: bottom(:, :), top(:, :)     !< original coordinates of the faces
    real(dp), intent(out) :: stiffness(:, :, :)
    logical, intent(out) :: good
    integer, parameter :: ratio(2) = [p_nu12_bottom, p_nu12_top]
    type(status_type) :: status
    integer :: side

    do side = 1, 2
      if (size(bottom, 1) == 2) then
        call plane_stiffness(materials(side), plane, stiffness(:, :, side), status)
      else
        call solid_stiffness(materials(side), central_frame(size(bottom, 2), bottom, top), stiffness(:, :, side), status)
      end if
      good = status%code == ok
      if (.not. good) then
        call fatal(jtype, jelem, 'PROPS(%I) ' // trim(reals(ratio(side))%name) // ' = %R and its neighbours: ' // &
          trim(sentence(status%code)) // '; %R must be positive', &
          [real_position(jtype, ratio(side))], [materials(side)%nu12, status%value])
        return
      end if
    end do
  end subroutine elasticity_of_solids

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
      points(k)%history%largest = svars(first + at%largest)
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
    end do
  end subroutine write_state

end module abaqus_interface_elements
