! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in continuum elements (CPS, CPE, CAX, C3D) as a procedure with the arguments of UELMAT. harness/uel/model/element_types.py
!> lists the types.
!>
!> JPROPS: family of the element (host_shape), integration points, direct strains (host_kinematics), enhanced hourglass
!> control, integration points of the mass. CPE4, CAX4 and C3D8 replace the volume strain of the points by its mean over the
!> element, as Abaqus does. CPS4R, CPE4R, CAX4R and C3D8R have the uniform strain and hourglass control (host_hourglass):
!> enhanced where JPROPS(4) is not zero, else with the stiffness parameter PROPS(3). JPROPS(4) is 1 if the material knows its
!> moduli, 2 if they are those of its first tangent. JPROPS(6) is the number of incompatible modes (host_incompatible), JPROPS(7)
!> that of the functions of the pressure of hybrid elements (host_hybrid): if the element has more unknowns than its nodes have
!> displacements, the others are its pressure. PROPS(1) is the thickness, of axisymmetric elements the angle 2 pi; PROPS(2) is
!> the density.
!>
!> Large displacements: Cauchy stress, rotated and updated increment by increment with the strain and the rotation at the middle of
!> the increment (Jaumann rate; Hughes and Winget). The tangent leaves out the change of the volume and of the middle of the
!> increment. Incompatible modes are part of the deformation gradient (host_incompatible).
!>
!> Generalised plane strain (host_planes): the planes come with the call, three unknowns of theirs behind those of the nodes.
!>
!> Hyperelastic materials take their stress from the deformation gradient, divided by the stretch of *EXPANSION, the same in all
!> directions (Analysis User's Guide, Hyperelastic behavior of rubberlike materials). Forces are derivatives of the energy, the
!> tangent those of the forces (host_mean_volume); where the volume strain is the mean, the points share the change of the volume.
!>
!> The matrix of a stress (host_context) is what the tangent in large displacements has of it, also where displacements are small.
!>
!> With layers JPROPS(1) is a family with the points of all layers (host_shape), and material, NPT, LAYER and KSPT of each point
!> follow; MATERIALLIB is the material of the first layer. Then all materials are in the directions of the points.
!>
!> The last of the predefined fields is the initial temperature; thermal strain is that of *EXPANSION since then.
!>
!> SVARS hold, for each point, E11 E22 E33 E12 S11 S22 S33 S12, in space with 13 and 23 after 12, in the directions of
!> *ORIENTATION where the section has one, as Abaqus prints them; in dynamic analyses then the forces of the last two
!> increments; then the directions of each point, if the material is in them (host_axes); last the incompatible modes, or the
!> moduli of the first tangent.
module host_solid
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_loc
  use core_mode_search, only: find_modes, mode_search, most_passes
  use core_rotation, only: about_mean
  use core_small_matrix, only: invert_general
  use core_strains, only: condense
  use host_axes, only: carry_axes, turn_heat, turn_matrix, values_of_axes
  use host_context, only: added_stress, current, initial_stresses, stress_matrix
  use host_coupling, only: add_heat_source, add_thermal_strain, coupling_t, find_shape, interpolate_fields, set_temperature, &
                           shares, thermal_strain
  use host_forces, only: add_axisymmetric_point, add_geometric, add_plane_point, add_space_point, add_stress_matrix, by_volume
  use host_gradients, only: all_gradients, carry, find_deformation, gradient_of, gradients_of_points
  use host_hybrid, only: add_compatibility, begin_pressure, begin_smoothing, keep_point, keep_temperature, mean_response_t, &
                         mean_stress, mean_stress_added, pressure_t, smooth, smooth_by_temperature, smoothing_change, &
                         smoothing_t
  use host_hourglass, only: resist_hourglass
  use host_hyperelastic, only: volume_of
  use host_incompatible, only: add_by_modes, begin_modes, enhance, enhanced_strains, gradient_in_the_middle, modes_t
  use host_inertia, only: is_dynamic, mass_matrix, respond
  use host_initial_stress, only: begin_point
  use host_kinds, only: dp, i4
  use host_kinematics, only: components, gradients, mean_gradients, point_position, rotated, rotation_of, size_of
  use host_mean_volume, only: add_curvature, add_mean_volume, add_uniform_volume
  use host_planes, only: add_curvature_of_fibres, add_stress_of_fibres, planes, planes_t
  use host_materials, only: elastic_bulk_modulus, elastic_energy, find_material, has_fields, has_heat_terms, is_viscous, &
                            material_t, needs_deformation, not_solved, set_constants, stress_update, thickness_strain
  use host_point, only: heat_t, move_to, point_t
  use host_shape, only: is_multilinear, rule_of, rule_t
  use host_thermal, only: call_hetval
  use host_usdfld, only: call_usdfld
  implicit none (type, external)
  private
  public :: solid_uelmat, solid_element, values_of_point

  integer, parameter :: head = 7    !< values of JPROPS before those of layers
  !> Share of the coordinates that counts as displacement in large displacements: the deformation gradient is rounded to 1e-16 of
  !> one, and forces on modes that come from strains of 1e-15 are none (find_modes has the square root of its limit, 1e-10).
  real(dp), parameter :: rounded = 1e-5_dp

contains

  subroutine solid_uelmat(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                          v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                          lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period, materiallib)
    integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                   lflags(*), mlvarx, mdload, jprops(*), njprop, materiallib
    real(dp) :: rhs(*), amatrx(*), svars(*), energy(*), props(*), coords(*), u(*), du(*), v(*), a(*), time(*), dtime, &
                params(*), adlmag(*), predef(*), ddlmag(*), pnewdt, period
    if (njprop > head) then
      call solid_element(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, coords, mcrd, nnode, u, du, v, a, params, dtime, &
                         predef, npredf, lflags, jprops, materiallib, layers=reshape(jprops(head + 1:njprop), [4, int(jprops(2))]))
    else
      call solid_element(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, coords, mcrd, nnode, u, du, v, a, params, dtime, &
                         predef, npredf, lflags, jprops, materiallib)
    end if
  end subroutine solid_uelmat

  !> The same without the unused arguments; coupling: if the element also has temperatures; layers: material, NPT, LAYER and KSPT
  !> of each point, if there are any; bounds: if the element is between two planes.
  subroutine solid_element(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, coords, mcrd, nnode, u, du, v, a, params, &
                           dtime, predef, npredf, lflags, jprops, materiallib, coupling, layers, bounds)
    integer(i4) :: ndofel, nrhs, nsvars, mcrd, nnode, npredf, lflags(*), jprops(*), materiallib
    real(dp) :: rhs(*), amatrx(*), energy(*), props(*), coords(*), u(*), du(*), v(*), a(*), params(*), dtime, predef(*)
    real(dp), target :: svars(*)
    type(coupling_t), intent(inout), optional :: coupling
    integer(i4), intent(in), optional :: layers(:, :)
    type(planes_t), intent(in), optional :: bounds
    type(material_t), pointer :: material
    type(rule_t), pointer :: rule
    type(planes_t) :: moved
    real(dp), pointer, contiguous :: axes(:, :, :, :)   !< of the points (host_axes), if the material is in them
    real(dp), pointer, contiguous :: moduli(:)          !< of the first tangent, if the hourglass control has them
    real(dp) :: mass(ndofel, ndofel), old(ndofel, 2), at_nodes(mcrd*nnode, mcrd*nnode), change(ndofel)
    integer :: dim, direct, first, last, modes, n, behind, of_nodes
    rule => rule_of(int(jprops(1)), int(jprops(2)))
    dim = rule%dim
    direct = jprops(3)
    modes = jprops(6)
    n = ndofel
    of_nodes = dim*rule%nodes
    material => find_material(materiallib)
    first = rule%points*values_of_point(dim) + 1
    last = first + 2*n - 1
    behind = nsvars - modes + 1
    moduli => null()
    if (jprops(4) == 2) then
      behind = behind - 2
      call c_f_pointer(c_loc(svars(behind)), moduli, [2])
    end if
    axes => null()
    if (material%local) then
      behind = behind - values_of_axes*rule%points
      call c_f_pointer(c_loc(svars(behind)), axes, [3, 3, 2, rule%points])
    end if
    old = 0
    if (behind > last) old = reshape(svars(first:last), [n, 2])
    if (any(lflags(3) == [4, 6]) .or. is_dynamic(lflags(1))) then
      call mass_matrix(rule_of(int(jprops(1)), int(jprops(5))), direct > dim, props(2)*merge(props(1), 1.0_dp, dim == 2), &
                       coords, at_nodes)
      mass = 0
      mass(:of_nodes, :of_nodes) = at_nodes
    end if
    rhs(1:n*nrhs) = 0
    amatrx(1:n*n) = 0
    if (lflags(3) /= 3 .and. lflags(3) /= 4) then
      ! no time passes where the matrix of a stress is asked for: DU is a perturbation
      change = du(:n)
      if (stress_matrix(lflags(3))) change = 0
      if (modes > 0) then
        call integrate_with_modes(rule, direct + 2*dim - 3, modes, lflags(3), lflags(2) /= 0, material, props(1), coords, &
                                  int(npredf), predef, u, change, du, rhs, amatrx, svars, &
                                  svars(nsvars - modes + 1:nsvars), energy, axes, int(jprops(7)), layers)
      else if (present(bounds)) then
        moved = bounds
        moved%w = u(of_nodes + 1:n)
        moved%dw = change(of_nodes + 1:)
        call integrate(rule, 3, 4, planes, lflags(3), lflags(2) /= 0, material, props(1), props(3), jprops(4) /= 0, coords, &
                       int(npredf), predef, u, change, rhs, amatrx, svars, energy, axes=axes, functions=int(jprops(7)), &
                       added=du(:n), moduli=moduli, bounds=moved)
      else if (n > of_nodes .and. .not. present(coupling)) then
        call integrate_with_pressure(rule, direct, n, lflags(3), lflags(2) /= 0, material, props(1), props(3), jprops(4) /= 0, &
                                     coords, int(npredf), predef, u, change, du, rhs, amatrx, svars, energy, axes)
      else
        call integrate(rule, direct, direct + 2*dim - 3, modes, lflags(3), lflags(2) /= 0, material, &
                       props(1), props(3), jprops(4) /= 0, coords, int(npredf), predef, u, change, rhs, amatrx, svars, energy, &
                       coupling, axes=axes, functions=int(jprops(7)), added=du(:of_nodes), moduli=moduli, layers=layers)
      end if
    end if
    call respond(n, lflags, params, dtime, v, a, mass, old, rhs, amatrx, energy(1))
    if (behind > last) svars(first:last) = reshape(old, [2*n])
  end subroutine solid_element

  !> Strains and stresses that SVARS hold for a point.
  pure integer function values_of_point(dim)
    integer, intent(in) :: dim
    values_of_point = merge(8, 12, dim == 2)
  end function values_of_point

  !> The same with incompatible modes: they are sought at the displacements of the nodes. The matrix of a stress is that of all
  !> unknowns where the modes follow the displacements as the tangent has them.
  subroutine integrate_with_modes(rule, strains, modes, request, finite, material, thickness, x, fields, predef, u, du, added, &
                                  force, stiffness, svars, alpha, energy, axes, functions, layers)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: strains, modes, fields
    integer(i4), intent(in) :: request   !< LFLAGS(3)
    logical, intent(in) :: finite
    type(material_t), intent(inout) :: material
    real(dp), intent(in) :: thickness, predef(2, fields, rule%nodes)
    real(dp), dimension(rule%dim*rule%nodes), intent(in) :: x, u, du, added   !< added: the perturbation
    real(dp), intent(inout) :: force(rule%dim*rule%nodes), stiffness(rule%dim*rule%nodes, rule%dim*rule%nodes)
    real(dp), intent(inout) :: svars(values_of_point(rule%dim)*rule%points), alpha(modes), energy(8)
    real(dp), intent(inout), optional :: axes(3, 3, 2, rule%points)
    integer, intent(in) :: functions     !< of the pressure, on which the mean stress is projected
    integer(i4), intent(in), optional :: layers(:, :)
    real(dp), dimension(rule%dim*rule%nodes + modes) :: all_force
    real(dp), dimension(rule%dim*rule%nodes + modes, rule%dim*rule%nodes + modes) :: all_stiffness
    real(dp) :: exact(modes, modes)          !< what the stiffness leaves out of the modes' own
    real(dp) :: inverse(modes, modes), svars_start(size(svars)), energy_start(8), follow(modes, rule%dim*rule%nodes)
    real(dp), allocatable :: axes_start(:, :, :, :)
    real(dp) :: unknowns(rule%dim*rule%nodes + modes), all_work, pnewdt
    type(modes_t) :: enhanced
    type(mode_search) :: search
    integer :: pass, n
    logical :: settled, good
    n = size(force)
    call begin_modes(enhanced, rule, strains, x, alpha)
    svars_start = svars
    energy_start = energy
    if (present(axes)) axes_start = axes
    pnewdt = current%pnewdt
    do pass = 1, most_passes
      svars = svars_start
      energy = energy_start
      if (present(axes)) axes = axes_start
      current%pnewdt = pnewdt
      enhanced%now = alpha
      all_force = 0
      all_stiffness = 0
      exact = 0
      call integrate(rule, rule%dim, strains, modes, merge(request, 1_i4, request == initial_stresses), finite, material, &
                     thickness, 0.0_dp, .false., x, fields, predef, u, du, all_force, all_stiffness, svars, energy, &
                     modes=enhanced, exact=exact, axes=axes, functions=functions, layers=layers)
      if (request == initial_stresses) then
        force = all_force(:n)
        return
      end if
      ! stresses at rest, thermal or initial, do none: there it is that of the nodal forces where nothing holds the nodes
      unknowns = abs([about_mean(rule%dim, u), alpha])
      if (finite) unknowns(:n) = unknowns(:n) + rounded*abs(about_mean(rule%dim, x))
      all_work = dot_product(unknowns, matmul(abs(all_stiffness), unknowns)) + &
                 sum(all_force(:n)**2)/max(maxval(abs(all_stiffness)), tiny(1.0_dp))
      exact = exact + all_stiffness(n + 1:, n + 1:)
      call find_modes(search, all_force(n + 1:), exact, all_work, alpha, inverse, settled, good)
      if (settled .or. .not. good) exit
    end do
    if (.not. (settled .and. good)) call not_solved('the incompatible modes are not in equilibrium')
    ! with what the stiffness has, so that the tangent is of one kind
    if (good) call invert_general(all_stiffness(n + 1:, n + 1:), inverse, good)
    call condense(n, inverse, all_force, all_stiffness, force, stiffness)
    if (.not. stress_matrix(request)) return
    follow = -matmul(inverse, all_stiffness(n + 1:, :n))
    all_stiffness = 0
    call integrate(rule, rule%dim, strains, modes, request, finite, material, thickness, 0.0_dp, .false., x, fields, predef, u, &
                   du, all_force, all_stiffness, svars, energy, modes=enhanced, axes=axes, functions=functions, &
                   added=[added, matmul(follow, added)], layers=layers)
    associate (across => matmul(all_stiffness(:n, n + 1:), follow))
      stiffness = all_stiffness(:n, :n) + across + transpose(across) + &
                  matmul(transpose(follow), matmul(all_stiffness(n + 1:, n + 1:), follow))
    end associate
  end subroutine integrate_with_modes

  !> The same with a pressure (host_hybrid), whose unknowns come after those of the nodes.
  subroutine integrate_with_pressure(rule, direct, n, request, finite, material, thickness, hourglass, enhanced, x, fields, &
                                     predef, u, du, added, force, stiffness, svars, energy, axes)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: direct, n, fields
    integer(i4), intent(in) :: request   !< LFLAGS(3)
    logical, intent(in) :: finite, enhanced
    type(material_t), intent(inout) :: material
    real(dp), intent(in) :: thickness, hourglass, predef(2, fields, rule%nodes)
    real(dp), intent(in) :: x(rule%dim*rule%nodes), u(n), du(n), added(n)   !< added: the perturbation
    real(dp), intent(inout) :: force(n), stiffness(n, n)
    real(dp), intent(inout) :: svars(values_of_point(rule%dim)*rule%points), energy(8)
    real(dp), intent(inout), optional :: axes(3, 3, 2, rule%points)
    real(dp) :: by_nodes(rule%dim*rule%nodes, rule%dim*rule%nodes)
    type(pressure_t) :: pressure
    integer :: m
    m = rule%dim*rule%nodes
    by_nodes = 0
    pressure%factors = u(m + 1:)
    pressure%added = added(m + 1:)
    call integrate(rule, direct, direct + 2*rule%dim - 3, 0, request, finite, material, thickness, hourglass, enhanced, x, &
                   fields, predef, u(:m), du(:m), force(:m), by_nodes, svars, energy, axes=axes, pressure=pressure, &
                   added=added(:m))
    force(m + 1:) = pressure%residual
    stiffness(:m, :m) = by_nodes
    if (stress_matrix(request)) return
    stiffness(:m, m + 1:) = pressure%by_displacements
    stiffness(m + 1:, :m) = transpose(pressure%by_displacements)
    stiffness(m + 1:, m + 1:) = pressure%by_factors
  end subroutine integrate_with_pressure

  !> Force, tangent, state and energies; of the initial stresses without a tangent; or the matrix of a stress. The unknowns are
  !> those of the nodes, then others: incompatible modes, or those of two planes.
  subroutine integrate(rule, direct, strains, others, request, finite, material, thickness, hourglass, enhanced, x, fields, &
                       predef, u, du, force, stiffness, svars, energy, coupling, modes, exact, axes, functions, &
                       pressure, added, moduli, layers, bounds)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: direct, strains, others, fields
    integer(i4), intent(in) :: request   !< LFLAGS(3)
    logical, intent(in) :: finite, enhanced
    type(material_t), intent(inout), target :: material    !< of the first layer
    real(dp), intent(in) :: thickness, hourglass, predef(2, fields, rule%nodes)
    real(dp), dimension(rule%dim, rule%nodes), intent(in) :: x, u, du
    real(dp), dimension(rule%dim*rule%nodes + others), intent(inout) :: force
    real(dp), dimension(rule%dim*rule%nodes + others, rule%dim*rule%nodes + others), intent(inout) :: stiffness
    real(dp), intent(inout) :: svars(values_of_point(rule%dim), rule%points), energy(8)
    type(coupling_t), intent(inout), optional :: coupling
    type(modes_t), intent(in), optional :: modes
    real(dp), intent(inout), optional :: exact(others, others)     !< stiffness of the modes by which the tangent is not exact
    real(dp), intent(inout), optional :: axes(3, 3, 2, rule%points)   !< of the points (host_axes), if the material is in them
    integer, intent(in), optional :: functions                 !< of the pressure, on which the mean stress is projected
    type(pressure_t), intent(inout), optional :: pressure      !< with the unknowns; then there is no initial stress
    real(dp), intent(in), optional :: added(rule%dim*rule%nodes + others)   !< perturbation, whose stress may be asked for
    real(dp), intent(inout), optional :: moduli(2)    !< of the enhanced hourglass control, zero until the first tangent is known
    integer(i4), intent(in), optional :: layers(:, :)
    type(planes_t), intent(in), optional :: bounds
    type(material_t), pointer :: here    !< material of the point
    real(dp) :: ratio(rule%points), by_planes(planes, rule%points), by_planes_mid(planes, rule%points), w(planes)
    real(dp), dimension(rule%nodes, direct, rule%points) :: g, g_mid, g_before
    real(dp), dimension(rule%dim*rule%nodes, strains, rule%points) :: b, b_mid
    real(dp), allocatable :: g_modes(:, :, :)   !< as g, of the nodes and the modes that act like nodes
    real(dp), dimension(rule%points) :: volume, volume_mid, volume_now, volume_before
    real(dp) :: stresses(strains, rule%points)
    real(dp) :: by_unknowns(rule%dim*rule%nodes + others, strains)
    real(dp) :: tangent(strains, strains)    !< mean of all points, for the hourglass control
    real(dp) :: now(rule%dim, rule%nodes), g_start(rule%nodes, direct), volume_start, deformation(3, 3, 2, rule%points)
    real(dp) :: strain(strains), stress(strains), modulus(strains, strains), thermal(6, 2), weight, elastic, work, flowed
    real(dp) :: now_axes(3, 3), middle(3, 3), gradient(3, 3), rate(6), by_temperature(strains + 1), expanded
    real(dp), allocatable :: by_corners(:)
    real(dp) :: weights(rule%points)
    logical :: averaged, begins, of_stress, smoothed
    type(smoothing_t) :: smoothing
    type(mean_response_t) :: mean
    type(point_t) :: point
    integer :: dim, nodes, n, flat, p, dissipated
    dim = rule%dim
    nodes = rule%nodes
    n = dim*nodes
    ! direct strains by the displacements of the nodes where x is their place
    flat = merge(dim, direct, present(bounds))
    begins = request == initial_stresses
    of_stress = stress_matrix(request)
    ! full integration of elements with straight edges locks if the volume is preserved, but not in plane stress; modes see to it
    averaged = rule%points > 1 .and. is_multilinear(rule) .and. material%ntens /= 3 .and. .not. present(modes)
    averaged = averaged .and. .not. (present(pressure) .or. rule%reduced)
    smoothed = .false.
    if (present(functions)) then
      smoothed = functions > 0 .and. rule%points > 1 .and. .not. begins
      averaged = averaged .and. functions == 0
    end if
    now = x
    if (finite) now = x + u
    ! the first pass of an analysis, without displacements, sees the initial shape
    current%deformed = finite .and. any(abs(u) > 0)
    w = 0
    if (present(bounds) .and. finite) w = bounds%w
    if (present(modes)) then
      allocate (g_modes(nodes + dim, dim, rule%points))
      call gradients_of_points(rule, dim, x, g, volume)
      g_modes(:nodes, :, :) = g
      g_modes(nodes + 1:, :, :) = modes%gradient
      volume_before = volume
      if (finite) call enhance(modes, rule, u, du, g_modes, volume, deformation)
    else
      call all_gradients(rule, direct, strains, averaged, now, g, b, volume, bounds, w, ratio, by_planes)
    end if
    if (finite .and. .not. present(modes)) then
      if (present(bounds)) w = bounds%w - 0.5_dp*bounds%dw
      call all_gradients(rule, direct, strains, averaged, now - 0.5_dp*du, g_mid, b_mid, volume_mid, bounds, w, &
                         by_planes=by_planes_mid)
    end if
    g_start = g(:, :, 1)
    volume_start = volume(1)
    if (rule%reduced .and. finite) then
      g_before = 0
      call gradients_of_points(rule, flat, x, g_before(:, :flat, :), volume_before)
      g_start = g_before(:, :, 1)
      volume_start = volume_before(1)
      if (flat == 3) then
        do p = 1, rule%points
          call carry(dim, direct, strains, nodes, g_before(:, :, p), u, g(:, :, p), b(:, :, p))
          call carry(dim, direct, strains, nodes, g_before(:, :, p), u - 0.5_dp*du, g_mid(:, :, p), b_mid(:, :, p))
        end do
      end if
    end if
    if (rule%reduced .and. rule%points > 1) call mean_gradients(rule%family, direct, x, g_start, volume_start)
    elastic = 0
    flowed = 0
    dissipated = merge(3, 4, is_viscous(material))
    work = energy(2) + energy(dissipated)
    if (has_fields(material) .or. present(layers)) point%length = size_of(rule, flat, now, volume)
    point%finite = finite
    if (finite .and. .not. present(modes) .and. &
        (needs_deformation(material) .or. material%local .or. smoothed .or. present(pressure))) then
      call find_deformation(rule, flat, averaged, x, u, du, deformation, volume_before, bounds)
    end if
    volume_now = volume
    if ((smoothed .or. present(pressure)) .and. .not. finite) volume_before = volume
    if (smoothed) call begin_smoothing(smoothing, rule, functions, x, volume_before, size(force))
    if (present(pressure)) then
      call begin_pressure(pressure, rule, x, volume_before*merge(thickness, 1.0_dp, dim == 2))
      point%hybrid = .true.
    end if
    ! the points share the change of the whole volume, so that forces are derivatives of the strain energy
    if (finite .and. averaged .and. allocated(material%hyperelastic)) then
      volume = volume_before*sum(volume)/sum(volume_before)
    end if
    here => material
    tangent = 0
    do p = 1, rule%points
      call move_to(point, p)
      if (present(layers)) then
        here => find_material(layers(1, p))
        point%npt = layers(2, p)
        point%layer = layers(3, p)
        point%kspt = layers(4, p)
      end if
      if (present(coupling)) call find_shape(coupling, direct, rule%points, p, now)
      if (has_fields(here)) then
        point%place = point_position(rule, p, now)
        call interpolate_fields(rule, p, fields, predef, here%variables, point)
        if (present(coupling)) call set_temperature(coupling, point)
      end if
      if (allocated(here%user_field) .and. .not. begins) then
        now_axes = here%axes
        if (present(axes)) now_axes = axes(:, :, 2, p)
        call call_usdfld(here%user_field, here%ntens, point, now_axes, now_axes, here%local, svars(:, p))
      end if
      if (allocated(here%dependence)) call set_constants(here, point)
      thermal = 0
      rate = 0
      if (allocated(here%expansion)) then
        thermal = thermal_strain(rule, p, fields, here%expansion, predef, present(modes), rate, coupling)
      end if
      if (present(modes)) then
        call enhanced_strains(modes, dim, nodes, strains, p, g_modes(:, :, p), by_unknowns)
      else
        by_unknowns(:n, :) = b(:, :, p)
      end if
      if (present(bounds)) by_unknowns(n + 1:, :) = of_planes(by_planes(:, p))
      if (finite) then
        if (present(modes)) then
          gradient = gradient_in_the_middle(deformation(:, :, :, p))
          strain = strain_of(strains, gradient)
        else
          gradient = gradient_of(dim, direct, nodes, du, g_mid(:, :, p))
          call find_strain(n, strains, b_mid(:, :, p), du, strain)
        end if
        point%rotation = rotation_of(gradient)
        if (present(bounds)) strain(3) = strain(3) + dot_product(bounds%dw, by_planes_mid(:, p))
        if (present(axes)) then
          call carry_axes(point, deformation(:, :, :, p), axes(:, :, 2, p), middle)
          point%turn = matmul(axes(:, :, 2, p), transpose(axes(:, :, 1, p)))
        else if (needs_deformation(here)) then
          point%deformation = deformation(:, :, :, p)
          point%turn = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])
        end if
      else
        if (present(axes)) then
          middle = axes(:, :, 1, p)
          axes(:, :, 2, p) = middle
        end if
        call find_strain(n, strains, by_unknowns(:n, :), u, strain)
        if (present(modes)) strain = strain + matmul(modes%now, by_unknowns(n + 1:, :))
        if (present(bounds)) strain(3) = strain(3) + dot_product(bounds%w, by_planes(:, p))
      end if
      weight = volume(p)*merge(thickness, 1.0_dp, dim == 2)
      if (present(pressure)) then
        expanded = 1
        if (allocated(here%hyperelastic)) expanded = (1 + thermal(1, 2))**3
        point%mean_stress = mean_stress(pressure, p)*expanded
        call compare_volumes(pressure, p, point%mean_stress, direct, strains, here, finite, weight, &
                             volume_before(p)*merge(thickness, 1.0_dp, dim == 2), expanded, strain, b(:, :, p))
      end if
      if (begins) then
        call begin_point(here, point, weight, svars(:, p), stress, elastic)
        if (present(axes)) stress = rotated(strains, stress, transpose(axes(:, :, 2, p)), 1.0_dp)
        modulus = 0
        work = elastic
      else
        if (present(axes)) call turn_strain(dim, strains, middle, strain)
        if (present(coupling)) point%heat = heat_t()
        call point_update(dim, strains, here, point, weight, finite, strain, thermal, rate, svars(:, p), stress, modulus, &
                          by_temperature, elastic, work, mean)
        if (allocated(here%networks)) flowed = flowed + weight*point%dissipated
        if (rule%reduced) tangent = tangent + volume(p)/sum(volume)*modulus
        if (present(axes)) then
          call turn_response(here, point, strains, axes(:, :, 2, p), stress, modulus)
          call turn_mean(strains, axes(:, :, 2, p), mean)
        end if
      end if
      if (finite .and. here%ntens == 3) weight = weight*exp(svars(3, p))
      if (present(coupling) .and. .not. begins) then
        if (has_heat_terms(here)) then
          if (allocated(here%thermal%source)) call call_hetval(here%thermal%source, point)
          call add_heat_source(coupling, weight, b(:, :, p), point%heat, components(strains, here%ntens))
        end if
        if (allocated(here%expansion)) then
          if (present(axes)) then
            rate = rotated(6, rate, transpose(axes(:, :, 2, p)), 2.0_dp)
            by_temperature(:strains) = rotated(strains, by_temperature(:strains), transpose(axes(:, :, 2, p)), 1.0_dp)
          end if
          call add_thermal_strain(coupling, weight, b(:, :, p), point%heat, by_temperature(:strains), &
                                  rate(components(here%ntens, 6)), shares(rule, p, .false., coupling))
        end if
        if (smoothed) then
          by_corners = coupling%shape(:size(coupling%heat))*sum(point%heat%stress_by_temperature(:3))/3
          if (allocated(here%expansion)) by_corners = by_corners + shares(rule, p, .false., coupling)*by_temperature(strains + 1)
          call keep_temperature(smoothing, p, by_corners)
        end if
      end if
      if (request == added_stress) then
        call find_strain(size(added), strains, by_unknowns(:size(added), :), added, strain)
        stress = matmul(modulus, strain)
        mean%stress = dot_product(mean%by_strains(:strains), strain)
        if (present(pressure)) stress(:direct) = stress(:direct) + mean_stress_added(pressure, p)
      end if
      if (smoothed) call keep_point(smoothing, p, weight, direct, finite, mean, by_unknowns)
      if (of_stress) then
        stresses(:, p) = stress
        weights(p) = weight
        cycle
      end if
      if (finite .and. present(bounds)) then
        call add_stress_of_fibres(bounds, rule, p, g(:, :, p), by_unknowns(:, 3), ratio(p), stress, weight, modulus, stiffness)
      else if (finite .and. present(modes)) then
        ! the search for the modes needs their exact derivatives
        if (present(exact) .and. .not. (present(axes) .or. allocated(here%hyperelastic))) then
          call add_by_modes(modes, dim, strains, p, gradient, g_modes(nodes + 1:, :, p), by_unknowns(n + 1:, :), stress, modulus, &
                            weight, exact)
        end if
        call add_enhanced(p, by_unknowns, stress, weight, modulus, stiffness)
      else if (finite) then
        call add_geometric(dim, direct, strains, nodes, g(:, :, p), stress, weight, modulus, stiffness)
      end if
      if (finite .and. (allocated(here%hyperelastic) .or. present(pressure))) then
        if (averaged) stresses(:, p) = stress
        if (rule%reduced) call add_uniform_volume(rule%family, direct, strains, now, g(:, :, p), b(:, :, p), stress, weight, &
                                                  merge(thickness, 1.0_dp, dim == 2), stiffness)
      end if
      select case (strains)
      case (3)
        call add_plane_point(n + others, by_unknowns, weight*stress, weight*modulus, force, stiffness)
      case (4)
        call add_axisymmetric_point(n + others, by_unknowns, weight*stress, weight*modulus, force, stiffness)
      case default
        call add_space_point(n + others, by_unknowns, weight*stress, weight*modulus, force, stiffness)
      end select
    end do
    if (of_stress) then
      if (smoothed) smoothing%change = smoothing_change(smoothing)
      do p = 1, rule%points
        if (smoothed) stresses(:, p) = stresses(:, p) + smoothing%change(p)*smoothing%mean(p)%unit(:strains)
        modulus = 0
        if (present(bounds)) then
          by_unknowns(:n, :) = b(:, :, p)
          by_unknowns(n + 1:, :) = of_planes(by_planes(:, p))
          call add_stress_of_fibres(bounds, rule, p, g(:, :, p), by_unknowns(:, 3), ratio(p), stresses(:, p), weights(p), &
                                    modulus, stiffness)
          stiffness = stiffness + weights(p)*matmul(by_unknowns, matmul(modulus, transpose(by_unknowns)))
        else if (present(modes)) then
          call enhanced_strains(modes, dim, nodes, strains, p, g_modes(:, :, p), by_unknowns)
          call add_enhanced(p, by_unknowns, stresses(:, p), weights(p), modulus, stiffness)
          stiffness = stiffness + weights(p)*matmul(by_unknowns, matmul(modulus, transpose(by_unknowns)))
        else
          call add_stress_matrix(dim, direct, strains, nodes, g(:, :, p), b(:, :, p), stresses(:, p), weights(p), stiffness)
        end if
      end do
      return
    end if
    if (finite .and. averaged .and. allocated(material%hyperelastic)) then
      call add_mean_volume(dim, direct, strains, nodes, rule%points, g, b, stresses, &
                           volume*merge(thickness, 1.0_dp, dim == 2), volume_now, stiffness)
    end if
    if (smoothed) then
      call smooth(smoothing, force, stiffness)
      if (present(coupling)) call smooth_by_temperature(smoothing, coupling%tangent(:n, n + 1:))
      do p = 1, rule%points
        associate (change => smoothing%change(p), volume_here => smoothing%weight(p), of_point => smoothing%mean(p))
          if (finite .and. present(bounds)) then
            by_unknowns(:n, :) = b(:, :, p)
            by_unknowns(n + 1:, :) = of_planes(by_planes(:, p))
            call add_curvature_of_fibres(bounds, rule, p, g(:, :, p), by_unknowns, by_unknowns(:, 3), ratio(p), &
                                         of_point%unit(:4), volume_here*change, stiffness)
          else if (finite .and. present(modes)) then
            call enhanced_strains(modes, dim, nodes, strains, p, g_modes(:, :, p), by_unknowns)
            modulus = by_volume(strains, dim, of_point%unit(:strains))
            call add_enhanced(p, by_unknowns, of_point%unit(:strains), volume_here*change, modulus, stiffness)
            stiffness = stiffness + volume_here*change*matmul(by_unknowns, matmul(modulus, transpose(by_unknowns)))
          else if (finite) then
            call add_curvature(dim, direct, strains, nodes, g(:, :, p), b(:, :, p), of_point%unit(:strains), &
                               volume_here*change, stiffness)
          end if
          elastic = elastic + volume_here*change*of_point%compressibility*(of_point%stress + 0.5_dp*change)
          work = work + volume_here*change*of_point%work
          associate (stress_state => svars(values_of_point(dim)/2 + 1:, p))
            stress_state = stress_state + change*of_point%unit_state(:size(stress_state))
          end associate
        end associate
      end do
    end if
    ! its networks alone dissipate, and the trapezoidal rule is not exact
    if (allocated(material%hyperelastic)) work = elastic + energy(dissipated) + flowed
    energy(2) = elastic
    energy(dissipated) = work - elastic
    if (present(moduli)) then
      if (.not. any(abs(moduli) > 0)) moduli = isotropic_part(dim, tangent)
    end if
    if (rule%reduced) then
      call resist_hourglass(rule, g_start(:, :dim), volume_start*merge(thickness, 1.0_dp, dim == 2), hourglass, &
                            enhanced_constants(material, enhanced, dim, tangent, moduli), finite, x, u, force(:n), &
                            stiffness(:n, :n), energy(6))
    end if

  contains

    !> As add_geometric, of nodes and modes; those of the volume turn nothing, so that what the modulus has of them is taken back.
    pure subroutine add_enhanced(point, by_all, stress, volume, modulus, stiffness)
      integer, intent(in) :: point
      real(dp), intent(in) :: by_all(:, :), stress(:), volume
      real(dp), intent(inout) :: modulus(:, :), stiffness(:, :)
      real(dp) :: part(size(by_all, 1))
      integer :: turning, i, k
      turning = dim*(nodes + dim)
      call add_geometric(dim, dim, strains, nodes + dim, g_modes(:, :, point), stress, volume, modulus, &
                         stiffness(:turning, :turning))
      part(:turning) = 2*volume*matmul(by_all(:turning, :), stress)
      part(turning + 1:) = volume*sum(stress(:dim))*modes%volume(:, point)
      do i = 1, size(by_all, 1) - turning
        k = turning + i
        stiffness(:, k) = stiffness(:, k) + modes%volume(i, point)*part
        stiffness(k, :) = stiffness(k, :) + modes%volume(i, point)*part
      end do
    end subroutine add_enhanced
  end subroutine integrate

  !> Strains, with engineering shears, of a gradient of displacements: 11, 22, 12 in the plane.
  pure function strain_of(m, gradient) result(strain)
    integer, intent(in) :: m
    real(dp), intent(in) :: gradient(3, 3)
    real(dp) :: strain(m)
    if (m == 3) then
      strain = [gradient(1, 1), gradient(2, 2), gradient(1, 2) + gradient(2, 1)]
    else
      strain = [gradient(1, 1), gradient(2, 2), gradient(3, 3), gradient(1, 2) + gradient(2, 1), &
                gradient(1, 3) + gradient(3, 1), gradient(2, 3) + gradient(3, 2)]
    end if
  end function strain_of

  !> Strains by the unknowns of two planes, which strain the fibres alone.
  pure function of_planes(by_planes) result(b)
    real(dp), intent(in) :: by_planes(planes)
    real(dp) :: b(planes, 4)
    b = 0
    b(:, 3) = by_planes
  end function of_planes

  !> Adds a point to the residual of the pressure: the change of its volume now, by the displacements less that of the material.
  subroutine compare_volumes(pressure, point, mean_stress, direct, m, material, finite, now, before, expanded, strain, b)
    type(pressure_t), intent(inout) :: pressure
    integer, intent(in) :: point, direct, m
    type(material_t), intent(in) :: material
    logical, intent(in) :: finite
    real(dp), intent(in) :: mean_stress
    !> Volumes, the change of that of a hyperelastic material by free expansion, and the strain if it is small.
    real(dp), intent(in) :: now, before, expanded, strain(m), b(:, :)
    real(dp) :: of_material(2), difference
    of_material = [1, 0]
    if (allocated(material%hyperelastic)) of_material = volume_of(material%hyperelastic, mean_stress)
    difference = before*sum(strain(:direct))
    if (finite) difference = now - before*expanded*of_material(1)
    call add_compatibility(pressure, point, difference, now*sum(b(:, :direct), 2), before*expanded**2*of_material(2))
  end subroutine compare_volumes

  !> Young's modulus and Poisson's ratio of an isotropic material for the enhanced hourglass control, the modulus in plane
  !> strain over 1 - nu^2; none without that control. Of hyperelastic materials the shear modulus is that of the present tangent,
  !> as long as it is positive, and Poisson's ratio the initial one.
  pure function enhanced_constants(material, enhanced, dim, tangent, moduli) result(constants)
    type(material_t), intent(in) :: material
    logical, intent(in) :: enhanced
    integer, intent(in) :: dim
    real(dp), intent(in) :: tangent(:, :)
    real(dp), intent(in), optional :: moduli(2)    !< the constants, if the material has none
    real(dp), allocatable :: constants(:)
    real(dp) :: young, poisson, shear
    allocate (constants(0))
    if (.not. enhanced) return
    if (present(moduli)) then
      constants = moduli
      return
    end if
    young = 1/material%compliance(1, 1)
    poisson = -material%compliance(1, 2)*young
    if (allocated(material%hyperelastic) .and. .not. allocated(material%networks)) then
      shear = shear_part(dim, tangent)
      if (shear > 0) young = 2*(1 + poisson)*shear
    end if
    if (material%ntens == 4) young = young/(1 - poisson**2)
    constants = [young, poisson]
  end function enhanced_constants

  !> Shear modulus of the isotropic part of a tangent, which is its mean over all directions (Voigt), or those of the plane.
  pure real(dp) function shear_part(dim, tangent)
    integer, intent(in) :: dim
    real(dp), intent(in) :: tangent(:, :)    !< direct components, then engineering shears
    real(dp) :: trace, cross
    integer :: i, n
    n = size(tangent, 1)
    trace = sum([(tangent(i, i), i=1, dim)])
    cross = sum(tangent(:dim, :dim)) - trace
    if (dim == 2) then
      shear_part = (trace - cross + 4*tangent(n, n))/8
    else
      shear_part = (trace - cross/2 + 3*(tangent(4, 4) + tangent(5, 5) + tangent(6, 6)))/15
    end if
  end function shear_part

  !> Young's modulus and Poisson's ratio of the isotropic part of a tangent; in the plane the modulus along an edge whose other
  !> direction is free, and 0. Zero unless the part is positive.
  pure function isotropic_part(dim, tangent) result(moduli)
    integer, intent(in) :: dim
    real(dp), intent(in) :: tangent(:, :)    !< direct components, then engineering shears
    real(dp) :: moduli(2), bulk, shear
    moduli = 0
    bulk = sum(tangent(:dim, :dim))/dim**2
    shear = shear_part(dim, tangent)
    if (.not. (bulk > 0 .and. shear > 0)) return
    if (dim == 2) then
      moduli(1) = 4*bulk*shear/(bulk + shear)
    else
      moduli = [9*bulk*shear/(3*bulk + shear), (3*bulk - 2*shear)/(2*(3*bulk + shear))]
    end if
  end function isotropic_part

  pure subroutine find_strain(n, m, b, u, strain)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: b(n, m), u(n)
    real(dp), intent(out) :: strain(m)
    integer :: k
    do k = 1, m
      strain(k) = sum(b(:, k)*u)
    end do
  end subroutine find_strain

  !> Strain of a point, from global directions to those of axes (rows).
  pure subroutine turn_strain(dim, m, axes, strain)
    integer, intent(in) :: dim, m
    real(dp), intent(in) :: axes(3, 3)
    real(dp), intent(inout) :: strain(m)
    real(dp) :: all(values_of_point(dim)/2)
    integer :: place(m)
    place = components(m, size(all))
    all = 0
    all(place) = strain
    all = rotated(size(all), all, axes, 2.0_dp)
    strain = all(place)
  end subroutine turn_strain

  !> Stress and tangent of a point, and the heat terms of UMAT and UHARD, from the directions of axes (rows) to global ones.
  subroutine turn_response(material, point, m, axes, stress, modulus)
    type(material_t), intent(in) :: material
    type(point_t), intent(inout) :: point
    integer, intent(in) :: m
    real(dp), intent(in) :: axes(3, 3)
    real(dp), intent(inout) :: stress(m), modulus(m, m)
    real(dp) :: turn(m, m)
    turn = turn_matrix(m, axes)
    stress = matmul(transpose(turn), stress)
    modulus = matmul(transpose(turn), matmul(modulus, turn))
    if (has_heat_terms(material)) call turn_heat(material%ntens, axes, point%heat)
  end subroutine turn_response

  !> Mean stress of a point, from the directions of axes (rows) to global ones.
  pure subroutine turn_mean(m, axes, mean)
    integer, intent(in) :: m
    real(dp), intent(in) :: axes(3, 3)
    type(mean_response_t), intent(inout) :: mean
    real(dp) :: turn(m, m)
    turn = turn_matrix(m, axes)
    mean%by_strains(:m) = matmul(mean%by_strains(:m), turn)
    mean%unit(:m) = matmul(mean%unit(:m), turn)
  end subroutine turn_mean

  !> Stress and tangent of a point (11, 22, 12 in the plane); its state and its part of the energies. strain is the total
  !> one in small displacements, that of the increment in large ones; thermal: at the start and end of the increment, and rate
  !> its derivative there. All is in global directions, or in those of the point if the material is (local).
  subroutine point_update(dim, m, material, point, volume, finite, strain, thermal, rate, state, stress, modulus, &
                          by_temperature, elastic, work, mean)
    integer, intent(in) :: dim, m     !< m: number of strains
    type(material_t), intent(in) :: material
    type(point_t), intent(inout) :: point
    logical, intent(in) :: finite
    real(dp), intent(in) :: volume, strain(m), thermal(6, 2), rate(6)
    real(dp), intent(inout) :: state(values_of_point(dim)), elastic, work
    real(dp), intent(out) :: stress(m), modulus(m, m)
    real(dp), intent(out) :: by_temperature(m + 1)   !< derivatives of the stress and of the mean stress, by thermal strain
    type(mean_response_t), intent(out) :: mean
    integer :: j, k, n, of_material(m), of_state(m), direct
    real(dp) :: total(material%ntens), t(material%ntens), t_rate(material%ntens), tangent(material%ntens, material%ntens)
    real(dp) :: e_old(values_of_point(dim)/2), t_old(values_of_point(dim)/2), e_new(values_of_point(dim)/2), &
                t_new(values_of_point(dim)/2), free(values_of_point(dim)/2), unit_state(values_of_point(dim)/2)
    real(dp) :: unit(material%ntens)
    real(dp) :: stretch(2)            ! of the free expansion of a hyperelastic material, at the start and the end
    n = values_of_point(dim)/2
    of_state = components(m, 2*dim)
    of_material = components(m, material%ntens)
    e_old = state(:n)
    t_old = state(n + 1:)
    if (finite) then
      e_old = rotated(n, e_old, point%rotation, 2.0_dp)
      t_old = rotated(n, t_old, point%rotation, 1.0_dp)
    end if
    total = 0
    do k = 1, m
      total(of_material(k)) = strain(k)
      if (finite) total(of_material(k)) = e_old(of_state(k)) + strain(k)
    end do
    direct = merge(2, 3, material%ntens == 3)
    stretch = 1
    if (allocated(material%hyperelastic)) then
      stretch = 1 + thermal(1, :)
      do k = 1, 2
        point%deformation(:, :, k) = point%deformation(:, :, k)/stretch(k)
      end do
    end if
    if (allocated(material%expansion)) total = total - thermal(components(material%ntens, 6), 2)
    call stress_update(material, point, total, t, tangent)
    if (allocated(material%expansion)) total = total + thermal(components(material%ntens, 6), 2)
    if (allocated(material%hyperelastic)) then
      ! its energy is that of the volume before the expansion
      t = t/stretch(2)**3
      tangent = tangent/stretch(2)**3
      point%energy = point%energy/stretch(2)**3
    end if
    e_new = 0
    t_new = 0
    do k = 1, m
      stress(k) = t(of_material(k))
      e_new(of_state(k)) = total(of_material(k))
      t_new(of_state(k)) = stress(k)
      do j = 1, m
        modulus(j, k) = tangent(of_material(j), of_material(k))
      end do
    end do
    by_temperature = 0
    if (allocated(material%expansion)) then
      t_rate = matmul(tangent, rate(components(material%ntens, 6)))/stretch(2)
      by_temperature = -[t_rate(of_material), sum(t_rate(:direct))/3]
    end if
    call find_mean(material, t, unit, mean)
    mean%by_strains(:m) = sum(tangent(:direct, of_material), 1)/3
    mean%unit(:m) = unit(of_material)
    unit_state = 0
    unit_state(of_state) = mean%unit(:m)
    if (material%ntens == 4) unit_state(3) = unit(3)
    elastic = elastic + volume*elastic_energy(material, point, t)
    if (material%ntens == 3) e_new(3) = thickness_strain(material, point, t) + thermal(3, 2)
    if (material%ntens == 4) t_new(3) = t(3)
    if (material%turned) then
      e_new = rotated(n, e_new, material%axes, 2.0_dp)
      t_new = rotated(n, t_new, material%axes, 1.0_dp)
      unit_state = rotated(n, unit_state, material%axes, 1.0_dp)
    end if
    mean%unit_state(:n) = unit_state
    ! trapezoidal rule, exact where the response is linear
    work = work + volume*0.5_dp*dot_product(t_new + t_old, e_new - e_old)
    mean%work = 0.5_dp*dot_product(unit_state, e_new - e_old)
    if (allocated(material%expansion)) then
      free = thermal(:n, 2) - thermal(:n, 1)
      if (material%turned) free = rotated(n, free, material%axes, 2.0_dp)
      work = work - volume*0.5_dp*dot_product(t_new + t_old, free)
      mean%work = mean%work - 0.5_dp*dot_product(unit_state, free)
    end if
    state(:n) = e_new
    state(n + 1:) = t_new
  end subroutine point_update

  !> Mean stress of a point by its stress, and the stress (unit) that a unit of the pressure beyond it causes (host_hybrid).
  pure subroutine find_mean(material, stress, unit, mean)
    type(material_t), intent(in) :: material
    real(dp), intent(in) :: stress(material%ntens)
    real(dp), intent(out) :: unit(material%ntens)
    type(mean_response_t), intent(out) :: mean
    real(dp) :: bulk
    integer :: direct
    direct = merge(2, 3, material%ntens == 3)
    mean%stress = sum(stress(:direct))/3
    unit = 0
    unit(:direct) = 1
    bulk = elastic_bulk_modulus(material)
    if (.not. bulk > 0) return
    mean%compressibility = 1/bulk
    unit = sum(material%stiffness(:material%ntens, :3), 2)/(3*bulk)
  end subroutine find_mean
end module host_solid
