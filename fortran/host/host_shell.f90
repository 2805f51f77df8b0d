! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in conventional shells (S3, S3R, S4, S4R, S8R) as a procedure with the arguments of UELMAT. harness/elements/shell.py gives
!> what they need.
!>
!> JPROPS: family of the surface (host_shape), its integration points, section points, 1 with *ORIENTATION; then material, layer and
!> section point of the layer (KSPT) of each section point. PROPS: thickness, density, stiffness against drilling, K11, K22 and K12
!> of the transverse shear, slenderness factor, place of the middle surface; elastic section stiffness (6, 6), of membrane strains
!> and curvatures; then place, weight and angle (radians) of each section point.
!>
!> Transverse shear is elastic, and not that of the section points (Analysis User's Guide, Shell section behavior): its
!> stiffness comes with the factor 1/(1 + slenderness area/thickness^2). It and the drilling are integrated fully, the shear of
!> eight nodes at the integration points. S4R has one point; its hourglass modes have the stiffness that the elastic section has
!> in S4.
!>
!> With NLGEOM all of it is in axes that turn with the element (host_corotation), of eight nodes with its points
!> (host_shell_directors).
!>
!> SVARS hold, for each section point of each integration point, E11 E22 E12 S11 S22 S12 in the directions of its layer, and SF1 to
!> SF5, SM1 to SM3 of the section; in dynamic analyses then the forces of the last two increments; then the directions of each
!> integration point, with *ORIENTATION (host_axes); last the director of each node.
module host_shell
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_loc
  use host_axes, only: values_of_axes
  use host_context, only: added_stress, current, stress_matrix
  use host_corotation, only: corotation_t, local_motion, turn_back
  use host_coupling, only: interpolate_fields
  use host_inertia, only: respond
  use host_kinds, only: dp, i4
  use host_materials, only: elastic_energy, find_material, has_fields, material_t, set_constants, stress_update
  use host_messages, only: add_message
  use host_polar, only: polar_axes, step
  use host_protect, only: escape
  use host_shape, only: parent_place, rule_of, rule_t
  use host_shell_directors, only: director_stiffness, director_strains, mean_directors, shell_stress
  use host_shell_strains, only: drilling_strain, enhance, shell_middle, shell_point, shell_strains, tensor_turn
  use host_usdfld, only: call_usdfld
  implicit none (type, external)
  private
  public :: shell_uelmat

  integer, parameter :: values = 14       !< of SVARS for a section point
  integer, parameter :: head = 44         !< values of PROPS before those of the section points

  real(dp), parameter :: identity(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])

  !> Sine below which the direction of an orientation is normal to the surface.
  real(dp), parameter :: smallest_sine = 1.745328e-3_dp

  !> The strain operators of an element, and the angle of the section's direction 1 at each point from the first axis, with
  !> *ORIENTATION and without.
  type :: operators_t
    type(shell_point), allocatable :: point(:)
    real(dp), allocatable :: b(:, :, :)     !< (8, unknowns, points)
    real(dp), allocatable :: angle(:), default(:)
    real(dp), allocatable :: turn(:, :, :)  !< (3, 3, points) strains to the directions of the section
  end type operators_t

  !> Motion of an element.
  type :: motion_t
    type(shell_point) :: middle             !< at the start
    real(dp), allocatable :: u(:), old(:)   !< displacements and rotations, now and before the increment
    real(dp), allocatable :: x(:, :)        !< where the nodes are, as COORDS of user routines
    real(dp), allocatable :: normal(:, :)   !< (3, points)
    real(dp), allocatable :: frame(:, :, :) !< (3, 3, points) rows: axes and normal before the increment
    real(dp), allocatable :: strain(:, :), before(:, :)   !< (8, points) along the axes of the points
    real(dp), allocatable :: drill(:)       !< drilling strains of host_shell_directors
  end type motion_t

