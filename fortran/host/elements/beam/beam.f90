! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in Timoshenko beams (B21, B22, B31, B32): of linear elastic sections or, with a material, of sections over whose points it
!> is integrated (host_beam_section). harness/uel/elements/families/beam.py gives what they need.
!>
!> Values of PROPS and JPROPS: built_in.toml.
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
  use host_adapter, only: element_t, keep_forces
  use host_beam_curved, only: add_curved_beam, curved_point, curved_strains
  use host_beam_section, only: energies_t, place_t, section_response, values_of_point
  use host_beam_turning, only: turning_beam, turning_strains
  use host_context, only: added_stress
  use host_kinds, only: dp
  use host_layout, only: j_beam_family, j_beam_mass_points, j_beam_points, j_beam_sections, p_beam_centroid, p_beam_density, &
                         p_beam_mass, p_beam_points, p_beam_shear_centre, p_beam_slenderness, p_beam_stiffness, p_beam_young
  use host_materials, only: material_t
  use host_polar, only: step
  use host_shape, only: is_quadratic, rule_of, rule_t
  implicit none (type, external)
  private
  public :: timoshenko_beam

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
    real(dp), pointer, contiguous :: x(:, :) => null(), u(:, :) => null()   !< by nodes
    real(dp), pointer, contiguous :: axes(:, :, :) => null()   !< (3, 3, points) columns t, 1, 2
    real(dp), pointer, contiguous :: places(:, :) => null()    !< of the section points, in PROPS
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

  subroutine timoshenko_beam(element)
    type(element_t), intent(inout) :: element
    integer :: points, full, states, first
    type(rule_t), pointer :: rule
    type(beam_t) :: beam
    type(resultants_t) :: resultants
    points = element%jprops(j_beam_points)
    full = element%jprops(j_beam_mass_points)
    rule => rule_of(int(element%jprops(j_beam_family)), full)
    first = size(element%svars) - 9*(points + full) + 1
    call describe(element, rule, beam)
    beam%axes(1:3, 1:3, 1:points) => element%svars(first:)
    states = points*max(1, beam%sections)*beam%values
    call keep_forces(element, states + 1, first)
    if (element%has_mass) call find_mass(beam, rule, element%props, element%svars(first + 9*points:), element%mass)
    if (.not. element%has_forces) return
    rule => rule_of(int(element%jprops(j_beam_family)), points)
    call integrate(beam, rule, element, element%rhs, element%amatrx, element%svars, resultants)
    if (element%of_stress) call turn_stress(beam, rule, element, resultants, element%amatrx)
  end subroutine timoshenko_beam

  !> Describe the beam of an element, but for its directions.
  subroutine describe(element, rule, beam)
    type(element_t), intent(in) :: element
    type(rule_t), intent(in) :: rule
    type(beam_t), intent(inout) :: beam
    integer :: values
    beam%n = element%n
    beam%dim = element%mcrd
    beam%each = merge(6, 3, element%mcrd == 3)
    beam%sections = element%jprops(j_beam_sections)
    beam%finite = element%finite
    beam%length = length_of(rule, beam%dim, element%coords)
    beam%centre(:, 1) = element%props(p_beam_centroid)
    beam%centre(:, 2) = element%props(p_beam_shear_centre)
    beam%material => element%material
    beam%values = 2*beam%each
    if (associated(beam%material)) then
      beam%values = beam%values + values_of_point(beam%material)
    else if (beam%sections > 0) then
      beam%values = beam%values + 2
    end if
    beam%x => element%coords
    beam%u(1:beam%each, 1:element%nodes) => element%u
    values = merge(4, 2, associated(beam%material))
    beam%places(1:values, 1:beam%sections) => element%props(p_beam_points:)
  end subroutine describe

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
  subroutine integrate(beam, rule, element, force, stiffness, svars, resultants)
    type(beam_t), intent(in) :: beam
    type(rule_t), intent(in) :: rule
    type(element_t), intent(inout) :: element
    real(dp), intent(inout) :: force(beam%n), stiffness(beam%n, beam%n)
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
    elastic = reshape(element%props(p_beam_stiffness), [6, 6])
    do k = 1, 2
      elastic(k + 1, k + 1) = elastic(k + 1, k + 1)/(1 + element%props(p_beam_slenderness(k))*beam%length**2)
    end do
    moved = 0
    moved(:beam%dim, :) = beam%x
    if (beam%finite) moved(:beam%dim, :) = beam%x + beam%u(:beam%dim, :)
    stored = 0
    stored_before = 0
    do p = 1, rule%points
      size = stretch(rule, p, beam%dim, beam%x)
      weight = rule%weight(p)*size
      place%axes = beam%axes(:, :, p)
      if (beam%finite .and. beam%dim == 3) then
        found = real(strains_in_space(beam, rule, p, cmplx(beam%u, kind=dp), place%axes), dp)
      else if (beam%finite) then
        motion = plane_motion(rule, p, size, beam%axes(:, :, p), beam%centre, beam%u)
        found = motion%strain
        place%axes = motion%turned
        part = reshape(plane_operator(rule, p, size, motion, beam%centre), [beam%each, beam%n])
      else
        part = reshape(along_unknowns(operator(rule, p, size, beam%axes(:, :, p), beam%centre), rows, unknowns), &
                       [beam%each, beam%n])
        found = matmul(part, element%u)
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
        call section_response(beam%material, rule, place, beam%sections, beam%places, element%fields, &
                              of_family(rule, element%predef), strain, forces, section, svars(:, :, p), energies)
        chosen = section(rows, rows)
        resultant = forces(rows)
      else
        call keep_stresses(beam%sections, beam%places, beam%centre(:, 1), element%props(p_beam_young), strain, svars(:, :, p))
      end if
      resultants%force(:, p) = resultant
      resultants%stiffness(:, :, p) = chosen
      if (beam%finite .and. beam%dim == 3) then
        call add_in_space(beam, rule, p, chosen, offset_of(associated(beam%material), chosen, found, resultant), beam%u, force, &
                          stiffness)
      else
        if (beam%finite) call add_turning(rule%nodes, motion, weight, resultant, stiffness)
        ! a compiler makes more of loops whose length it knows
        if (beam%each == 6) then
          call add_section(6, beam%n, part, weight, resultant, chosen, force, stiffness)
        else
          call add_section(3, beam%n, part, weight, resultant, chosen, force, stiffness)
        end if
      end if
      do k = 1, max(1, beam%sections)
        svars(beam%values - 2*beam%each + 1:, k, p) = [resultant, found]
      end do
    end do
    associate (energy => element%energy)
      if (associated(beam%material)) then
        ! what is not stored is dissipated
        energy(4) = energy(2) + energy(4) - stored_before + energies%work - energies%elastic
      end if
      energy(2) = stored + energies%elastic
    end associate
  end subroutine integrate

  !> Add force and stiffness of a section whose strains are linear in the unknowns.
  pure subroutine add_section(each, n, part, weight, resultant, modulus, force, stiffness)
    integer, value :: each
    integer, intent(in) :: n
    real(dp), intent(in) :: part(each, n), weight, resultant(each), modulus(each, each)
    real(dp), intent(inout) :: force(n), stiffness(n, n)
    force = force + weight*matmul(resultant, part)
    stiffness = stiffness + weight*matmul(transpose(part), matmul(modulus, part))
  end subroutine add_section

  !> The initial stress matrix (host_context): change of the forces as the beam turns.
  subroutine turn_stress(beam, rule, element, resultants, stiffness)
    type(beam_t), intent(in) :: beam
    type(rule_t), intent(in) :: rule
    type(element_t), intent(in) :: element
    type(resultants_t), intent(in) :: resultants
    real(dp), intent(out) :: stiffness(beam%n, beam%n)
    real(dp), parameter :: nothing(6, 6) = 0
    real(dp), dimension(beam%each, rule%nodes) :: at, added
    real(dp) :: forces(beam%each), ignored(beam%n), turned(3, 3), size
    type(plane_motion_t) :: motion
    integer :: p
    added = reshape(element%added, shape(added))
    at = 0
    if (beam%finite) at = beam%u
    ignored = 0
    stiffness = 0
    do p = 1, rule%points
      size = stretch(rule, p, beam%dim, beam%x)
      forces = resultants%force(:, p)
      if (beam%dim == 3) then
        if (element%request == added_stress) then
          forces = aimag(strains_in_space(beam, rule, p, cmplx(at, step*added, dp), turned))/step
          forces = matmul(resultants%stiffness(:, :, p), forces)
        end if
        call add_in_space(beam, rule, p, nothing, forces, at, ignored, stiffness)
      else
        motion = plane_motion(rule, p, size, beam%axes(:, :, p), beam%centre, at)
        if (element%request == added_stress) then
          associate (part => reshape(plane_operator(rule, p, size, motion, beam%centre), [beam%each, beam%n]))
            forces = matmul(resultants%stiffness(:, :, p), matmul(part, element%added))
          end associate
        end if
        call add_turning(rule%nodes, motion, rule%weight(p)*size, forces, stiffness)
      end if
    end do
  end subroutine turn_stress

  !> Strains of a beam in space in large displacements, and its directions now.
  function strains_in_space(beam, rule, p, u, turned) result(strain)
    type(beam_t), intent(in) :: beam
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: p
    complex(dp), intent(in) :: u(6, rule%nodes)
    real(dp), intent(out) :: turned(3, 3)
    complex(dp) :: strain(6)
    if (is_quadratic(rule)) then
      call curved_strains(point_of(beam, rule, p), u, strain, turned)
    else
      call turning_strains(beam%x, beam%axes(:, :, p), beam%centre, u, strain, turned)
    end if
  end function strains_in_space

  !> Add its forces and stiffness, where the forces of the section are linear in its strains, but for an offset.
  subroutine add_in_space(beam, rule, p, section, offset, u, force, stiffness)
    type(beam_t), intent(in) :: beam
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: p
    real(dp), intent(in) :: section(6, 6), offset(6), u(6, rule%nodes)
    real(dp), intent(inout) :: force(beam%n), stiffness(beam%n, beam%n)
    if (is_quadratic(rule)) then
      call add_curved_beam(point_of(beam, rule, p), section, offset, u, force, stiffness)
    else
      ! of its only point
      call turning_beam(beam%x, beam%axes(:, :, p), beam%centre, section, offset, u, force, stiffness)
    end if
  end subroutine add_in_space

  !> A point of a beam of three nodes.
  pure function point_of(beam, rule, p) result(point)
    type(beam_t), intent(in) :: beam
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: p
    type(curved_point) :: point
    real(dp) :: size
    size = stretch(rule, p, 3, beam%x)
    point%n = along_axis(rule, rule%n(:, p))
    point%slope = along_axis(rule, rule%dn(:, 1, p))/size
    point%axes = beam%axes(:, :, p)
    point%centre = beam%centre
    point%x = beam%x
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
  pure subroutine find_mass(beam, rule, props, axes, mass)
    type(beam_t), intent(in) :: beam
    type(rule_t), intent(in) :: rule
    real(dp), intent(in) :: props(:), axes(3, 3, rule%points)
    real(dp), intent(inout) :: mass(beam%n, beam%n)
    real(dp) :: of_section(6, 6), turn(6, 6), kept(beam%each, beam%each), at(rule%nodes), weight
    integer :: i, j, k, p, each, unknowns(beam%each)
    each = beam%each
    unknowns = kept_of(each, planar_unknowns)
    do p = 1, rule%points
      turn = 0
      turn(:3, :3) = axes(:, :, p)
      turn(4:, 4:) = axes(:, :, p)
      of_section = matmul(turn, matmul(reshape(props(p_beam_mass), [6, 6]), transpose(turn)))
      kept = of_section(unknowns, unknowns)
      at = along_axis(rule, rule%n(:, p))
      weight = props(p_beam_density)*rule%weight(p)*stretch(rule, p, beam%dim, beam%x)
      do k = 1, rule%nodes
        do j = 1, rule%nodes
          if (j /= k .and. .not. is_quadratic(rule)) cycle
          i = each*(j - 1)
          mass(i + 1:i + each, each*(k - 1) + 1:each*k) = mass(i + 1:i + each, each*(k - 1) + 1:each*k) &
            + weight*merge(at(j)*at(k), at(k), is_quadratic(rule))*kept
        end do
      end do
    end do
  end subroutine find_mass
end module host_beam
