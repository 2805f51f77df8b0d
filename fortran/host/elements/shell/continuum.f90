! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in continuum shells (SC6R, SC8R). harness/uel/elements/families/continuum_shell.py gives what they need.
!>
!> Pairs of nodes at the bottom and the top, b and t, make the shell m(r,s) + z d(r,s)/h of host_shell_strains: the middle surface
!> m = (b + t)/2, and d = t - b over the thickness h as the director. Its strains are those of Green and Lagrange, less what is
!> quadratic in z: half of the change of
!>
!>     m,a . m,b,    z (m,a . d,b + d,a . m,b)/h,    2 m,a . d/h,    d . d/h^2,
!>
!> with the shear assumed from the middles of the edges, and the last one, across, interpolated between the pairs (P. Betsch, E.
!> Stein, Communications in Numerical Methods in Engineering 11 (1995) 899): what the middle of a curved element would have of it
!> would resist bending. Each is a quadratic form of the places of the nodes, so B is linear in them, and the geometric
!> stiffness of a given stress is constant. They are turned from the director to the normal, so that elements whose edges are not
!> normal to the faces have constant strains. The enhanced modes of host_shell_strains complete what S. Klinkel, F. Gruttmann and W.
!> Wagner (Computers and Structures 71 (1999) 43) have of such shells. Without NLGEOM strains are linear.
!>
!> Section points are in plane stress, at one point of the surface. The stress across is constant, the thickness modulus times
!>
!>     strain across + nu/(1 - nu) (11 + 22 of the middle surface).
!>
!> It and the transverse shear are elastic, and integrated fully. The hourglass modes of four pairs have the stiffness that the
!> elastic section has at 2 x 2 points for the strains there less their mean.
!>
!> Places and weights of the section points, and what the elastic section has, are for the thickness of the section, and change
!> with that of the element. Stresses are in axes that move with the surface; those of user routines turn with the middle of the
!> element (core_solid_rotation).
!>
!> Values of PROPS and JPROPS: built_in.toml. SVARS hold the values of the section points (host_shell_section); in dynamic analyses
!> then the forces of the last two increments; then the directions of the integration point, with *ORIENTATION (host_axes); last
!> the stack direction.
module host_continuum_shell
  use core_small_matrix, only: invert
  use core_solid_rotation, only: find_turn, solid_turn
  use host_adapter, only: element_t, keep_forces
  use host_axes, only: values_of_axes
  use host_context, only: added_stress, current
  use host_kinds, only: dp, i4
  use host_layout, only: j_continuum_shell_family, j_continuum_shell_layers, j_continuum_shell_oriented, j_continuum_shell_scaled, &
                         j_continuum_shell_sections, j_continuum_shell_surface, p_continuum_shell_modulus, &
                         p_continuum_shell_points, p_continuum_shell_transverse, p_section_density, p_section_thickness, &
                         section_values
  use host_messages, only: add_message
  use host_protect, only: escape
  use host_shape, only: parent_place, rule_of, rule_t
  use host_shell_directors, only: shell_stress
  use host_shell_section, only: add_section_points, elastic_section, integrate_section, motion_t, operators_t, prepare_operators, &
                                report_shape, section_turn, set_direction, shear_stiffness
  use host_shell_strains, only: assumed_shear, enhance, shell_middle, shell_place, shell_point
  use host_solid_mass, only: mass_matrix
  implicit none (type, external)
  private
  public :: continuum_shell

  integer, parameter :: across = 9     !< place of the strain across among those of a point

  !> The shell between the faces of an element.
  type :: pairs_t
    integer, allocatable :: order(:)        !< local nodes: those at the bottom, then those at the top
    real(dp), allocatable :: x(:, :)        !< (3, pairs) middle surface
    real(dp), allocatable :: d(:, :)        !< (3, pairs) from the bottom to the top
    real(dp) :: height = 0                  !< thickness in the middle
    real(dp) :: director(3) = 0             !< there: d over the thickness
    real(dp), allocatable :: gradient(:, :) !< (3, nodes) of the shape functions there
  end type pairs_t

  !> Strains of points: half of the change of quadratic forms of the places of the nodes.
  type, extends(operators_t) :: forms_t
    real(dp), allocatable :: form(:, :, :)  !< (9, nodes*nodes, points)
  end type forms_t

  !> Elastic strains of an element with their stiffness.
  type :: elastic_t
    real(dp), allocatable :: form(:, :)     !< (strains, nodes*nodes)
    real(dp), allocatable :: modulus(:, :)  !< (strains, strains), integrated
  end type elastic_t

