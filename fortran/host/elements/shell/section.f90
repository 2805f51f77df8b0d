! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Sections of shells: their directions at integration points, their stresses and state at section points, and the stiffness of what
!> is elastic. Conventional shells (host_shell) and continuum shells (host_continuum_shell) have them.
!>
!> Values of PROPS, and of each section point of each integration point in SVARS: built_in.toml.
module host_shell_section
  use host_adapter, only: element_t
  use host_context, only: current, output_variables
  use host_coupling, only: interpolate_fields
  use host_kinds, only: dp, i4
  use host_layout, only: p_section_shear, p_section_slenderness, p_section_stiffness, p_section_thickness, section_values
  use host_materials, only: elastic_energy, find_material, has_fields, material_t, set_constants, stress_update
  use host_messages, only: add_message
  use host_protect, only: escape
  use host_point, only: move_to, point_t
  use host_shape, only: rule_t
  use host_shell_directors, only: shell_stress
  use host_shell_strains, only: shell_point, tensor_turn
  use host_usdfld, only: call_usdfld
  use host_uvarm, only: keep_uvar
  implicit none (type, external)
  private
  public :: operators_t, motion_t, identity
  public :: prepare_operators, set_direction, report_shape, elastic_section, shear_stiffness, shear_matrix, shear_energy
  public :: section_turn, add_section_points, integrate_section

  real(dp), parameter :: identity(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])

  !> Sine below which the direction of an orientation is normal to the surface.
  real(dp), parameter :: smallest_sine = 1.745328e-3_dp

  !> The strain operators of an element, and the angle of the section's direction 1 at each point from the first axis, with
  !> *ORIENTATION and without.
  type :: operators_t
    type(shell_point), allocatable :: point(:)
    real(dp), allocatable :: b(:, :, :)     !< (8 or more, unknowns, points)
    real(dp), allocatable :: angle(:), default(:)
    real(dp), allocatable :: turn(:, :, :)  !< (3, 3, points) strains to the directions of the section
  end type operators_t

  !> Motion of an element.
  type :: motion_t
    real(dp), allocatable :: u(:), old(:)   !< unknowns without its rotation, now and before the increment
    real(dp), allocatable :: x(:, :)        !< where the nodes are, as COORDS of user routines
    real(dp), allocatable :: normal(:, :)   !< (3, points) along which the section points follow each other
    real(dp), allocatable :: frame(:, :, :) !< (3, 3, points) rows: axes and normal before the increment
    real(dp), allocatable :: strain(:, :)   !< (8, points) along the axes of the points
  end type motion_t