contains

  subroutine shell_uelmat(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                          v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                          lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period, materiallib)
    integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                   lflags(*), mlvarx, mdload, jprops(*), njprop, materiallib
    real(dp), target :: svars(*)
    real(dp) :: rhs(*), amatrx(*), energy(*), props(*), coords(*), u(*), du(*), v(*), a(*), time(*), dtime, &
                params(*), adlmag(*), predef(*), ddlmag(*), pnewdt, period
    real(dp), pointer, contiguous :: axes(:, :, :, :)
    real(dp) :: mass(ndofel, ndofel), old(ndofel, 2), change(ndofel), shear(2, 2), stored(2)
    integer :: n, first, behind
    logical :: directors
    type(operators_t) :: at_points, full
    type(motion_t) :: motion
    type(shell_stress) :: stress
    n = ndofel
    first = jprops(2)*jprops(3)*values + 1
    behind = nsvars + 1 - 3*nnode
    axes => null()
    if (jprops(4) /= 0) then
      behind = behind - values_of_axes*jprops(2)
      call c_f_pointer(c_loc(svars(behind)), axes, [3, 3, 2, int(jprops(2))])
    end if
    old = 0
    if (behind > first) old = reshape(svars(first:behind - 1), [n, 2])
    call prepare(int(jprops(:4)), int(nnode), n, coords, svars(nsvars - 3*nnode + 1), props, axes, at_points, full)
    mass = 0
    call add_mass(int(nnode), props(1), props(2), props(8), full%point, mass)
    rhs(1:n*nrhs) = 0
    amatrx(1:n*n) = 0
    if (lflags(3) /= 3 .and. lflags(3) /= 4) then
      ! no time passes where the matrix of a stress is asked for: DU is a perturbation
      change = du(:n)
      if (stress_matrix(lflags(3))) change = 0
      shear = shear_stiffness(props, sum(full%point%weight))
      directors = nnode == 8 .and. lflags(2) /= 0
      if (directors) then
        motion = motion_of_directors(int(nnode), coords, svars(nsvars - 3*nnode + 1), at_points, full%point, u, change)
        stored = [shear_energy(at_points, shear, motion%before), shear_energy(at_points, shear, motion%strain)]
        energy(6) = 0.5_dp*props(3)*sum(full%point%weight*motion%drill**2)
      else
        motion = motion_of(int(nnode), n, coords, at_points, u, change, lflags(2) /= 0)
        call add_elastic(int(nnode), n, props, shear, at_points, full, motion, rhs, amatrx, stored, energy(6))
      end if
      energy(2) = energy(2) - stored(1)
      call integrate(rule_of(int(jprops(1)), int(jprops(2))), int(jprops(3)), jprops(5), props(head + 1), shear, at_points, &
                     int(npredf), predef, motion, stress, svars, energy, sum(full%point%weight))
      energy(2) = energy(2) + stored(2)
      stress%drilling = props(3)
      if (directors) stress%drill = props(3)*motion%drill
      if (directors .or. (nnode == 8 .and. stress_matrix(lflags(3)))) then
        call turn_directors(int(nnode), n, lflags, coords, svars(nsvars - 3*nnode + 1), at_points%point, full%point, u, du, &
                            stress, rhs, amatrx)
      else
        call add_section_points(n, at_points, stress, rhs, amatrx)
        if (stress_matrix(lflags(3))) then
          call turn_stress(int(nnode), n, lflags, coords, motion%middle, u, du, rhs, amatrx)
        else if (lflags(2) /= 0) then
          call turn_back(int(nnode), coords, motion%middle%frame, motion%middle%gradient(:nnode, :), u, rhs, amatrx)
        end if
      end if
    end if
    call respond(n, lflags, params, dtime, v, a, mass, old, rhs, amatrx, energy(1))
    if (behind > first) svars(first:behind - 1) = reshape(old, [2*n])
  end subroutine shell_uelmat

  !> Displacements and rotations, with NLGEOM without the rotation of the element, and their strains.
  pure function motion_of(nodes, n, x, at, u, du, large) result(found)
    integer, intent(in) :: nodes, n
    real(dp), intent(in) :: x(3, nodes), u(n), du(n)
    type(operators_t), intent(in) :: at
    logical, intent(in) :: large
    type(motion_t) :: found
    type(corotation_t) :: before, now
    real(dp) :: moved(6, nodes), gradient(nodes, 2), turn(3, 3), turn_before(3, 3)
    integer :: p
    moved = reshape(u, [6, nodes])
    found%middle = shell_middle(nodes, x)
    found%u = u
    found%old = u - du
    found%x = x
    turn = identity
    turn_before = identity
    if (large) then
      gradient = found%middle%gradient(:nodes, :)
      before = local_motion(nodes, x, found%middle%frame, gradient, cmplx(reshape(found%old, [6, nodes]), kind=dp))
      now = local_motion(nodes, x, found%middle%frame, gradient, cmplx(moved, kind=dp))
      found%u = reshape(real(now%local, dp), [n])
      found%old = reshape(real(before%local, dp), [n])
      turn = real(now%rotation, dp)
      turn_before = real(before%rotation, dp)
      found%x = x + moved(:3, :)
    end if
    allocate (found%normal(3, size(at%point)), found%strain(8, size(at%point)), found%frame(3, 3, size(at%point)))
    do p = 1, size(at%point)
      found%normal(:, p) = matmul(turn, at%point(p)%frame(3, :))
      found%frame(:, :, p) = matmul(at%point(p)%frame, transpose(turn_before))
      found%strain(:, p) = matmul(at%b(:, :, p), found%u)
    end do
  end function motion_of

  !> Strains of a shell whose directors turn.
  pure function motion_of_directors(nodes, x, v, at, full, u, du) result(found)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(3, nodes), v(3, nodes), u(6, nodes), du(6, nodes)
    type(operators_t), intent(in) :: at
    type(shell_point), intent(in) :: full(:)
    type(motion_t) :: found
    complex(dp) :: strains(8, size(at%point)), drill(size(full))
    integer :: p
    found%x = x + u(:3, :)
    found%normal = mean_directors(nodes, x, v, at%point, u)
    call director_strains(nodes, x, v, at%point, full, cmplx(u - du, kind=dp), strains, drill)
    found%before = real(strains, dp)
    call director_strains(nodes, x, v, at%point, full, cmplx(u, kind=dp), strains, drill)
    found%strain = real(strains, dp)
    found%drill = real(drill, dp)
    allocate (found%frame(3, 3, size(at%point)))
    do p = 1, size(at%point)
      associate (along => matmul(x + u(:3, :) - du(:3, :), at%point(p)%gradient(:nodes, :)))
        found%frame(:, :, p) = transpose(real(polar_axes(cmplx(along, kind=dp)), dp))
      end associate
    end do
  end function motion_of_directors

  !> The matrix of a stress (host_context), from the forces and the stiffness by the motion of an element: what its forces change by
  !> as it turns.
  pure subroutine turn_stress(nodes, n, lflags, x, middle, u, du, force, stiffness)
    integer, intent(in) :: nodes, n
    integer(i4), intent(in) :: lflags(3)
    real(dp), intent(in) :: x(3, nodes), u(n), du(n)
    type(shell_point), intent(in) :: middle
    real(dp), intent(inout) :: force(n), stiffness(n, n)
    complex(dp) :: moved(n)
    real(dp) :: at(n), gradient(nodes, 2)
    type(corotation_t) :: now
    gradient = middle%gradient(:nodes, :)
    at = 0
    if (lflags(2) /= 0) at = u
    if (lflags(3) == added_stress) then
      moved = cmplx(at, step*du, dp)
      now = local_motion(nodes, x, middle%frame, gradient, reshape(moved, [6, nodes]))
      force = matmul(stiffness, reshape(aimag(now%local), [n]))/step
    end if
    stiffness = 0
    call turn_back(nodes, x, middle%frame, gradient, at, force, stiffness)
  end subroutine turn_stress

  !> Forces and stiffness of a shell whose directors turn, or the matrix of its stress.
  pure subroutine turn_directors(nodes, n, lflags, x, v, points, full, u, du, stress, force, stiffness)
    integer, intent(in) :: nodes, n
    integer(i4), intent(in) :: lflags(3)
    real(dp), intent(in) :: x(3, nodes), v(3, nodes), u(n), du(n)
    type(shell_point), intent(in) :: points(:), full(:)
    type(shell_stress), intent(inout) :: stress
    real(dp), intent(out) :: force(n), stiffness(n, n)
    complex(dp) :: moved(6, nodes), strains(8, size(points)), drill(size(full))
    real(dp) :: at(n)
    integer :: p
    at = 0
    if (lflags(2) /= 0) at = u
    if (stress_matrix(lflags(3))) then
      if (lflags(3) == added_stress) then
        moved = reshape(cmplx(at, step*du, dp), [6, nodes])
        call director_strains(nodes, x, v, points, full, moved, strains, drill)
        do p = 1, size(points)
          stress%force(:, p) = matmul(stress%modulus(:, :, p), aimag(strains(:, p)))/step
        end do
        stress%drill = stress%drilling*aimag(drill)/step
      else if (lflags(2) == 0) then
        call director_strains(nodes, x, v, points, full, reshape(cmplx(at, step*u, dp), [6, nodes]), strains, drill)
        stress%drill = stress%drilling*aimag(drill)/step
      end if
      stress%modulus = 0
      stress%drilling = 0
    end if
    call director_stiffness(nodes, x, v, points, full, reshape(at, [6, nodes]), stress, force, stiffness)
  end subroutine turn_directors

  !> Operators at the integration points, and at those of full integration. Leaves the pass if the surface is folded.
  subroutine prepare(kind, nodes, n, x, v, props, axes, at_points, full)
    integer, intent(in) :: kind(4), nodes, n
    real(dp), intent(in) :: x(3, nodes), v(3, nodes), props(head)
    real(dp), intent(in), pointer, contiguous :: axes(:, :, :, :)
    type(operators_t), intent(out) :: at_points, full
    integer :: points
    call find_operators(rule_of(kind(1), kind(2)), n, x, v, props, axes, at_points)
    points = merge(9, nodes, nodes == 8)
    if (kind(2) == points) then
      full = at_points
    else
      call find_operators(rule_of(kind(1), points), n, x, v, props, axes, full)
    end if
  end subroutine prepare

  !> axes: of the integration points; the first ones count where there are more points.
  subroutine find_operators(rule, n, x, v, props, axes, found)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: n
    real(dp), intent(in) :: x(3, rule%nodes), v(3, rule%nodes), props(head)
    real(dp), intent(in), pointer, contiguous :: axes(:, :, :, :)
    type(operators_t), intent(out) :: found
    real(dp) :: membrane(3, 3, rule%points), elastic(6, 6), angle
    real(dp) :: b(8, 6, rule%nodes)
    integer :: p
    elastic = reshape(props(9:44), [6, 6])
    allocate (found%point(rule%points), found%b(8, n, rule%points), found%angle(rule%points), found%default(rule%points), &
              found%turn(3, 3, rule%points))
    do p = 1, rule%points
      call shell_strains(rule%nodes, x, v, parent_place(rule, p), rule%weight(p), found%point(p), b)
      if (.not. found%point(p)%good) call report_shape(p)
      found%b(:, :, p) = reshape(b, [8, n])
      angle = angle_of(p, found%point(p)%frame, default_direction(found%point(p)%frame(3, :)))
      found%default(p) = angle
      if (associated(axes)) angle = angle_of(p, found%point(p)%frame, axes(1, :, 1, min(p, size(axes, 4))))
      found%angle(p) = angle
      found%turn(:, :, p) = tensor_turn(angle)
      membrane(:, :, p) = matmul(transpose(found%turn(:, :, p)), matmul(elastic(:3, :3), found%turn(:, :, p)))
    end do
    if (rule%nodes == 4 .and. rule%points > 1) call enhance(found%point, membrane, found%b)
  end subroutine find_operators

  !> The global direction whose projection is direction 1 by default: x, or z where x is within 0.1 degrees of the normal.
  pure function default_direction(normal) result(direction)
    real(dp), intent(in) :: normal(3)
    real(dp) :: direction(3)
    direction = [1, 0, 0]
    if (hypot(normal(2), normal(3)) < smallest_sine) direction = [0, 0, 1]
  end function default_direction

  !> Angle of the projection of a direction from the first axis of a point. Leaves the pass if it is normal to the surface.
  real(dp) function angle_of(point, frame, direction)
    integer, intent(in) :: point
    real(dp), intent(in) :: frame(3, 3), direction(3)
    real(dp) :: along(2)
    character(len=160) :: text
    along = matmul(frame(:2, :), direction)
    if (.not. norm2(along) > 1.0e-6_dp) then
      write (text, '(a,i0)') '*ORIENTATION: the axis that is projected is normal to the shell at integration point ', point
      call add_message(-3_i4, trim(text))
      call escape()
    end if
    angle_of = atan2(along(2), along(1))
  end function angle_of

  subroutine report_shape(point)
    integer, intent(in) :: point
    character(len=160) :: text
    write (text, '(a,i0,a)') 'the shell has no area or is folded at its integration point ', point, &
      '; its nodes must run around it'
    call add_message(-3_i4, trim(text))
    call escape()
  end subroutine report_shape

  !> Mass, with the rotary inertia of the thickness for all rotations: lumped, of eight nodes consistent.
  pure subroutine add_mass(nodes, thickness, density, middle, points, mass)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: thickness, density, middle
    type(shell_point), intent(in) :: points(:)
    real(dp), intent(inout) :: mass(6, nodes, 6, nodes)
    real(dp) :: area(nodes, nodes), inertia
    integer :: i, k, p
    area = 0
    do p = 1, size(points)
      associate (shape => points(p)%n(:nodes))
        if (nodes == 8) then
          area = area + points(p)%weight*spread(shape, 2, nodes)*spread(shape, 1, nodes)
        else
          do k = 1, nodes
            area(k, k) = area(k, k) + points(p)%weight*shape(k)
          end do
        end if
      end associate
    end do
    do i = 1, 6
      inertia = density*thickness*merge(1.0_dp, thickness**2/12 + middle**2, i <= 3)
      mass(i, :, i, :) = inertia*area
    end do
  end subroutine add_mass

  !> Transverse shear stiffness of the section.
  pure function shear_stiffness(props, area) result(k)
    real(dp), intent(in) :: props(head), area
    real(dp) :: k(2, 2)
    k = reshape([props(4), props(6), props(6), props(5)], [2, 2])/(1 + props(7)*area/props(1)**2)
  end function shear_stiffness

  !> Transverse shear strains by the unknowns, in the directions of the section.
  pure function section_shear(operators, p, n) result(b)
    type(operators_t), intent(in) :: operators
    integer, intent(in) :: p, n
    real(dp) :: b(2, n), turn(8, 8)
    turn = section_turn(operators, p)
    b = matmul(turn(7:, 7:), operators%b(7:, :, p))
  end function section_shear

  !> Stiffness of the transverse shear, integrated at points.
  pure function shear_matrix(at, n, k) result(shear)
    type(operators_t), intent(in) :: at
    integer, intent(in) :: n
    real(dp), intent(in) :: k(2, 2)
    real(dp) :: shear(n, n), b(2, n)
    integer :: p
    shear = 0
    do p = 1, size(at%point)
      b = section_shear(at, p, n)
      shear = shear + at%point(p)%weight*matmul(transpose(b), matmul(k, b))
    end do
  end function shear_matrix

  !> Its energy, by the strains at the points.
  pure real(dp) function shear_energy(at, k, strains)
    type(operators_t), intent(in) :: at
    real(dp), intent(in) :: k(2, 2), strains(:, :)
    real(dp) :: turn(8, 8), shear(2)
    integer :: p
    shear_energy = 0
    do p = 1, size(at%point)
      turn = section_turn(at, p)
      shear = matmul(turn(7:, 7:), strains(7:, p))
      shear_energy = shear_energy + 0.5_dp*at%point(p)%weight*dot_product(shear, matmul(k, shear))
    end do
  end function shear_energy

  !> Matrix from the strains along the axes of a point to those in the directions of the section.
  pure function section_turn(at, p) result(turn)
    type(operators_t), intent(in) :: at
    integer, intent(in) :: p
    real(dp) :: turn(8, 8), c, s
    c = cos(at%angle(p))
    s = sin(at%angle(p))
    turn = 0
    turn(:3, :3) = at%turn(:, :, p)
    turn(4:6, 4:6) = at%turn(:, :, p)
    turn(7, 7:) = [c, s]
    turn(8, 7:) = [-s, c]
  end function section_turn

  !> What is linear: transverse shear, drilling, and hourglass modes of four nodes with one point.
  subroutine add_elastic(nodes, n, props, k, at_points, full, motion, force, stiffness, stored, spurious)
    integer, intent(in) :: nodes, n
    real(dp), intent(in) :: props(head), k(2, 2)
    type(operators_t), intent(in) :: at_points, full
    type(motion_t), intent(in) :: motion
    real(dp), intent(inout) :: force(n), stiffness(n, n)
    real(dp), intent(out) :: stored(2)     !< energy of the shear, before and now
    real(dp), intent(out) :: spurious      !< energy of drilling and hourglass modes
    real(dp) :: shear(n, n), artificial(n, n), drill(n), part(n, n)
    integer :: p
    artificial = 0
    if (nodes == 8) then
      shear = shear_matrix(at_points, n, k)
    else
      shear = shear_matrix(full, n, k)
    end if
    do p = 1, size(full%point)
      drill = reshape(drilling_strain(nodes, full%point(p)), [n])
      artificial = artificial + full%point(p)%weight*props(3)*spread(drill, 2, n)*spread(drill, 1, n)
    end do
    if (size(at_points%point) == 1 .and. nodes == 4) then
      do p = 1, 4
        call add_section(n, props, full, p, artificial)
      end do
      part = 0
      call add_section(n, props, at_points, 1, part)
      artificial = artificial - part
    end if
    stiffness = stiffness + shear + artificial
    associate (u => motion%u, old => motion%old)
      force = force + matmul(shear + artificial, u)
      stored = 0.5_dp*[dot_product(old, matmul(shear, old)), dot_product(u, matmul(shear, u))]
      spurious = 0.5_dp*dot_product(u, matmul(artificial, u))
    end associate
  end subroutine add_elastic

  !> Stiffness of the elastic section at a point.
  pure subroutine add_section(n, props, operators, p, stiffness)
    integer, intent(in) :: n, p
    real(dp), intent(in) :: props(head)
    type(operators_t), intent(in) :: operators
    real(dp), intent(inout) :: stiffness(n, n)
    real(dp) :: b(6, n)
    b(:3, :) = matmul(operators%turn(:, :, p), operators%b(:3, :, p))
    b(4:, :) = matmul(operators%turn(:, :, p), operators%b(4:6, :, p))
    stiffness = stiffness + operators%point(p)%weight*matmul(transpose(b), matmul(reshape(props(9:44), [6, 6]), b))
  end subroutine add_section

  !> Forces and stiffness of membrane and bending, by displacements and rotations whose strains are linear.
  pure subroutine add_section_points(n, at, stress, force, stiffness)
    integer, intent(in) :: n
    type(operators_t), intent(in) :: at
    type(shell_stress), intent(in) :: stress
    real(dp), intent(inout) :: force(n), stiffness(n, n)
    integer :: p
    do p = 1, size(at%point)
      associate (b => at%b(:6, :, p), weight => at%point(p)%weight)
        force = force + weight*matmul(stress%force(:6, p), b)
        stiffness = stiffness + weight*matmul(transpose(b), matmul(stress%modulus(:6, :6, p), b))
      end associate
    end do
  end subroutine add_section_points

  !> Stress and state of all section points, and what they make along the axes of the integration points.
  subroutine integrate(rule, sections, of_section, section, k_shear, at, fields, predef, motion, found, svars, energy, area)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: sections, fields
    integer(i4), intent(in) :: of_section(3, sections)
    real(dp), intent(in) :: section(3, sections), k_shear(2, 2), predef(2, fields, rule%nodes), area
    type(operators_t), intent(in) :: at
    type(motion_t), intent(in) :: motion
    type(shell_stress), intent(inout) :: found
    real(dp), intent(inout), target :: svars(values, sections, rule%points)
    real(dp), intent(inout) :: energy(8)
    type(material_t), pointer :: material
    real(dp) :: axes(8, 8), strain(8), resultant(8), tangent(8, 8), turn(3, 3), layer(3), stress(3), modulus(3, 3)
    real(dp) :: elastic, work, volume, z
    integer(i4) :: column
    integer :: k, p
    logical :: valid
    current%finite = .false.
    current%deformed = .false.
    elastic = 0
    work = energy(2) + energy(4)
    allocate (found%force(8, rule%points), found%modulus(8, 8, rule%points))
    do p = 1, rule%points
      axes = section_turn(at, p)
      strain = matmul(axes, motion%strain(:, p))
      tangent = 0
      tangent(7:, 7:) = k_shear
      resultant = matmul(tangent, strain)
      do k = 1, sections
        material => find_material(of_section(1, k))
        z = section(1, k)
        if (has_fields(material)) then
          current%length = sqrt(area)*merge(0.5_dp, 1.0_dp, rule%nodes == 8)
          current%place = matmul(motion%x, at%point(p)%n(:rule%nodes)) + z*motion%normal(:, p)
          call interpolate_fields(rule, p, fields, predef, material%variables)
        end if
        current%npt = int(p, i4)
        current%layer = of_section(2, k)
        current%kspt = of_section(3, k)
        column = int((p - 1)*sections + k, i4)
        if (allocated(material%user_field)) then
          call call_usdfld(material%user_field, 3, column, turned(at%angle(p) + section(3, k), motion%frame(:, :, p)), &
                           turned(at%angle(p) - at%default(p) + section(3, k), identity), .true., svars(:6, k, p))
        end if
        if (allocated(material%dependence)) call set_constants(material, p)
        turn = tensor_turn(section(3, k))
        layer = matmul(turn, strain(:3) + z*strain(4:6))
        call stress_update(material, column, layer, stress, modulus, valid)
        volume = at%point(p)%weight*section(2, k)
        elastic = elastic + volume*elastic_energy(material, column, stress)
        associate (state => svars(:6, k, p))
          ! trapezoidal rule, exact where the response is linear
          work = work + volume*0.5_dp*dot_product(stress + state(4:), layer - state(:3))
          state = [layer, stress]
        end associate
        stress = matmul(transpose(turn), stress)
        modulus = section(2, k)*matmul(transpose(turn), matmul(modulus, turn))
        resultant(:6) = resultant(:6) + section(2, k)*[stress, z*stress]
        tangent(:3, :3) = tangent(:3, :3) + modulus
        tangent(4:6, :3) = tangent(4:6, :3) + z*modulus
        tangent(:3, 4:6) = tangent(:3, 4:6) + z*modulus
        tangent(4:6, 4:6) = tangent(4:6, 4:6) + z**2*modulus
      end do
      do k = 1, sections
        svars(7:, k, p) = resultant([1, 2, 3, 7, 8, 4, 5, 6])
      end do
      found%force(:, p) = matmul(resultant, axes)
      found%modulus(:, :, p) = matmul(transpose(axes), matmul(tangent, axes))
    end do
    if (allocated(current%fields)) deallocate (current%fields)
    energy(2) = elastic
    energy(4) = work - elastic
  end subroutine integrate

  !> Directions (rows) turned by an angle about the third.
  pure function turned(angle, axes)
    real(dp), intent(in) :: angle, axes(3, 3)
    real(dp) :: turned(3, 3)
    turned(1, :) = cos(angle)*axes(1, :) + sin(angle)*axes(2, :)
    turned(2, :) = cos(angle)*axes(2, :) - sin(angle)*axes(1, :)
    turned(3, :) = axes(3, :)
  end function turned
end module host_shell
