! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in Timoshenko beams (B21, B22, B31, B32): of linear elastic sections as a procedure with the arguments of UEL, of sections
!> whose material is integrated over the section points (host_beam_section) as one with those of UELMAT.
!> harness/uel/elements/families/beam.py gives what they need.
!>
!> JPROPS: family of the axis (host_shape), its integration points, section points, integration points of the mass. PROPS: density;
!> slenderness compensation of the shear along directions 2 and 1, over the squared length of the element; place of the centroid and
!> of the shear centre along directions 1 and 2; Young's modulus; section stiffness (6, 6) by the strains below; mass per length and
!> density (6, 6) of translations and rotations in the directions t, 1, 2; then the place of each section point, where a
!> material is integrated followed by its area and lever. The section stiffness is then that of what is elastic beside the material.
!>
!> With NLGEOM beams in a plane have the strains of E. Reissner, Journal of Applied Mathematics and Physics 23 (1972) 795: those of
!> the axis in directions that turn with the section; for those in space see host_beam_turning, and host_beam_curved of three nodes.
!>
!> Strains of the section, in this order: axial strain of the centroid, transverse shear strains along 2 and 1 of the shear centre,
!> curvature changes about 1 and 2, twist. Forces have the same order: SF1 SF2 SF3 SM1 SM2 SM3. Beams in a plane have the first two
!> and the curvature about 1, which is -z.
!>
!> SVARS hold, for each section point of each integration point, E11 S11 or what host_beam_section has, then forces and strains of
!> the section, which are alone where there are no section points; in dynamic analyses then the forces of the last two increments;
!> last the directions t, 1, 2 of the integration points, then of those of the mass.
module host_beam
  use host_beam_curved, only: add_curved_beam, curved_point, curved_strains
  use host_beam_section, only: energies_t, place_t, section_response, values_of_point
  use host_beam_turning, only: turning_beam, turning_strains
  use host_context, only: added_stress, stress_matrix
  use host_inertia, only: respond
  use host_kinds, only: dp, i4
  use host_materials, only: find_material, material_t
  use host_polar, only: step
  use host_shape, only: is_quadratic, rule_of, rule_t
  implicit none (type, external)
  private
  public :: beam_uel, beam_uelmat

  integer, parameter :: head = 80                        !< values of PROPS before the section points
  integer, parameter :: planar(3) = [1, 2, 4]            !< strains of a beam in a plane
  integer, parameter :: planar_unknowns(3) = [1, 2, 6]   !< dofs of its nodes

  !> An element in a pass.
  type :: beam_t
    integer :: dim = 0, n = 0
    integer :: each = 0                 !< strains, and unknowns of a node
    integer :: sections = 0             !< section points
    integer :: values = 0               !< of SVARS for each of them
    logical :: finite = .false.         !< large displacements
    real(dp) :: length = 0
    real(dp) :: centre(2, 2) = 0        !< places of the centroid and of the shear centre
    type(material_t), pointer :: material => null()   !< integrated over the section
  end type beam_t

  !> Forces of the section at the integration points, and their derivatives by its strains.
  type :: resultants_t
    real(dp), allocatable :: force(:, :), stiffness(:, :, :)
  end type resultants_t

  !> Motion of a beam in a plane at a point, in large displacements.
  type :: plane_motion_t
    real(dp) :: turned(3, 3) = 0        !< directions t, 1, 2 now
    real(dp) :: line(2) = 0             !< stretch less one, and shear, of the line of the nodes
    real(dp) :: strain(3) = 0
    real(dp) :: n(3) = 0, slope(3) = 0  !< of the nodes along the axis
  end type plane_motion_t