contains

  subroutine continuum_shell(element)
    type(element_t), intent(inout) :: element
    real(dp), pointer, contiguous :: axes(:, :, :, :)
    integer :: behind
    behind = size(element%svars)
    axes => null()
    if (element%jprops(j_continuum_shell_oriented) /= 0) then
      behind = behind - values_of_axes
      axes(1:3, 1:3, 1:2, 1:1) => element%svars(behind:)
    end if
    call keep_forces(element, element%jprops(j_continuum_shell_sections)*section_values + 1, behind)
    if (element%has_mass) then
      call mass_matrix(rule_of(int(element%jprops(j_continuum_shell_family)), element%nodes), .false., &
                       element%props(p_section_density), element%coords, element%mass)
    end if
    if (element%has_forces) call integrate(element, axes)
  end subroutine continuum_shell

  !> Force, tangent, state and energies; or the initial stress matrix (host_context).
  subroutine integrate(element, axes)
    type(element_t), intent(inout) :: element
    real(dp), intent(in), pointer, contiguous :: axes(:, :, :, :)
    real(dp) :: elastic(6, 6), section(3, element%jprops(j_continuum_shell_sections)), ratio, k_shear(2, 2)
    integer(i4), pointer, contiguous :: of_section(:, :)
    type(pairs_t) :: pairs
    type(forms_t) :: middle, full
    type(motion_t) :: motion
    type(shell_stress) :: stress
    type(elastic_t) :: linear(2)
    integer :: k
    associate (nodes => element%nodes, n => element%n, jprops => element%jprops, props => element%props, energy => element%energy, &
               x => element%coords, u => element%u, du => element%du, large => element%finite)
      pairs = pairs_of(nodes, x, nint(element%svars(size(element%svars))))
      ratio = pairs%height/props(p_section_thickness)
      elastic = elastic_section(props)
      elastic(:3, :3) = ratio*elastic(:3, :3)
      elastic(4:, :3) = ratio**2*elastic(4:, :3)
      elastic(:3, 4:) = ratio**2*elastic(:3, 4:)
      elastic(4:, 4:) = ratio**3*elastic(4:, 4:)
      of_section(1:3, 1:size(section, 2)) => jprops(j_continuum_shell_layers:)
      section = reshape(props(p_continuum_shell_points:), shape(section))
      section(:2, :) = ratio*section(:2, :)
      call find_forms(rule_of(int(jprops(j_continuum_shell_surface)), 1), pairs, nodes, axes, elastic, middle)
      call find_forms(rule_of(int(jprops(j_continuum_shell_surface)), nodes/2), pairs, nodes, axes, elastic, full)
      k_shear = shear_stiffness(props, sum(full%point%weight)/ratio**2)
      if (jprops(j_continuum_shell_scaled) /= 0) k_shear = ratio*k_shear
      linear(1) = shear_and_across(nodes, full, k_shear, pairs%height*props(p_continuum_shell_modulus), &
                                   props(p_continuum_shell_transverse))
      linear(2) = hourglass_of(nodes, full, elastic)

      call find_motion(nodes, x, pairs, middle, u, du, large, motion)
      energy(2) = energy(2) - stored_by(nodes, linear(1), x, u - du, large)
      call integrate_section(element, rule_of(int(jprops(j_continuum_shell_family)), 1), of_section, section, k_shear, middle, &
                             motion, stress, element%svars, sqrt(sum(full%point%weight)))
      energy(2) = energy(2) + stored_by(nodes, linear(1), x, u, large)
      energy(6) = stored_by(nodes, linear(2), x, u, large)
      if (element%of_stress) then
        call add_stress(element, middle, linear, stress, element%rhs, element%amatrx)
        return
      end if
      middle%b(:, :, 1) = gradient_of(nodes, middle%form(:, :, 1), motion%x)
      call add_section_points(n, middle, stress, element%rhs, element%amatrx)
      if (large) call add_forms(nodes, middle%point(1)%weight*stress%force(:6, 1), middle%form(:6, :, 1), element%amatrx)
      do k = 1, 2
        call add_elastic(nodes, linear(k), x, u, large, element%rhs, element%amatrx)
      end do
    end associate
  end subroutine integrate

  !> The initial stress matrix of the present stress, or of that of a perturbation: the sum over the forms of all strains.
  subroutine add_stress(element, middle, linear, stress, force, stiffness)
    type(element_t), intent(in) :: element
    type(forms_t), intent(in) :: middle
    type(elastic_t), intent(in) :: linear(2)
    type(shell_stress), intent(in) :: stress
    real(dp), intent(inout) :: force(element%n), stiffness(element%n, element%n)
    real(dp) :: at(3, element%nodes), resultant(6)
    logical :: added
    integer :: k, nodes
    nodes = element%nodes
    added = element%request == added_stress
    at = element%coords
    if (element%finite) at = at + reshape(element%u, [3, nodes])
    resultant = stress%force(:6, 1)
    associate (b => gradient_of(nodes, middle%form(:6, :, 1), at), weight => middle%point(1)%weight)
      if (added) resultant = matmul(stress%modulus(:6, :6, 1), matmul(b, element%added))
      force = force + weight*matmul(resultant, b)
      call add_forms(nodes, weight*resultant, middle%form(:6, :, 1), stiffness)
    end associate
    do k = 1, 2
      associate (b => gradient_of(nodes, linear(k)%form, at))
        if (added) then
          associate (change => matmul(linear(k)%modulus, matmul(b, element%added)))
            force = force + matmul(change, b)
            call add_forms(nodes, change, linear(k)%form, stiffness)
          end associate
        else
          associate (now => matmul(linear(k)%modulus, &
                                   strains_of(nodes, linear(k)%form, element%coords, element%u, element%finite)))
            force = force + matmul(now, b)
            call add_forms(nodes, now, linear(k)%form, stiffness)
          end associate
        end if
      end associate
    end do
  end subroutine add_stress

  !> Half of the change of the forms; without large displacements what is linear in them.
  pure function strains_of(nodes, form, x, u, large) result(strain)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: form(:, :), x(3, nodes), u(3*nodes)
    logical, intent(in) :: large
    real(dp) :: strain(size(form, 1)), middle(3, nodes)
    middle = x
    if (large) middle = x + 0.5_dp*reshape(u, [3, nodes])
    strain = matmul(gradient_of(nodes, form, middle), u)
  end function strains_of

  !> Derivatives of half of the forms by the places of the nodes: B.
  pure function gradient_of(nodes, form, x) result(b)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: form(:, :), x(3, nodes)
    real(dp) :: b(size(form, 1), 3*nodes)
    integer :: k
    do k = 1, nodes
      b(:, 3*k - 2:3*k) = matmul(form(:, nodes*(k - 1) + 1:nodes*k), transpose(x))
    end do
  end function gradient_of

  !> Add what stresses on the forms have of stiffness.
  pure subroutine add_forms(nodes, stress, form, stiffness)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: stress(:), form(:, :)
    real(dp), intent(inout) :: stiffness(3*nodes, 3*nodes)
    real(dp) :: together(nodes, nodes)
    integer :: i
    together = reshape(matmul(stress, form), [nodes, nodes])
    do i = 1, 3
      stiffness(i::3, i::3) = stiffness(i::3, i::3) + together
    end do
  end subroutine add_forms

  !> Force and stiffness of elastic strains.
  pure subroutine add_elastic(nodes, elastic, x, u, large, force, stiffness)
    integer, intent(in) :: nodes
    type(elastic_t), intent(in) :: elastic
    real(dp), intent(in) :: x(3, nodes), u(3*nodes)
    logical, intent(in) :: large
    real(dp), intent(inout) :: force(3*nodes), stiffness(3*nodes, 3*nodes)
    real(dp) :: b(size(elastic%form, 1), 3*nodes), stress(size(elastic%form, 1)), at(3, nodes)
    at = x
    if (large) at = x + reshape(u, [3, nodes])
    b = gradient_of(nodes, elastic%form, at)
    stress = matmul(elastic%modulus, strains_of(nodes, elastic%form, x, u, large))
    force = force + matmul(stress, b)
    stiffness = stiffness + matmul(transpose(b), matmul(elastic%modulus, b))
    if (large) call add_forms(nodes, stress, elastic%form, stiffness)
  end subroutine add_elastic

  !> Their energy.
  pure real(dp) function stored_by(nodes, elastic, x, u, large)
    integer, intent(in) :: nodes
    type(elastic_t), intent(in) :: elastic
    real(dp), intent(in) :: x(3, nodes), u(3*nodes)
    logical, intent(in) :: large
    real(dp) :: strain(size(elastic%form, 1))
    strain = strains_of(nodes, elastic%form, x, u, large)
    stored_by = 0.5_dp*dot_product(strain, matmul(elastic%modulus, strain))
  end function stored_by

  !> Motion of the middle, where the section points are.
  subroutine find_motion(nodes, x, pairs, at, u, du, large, motion)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(3, nodes), u(3*nodes), du(3*nodes)
    type(pairs_t), intent(in) :: pairs
    type(forms_t), intent(in) :: at
    logical, intent(in) :: large
    type(motion_t), intent(out) :: motion
    real(dp) :: now(3, 3), before(3, 3)
    integer :: i
    motion%x = x
    now = 0
    do i = 1, 3
      now(i, i) = 1
    end do
    before = now
    if (large) then
      motion%x = x + reshape(u, [3, nodes])
      before = turn_of(3*nodes, pairs%gradient, x, u - du)
      now = turn_of(3*nodes, pairs%gradient, x, u)
    end if
    motion%normal = reshape(matmul(now, pairs%director), [3, 1])
    motion%frame = reshape(matmul(at%point(1)%frame, transpose(before)), [3, 3, 1])
    motion%strain = reshape(strains_of(nodes, at%form(:8, :, 1), x, u, large), [8, 1])
  end subroutine find_motion

  !> Rotation of the middle. Leaves the pass if the element is inside out.
  function turn_of(n, gradient, x, u) result(rotation)
    integer, intent(in) :: n
    real(dp), intent(in) :: gradient(3, n/3), x(n), u(n)
    real(dp) :: rotation(3, 3), moved(n)
    type(solid_turn) :: turn
    logical :: good
    call find_turn(3, n/3, gradient, x, u, turn, moved, good)
    if (.not. good) then
      current%distorted = 1
      call escape()
    end if
    rotation = turn%rotation
  end function turn_of

  !> The shell between the faces along the stack direction. Leaves the pass if it has no thickness.
  function pairs_of(nodes, x, stack) result(pairs)
    integer, intent(in) :: nodes, stack
    real(dp), intent(in) :: x(3, nodes)
    type(pairs_t) :: pairs
    type(shell_point) :: middle
    real(dp) :: along(3)
    integer :: k, m
    m = nodes/2
    pairs%order = order_of(nodes, stack)
    associate (bottom => x(:, pairs%order(:m)), top => x(:, pairs%order(m + 1:)))
      pairs%x = 0.5_dp*(bottom + top)
      pairs%d = top - bottom
    end associate
    middle = shell_middle(m, pairs%x)
    if (.not. middle%good) call report_shape(1)
    associate (n => middle%n(:m), frame => middle%frame, g => middle%gradient)
      along = matmul(pairs%d, n)
      pairs%height = dot_product(along, frame(3, :))
      if (.not. pairs%height > 0) then
        call add_message(-3_i4, 'the continuum shell has no thickness, or is inside out along its stack direction')
        call escape()
      end if
      pairs%director = along/pairs%height
      allocate (pairs%gradient(3, nodes))
      do k = 1, m
        along = 0.5_dp*matmul(g(k, :), frame(:2, :))
        along = along - dot_product(along, pairs%director)*frame(3, :)
        pairs%gradient(:, pairs%order(k)) = along - n(k)/pairs%height*frame(3, :)
        pairs%gradient(:, pairs%order(m + k)) = along + n(k)/pairs%height*frame(3, :)
      end do
    end associate
  end function pairs_of

  !> Local nodes of the bottom, around it seen from the top, and those of the top above them. stack: the parent coordinate from the
  !> bottom to the top, negative in the opposite direction.
  pure function order_of(nodes, stack) result(order)
    integer, intent(in) :: nodes, stack
    integer :: order(nodes), m
    m = nodes/2
    if (nodes == 6) then
      order = [1, 2, 3, 4, 5, 6]
    else
      select case (abs(stack))
      case (1)
        order = [1, 4, 8, 5, 2, 3, 7, 6]
      case (2)
        order = [1, 5, 6, 2, 4, 8, 7, 3]
      case default
        order = [1, 2, 3, 4, 5, 6, 7, 8]
      end select
    end if
    if (stack < 0) order = [order(m + 1), order(nodes:m + 2:-1), order(1), order(m:2:-1)]
  end function order_of

  !> Forms of the points of a rule: those of the strains of host_shell_strains, then of the one across.
  subroutine find_forms(rule, pairs, nodes, axes, elastic, found)
    type(rule_t), intent(in) :: rule
    type(pairs_t), intent(in) :: pairs
    integer, intent(in) :: nodes
    real(dp), intent(in), pointer, contiguous :: axes(:, :, :, :)
    real(dp), intent(in) :: elastic(6, 6)
    type(forms_t), intent(out) :: found
    real(dp) :: membrane(3, 3, rule%points), shape(rule%nodes)
    integer :: p
    call prepare_operators(across, 3*nodes, rule%points, found)
    allocate (found%form(across, nodes*nodes, rule%points))
    do p = 1, rule%points
      found%point(p) = shell_place(rule%nodes, pairs%x, parent_place(rule, p), rule%weight(p))
      if (.not. found%point(p)%good) call report_shape(p)
      found%form(:, :, p) = reshape(forms_of(nodes, pairs, found%point(p)), [across, nodes*nodes])
      shape = found%point(p)%n(:rule%nodes)
      found%point(p)%n(pairs%order) = 0.5_dp*[shape, shape]
      call set_direction(found, p, axes)
      membrane(:, :, p) = matmul(transpose(found%turn(:, :, p)), matmul(elastic(:3, :3), found%turn(:, :, p)))
    end do
    if (rule%nodes == 4 .and. rule%points > 1) call enhance(found%point, membrane, found%form)
  end subroutine find_forms

  !> Forms of a point, along its axes and normal.
  pure function forms_of(nodes, pairs, point) result(form)
    integer, intent(in) :: nodes
    type(pairs_t), intent(in) :: pairs
    type(shell_point), intent(in) :: point
    real(dp) :: form(across, nodes, nodes)
    ! factors of m . m, m . d and d . d of two pairs
    real(dp), dimension(across, nodes/2, nodes/2) :: mm, md, dd
    real(dp) :: height, tilt(2), d(3), inverse(2, 2), determinant, shear(2, nodes/2, nodes/2), ends(nodes/2, nodes/2)
    integer, parameter :: first(3) = [1, 2, 1], second(3) = [1, 2, 2]
    integer :: i, k, m
    m = nodes/2
    d = matmul(pairs%d, point%n(:m))
    height = dot_product(d, point%frame(3, :))
    tilt = matmul(point%frame(:2, :), d)/height
    mm = 0
    md = 0
    dd = 0
    do i = 1, 3
      associate (g => point%gradient(:m, first(i)), h => point%gradient(:m, second(i)))
        ends = spread(g, 2, m)*spread(h, 1, m)
        if (first(i) /= second(i)) ends = ends + transpose(ends)
        mm(i, :, :) = ends
        ! with one thickness, those of the only point are the means of the others
        md(i + 3, :, :) = ends/pairs%height
      end associate
    end do
    call invert(2, point%jacobian, inverse, determinant)
    shear = assumed_shear(m, point%parent)
    do i = 1, 2
      md(6 + i, :, :) = (inverse(i, 1)*shear(1, :, :) + inverse(i, 2)*shear(2, :, :))/height
    end do
    do k = 1, m
      dd(across, k, k) = point%n(k)/height**2
    end do
    call straighten(mm)
    call straighten(md)
    call straighten(dd)
    associate (bottom => pairs%order(:m), top => pairs%order(m + 1:))
      do i = 1, across
        associate (mixed => 0.5_dp*md(i, :, :))
          form(i, bottom, bottom) = 0.25_dp*mm(i, :, :) - mixed - transpose(mixed) + dd(i, :, :)
          form(i, top, top) = 0.25_dp*mm(i, :, :) + mixed + transpose(mixed) + dd(i, :, :)
          form(i, top, bottom) = 0.25_dp*mm(i, :, :) - mixed + transpose(mixed) - dd(i, :, :)
          form(i, bottom, top) = 0.25_dp*mm(i, :, :) + mixed - transpose(mixed) - dd(i, :, :)
        end associate
      end do
    end associate
  contains
    !> From the director to the normal.
    pure subroutine straighten(f)
      real(dp), intent(inout) :: f(:, :, :)
      f(7, :, :) = f(7, :, :) - 2*tilt(1)*f(1, :, :) - tilt(2)*f(3, :, :)
      f(8, :, :) = f(8, :, :) - 2*tilt(2)*f(2, :, :) - tilt(1)*f(3, :, :)
      f(across, :, :) = f(across, :, :) - tilt(1)*f(7, :, :) - tilt(2)*f(8, :, :) &
                        - tilt(1)**2*f(1, :, :) - tilt(2)**2*f(2, :, :) - tilt(1)*tilt(2)*f(3, :, :)
    end subroutine straighten
  end function forms_of

  !> Transverse shear, and the stress across: its modulus times the thickness; ratio: nu/(1 - nu).
  pure function shear_and_across(nodes, full, k_shear, modulus, ratio) result(found)
    integer, intent(in) :: nodes
    type(forms_t), intent(in) :: full
    real(dp), intent(in) :: k_shear(2, 2), modulus, ratio
    type(elastic_t) :: found
    real(dp) :: turn(8, 8)
    integer :: p
    allocate (found%form(3*size(full%point), nodes**2), found%modulus(3*size(full%point), 3*size(full%point)))
    found%modulus = 0
    do p = 1, size(full%point)
      turn = section_turn(full, p)
      associate (form => full%form(:, :, p), weight => full%point(p)%weight, k => 3*p - 2)
        found%form(k:k + 1, :) = matmul(turn(7:, 7:), form(7:8, :))
        found%form(k + 2, :) = form(across, :) + ratio*(form(1, :) + form(2, :))
        found%modulus(k:k + 1, k:k + 1) = weight*k_shear
        found%modulus(k + 2, k + 2) = weight*modulus
      end associate
    end do
  end function shear_and_across

  !> Hourglass modes: the strains of the section at the points of full integration less their mean, along the axes of the points,
  !> which move with the element. Directions projected from global axes would make the mean depend on them. Triangles have none.
  pure function hourglass_of(nodes, full, elastic) result(found)
    integer, intent(in) :: nodes
    type(forms_t), intent(in) :: full
    real(dp), intent(in) :: elastic(6, 6)
    type(elastic_t) :: found
    real(dp) :: mean(6, nodes**2), turn(8, 8)
    integer :: count, p
    count = merge(size(full%point), 0, nodes == 8)
    allocate (found%form(6*count, nodes**2), found%modulus(6*count, 6*count))
    found%modulus = 0
    mean = 0
    do p = 1, count
      turn = section_turn(full, p)
      associate (k => 6*(p - 1), weight => full%point(p)%weight)
        found%form(k + 1:k + 6, :) = full%form(:6, :, p)
        found%modulus(k + 1:k + 6, k + 1:k + 6) = weight*matmul(transpose(turn(:6, :6)), matmul(elastic, turn(:6, :6)))
        mean = mean + weight/sum(full%point%weight)*found%form(k + 1:k + 6, :)
      end associate
    end do
    do p = 1, count
      associate (form => found%form(6*p - 5:6*p, :))
        form = form - mean
      end associate
    end do
  end function hourglass_of
end module host_continuum_shell
