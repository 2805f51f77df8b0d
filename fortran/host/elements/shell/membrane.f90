! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in membranes (M3D3, M3D4, M3D4R, M3D6, M3D8, M3D8R): surfaces in plane stress without any stiffness in bending.
!>
!> The material is in two directions of each point, which turn with the rotation of the polar decomposition f = R U of the
!> deformation of the surface. The strain of an increment is that of its middle, sym((U - U') (U + U')^-1) 2. The thickness follows
!> the area, t = T (dA/da)**(nu/(1 - nu)), with Poisson's ratio of the section (Theory Guide, Membrane elements). With the Cauchy
!> stress s the force of a node is
!>
!>     the integral of N grad over the initial surface,    N = t da/dA R s U^-1,
!>
!> grad its gradient there. The tangent is exact, by complex steps of N over the six components of f.
!>
!> M3D4R has one point. Its hourglass displacement q = x gamma (host_hourglass) has the total stiffness of a plane element, in the
!> direction of the normal as well: the energy is that of the change of (g1 q, g2 q, (g1 x g2) q), with the columns of f, which no
!> rotation changes. That Abaqus resists warping so is inferred.
!>
!> The initial stress matrix (host_context) is that of forces along the gradients, U^-1 s U^-1 on each direction alike.
!>
!> Values of PROPS, JPROPS and of each point in SVARS: built_in.toml. In dynamic analyses SVARS go on with the forces of the last
!> two increments; last are the directions of each point, with *ORIENTATION (host_axes).
module host_membrane
  use core_rotation, only: cross, surface_frame
  use core_small_matrix, only: invert
  use host_adapter, only: element_t, keep_forces
  use host_axes, only: values_of_axes
  use host_context, only: added_stress, current, initial_stresses, output_variables
  use host_coupling, only: interpolate_fields
  use host_initial_stress, only: begin_point
  use host_kinds, only: dp, i4
  use host_layout, only: j_membrane_family, j_membrane_mass_points, j_membrane_oriented, j_membrane_points, membrane_values, &
                         p_membrane_density, p_membrane_hourglass, p_membrane_poisson, p_membrane_thickness
  use host_materials, only: elastic_energy, has_fields, material_t, set_constants, stress_update
  use host_messages, only: add_message
  use host_point, only: move_to, point_t
  use host_polar, only: complex_cross => cross, polar_axes, step
  use host_protect, only: escape
  use host_shape, only: hourglass_shapes, is_quadratic, rule_of, rule_t
  use host_usdfld, only: call_usdfld
  use host_uvarm, only: keep_uvar
  implicit none (type, external)
  private
  public :: membrane

  real(dp), parameter :: smallest_area = 1.0e-8_dp   !< over that before any displacement
  real(dp), parameter :: identity(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])

  !> A point before any displacement.
  type :: place_t
    real(dp) :: frame(3, 3) = 0           !< rows: directions of the material, and the normal
    real(dp) :: basis(3, 3) = 0           !< the same along the default directions
    real(dp) :: gradient(8, 2) = 0        !< of the shape functions along the two directions
    real(dp) :: area = 0
  end type place_t

  !> A point in the increment: what its forces need besides the deformation f.
  type :: response_t
    real(dp) :: before(2, 2) = 0          !< stretch at the start of the increment
    real(dp) :: increment(3) = 0          !< strain of the increment
    real(dp) :: stress(3) = 0, modulus(3, 3) = 0
    real(dp) :: volume = 0                !< before any displacement
    real(dp) :: thinning = 0              !< nu/(1 - nu)
  end type response_t