contains

  subroutine beam_uel(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                      v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                      lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period)
    integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                   lflags(*), mlvarx, mdload, jprops(*), njprop
    real(dp) :: rhs(*), amatrx(*), svars(*), energy(*), props(*), coords(*), u(*), du(*), v(*), a(*), time(*), dtime, &
                params(*), adlmag(*), predef(*), ddlmag(*), pnewdt, period
    call beam_uelmat(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                     v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                     lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period, 0_i4)
  end subroutine beam_uel

  !> materiallib: 0 of a linear elastic section.
  subroutine beam_uelmat(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                         v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                         lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period, materiallib)
    integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                   lflags(*), mlvarx, mdload, jprops(*), njprop, materiallib
    real(dp) :: rhs(*), amatrx(*), svars(*), energy(*), props(*), coords(*), u(*), du(*), v(*), a(*), time(*), dtime, &
                params(*), adlmag(*), predef(*), ddlmag(*), pnewdt, period
    real(dp) :: mass(ndofel, ndofel), old(ndofel, 2)
    integer :: n, points, full, states, axes
    type(rule_t), pointer :: rule
    type(beam_t) :: beam
    type(resultants_t) :: resultants
    n = ndofel
    points = jprops(2)
    full = jprops(4)
    rule => rule_of(int(jprops(1)), full)
    beam%n = n
    beam%dim = mcrd
    beam%each = merge(6, 3, mcrd == 3)
    beam%sections = jprops(3)
    beam%finite = lflags(2) /= 0
    beam%length = length_of(rule, beam%dim, coords)
    beam%centre = reshape(props(4:7), [2, 2])
    beam%material => find_material(materiallib)
    beam%values = 2*beam%each
    if (associated(beam%material)) then
      beam%values = beam%values + values_of_point(beam%material)
    else if (beam%sections > 0) then
      beam%values = beam%values + 2
    end if
    states = points*max(1, beam%sections)*beam%values
    axes = nsvars - 9*(points + full) + 1
    old = 0
    if (axes > states + 1) old = reshape(svars(states + 1:axes - 1), [n, 2])
    call find_mass(rule, beam%dim, beam%each, n, props, coords, svars(axes + 9*points), mass)
    rhs(1:n*nrhs) = 0
    amatrx(1:n*n) = 0
    if (lflags(3) /= 3 .and. lflags(3) /= 4) then
      call integrate(beam, rule_of(int(jprops(1)), points), props(:head), props(head + 1), coords, svars(axes), u, int(npredf), &
                     predef, rhs, amatrx, svars, energy, resultants)
      if (stress_matrix(lflags(3))) then
        call turn_stress(beam, rule_of(int(jprops(1)), points), lflags(3), coords, svars(axes), u, du, resultants, amatrx)
      end if
    end if
    call respond(n, lflags, params, dtime, v, a, mass, old, rhs, amatrx, energy(1))
    if (axes > states + 1) svars(states + 1:axes - 1) = reshape(old, [2*n])
  end subroutine beam_uelmat

  !> Length of the element by the parent coordinate at a point. Nodes follow each other along the axis.
  pure real(dp) function stretch(rule, p, dim, x)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: p, dim
    real(dp), intent(in) :: x(dim, rule%nodes)
    stretch = norm2(matmul(x, along_axis(rule, rule%dn(:, 1, p))))
  end function stretch

  !> Values of the nodes of a family, whose middle comes last, in the order of nodes along the axis.
  pure function along_axis(rule, of_family) result(values)
    type(rule_t), intent(in) :: rule
    real(dp), intent(in) :: of_family(rule%nodes)
    real(dp) :: values(rule%nodes)
    values = of_family
    if (is_quadratic(rule)) values(2:3) = of_family([3, 2])
  end function along_axis

  pure real(dp) function length_of(rule, dim, x) result(length)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: dim
    real(dp), intent(in) :: x(dim, rule%nodes)
    integer :: p
    length = sum([(rule%weight(p)*stretch(rule, p, dim, x), p=1, rule%points)])
  end function length_of

  !> Strains of the section at a point by the displacements and rotations of the nodes in space.
  pure function operator(rule, p, size, axes, centre) result(b)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: p
    real(dp), intent(in) :: size           !< stretch
    real(dp), intent(in) :: axes(3, 3)     !< columns t, 1, 2
    real(dp), intent(in) :: centre(2, 2)   !< places of the centroid and of the shear centre
    real(dp) :: b(6, 6, rule%nodes), n(rule%nodes), slope(rule%nodes)
    integer :: k
    n = along_axis(rule, rule%n(:, p))
    slope = along_axis(rule, rule%dn(:, 1, p))/size
    b = 0
    do k = 1, rule%nodes
      associate (t => axes(:, 1), first => axes(:, 2), second => axes(:, 3))
        b(1, :3, k) = slope(k)*t
        b(2, :3, k) = slope(k)*second
        b(2, 4:, k) = n(k)*first
        b(3, :3, k) = slope(k)*first
        b(3, 4:, k) = -n(k)*second
        b(4, 4:, k) = slope(k)*first
        b(5, 4:, k) = slope(k)*second
        b(6, 4:, k) = slope(k)*t
      end associate
      ! from the node line to the centroid and the shear centre
      b(1, :, k) = b(1, :, k) + centre(2, 1)*b(4, :, k) - centre(1, 1)*b(5, :, k)
      b(2, :, k) = b(2, :, k) + centre(1, 2)*b(6, :, k)
      b(3, :, k) = b(3, :, k) - centre(2, 2)*b(6, :, k)
    end do
  end function operator

  !> Forces, stiffness, state and energy.
  subroutine integrate(beam, rule, props, section_points, x, axes, u, fields, predef, force, stiffness, svars, energy, resultants)
    type(beam_t), intent(in) :: beam
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: fields
    real(dp), intent(in) :: props(head), x(beam%dim, rule%nodes), u(beam%each, rule%nodes), predef(2, fields, rule%nodes)
    real(dp), intent(in) :: section_points(merge(4, 2, associated(beam%material)), beam%sections)
    real(dp), intent(in) :: axes(3, 3, rule%points)    !< columns t, 1, 2
    real(dp), intent(inout) :: force(beam%n), stiffness(beam%n, beam%n), energy(8)
    real(dp), intent(inout) :: svars(beam%values, max(1, beam%sections), rule%points)
    type(resultants_t), intent(out) :: resultants
    real(dp) :: elastic(6, 6), section(6, 6), strain(6), forces(6), size, weight, stored, stored_before
    real(dp) :: part(beam%each, beam%n), chosen(beam%each, beam%each), found(beam%each), resultant(beam%each), moved(3, rule%nodes)
    type(plane_motion_t) :: motion
    type(place_t) :: place
    type(energies_t) :: energies
    integer :: rows(beam%each), unknowns(beam%each), k, p
    rows = kept_of(beam%each, planar)
    unknowns = kept_of(beam%each, planar_unknowns)
    allocate (resultants%force(beam%each, rule%points), resultants%stiffness(beam%each, beam%each, rule%points))
    elastic = reshape(props(9:44), [6, 6])
    do k = 1, 2
      elastic(k + 1, k + 1) = elastic(k + 1, k + 1)/(1 + props(k + 1)*beam%length**2)
    end do
    moved = 0
    moved(:beam%dim, :) = x
    if (beam%finite) moved(:beam%dim, :) = x + u(:beam%dim, :)
    stored = 0
    stored_before = 0
    do p = 1, rule%points
      size = stretch(rule, p, beam%dim, x)
      weight = rule%weight(p)*size
      place%axes = axes(:, :, p)
      if (beam%finite .and. beam%dim == 3) then
        found = real(strains_in_space(beam, rule, p, x, axes(:, :, p), cmplx(u, kind=dp), place%axes), dp)
      else if (beam%finite) then
        motion = plane_motion(rule, p, size, axes(:, :, p), beam%centre, u)
        found = motion%strain
        place%axes = motion%turned
        part = reshape(plane_operator(rule, p, size, motion, beam%centre), [beam%each, beam%n])
      else
        part = reshape(along_unknowns(operator(rule, p, size, axes(:, :, p), beam%centre), rows, unknowns), [beam%each, beam%n])
        found = matmul(part, reshape(u, [beam%n]))
      end if
      strain = 0
      strain(rows) = found
      section = elastic
      chosen = section(rows, rows)
      resultant = matmul(chosen, found)
      stored = stored + 0.5_dp*weight*dot_product(resultant, found)
      if (associated(beam%material)) then
        associate (before => svars(beam%values - beam%each + 1:, 1, p))
          stored_before = stored_before + 0.5_dp*weight*dot_product(before, matmul(chosen, before))
        end associate
        place%point = p
        place%line = matmul(moved, along_axis(rule, rule%n(:, p)))
        place%centroid = beam%centre(:, 1)
        place%weight = weight
        place%length = beam%length
        forces = 0
        forces(rows) = resultant
        call section_response(beam%material, rule, place, beam%sections, section_points, fields, of_family(rule, predef), strain, &
                              forces, section, svars(:, :, p), energies)
        chosen = section(rows, rows)
        resultant = forces(rows)
      else
        call keep_stresses(beam%sections, section_points, beam%centre(:, 1), props(8), strain, svars(:, :, p))
      end if
      resultants%force(:, p) = resultant
      resultants%stiffness(:, :, p) = chosen
      if (beam%finite .and. beam%dim == 3) then
        call add_in_space(beam, rule, p, x, axes(:, :, p), chosen, &
                          offset_of(associated(beam%material), chosen, found, resultant), u, force, stiffness)
      else
        if (beam%finite) call add_turning(rule%nodes, motion, weight, resultant, stiffness)
        force = force + weight*matmul(resultant, part)
        stiffness = stiffness + weight*matmul(transpose(part), matmul(chosen, part))
      end if
      do k = 1, max(1, beam%sections)
        svars(beam%values - 2*beam%each + 1:, k, p) = [resultant, found]
      end do
    end do
    if (associated(beam%material)) then
      ! what is not stored is dissipated
      energy(4) = energy(2) + energy(4) - stored_before + energies%work - energies%elastic
    end if
    energy(2) = stored + energies%elastic
  end subroutine integrate

  !> The matrix of a stress (host_context): what the forces change by as the beam turns.
  subroutine turn_stress(beam, rule, request, x, axes, u, du, resultants, stiffness)
    type(beam_t), intent(in) :: beam
    type(rule_t), intent(in) :: rule
    integer(i4), intent(in) :: request
    real(dp), intent(in) :: x(beam%dim, rule%nodes), axes(3, 3, rule%points), u(beam%each, rule%nodes), du(beam%each, rule%nodes)
    type(resultants_t), intent(in) :: resultants
    real(dp), intent(out) :: stiffness(beam%n, beam%n)
    real(dp), parameter :: nothing(6, 6) = 0
    real(dp) :: at(beam%each, rule%nodes), forces(beam%each), ignored(beam%n), turned(3, 3), size
    type(plane_motion_t) :: motion
    integer :: p
    at = 0
    if (beam%finite) at = u
    ignored = 0
    stiffness = 0
    do p = 1, rule%points
      size = stretch(rule, p, beam%dim, x)
      forces = resultants%force(:, p)
      if (beam%dim == 3) then
        if (request == added_stress) then
          forces = aimag(strains_in_space(beam, rule, p, x, axes(:, :, p), cmplx(at, step*du, dp), turned))/step
          forces = matmul(resultants%stiffness(:, :, p), forces)
        end if
        call add_in_space(beam, rule, p, x, axes(:, :, p), nothing, forces, at, ignored, stiffness)
      else
        motion = plane_motion(rule, p, size, axes(:, :, p), beam%centre, at)
        if (request == added_stress) then
          associate (part => reshape(plane_operator(rule, p, size, motion, beam%centre), [beam%each, beam%n]))
            forces = matmul(resultants%stiffness(:, :, p), matmul(part, reshape(du, [beam%n])))
          end associate
        end if
        call add_turning(rule%nodes, motion, rule%weight(p)*size, forces, stiffness)
      end if
    end do
  end subroutine turn_stress

  !> Strains of a beam in space in large displacements, and its directions now.
  function strains_in_space(beam, rule, p, x, axes, u, turned) result(strain)
    type(beam_t), intent(in) :: beam
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: p
    real(dp), intent(in) :: x(3, rule%nodes), axes(3, 3)
    complex(dp), intent(in) :: u(6, rule%nodes)
    real(dp), intent(out) :: turned(3, 3)
    complex(dp) :: strain(6)
    if (is_quadratic(rule)) then
      call curved_strains(point_of(beam, rule, p, x, axes), u, strain, turned)
    else
      call turning_strains(x, axes, beam%centre, u, strain, turned)
    end if
  end function strains_in_space

  !> Add its forces and stiffness, where the forces of the section are linear in its strains, but for an offset.
  subroutine add_in_space(beam, rule, p, x, axes, section, offset, u, force, stiffness)
    type(beam_t), intent(in) :: beam
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: p
    real(dp), intent(in) :: x(3, rule%nodes), axes(3, 3), section(6, 6), offset(6), u(6, rule%nodes)
    real(dp), intent(inout) :: force(beam%n), stiffness(beam%n, beam%n)
    if (is_quadratic(rule)) then
      call add_curved_beam(point_of(beam, rule, p, x, axes), section, offset, u, force, stiffness)
    else
      ! of its only point
      call turning_beam(x, axes, beam%centre, section, offset, u, force, stiffness)
    end if
  end subroutine add_in_space

  !> A point of a beam of three nodes.
  pure function point_of(beam, rule, p, x, axes) result(point)
    type(beam_t), intent(in) :: beam
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: p
    real(dp), intent(in) :: x(3, rule%nodes), axes(3, 3)
    type(curved_point) :: point
    real(dp) :: size
    size = stretch(rule, p, 3, x)
    point%n = along_axis(rule, rule%n(:, p))
    point%slope = along_axis(rule, rule%dn(:, 1, p))/size
    point%axes = axes
    point%centre = beam%centre
    point%x = x
    point%weight = rule%weight(p)*size
  end function point_of

  !> Forces of the section that are not its stiffness times its strains: none where it is linear.
  pure function offset_of(nonlinear, stiffness, strain, forces) result(offset)
    logical, intent(in) :: nonlinear
    real(dp), intent(in) :: stiffness(6, 6), strain(6), forces(6)
    real(dp) :: offset(6)
    offset = 0
    if (nonlinear) offset = forces - matmul(stiffness, strain)
  end function offset_of

  !> E11 and S11 at the section points of a linear elastic section.
  pure subroutine keep_stresses(sections, points, centroid, young, strain, state)
    integer, intent(in) :: sections
    real(dp), intent(in) :: points(2, sections), centroid(2), young, strain(6)
    real(dp), intent(inout) :: state(:, :)
    real(dp) :: along
    integer :: k
    do k = 1, sections
      associate (arm => points(:, k) - centroid)
        along = strain(1) + arm(2)*strain(4) - arm(1)*strain(5)
      end associate
      state(:2, k) = [along, young*along]
    end do
  end subroutine keep_stresses

  !> Temperatures and fields of the nodes in the order of the family, whose middle comes last.
  pure function of_family(rule, predef) result(values)
    type(rule_t), intent(in) :: rule
    real(dp), intent(in) :: predef(:, :, :)
    real(dp) :: values(ubound(predef, 1), ubound(predef, 2), rule%nodes)
    values = predef
    if (is_quadratic(rule)) values(:, :, 2:3) = predef(:, :, [3, 2])
  end function of_family

  !> Strains and directions of a beam in a plane in large displacements.
  pure function plane_motion(rule, p, size, axes, centre, u) result(motion)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: p
    real(dp), intent(in) :: size, axes(3, 3), centre(2, 2), u(3, rule%nodes)
    type(plane_motion_t) :: motion
    real(dp) :: n(rule%nodes), slope(rule%nodes), tangent(2), angle
    integer :: i
    n = along_axis(rule, rule%n(:, p))
    slope = along_axis(rule, rule%dn(:, 1, p))/size
    motion%n(:rule%nodes) = n
    motion%slope(:rule%nodes) = slope
    angle = dot_product(n, u(3, :))
    motion%turned = axes
    do i = 1, 3, 2
      motion%turned(:2, i) = [cos(angle)*axes(1, i) - sin(angle)*axes(2, i), sin(angle)*axes(1, i) + cos(angle)*axes(2, i)]
    end do
    tangent = axes(:2, 1) + matmul(u(:2, :), slope)
    motion%line = [dot_product(tangent, motion%turned(:2, 1)) - 1, dot_product(tangent, motion%turned(:2, 3))]
    motion%strain = [motion%line, -dot_product(slope, u(3, :))]
    motion%strain(1) = motion%strain(1) + centre(2, 1)*motion%strain(3)
  end function plane_motion

  !> How these strains vary with the unknowns.
  pure function plane_operator(rule, p, size, motion, centre) result(part)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: p
    real(dp), intent(in) :: size, centre(2, 2)
    type(plane_motion_t), intent(in) :: motion
    real(dp) :: part(3, 3, rule%nodes)
    part = along_unknowns(operator(rule, p, size, motion%turned, centre), planar, planar_unknowns)
    part(1, 3, :) = part(1, 3, :) + motion%line(2)*motion%n(:rule%nodes)
    part(2, 3, :) = part(2, 3, :) - motion%line(1)*motion%n(:rule%nodes)
  end function plane_operator

  !> Stiffness of forces that turn with a beam in a plane.
  pure subroutine add_turning(nodes, motion, weight, forces, stiffness)
    integer, intent(in) :: nodes
    type(plane_motion_t), intent(in) :: motion
    real(dp), intent(in) :: weight, forces(3)
    real(dp), intent(inout) :: stiffness(3, nodes, 3, nodes)
    real(dp) :: across(2)
    integer :: i, j
    associate (n => motion%n, slope => motion%slope, line => motion%line)
      across = forces(1)*motion%turned(:2, 3) - forces(2)*motion%turned(:2, 1)
      do j = 1, nodes
        do i = 1, nodes
          stiffness(:2, i, 3, j) = stiffness(:2, i, 3, j) + weight*slope(i)*n(j)*across
          stiffness(3, i, :2, j) = stiffness(3, i, :2, j) + weight*n(i)*slope(j)*across
          stiffness(3, i, 3, j) = stiffness(3, i, 3, j) - weight*n(i)*n(j)*(forces(1)*(1 + line(1)) + forces(2)*line(2))
        end do
      end do
    end associate
  end subroutine add_turning

  !> Some strains by some unknowns of each node.
  pure function along_unknowns(b, rows, unknowns) result(part)
    real(dp), intent(in) :: b(:, :, :)
    integer, intent(in) :: rows(:), unknowns(:)
    real(dp) :: part(ubound(rows, 1), ubound(unknowns, 1), ubound(b, 3))
    part = b(rows, unknowns, :)
  end function along_unknowns

  !> All six, or those of a beam in a plane.
  pure function kept_of(each, in_plane) result(kept)
    integer, intent(in) :: each, in_plane(3)
    integer :: kept(each), k
    if (each == 6) then
      kept = [(k, k=1, 6)]
    else
      kept = in_plane
    end if
  end function kept_of

  !> Mass matrix: lumped with two nodes, consistent with three (Abaqus Theory Guide, Mass and inertia for Timoshenko beams).
  pure subroutine find_mass(rule, dim, each, n, props, x, axes, mass)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: dim, each, n
    real(dp), intent(in) :: props(head), x(dim, rule%nodes), axes(3, 3, rule%points)
    real(dp), intent(out) :: mass(n, n)
    real(dp) :: of_section(6, 6), turn(6, 6), at(rule%nodes), weight
    integer :: i, j, k, p, unknowns(each)
    unknowns = kept_of(each, planar_unknowns)
    mass = 0
    do p = 1, rule%points
      turn = 0
      turn(:3, :3) = axes(:, :, p)
      turn(4:, 4:) = axes(:, :, p)
      of_section = matmul(turn, matmul(reshape(props(45:80), [6, 6]), transpose(turn)))
      at = along_axis(rule, rule%n(:, p))
      weight = props(1)*rule%weight(p)*stretch(rule, p, dim, x)
      do k = 1, rule%nodes
        do j = 1, rule%nodes
          if (j /= k .and. .not. is_quadratic(rule)) cycle
          i = each*(j - 1)
          mass(i + 1:i + each, each*(k - 1) + 1:each*k) = mass(i + 1:i + each, each*(k - 1) + 1:each*k) &
            + weight*merge(at(j)*at(k), at(k), is_quadratic(rule))*of_section(unknowns, unknowns)
        end do
      end do
    end do
  end subroutine find_mass
end module host_beam