contains

  !> Room for the operators of points.
  pure subroutine prepare_operators(strains, unknowns, points, found)
    integer, intent(in) :: strains, unknowns, points
    class(operators_t), intent(inout) :: found
    allocate (found%point(points), found%b(strains, unknowns, points), found%angle(points), found%default(points), &
              found%turn(3, 3, points))
  end subroutine prepare_operators

  !> Directions of the section at a point. axes: those of the integration points (host_axes), not associated without *ORIENTATION;
  !> the first ones count where there are more points.
  subroutine set_direction(found, p, axes)
    class(operators_t), intent(inout) :: found
    integer, intent(in) :: p
    real(dp), intent(in), pointer, contiguous :: axes(:, :, :, :)
    associate (frame => found%point(p)%frame)
      found%default(p) = angle_of(p, frame, default_direction(frame(3, :)))
      found%angle(p) = found%default(p)
      if (associated(axes)) found%angle(p) = angle_of(p, frame, axes(1, :, 1, min(p, size(axes, 4))))
    end associate
    found%turn(:, :, p) = tensor_turn(found%angle(p))
  end subroutine set_direction

  !> Stiffness of the elastic section.
  pure function elastic_section(props) result(elastic)
    real(dp), intent(in) :: props(:)
    real(dp) :: elastic(6, 6)
    elastic = reshape(props(p_section_stiffness), [6, 6])
  end function elastic_section

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

  !> Transverse shear stiffness of the section.
  pure function shear_stiffness(props, area) result(k)
    real(dp), intent(in) :: props(:), area
    real(dp) :: k(2, 2)
    k = reshape(props(p_section_shear([1, 3, 3, 2])), [2, 2])/(1 + props(p_section_slenderness)*area/props(p_section_thickness)**2)
  end function shear_stiffness

  !> Transverse shear strains by the unknowns, in the directions of the section.
  pure function section_shear(operators, p, n) result(b)
    class(operators_t), intent(in) :: operators
    integer, intent(in) :: p, n
    real(dp) :: b(2, n), turn(8, 8)
    turn = section_turn(operators, p)
    b = matmul(turn(7:, 7:), operators%b(7:8, :, p))
  end function section_shear

  !> Stiffness of the transverse shear, integrated at points.
  pure function shear_matrix(at, n, k) result(shear)
    class(operators_t), intent(in) :: at
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
    class(operators_t), intent(in) :: at
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
    class(operators_t), intent(in) :: at
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

  !> Forces and stiffness of membrane and bending, by displacements and rotations whose strains are linear.
  pure subroutine add_section_points(n, at, stress, force, stiffness)
    integer, intent(in) :: n
    class(operators_t), intent(in) :: at
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

  !> Stress and state of all section points, and what they make along the axes of the integration points. of_section, section: what
  !> JPROPS and PROPS have of the section points. length: of the element, for user routines.
  subroutine integrate_section(element, rule, of_section, section, k_shear, at, motion, found, svars, length)
    type(element_t), intent(inout) :: element
    type(rule_t), intent(in) :: rule
    integer(i4), intent(in) :: of_section(:, :)
    real(dp), intent(in) :: section(:, :), k_shear(2, 2), length
    class(operators_t), intent(in) :: at
    class(motion_t), intent(in) :: motion
    type(shell_stress), intent(inout) :: found
    real(dp), intent(inout), target :: svars(section_values, size(section, 2), rule%points)
    type(material_t), pointer :: material
    real(dp) :: axes(8, 8), strain(8), resultant(8), tangent(8, 8), turn(3, 3), layer(3), stress(3), modulus(3, 3)
    real(dp) :: directions(3, 3), basis(3, 3), elastic, work, volume, z
    type(point_t) :: point
    integer :: k, p, sections
    sections = size(section, 2)
    elastic = 0
    work = element%energy(2) + element%energy(4)
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
          point%length = length
          point%place = matmul(motion%x, at%point(p)%n(:rule%nodes)) + z*motion%normal(:, p)
          call interpolate_fields(rule, p, element%fields, element%predef, material%variables, point)
        end if
        point%npt = int(p, i4)
        point%layer = of_section(2, k)
        point%kspt = of_section(3, k)
        call move_to(point, (p - 1)*sections + k)
        directions = turned(at%angle(p) + section(3, k), motion%frame(:, :, p))
        basis = turned(at%angle(p) - at%default(p) + section(3, k), identity)
        if (current%flags(3) == output_variables) then
          if (allocated(material%user_output)) then
            call keep_uvar(material%user_output, 3, point, directions, basis, svars(:6, k, p))
          end if
          cycle
        end if
        if (allocated(material%user_field)) then
          call call_usdfld(material%user_field, 3, point, directions, basis, .true., svars(:6, k, p))
        end if
        if (allocated(material%dependence)) call set_constants(material, point)
        turn = tensor_turn(section(3, k))
        layer = matmul(turn, strain(:3) + z*strain(4:6))
        call stress_update(material, point, layer, stress, modulus)
        volume = at%point(p)%weight*section(2, k)
        elastic = elastic + volume*elastic_energy(material, point, stress)
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
    element%energy(2) = elastic
    element%energy(4) = work - elastic
  end subroutine integrate_section

  !> Directions (rows) turned by an angle about the third.
  pure function turned(angle, axes)
    real(dp), intent(in) :: angle, axes(3, 3)
    real(dp) :: turned(3, 3)
    turned(1, :) = cos(angle)*axes(1, :) + sin(angle)*axes(2, :)
    turned(2, :) = cos(angle)*axes(2, :) - sin(angle)*axes(1, :)
    turned(3, :) = axes(3, :)
  end function turned
end module host_shell_section