contains

  subroutine membrane(element)
    type(element_t), intent(inout), target :: element
    real(dp), pointer, contiguous :: axes(:, :, :, :), none(:, :, :, :)
    type(place_t) :: places(element%jprops(j_membrane_points)), full(element%jprops(j_membrane_mass_points))
    type(rule_t), pointer :: rule, mass_rule
    integer :: points, behind
    associate (jprops => element%jprops, props => element%props, x => element%coords)
      points = jprops(j_membrane_points)
      rule => rule_of(int(jprops(j_membrane_family)), points)
      mass_rule => rule_of(int(jprops(j_membrane_family)), int(jprops(j_membrane_mass_points)))
      behind = size(element%svars) + 1
      axes => null()
      none => null()
      if (jprops(j_membrane_oriented) /= 0) then
        behind = behind - values_of_axes*points
        axes(1:3, 1:3, 1:2, 1:points) => element%svars(behind:)
      end if
      call keep_forces(element, points*membrane_values + 1, behind)
      places = places_of(rule, x, axes)
      full = places_of(mass_rule, x, none)
      if (element%has_mass) then
        call find_mass(mass_rule, props(p_membrane_thickness)*props(p_membrane_density), full%area, element%mass)
      end if
      if (element%has_forces) then
        call integrate(rule, places, element, element%svars, element%rhs, element%amatrx)
      end if
    end associate
  end subroutine membrane

  !> All points of a rule. axes: those of *ORIENTATION, whose first one is projected. Leaves the pass if the surface is folded.
  function places_of(rule, x, axes) result(places)
    type(rule_t), intent(in) :: rule
    real(dp), intent(in) :: x(3, rule%nodes)
    real(dp), intent(in), pointer, contiguous :: axes(:, :, :, :)
    type(place_t) :: places(rule%points)
    real(dp) :: along(3, 2, rule%points), whole(3), frame(3, 3), area, inverse(2, 2), determinant
    character(len=160) :: text
    integer :: p
    whole = 0
    do p = 1, rule%points
      along(:, :, p) = matmul(x, rule%dn(:, :, p))
      whole = whole + cross(along(:, 1, p), along(:, 2, p))
    end do
    do p = 1, rule%points
      call surface_frame(along(:, 1, p), along(:, 2, p), frame, area)
      if (.not. dot_product(frame(2, :), whole) > 0) then
        write (text, '(a,i0,a)') 'the membrane has no area or is folded at its integration point ', p, &
          '; its nodes must run around it'
        call add_message(-3_i4, trim(text))
        call escape()
      end if
      places(p)%area = rule%weight(p)*area
      ! rows of a frame are the direction, the normal and the other direction
      frame = frame([1, 3, 2], :)
      places(p)%frame = frame
      if (associated(axes)) places(p)%frame = frame_along(p, frame(3, :), axes(1, :, 1, p))
      places(p)%basis = matmul(places(p)%frame, transpose(frame))
      call invert(2, matmul(places(p)%frame(:2, :), along(:, :, p)), inverse, determinant)
      places(p)%gradient(:rule%nodes, :) = matmul(rule%dn(:, :, p), inverse)
    end do
  end function places_of

  !> Directions (rows) of a surface: the projection of a direction, the one across, and the normal.
  function frame_along(point, normal, direction) result(frame)
    integer, intent(in) :: point
    real(dp), intent(in) :: normal(3), direction(3)
    real(dp) :: frame(3, 3)
    character(len=160) :: text
    frame(1, :) = direction - dot_product(direction, normal)*normal
    if (.not. norm2(frame(1, :)) > 1.0e-6_dp) then
      write (text, '(a,i0)') '*ORIENTATION: the axis that is projected is normal to the membrane at integration point ', point
      call add_message(-3_i4, trim(text))
      call escape()
    end if
    frame(1, :) = frame(1, :)/norm2(frame(1, :))
    frame(2, :) = cross(normal, frame(1, :))
    frame(3, :) = normal
  end function frame_along

  !> Mass: lumped, of elements with middle nodes consistent.
  pure subroutine find_mass(rule, density, area, mass)
    type(rule_t), intent(in) :: rule
    real(dp), intent(in) :: density               !< per area
    real(dp), intent(in) :: area(rule%points)
    real(dp), intent(out) :: mass(3, rule%nodes, 3, rule%nodes)
    real(dp) :: part(rule%nodes, rule%nodes)
    integer :: i, k, p
    mass = 0
    do p = 1, rule%points
      part = spread(rule%n(:, p), 2, rule%nodes)*spread(rule%n(:, p), 1, rule%nodes)
      if (.not. is_quadratic(rule)) then
        part = 0
        do k = 1, rule%nodes
          part(k, k) = rule%n(k, p)
        end do
      end if
      do i = 1, 3
        mass(i, :, i, :) = mass(i, :, i, :) + density*area(p)*part
      end do
    end do
  end subroutine find_mass

  !> Force, tangent, state and energies, or the initial stress matrix.
  subroutine integrate(rule, places, element, svars, force, stiffness)
    type(rule_t), intent(in) :: rule
    type(place_t), intent(in) :: places(rule%points)
    type(element_t), intent(inout) :: element
    real(dp), intent(inout), target :: svars(membrane_values, rule%points)
    real(dp), intent(inout) :: force(3, rule%nodes), stiffness(3, rule%nodes, 3, rule%nodes)
    type(material_t), pointer :: material
    real(dp), dimension(:, :), pointer, contiguous :: x, u, du, added
    type(response_t) :: at
    type(point_t) :: point
    real(dp) :: linear(3, 6), strain(3), stress(3), f(3, 2), f_before(3, 2), nominal(3, 2), rate(3, 2, 3, 2)
    real(dp) :: volume, elastic, work, state(8)
    integer :: p
    material => element%material
    x => element%coords
    u(1:3, 1:rule%nodes) => element%u
    du(1:3, 1:rule%nodes) => element%du
    added(1:3, 1:rule%nodes) => element%added
    point%finite = element%finite
    current%deformed = element%finite .and. any(abs(u) > 0)
    point%rotation = identity
    point%turn = identity
    point%length = sqrt(sum(places%area))*merge(0.5_dp, 1.0_dp, is_quadratic(rule))
    at%thinning = element%props(p_membrane_poisson)/(1 - element%props(p_membrane_poisson))
    elastic = 0
    work = element%energy(2) + element%energy(4)
    do p = 1, rule%points
      call move_to(point, p)
      associate (g => places(p)%gradient(:rule%nodes, :), frame => places(p)%frame)
        at%volume = places(p)%area*element%props(p_membrane_thickness)
        linear = strain_matrix(transpose(frame(:2, :)))
        if (element%request == initial_stresses) then
          ! as plane elements keep it, with E33 and S33
          state = 0
          state([5, 6, 8]) = svars(4:, p)
          call begin_point(material, point, at%volume, state, stress, elastic)
          force = force + matmul(reshape(at%volume*matmul(stress, linear), [3, 2]), transpose(g))
          cycle
        end if
        f = transpose(frame(:2, :))
        f_before = f
        if (element%finite) then
          f = f + matmul(u, g)
          f_before = f - matmul(du, g)
          call find_increment(point, f_before, f, at, volume)
          strain = svars(:3, p) + at%increment
        else
          volume = at%volume
          strain = matmul(linear, reshape(matmul(u, g), [6]))
        end if
        if (has_fields(material)) then
          point%place = matmul(x, rule%n(:, p))
          if (element%finite) point%place = matmul(x + u, rule%n(:, p))
          call interpolate_fields(rule, p, element%fields, element%predef, material%variables, point)
        end if
        if (element%request == output_variables) then
          call keep_uvar(material%user_output, 3, point, transpose(directions_of(f)), places(p)%basis, svars(:, p))
          cycle
        end if
        if (allocated(material%user_field)) then
          call call_usdfld(material%user_field, 3, point, transpose(directions_of(f_before)), places(p)%basis, .true., svars(:, p))
        end if
        if (allocated(material%dependence)) call set_constants(material, point)
        call stress_update(material, point, strain, stress, at%modulus)
        elastic = elastic + volume*elastic_energy(material, point, stress)
        ! trapezoidal rule, exact where the response is linear
        work = work + volume*0.5_dp*dot_product(stress + svars(4:, p), strain - svars(:3, p))
        svars(:, p) = [strain, stress]
        at%stress = stress
        if (element%of_stress) then
          if (element%request == added_stress) at%stress = matmul(at%modulus, strain_of(f, matmul(added, g)))
          nominal = 0
          rate = stress_rate(at, f)
        else if (element%finite) then
          call find_forces(at, f, nominal, rate)
        else
          nominal = reshape(at%volume*matmul(stress, linear), [3, 2])
          rate = reshape(at%volume*matmul(transpose(linear), matmul(at%modulus, linear)), [3, 2, 3, 2])
        end if
        call scatter(rule%nodes, g, nominal, rate, force, stiffness)
      end associate
    end do
    element%energy(2) = elastic
    if (element%request == initial_stresses) return
    element%energy(4) = work - elastic
    if (rule%reduced .and. .not. element%of_stress) then
      call resist(places(1), element%props(p_membrane_thickness)*places(1)%area*element%props(p_membrane_hourglass), &
                  element%finite, x, u, force, stiffness, &
                  element%energy(6))
    end if
  end subroutine integrate

  !> Strain of an increment, stretches and thickness at both ends for UMAT, and the volume at its end. Leaves the pass if the
  !> surface has no area.
  subroutine find_increment(point, before, f, at, volume)
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: before(3, 2), f(3, 2)
    type(response_t), intent(inout) :: at
    real(dp), intent(out) :: volume
    real(dp) :: stretch(2, 2)
    ! of a surface without area there are no stretches
    if (.not. (norm2(cross(f(:, 1), f(:, 2))) > smallest_area .and. norm2(cross(before(:, 1), before(:, 2))) > smallest_area)) then
      current%distorted = int(point%number)
      call escape()
    end if
    at%before = real(stretch_of(cmplx(before, kind=dp)), dp)
    stretch = real(stretch_of(cmplx(f, kind=dp)), dp)
    at%increment = real(increment_of(at%before, cmplx(stretch, kind=dp)), dp)
    volume = at%volume*determinant(stretch)**(1 - at%thinning)
    point%deformation = 0
    point%deformation(:2, :2, 1) = at%before
    point%deformation(:2, :2, 2) = stretch
    point%deformation(3, 3, :) = [determinant(at%before), determinant(stretch)]**(-at%thinning)
  end subroutine find_increment

  !> Forces N times the volume by the deformation, and their derivatives.
  pure subroutine find_forces(at, f, nominal, rate)
    type(response_t), intent(in) :: at
    real(dp), intent(in) :: f(3, 2)
    real(dp), intent(out) :: nominal(3, 2), rate(3, 2, 3, 2)
    complex(dp) :: moved(3, 2), found(3, 2)
    integer :: i, k
    do k = 1, 2
      do i = 1, 3
        moved = cmplx(f, kind=dp)
        moved(i, k) = cmplx(f(i, k), step, dp)
        found = forces_at(at, moved)
        rate(:, :, i, k) = aimag(found)/step
      end do
    end do
    nominal = real(found, dp)
  end subroutine find_forces

  !> The same at a deformation near that of the stress.
  pure function forces_at(at, f) result(nominal)
    type(response_t), intent(in) :: at
    complex(dp), intent(in) :: f(3, 2)
    complex(dp) :: nominal(3, 2), axes(3, 3), stretch(2, 2), stress(3), area
    axes = polar_axes(f)
    stretch = matmul(transpose(axes(:, :2)), f)
    area = stretch(1, 1)*stretch(2, 2) - stretch(1, 2)*stretch(2, 1)
    stress = at%stress + matmul(at%modulus, increment_of(at%before, stretch) - at%increment)
    nominal = at%volume*area**(1 - at%thinning)* &
              matmul(axes(:, :2), matmul(reshape(stress([1, 3, 3, 2]), [2, 2]), inverse_of(stretch)))
  end function forces_at

  !> Derivatives of the forces of a stress that stays along the gradients.
  pure function stress_rate(at, f) result(rate)
    type(response_t), intent(in) :: at
    real(dp), intent(in) :: f(3, 2)
    real(dp) :: rate(3, 2, 3, 2), stretch(2, 2), inverse(2, 2), along(2, 2)
    integer :: i
    stretch = real(stretch_of(cmplx(f, kind=dp)), dp)
    inverse = real(inverse_of(cmplx(stretch, kind=dp)), dp)
    along = matmul(inverse, matmul(reshape(at%stress([1, 3, 3, 2]), [2, 2]), inverse))
    rate = 0
    do i = 1, 3
      rate(i, :, i, :) = at%volume*determinant(stretch)**(1 - at%thinning)*along
    end do
  end function stress_rate

  !> Strain of the increment to a stretch, at its middle: 11, 22 and engineering shear.
  pure function increment_of(before, stretch) result(strain)
    real(dp), intent(in) :: before(2, 2)
    complex(dp), intent(in) :: stretch(2, 2)
    complex(dp) :: strain(3), h(2, 2)
    h = 2*matmul(stretch - before, inverse_of(stretch + before))
    strain = [h(1, 1), h(2, 2), h(1, 2) + h(2, 1)]
  end function increment_of

  !> Strain by the change of a deformation, along its directions.
  pure function strain_of(f, change) result(strain)
    real(dp), intent(in) :: f(3, 2), change(3, 2)
    real(dp) :: strain(3), axes(3, 3), h(2, 2)
    axes = directions_of(f)
    h = matmul(matmul(transpose(axes(:, :2)), change), real(inverse_of(stretch_of(cmplx(f, kind=dp))), dp))
    strain = [h(1, 1), h(2, 2), h(1, 2) + h(2, 1)]
  end function strain_of

  !> Small strain by the gradients along two directions: of three displacements along the first, then along the second.
  pure function strain_matrix(directions) result(b)
    real(dp), intent(in) :: directions(3, 2)
    real(dp) :: b(3, 6)
    b = 0
    b(1, :3) = directions(:, 1)
    b(2, 4:) = directions(:, 2)
    b(3, :3) = directions(:, 2)
    b(3, 4:) = directions(:, 1)
  end function strain_matrix

  !> Directions of the material, in columns, and the normal.
  pure function directions_of(f) result(axes)
    real(dp), intent(in) :: f(3, 2)
    real(dp) :: axes(3, 3)
    axes = real(polar_axes(cmplx(f, kind=dp)), dp)
  end function directions_of

  !> U of the polar decomposition.
  pure function stretch_of(f) result(stretch)
    complex(dp), intent(in) :: f(3, 2)
    complex(dp) :: stretch(2, 2), axes(3, 3)
    axes = polar_axes(f)
    stretch = matmul(transpose(axes(:, :2)), f)
  end function stretch_of

  pure real(dp) function determinant(a)
    real(dp), intent(in) :: a(2, 2)
    determinant = a(1, 1)*a(2, 2) - a(1, 2)*a(2, 1)
  end function determinant

  pure function inverse_of(a) result(b)
    complex(dp), intent(in) :: a(2, 2)
    complex(dp) :: b(2, 2)
    b = reshape([a(2, 2), -a(2, 1), -a(1, 2), a(1, 1)], [2, 2])/(a(1, 1)*a(2, 2) - a(1, 2)*a(2, 1))
  end function inverse_of

  !> Add forces by the deformation of a point, and their derivatives, to those of the nodes with gradients g.
  pure subroutine scatter(nodes, g, nominal, rate, force, stiffness)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: g(:, :), nominal(:, :), rate(:, :, :, :)
    real(dp), intent(inout) :: force(3, nodes), stiffness(3, nodes, 3, nodes)
    integer :: a, i, j, k
    force = force + matmul(nominal, transpose(g))
    do a = 1, nodes
      do i = 1, 3
        do k = 1, 3
          do j = 1, nodes
            stiffness(k, j, i, a) = stiffness(k, j, i, a) + dot_product(g(j, :), matmul(rate(k, :, i, :), g(a, :)))
          end do
        end do
      end do
    end do
  end subroutine scatter

  !> Add the hourglass control of four nodes with one point: its deformation is f and the hourglass displacement.
  pure subroutine resist(place, modulus, finite, x, u, force, stiffness, energy)
    type(place_t), intent(in) :: place
    real(dp), intent(in) :: modulus               !< parameter times volume
    logical, intent(in) :: finite
    real(dp), intent(in) :: x(3, 4), u(3, 4)
    real(dp), intent(inout) :: force(3, 4), stiffness(3, 4, 3, 4), energy
    real(dp) :: h(4, 1), g(4, 3), k, start(3), f(3, 3), nominal(3, 3), rate(3, 3, 3, 3)
    complex(dp) :: moved(3, 3), found(3, 3)
    integer :: i, j
    h = hourglass_shapes(2)
    g(:, :2) = place%gradient(:4, :)
    ! what is left of the pattern in no linear displacement; of the place it is along the normal
    g(:, 3) = h(:, 1) - matmul(g(:, :2), matmul(place%frame(:2, :), matmul(x, h(:, 1))))
    k = modulus*sum(g(:, :2)**2)/dot_product(h(:, 1), g(:, 3))**2
    if (.not. finite) then
      nominal = 0
      nominal(:, 3) = k*matmul(u, g(:, 3))
      rate = 0
      do i = 1, 3
        rate(i, 3, i, 3) = k
      end do
      energy = 0.5_dp*k*sum(matmul(u, g(:, 3))**2)
    else
      f(:, :2) = transpose(place%frame(:2, :))
      f(:, 3) = matmul(x, g(:, 3))
      start = real(invariants_of(cmplx(f, kind=dp)), dp)
      f = f + matmul(u, g)
      do j = 1, 3
        do i = 1, 3
          moved = cmplx(f, kind=dp)
          moved(i, j) = cmplx(f(i, j), step, dp)
          found = hourglass_forces(k, start, moved)
          rate(:, :, i, j) = aimag(found)/step
        end do
      end do
      nominal = real(found, dp)
      energy = 0.5_dp*k*sum((real(invariants_of(cmplx(f, kind=dp)), dp) - start)**2)
    end if
    call scatter(4, g, nominal, rate, force, stiffness)
  end subroutine resist

  !> What no rotation changes of the columns of f and a vector behind them.
  pure function invariants_of(f) result(invariants)
    complex(dp), intent(in) :: f(3, 3)
    complex(dp) :: invariants(3)
    invariants = [sum(f(:, 1)*f(:, 3)), sum(f(:, 2)*f(:, 3)), sum(complex_cross(f(:, 1), f(:, 2))*f(:, 3))]
  end function invariants_of

  !> Derivatives of the energy k/2 of their change.
  pure function hourglass_forces(k, start, f) result(force)
    real(dp), intent(in) :: k, start(3)
    complex(dp), intent(in) :: f(3, 3)
    complex(dp) :: force(3, 3), c(3)
    c = k*(invariants_of(f) - start)
    force(:, 1) = c(1)*f(:, 3) + c(3)*complex_cross(f(:, 2), f(:, 3))
    force(:, 2) = c(2)*f(:, 3) + c(3)*complex_cross(f(:, 3), f(:, 1))
    force(:, 3) = c(1)*f(:, 1) + c(2)*f(:, 2) + c(3)*complex_cross(f(:, 1), f(:, 2))
  end function hourglass_forces
end module host_membrane
