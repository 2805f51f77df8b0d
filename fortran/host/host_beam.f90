! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in Timoshenko beams (B21, B22, B31, B32) of linear elastic sections as a procedure with the arguments of UEL.
!> harness/elements/beam.py gives what they need.
!>
!> JPROPS: family of the axis (host_shape), its integration points, section points, integration points of the mass. PROPS: density;
!> slenderness compensation of the shear along directions 2 and 1, over the squared length of the element; place of the centroid and
!> of the shear centre along directions 1 and 2; Young's modulus; section stiffness (6, 6) by the strains below; mass per length and
!> density (6, 6) of translations and rotations in the directions t, 1, 2; then the place of each section point.
!>
!> With NLGEOM beams in a plane have the strains of E. Reissner, Journal of Applied Mathematics and Physics 23 (1972) 795: those of
!> the axis in directions that turn with the section; for those of two nodes in space see host_beam_turning.
!>
!> Strains of the section, in this order: axial strain of the centroid, transverse shear strains along 2 and 1 of the shear centre,
!> curvature changes about 1 and 2, twist. Forces have the same order: SF1 SF2 SF3 SM1 SM2 SM3. Beams in a plane have the first two
!> and the curvature about 1, which is -z.
!>
!> SVARS hold, for each section point of each integration point, E11 S11, then forces and strains of the section, which are alone
!> where there are no section points; in dynamic analyses then the forces of the last two increments; last the directions t, 1, 2
!> of the integration points, then of those of the mass.
module host_beam
  use host_beam_turning, only: turning_beam
  use host_inertia, only: respond
  use host_kinds, only: dp, i4
  use host_shape, only: is_quadratic, rule_of, rule_t
  implicit none (type, external)
  private
  public :: beam_uel

  integer, parameter :: head = 80                        !< values of PROPS before the section points
  integer, parameter :: planar(3) = [1, 2, 4]            !< strains of a beam in a plane
  integer, parameter :: planar_unknowns(3) = [1, 2, 6]   !< dofs of its nodes

