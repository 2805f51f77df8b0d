! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in conventional shells (S3, S3R, S4, S4R, S8R). harness/uel/elements/families/shell.py gives what they need.
!>
!> Transverse shear is elastic, and not that of the section points (Analysis User's Guide, Shell section behavior): its
!> stiffness comes with the factor 1/(1 + slenderness area/thickness^2). It and the drilling are integrated fully, the shear of
!> eight nodes at the integration points. S4R has one point, for the shear as well, and the hourglass control and the drilling of
!> host_shell_hourglass. With the enhanced control its hourglass modes have the stiffness that the elastic section has in S4.
!>
!> With NLGEOM all of it is in axes that turn with the element (host_corotation), of eight nodes with its points
!> (host_shell_directors).
!>
!> Values of PROPS and JPROPS: built_in.toml. SVARS hold the values of the section points (host_shell_section); in dynamic analyses
!> then the forces of the last two increments; then the directions of each integration point, with *ORIENTATION (host_axes); last
!> the director of each node.
module host_shell
  use host_adapter, only: element_t, keep_forces
  use host_axes, only: values_of_axes
  use host_context, only: added_stress
  use host_corotation, only: corotation_t, local_motion, turn_back
  use host_kinds, only: dp, i4
  use host_layout, only: j_shell_family, j_shell_layers, j_shell_oriented, j_shell_points, j_shell_sections, p_section_density, &
                         p_section_thickness, p_shell_drilling, p_shell_hourglass, p_shell_middle, p_shell_points, section_values
  use host_polar, only: polar_axes, step
  use host_shape, only: parent_place, rule_of, rule_t
  use host_shell_directors, only: director_stiffness, director_strains, mean_directors, shell_stress
  use host_shell_hourglass, only: drilling_of_corners, hourglass_of_shell
  use host_shell_section, only: add_section_points, elastic_section, identity, integrate_section, motion_t, operators_t, &
                                prepare_operators, report_shape, set_direction, shear_energy, shear_matrix, shear_stiffness
  use host_shell_strains, only: by_rotations, drilling_strain, enhance, shell_middle, shell_point, shell_strains
  implicit none (type, external)
  private
  public :: shell

  !> Motion of an element.
  type, extends(motion_t) :: shell_motion
    type(shell_point) :: middle             !< at the start
    real(dp), allocatable :: before(:, :)   !< (8, points) strains before the increment, of host_shell_directors
    real(dp), allocatable :: drill(:)       !< drilling strains of host_shell_directors
  end type shell_motion

contains

  subroutine shell(element)
    type(element_t), intent(inout) :: element
    real(dp), pointer, contiguous :: axes(:, :, :, :), v(:, :)
    type(operators_t) :: at_points, full
    integer :: points, behind
    associate (nodes => element%nodes, props => element%props)
      points = element%jprops(j_shell_points)
      behind = size(element%svars) + 1 - 3*nodes
      v(1:3, 1:nodes) => element%svars(behind:)
      axes => null()
      if (element%jprops(j_shell_oriented) /= 0) then
        behind = behind - values_of_axes*points
        axes(1:3, 1:3, 1:2, 1:points) => element%svars(behind:)
      end if
      call keep_forces(element, points*element%jprops(j_shell_sections)*section_values + 1, behind)
      call prepare(element, v, axes, at_points, full)
      if (element%has_mass) then
        call add_mass(nodes, props(p_section_thickness), props(p_section_density), props(p_shell_middle), full%point, element%mass)
      end if
      if (element%has_forces) call add_forces(element, v, at_points, full)
    end associate
  end subroutine shell

  !> Force, tangent, state and energies, or the initial stress matrix (host_context).
  subroutine add_forces(element, v, at_points, full)
    type(element_t), intent(inout) :: element
    real(dp), intent(in) :: v(3, element%nodes)
    type(operators_t), intent(in) :: at_points, full
    integer(i4), pointer, contiguous :: of_section(:, :)
    real(dp), pointer, contiguous :: section(:, :)
    real(dp) :: shear(2, 2), stored(2)
    type(shell_motion) :: motion
    type(shell_stress) :: stress
    logical :: directors
    associate (nodes => element%nodes, n => element%n, x => element%coords, props => element%props, energy => element%energy)
      of_section(1:3, 1:element%jprops(j_shell_sections)) => element%jprops(j_shell_layers:)
      section(1:3, 1:element%jprops(j_shell_sections)) => element%props(p_shell_points:)
      shear = shear_stiffness(props, sum(full%point%weight))
      directors = nodes == 8 .and. element%finite
      if (directors) then
        motion = motion_of_directors(nodes, x, v, at_points, full%point, element%u, element%du)
        stored = [shear_energy(at_points, shear, motion%before), shear_energy(at_points, shear, motion%strain)]
        energy(6) = 0.5_dp*props(p_shell_drilling)*sum(full%point%weight*motion%drill**2)
      else
        motion = motion_of(nodes, n, x, at_points, element%u, element%du, element%finite)
        call add_elastic(element, v, shear, at_points, full, motion, stored)
      end if
      energy(2) = energy(2) - stored(1)
      call integrate_section(element, rule_of(int(element%jprops(j_shell_family)), int(element%jprops(j_shell_points))), &
                             of_section, section, shear, &
                             at_points, motion, stress, element%svars, &
                             sqrt(sum(full%point%weight))*merge(0.5_dp, 1.0_dp, nodes == 8))
      energy(2) = energy(2) + stored(2)
      stress%drilling = props(p_shell_drilling)
      if (directors) stress%drill = props(p_shell_drilling)*motion%drill
      if (directors .or. (nodes == 8 .and. element%of_stress)) then
        call turn_directors(element, v, at_points%point, full%point, stress)
      else
        call add_section_points(n, at_points, stress, element%rhs, element%amatrx)
        if (element%of_stress) then
          call turn_stress(element, motion%middle)
        else if (element%finite) then
          call turn_back(nodes, x, motion%middle%frame, motion%middle%gradient(:nodes, :), element%u, element%rhs, element%amatrx)
        end if
      end if
    end associate
  end subroutine add_forces

  !> Displacements and rotations, with NLGEOM without the rotation of the element, and their strains.
  pure function motion_of(nodes, n, x, at, u, du, large) result(found)
    integer, intent(in) :: nodes, n
    real(dp), intent(in) :: x(3, nodes), u(n), du(n)
    type(operators_t), intent(in) :: at
    logical, intent(in) :: large
    type(shell_motion) :: found
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
    type(shell_motion) :: found
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

  !> The initial stress matrix (host_context): change of the forces as the element turns. On entry RHS and AMATRX are its forces and
  !> its stiffness without that rotation.
  pure subroutine turn_stress(element, middle)
    type(element_t), intent(inout) :: element
    type(shell_point), intent(in) :: middle
    real(dp) :: at(element%n), gradient(element%nodes, 2)
    type(corotation_t) :: now
    associate (nodes => element%nodes, n => element%n, x => element%coords)
      gradient = middle%gradient(:nodes, :)
      at = 0
      if (element%finite) at = element%u
      if (element%request == added_stress) then
        now = local_motion(nodes, x, middle%frame, gradient, reshape(cmplx(at, step*element%added, dp), [6, nodes]))
        element%rhs(:, 1) = matmul(element%amatrx, reshape(aimag(now%local), [n]))/step
      end if
      element%amatrx = 0
      call turn_back(nodes, x, middle%frame, gradient, at, element%rhs, element%amatrx)
    end associate
  end subroutine turn_stress

  !> Forces and stiffness of a shell whose directors turn, or its initial stress matrix.
  pure subroutine turn_directors(element, v, points, full, stress)
    type(element_t), intent(inout) :: element
    real(dp), intent(in) :: v(3, element%nodes)
    type(shell_point), intent(in) :: points(:), full(:)
    type(shell_stress), intent(inout) :: stress
    complex(dp) :: moved(6, element%nodes), strains(8, size(points)), drill(size(full))
    real(dp) :: at(element%n)
    integer :: p
    associate (nodes => element%nodes, x => element%coords)
      at = 0
      if (element%finite) at = element%u
      if (element%of_stress) then
        if (element%request == added_stress) then
          moved = reshape(cmplx(at, step*element%added, dp), [6, nodes])
          call director_strains(nodes, x, v, points, full, moved, strains, drill)
          do p = 1, size(points)
            stress%force(:, p) = matmul(stress%modulus(:, :, p), aimag(strains(:, p)))/step
          end do
          stress%drill = stress%drilling*aimag(drill)/step
        else if (.not. element%finite) then
          moved = reshape(cmplx(at, step*element%u, dp), [6, nodes])
          call director_strains(nodes, x, v, points, full, moved, strains, drill)
          stress%drill = stress%drilling*aimag(drill)/step
        end if
        stress%modulus = 0
        stress%drilling = 0
      end if
      call director_stiffness(nodes, x, v, points, full, reshape(at, [6, nodes]), stress, element%rhs, element%amatrx)
    end associate
  end subroutine turn_directors

  !> Operators at the integration points, and at those of full integration. Leaves the pass if the surface is folded.
  subroutine prepare(element, v, axes, at_points, full)
    type(element_t), intent(in) :: element
    real(dp), intent(in) :: v(3, element%nodes)
    real(dp), intent(in), pointer, contiguous :: axes(:, :, :, :)
    type(operators_t), intent(out) :: at_points, full
    integer :: family, points, reduced
    family = element%jprops(j_shell_family)
    reduced = element%jprops(j_shell_points)
    points = merge(9, element%nodes, element%nodes == 8)
    call find_operators(rule_of(family, reduced), element%n, element%coords, v, element%props, axes, at_points)
    if (reduced == points) then
      full = at_points
    else
      call find_operators(rule_of(family, points), element%n, element%coords, v, element%props, axes, full)
    end if
  end subroutine prepare

  !> axes: of the integration points; the first ones count where there are more points.
  subroutine find_operators(rule, n, x, v, props, axes, found)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: n
    real(dp), intent(in) :: x(3, rule%nodes), v(3, rule%nodes), props(:)
    real(dp), intent(in), pointer, contiguous :: axes(:, :, :, :)
    type(operators_t), intent(out) :: found
    real(dp) :: membrane(3, 3, rule%points), elastic(6, 6), b(8, 6, rule%nodes)
    integer :: p
    elastic = elastic_section(props)
    call prepare_operators(8, n, rule%points, found)
    do p = 1, rule%points
      call shell_strains(rule%nodes, x, v, parent_place(rule, p), rule%weight(p), found%point(p), b)
      if (.not. found%point(p)%good) call report_shape(p)
      found%b(:, :, p) = reshape(by_rotations(rule%nodes, v, b), [8, n])
      call set_direction(found, p, axes)
      membrane(:, :, p) = matmul(transpose(found%turn(:, :, p)), matmul(elastic(:3, :3), found%turn(:, :, p)))
    end do
    if (rule%nodes == 4 .and. rule%points > 1) call enhance(found%point, membrane, found%b)
  end subroutine find_operators

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

  !> What is linear: transverse shear, drilling, and hourglass modes of four nodes with one point.
  subroutine add_elastic(element, v, k, at_points, full, motion, stored)
    type(element_t), intent(inout) :: element
    real(dp), intent(in) :: v(3, element%nodes), k(2, 2)
    type(operators_t), intent(in) :: at_points, full
    type(shell_motion), intent(in) :: motion
    real(dp), intent(out) :: stored(2)     !< energy of the shear, before and now
    real(dp), dimension(element%n, element%n) :: shear, artificial
    real(dp) :: drill(element%n), area, moduli(2)
    logical :: reduced
    integer :: n, p
    n = element%n
    artificial = 0
    reduced = element%nodes == 4 .and. size(at_points%point) == 1
    moduli = element%props(p_shell_hourglass)
    if (element%nodes == 8 .or. (reduced .and. any(moduli > 0))) then
      shear = shear_matrix(at_points, n, k)
    else
      shear = shear_matrix(full, n, k)
    end if
    if (reduced) then
      area = sum(full%point%weight)
      artificial = drilling_of_corners(element%coords, motion%middle, area, element%props(p_section_thickness), &
                                       element%props(p_shell_drilling))
      if (any(moduli > 0)) then
        artificial = artificial + hourglass_of_shell(element%coords, v, motion%middle, area, moduli, 0.5_dp*(k(1, 1) + k(2, 2)), &
                                                     at_points%b(7:8, :, 1))
      else
        artificial = artificial + hourglass_stiffness(n, elastic_section(element%props), at_points, full)
      end if
    else
      do p = 1, size(full%point)
        drill = reshape(drilling_strain(element%nodes, full%point(p)), [n])
        artificial = artificial + full%point(p)%weight*element%props(p_shell_drilling)*spread(drill, 2, n)*spread(drill, 1, n)
      end do
    end if
    element%amatrx = element%amatrx + shear + artificial
    associate (u => motion%u, old => motion%old)
      element%rhs(:, 1) = element%rhs(:, 1) + matmul(shear + artificial, u)
      stored = 0.5_dp*[dot_product(old, matmul(shear, old)), dot_product(u, matmul(shear, u))]
      element%energy(6) = 0.5_dp*dot_product(u, matmul(artificial, u))
    end associate
  end subroutine add_elastic

  !> Enhanced stiffness of hourglass modes: what the elastic section has at the points of full integration more than at the only
  !> point.
  pure function hourglass_stiffness(n, elastic, at_points, full) result(stiffness)
    integer, intent(in) :: n
    real(dp), intent(in) :: elastic(6, 6)
    class(operators_t), intent(in) :: at_points, full
    real(dp) :: stiffness(n, n)
    integer :: p
    stiffness = -section_matrix(n, elastic, at_points, 1)
    do p = 1, size(full%point)
      stiffness = stiffness + section_matrix(n, elastic, full, p)
    end do
  end function hourglass_stiffness

  !> Stiffness of the elastic section at a point.
  pure function section_matrix(n, elastic, operators, p) result(stiffness)
    integer, intent(in) :: n, p
    real(dp), intent(in) :: elastic(6, 6)
    class(operators_t), intent(in) :: operators
    real(dp) :: stiffness(n, n), b(6, n)
    b(:3, :) = matmul(operators%turn(:, :, p), operators%b(:3, :, p))
    b(4:, :) = matmul(operators%turn(:, :, p), operators%b(4:6, :, p))
    stiffness = operators%point(p)%weight*matmul(transpose(b), matmul(elastic, b))
  end function section_matrix
end module host_shell