contains

  subroutine beam_uel(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                      v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                      lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period)
    integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                   lflags(*), mlvarx, mdload, jprops(*), njprop
    real(dp) :: rhs(*), amatrx(*), svars(*), energy(*), props(*), coords(*), u(*), du(*), v(*), a(*), time(*), dtime, &
                params(*), adlmag(*), predef(*), ddlmag(*), pnewdt, period
    real(dp) :: mass(ndofel, ndofel), old(ndofel, 2)
    integer :: n, each, points, full, values, states, axes
    type(rule_t), pointer :: rule
    n = ndofel
    each = merge(6, 3, mcrd == 3)
    points = jprops(2)
    full = jprops(4)
    values = 2*each + merge(2, 0, jprops(3) > 0)
    states = points*max(1, int(jprops(3)))*values
    axes = nsvars - 9*(points + full) + 1
    rule => rule_of(int(jprops(1)), full)
    old = 0
    if (axes > states + 1) old = reshape(svars(states + 1:axes - 1), [n, 2])
    call find_mass(rule, int(mcrd), each, n, props, coords, svars(axes + 9*points), mass)
    rhs(1:n*nrhs) = 0
    amatrx(1:n*n) = 0
    if (lflags(3) /= 3 .and. lflags(3) /= 4) then
      call integrate(rule_of(int(jprops(1)), points), int(mcrd), each, n, lflags(2) /= 0, int(jprops(3)), values, props, &
                     length_of(rule, int(mcrd), coords), coords, svars(axes), u, rhs, amatrx, svars, energy(2))
    end if
    call respond(n, lflags, params, dtime, v, a, mass, old, rhs, amatrx, energy(1))
    if (axes > states + 1) svars(states + 1:axes - 1) = reshape(old, [2*n])
  end subroutine beam_uel

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
  pure subroutine integrate(rule, dim, each, n, finite, sections, values, props, length, x, axes, u, force, stiffness, svars, &
                            stored)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: dim, n, sections, values
    integer, intent(in) :: each         !< strains, and unknowns of a node
    logical, intent(in) :: finite       !< of beams in a plane or of two nodes
    real(dp), intent(in) :: props(head + 2*sections), length, x(dim, rule%nodes), u(n)
    real(dp), intent(in) :: axes(3, 3, rule%points)    !< columns t, 1, 2
    real(dp), intent(inout) :: force(n), stiffness(n, n), svars(values, max(1, sections), rule%points)
    real(dp), intent(out) :: stored
    real(dp) :: section(6, 6), centre(2, 2), strain(6), along, size, weight
    real(dp) :: part(each, n), chosen(each, each), found(each), resultant(each)
    integer :: rows(each), unknowns(each), k, p
    rows = kept_of(each, planar)
    unknowns = kept_of(each, planar_unknowns)
    section = reshape(props(9:44), [6, 6])
    centre = reshape(props(4:7), [2, 2])
    do k = 1, 2
      section(k + 1, k + 1) = section(k + 1, k + 1)/(1 + props(k + 1)*length**2)
    end do
    chosen = section(rows, rows)
    stored = 0
    do p = 1, rule%points
      size = stretch(rule, p, dim, x)
      weight = rule%weight(p)*size
      if (finite .and. dim == 3) then
        ! of its only point
        call turning_beam(x, axes(:, :, p), centre, section, u, found, force, stiffness)
      else if (finite) then
        call plane_strains(rule, p, size, axes(:, :, p), centre, u, chosen, weight, found, part, stiffness)
      else
        part = reshape(along_unknowns(operator(rule, p, size, axes(:, :, p), centre), rows, unknowns), [each, n])
        found = matmul(part, u)
      end if
      strain = 0
      strain(rows) = found
      resultant = matmul(chosen, found)
      stored = stored + 0.5_dp*weight*dot_product(resultant, found)
      if (.not. finite .or. dim == 2) then
        force = force + weight*matmul(resultant, part)
        stiffness = stiffness + weight*matmul(transpose(part), matmul(chosen, part))
      end if
      do k = 1, sections
        associate (place => props(head + 2*k - 1:head + 2*k) - props(4:5))
          along = strain(1) + place(2)*strain(4) - place(1)*strain(5)
        end associate
        svars(:2, k, p) = [along, props(8)*along]
      end do
      do k = 1, max(1, sections)
        svars(values - 2*each + 1:, k, p) = [resultant, found]
      end do
    end do
  end subroutine integrate

  !> Strains of a beam in a plane in large displacements, how they vary with the unknowns, and the stiffness of forces that turn.
  pure subroutine plane_strains(rule, p, size, axes, centre, u, section, weight, strain, part, stiffness)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: p
    real(dp), intent(in) :: size, axes(3, 3), centre(2, 2), u(3, rule%nodes), section(3, 3), weight
    real(dp), intent(out) :: strain(3), part(3, 3, rule%nodes)
    real(dp), intent(inout) :: stiffness(3, rule%nodes, 3, rule%nodes)
    real(dp) :: n(rule%nodes), slope(rule%nodes), turned(3, 3), forces(3), tangent(2), line(2), across(2), angle
    integer :: i, j
    n = along_axis(rule, rule%n(:, p))
    slope = along_axis(rule, rule%dn(:, 1, p))/size
    angle = dot_product(n, u(3, :))
    turned = axes
    do i = 1, 3, 2
      turned(:2, i) = [cos(angle)*axes(1, i) - sin(angle)*axes(2, i), sin(angle)*axes(1, i) + cos(angle)*axes(2, i)]
    end do
    tangent = axes(:2, 1) + matmul(u(:2, :), slope)
    ! stretch and shear of the line of the nodes
    line = [dot_product(tangent, turned(:2, 1)) - 1, dot_product(tangent, turned(:2, 3))]
    strain = [line, -dot_product(slope, u(3, :))]
    strain(1) = strain(1) + centre(2, 1)*strain(3)
    part = along_unknowns(operator(rule, p, size, turned, centre), planar, planar_unknowns)
    part(1, 3, :) = part(1, 3, :) + line(2)*n
    part(2, 3, :) = part(2, 3, :) - line(1)*n
    forces = matmul(section, strain)
    across = forces(1)*turned(:2, 3) - forces(2)*turned(:2, 1)
    do j = 1, rule%nodes
      do i = 1, rule%nodes
        stiffness(:2, i, 3, j) = stiffness(:2, i, 3, j) + weight*slope(i)*n(j)*across
        stiffness(3, i, :2, j) = stiffness(3, i, :2, j) + weight*n(i)*slope(j)*across
        stiffness(3, i, 3, j) = stiffness(3, i, 3, j) - weight*n(i)*n(j)*(forces(1)*(1 + line(1)) + forces(2)*line(2))
      end do
    end do
  end subroutine plane_strains

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
