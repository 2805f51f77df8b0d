! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in cohesive elements COH2D4, COH3D6 and COH3D8 with traction-separation response.
!>
!> Nodes of the bottom face, then of the top face: 1 2 and 4 3, 1 2 3 and 4 5 6, or 1 2 3 4 and 5 6 7 8. Integration points lie
!> at the corners of the mid-surface, so the separation of a point is that of one pair of nodes. The normal points from bottom to
!> top; s is the tangent from 1 to 2 in the plane, and otherwise the projection of the global 1-axis on the mid-surface (of the
!> 3-axis where the 1-axis is within 0.1 degrees of the normal), t = n x s.
!>
!> With large displacements the frame turns with the mid-surface of the present shape, by the rotation of the polar decomposition of
!> its deformation; separations are those of the present positions in this frame, less those at the start, and tractions are per
!> initial area.
!>
!> Mass per area is density times constitutive thickness, by halves at the two nodes of each point (Analysis User's Guide, Defining
!> the constitutive response of cohesive elements using a traction-separation description: with the thickness 1 the density is a
!> mass per area).
!>
!> An element is deleted at the end of the increment in which the damage of all its points has reached MAX DEGRADATION with
!> none of them in compression (Analysis User's Guide, Maximum degradation and choice of element removal).
!>
!> Values of PROPS and JPROPS: cohesive in built_in.toml. SVARS hold for each point, with a component for each dimension:
!> position, separation, traction, damage, energies dissipated by damage, by viscosity, damage without viscosity, strain,
!> initiation criterion, status; in dynamic analyses then the forces of the last two increments.
module host_cohesive
  use core_rotation, only: line_frame, surface_frame, turned_frame
  use host_adapter, only: element_t, keep_forces
  use host_kinds, only: dp, i4
  use host_layout, only: j_cohesive_deletion, j_cohesive_family, j_cohesive_law, p_cohesive_density, p_cohesive_law, &
                         p_cohesive_thickness, p_cohesive_width
  use host_messages, only: add_message
  use host_protect, only: escape
  use host_shape, only: line2, quad4, tri3
  use host_traction_separation, only: cohesive_law, cohesive_point, fine, read_law, update_point
  implicit none (type, external)
  private
  public :: cohesive

  !> Rows n, s, t of a frame from rows s, n, t, and the other way round.
  integer, parameter :: by_normal(3) = [2, 1, 3]

contains

  subroutine cohesive(element)
    type(element_t), intent(inout) :: element
    integer, parameter :: forces_wanted(4) = [1, 2, 5, 6]
    integer :: points
    points = element%nodes/2
    call keep_forces(element, points*values_of_point(element%mcrd) + 1, size(element%svars) + 1)
    if (element%has_mass) call lump_mass(element, points, element%coords, element%mass)
    if (.not. any(element%request == forces_wanted)) return
    associate (props => element%props, jprops => element%jprops, dim => element%mcrd)
      call integrate(element, read_law(props(p_cohesive_law:), jprops(j_cohesive_law:)), dim, points, element%coords, &
                     element%u, element%rhs, element%amatrx, element%svars)
    end associate
  end subroutine cohesive

  !> SVARS of a point.
  pure integer function values_of_point(dim)
    integer, intent(in) :: dim
    values_of_point = 5*dim + 5
  end function values_of_point

  !> Force, tangent, state and energies.
  subroutine integrate(element, law, n, points, x, u, rhs, stiffness, svars)
    type(element_t), intent(inout) :: element
    type(cohesive_law), intent(in) :: law
    integer, intent(in) :: n, points
    real(dp), intent(in) :: x(n, 2*points), u(n, 2*points)
    real(dp), intent(inout) :: rhs(n, 2*points), stiffness(n, 2*points, n, 2*points), svars(5*n + 5, points)
    type(cohesive_point) :: old, new
    real(dp) :: frame(3, n), area, separation(3), tangent(3, 3), force(n), block(n, n), distance, fault
    real(dp) :: present_frame(3, n), turning(3, n, n, points), apart(n), change(n)
    integer :: p, bottom, top, status, i, k, q, node, family
    logical :: removed, failed
    family = element%jprops(j_cohesive_family)
    removed = is_removed(n, svars(:, 1))
    failed = element%jprops(j_cohesive_deletion) /= 0
    ! deletion counts the energy that is still stored as lost by damage
    if (removed) element%energy(4) = element%energy(4) + element%energy(2)
    element%energy(2) = 0
    if (.not. removed) element%energy(3:4) = 0
    do p = 1, points
      bottom = p
      top = opposite(family, points, p)
      call measure(family, n, points, p, x, frame, area)
      distance = thickness_at(n, points, x, element%props(p_cohesive_thickness), frame, bottom, top)
      separation = matmul(frame, u(:, top) - u(:, bottom))
      if (element%finite) then
        call turn_frame(family, n, points, p, x, x + u, frame, present_frame, turning)
        apart = x(:, top) + u(:, top) - x(:, bottom) - u(:, bottom)
        separation = matmul(present_frame, apart) - matmul(frame, x(:, top) - x(:, bottom))
        frame = present_frame
      end if
      call get_point(n, svars(:, p), old)
      if (removed) then
        new = old
        new%separation = separation
        new%traction = 0
      else
        call update_point(law, distance, element%dtime, separation, old, new, tangent, status, fault)
        if (status /= fine) call stop_with('*DAMAGE EVOLUTION: the fracture energy at the mode mix must exceed the elastic ' &
                                           //'energy at the onset of damage, and falls short by', fault, p)
        area = element%props(p_cohesive_width)*area
        force = area*matmul(new%traction, frame)
        rhs(:, bottom) = rhs(:, bottom) - force
        rhs(:, top) = rhs(:, top) + force
        block = area*matmul(transpose(frame), matmul(tangent, frame))
        stiffness(:, bottom, :, bottom) = stiffness(:, bottom, :, bottom) + block
        stiffness(:, top, :, top) = stiffness(:, top, :, top) + block
        stiffness(:, bottom, :, top) = stiffness(:, bottom, :, top) - block
        stiffness(:, top, :, bottom) = stiffness(:, top, :, bottom) - block
        if (element%finite) then
          do q = 1, points
            do i = 1, n
              ! a node of the mid-surface moves by half of what each of its two nodes does
              change = 0.5_dp*area*(matmul(matmul(tangent, matmul(turning(:, :, i, q), apart)), frame) &
                                    + matmul(new%traction, turning(:, :, i, q)))
              do k = 1, 2
                node = merge(q, opposite(family, points, q), k == 1)
                stiffness(:, top, i, node) = stiffness(:, top, i, node) + change
                stiffness(:, bottom, i, node) = stiffness(:, bottom, i, node) - change
              end do
            end do
          end do
        end if
        element%energy(2:4) = element%energy(2:4) &
                              + area*[0.5_dp*dot_product(new%traction, separation), new%viscous, sum(new%dissipated)]
        failed = failed .and. new%damage >= law%most .and. separation(1) >= 0
      end if
      call put_point(n, 0.5_dp*(x(:, bottom) + x(:, top)), new, distance, svars(:, p))
    end do
    svars(5*n + 5, :) = merge(0, 1, removed .or. failed)
  end subroutine integrate

  !> Lumped mass matrix.
  subroutine lump_mass(element, points, x, mass)
    type(element_t), intent(in) :: element
    integer, intent(in) :: points
    real(dp), intent(in) :: x(element%mcrd, 2*points)
    real(dp), intent(inout) :: mass(element%mcrd, 2*points, element%mcrd, 2*points)
    real(dp) :: frame(3, element%mcrd), area, half
    integer :: p, i, top, n, family
    n = element%mcrd
    family = element%jprops(j_cohesive_family)
    do p = 1, points
      top = opposite(family, points, p)
      call measure(family, n, points, p, x, frame, area)
      half = 0.5_dp*(element%props(p_cohesive_width)*element%props(p_cohesive_density))*area &
             *thickness_at(n, points, x, element%props(p_cohesive_thickness), frame, p, top)
      do i = 1, n
        mass(i, p, i, p) = half
        mass(i, top, i, top) = half
      end do
    end do
  end subroutine lump_mass

  !> Constitutive thickness at a point: the given one, or the distance of its nodes along the normal, the first row of the frame.
  real(dp) function thickness_at(n, points, x, given, frame, bottom, top)
    integer, intent(in) :: n, points, bottom, top
    real(dp), intent(in) :: x(n, 2*points), given, frame(3, n)
    thickness_at = given
    if (.not. given > 0) thickness_at = dot_product(frame(1, :), x(:, top) - x(:, bottom))
    if (.not. thickness_at > 0) then
      call stop_with('THICKNESS=GEOMETRY: the thickness between the faces is', thickness_at, bottom)
    end if
  end function thickness_at

  !> Node of the top face that lies over one of the bottom face.
  pure integer function opposite(family, points, node)
    integer, intent(in) :: family, points, node
    opposite = points + node
    if (family == line2) opposite = 2*points + 1 - node
  end function opposite

  !> True for a deleted element: STATUS is 0; it is also 0 before the first call, but then so is the damage.
  pure logical function is_removed(n, svars)
    integer, intent(in) :: n
    real(dp), intent(in) :: svars(5*n + 5)
    is_removed = svars(3*n + 1) > 0 .and. .not. svars(5*n + 5) > 0
  end function is_removed

  !> State of a point from its SVARS.
  pure subroutine get_point(n, svars, point)
    integer, intent(in) :: n
    real(dp), intent(in) :: svars(5*n + 5)
    type(cohesive_point), intent(out) :: point
    point%separation(:n) = svars(n + 1:2*n)
    point%traction(:n) = svars(2*n + 1:3*n)
    point%damage = svars(3*n + 1)
    point%dissipated(:n) = svars(3*n + 2:4*n + 1)
    point%viscous = svars(4*n + 2)
    point%largest = svars(4*n + 3)
    point%criterion = svars(5*n + 4)
  end subroutine get_point

  !> SVARS of a point except the status.
  pure subroutine put_point(n, position, point, thickness, svars)
    integer, intent(in) :: n
    real(dp), intent(in) :: position(n), thickness
    type(cohesive_point), intent(in) :: point
    real(dp), intent(inout) :: svars(5*n + 5)
    svars(:5*n + 4) = [position, point%separation(:n), point%traction(:n), point%damage, point%dissipated(:n), &
                       point%viscous, point%largest, point%separation(:n)/thickness, point%criterion]
  end subroutine put_point

  !> Rows n, s, t of the frame of a corner of the mid-surface, and its area (its length in the plane).
  subroutine measure(family, n, points, point, x, frame, area)
    integer, intent(in) :: family, n, points, point
    real(dp), intent(in) :: x(n, 2*points)
    real(dp), intent(out) :: frame(3, n), area
    real(dp) :: a(3), b(3), by_a(points), by_b(points), axes(3, 3)
    call edges_at(family, n, points, point, x, a, b, by_a, by_b)
    frame = 0
    area = 0
    select case (family)
    case (line2)
      call line_frame([0.0_dp, 0.0_dp], a(:2), axes(:2, :2), area)
      frame(:2, :) = axes(by_normal(:2), :n)
      area = 0.5_dp*area
    case (quad4, tri3)
      call surface_frame(a, b, axes, area)
      frame = axes(by_normal, :n)
      ! each corner of a triangle stands for a third of it
      if (family == tri3) area = area/6.0_dp
    case default
      call add_message(-3_i4, 'cohesive elements between faces of this family are not known to the host')
      call escape()
    end select
    if (.not. area > 0) call stop_with('the area of the mid-surface is', area, point)
  end subroutine measure

  !> Vectors in the mid-surface at a corner: in the plane from 1 to 2, in a triangle from 1 to 2 and to 3, else half the edges
  !> there, the second one counter-clockwise from the first; and how much of each node of the mid-surface they have. Zero for
  !> other families.
  pure subroutine edges_at(family, n, points, point, x, a, b, by_a, by_b)
    integer, intent(in) :: family, n, points, point
    real(dp), intent(in) :: x(n, 2*points)
    real(dp), intent(out) :: a(3), b(3), by_a(points), by_b(points)
    integer, parameter :: before(4) = [2, 1, 4, 3], beside(4) = [4, 3, 2, 1]
    real(dp), parameter :: along(4) = [0.5_dp, -0.5_dp, -0.5_dp, 0.5_dp], across(4) = [0.5_dp, 0.5_dp, -0.5_dp, -0.5_dp]
    integer :: p
    by_a = 0
    by_b = 0
    if (family == line2) then
      by_a = [-1.0_dp, 1.0_dp]
    else if (family == tri3) then
      by_a = [-1.0_dp, 1.0_dp, 0.0_dp]
      by_b = [-1.0_dp, 0.0_dp, 1.0_dp]
    else if (family == quad4) then
      by_a(before(point)) = along(point)
      by_a(point) = -along(point)
      by_b(beside(point)) = across(point)
      by_b(point) = -across(point)
    end if
    a = 0
    b = 0
    do p = 1, points
      a(:n) = a(:n) + by_a(p)*0.5_dp*(x(:, p) + x(:, opposite(family, points, p)))
      b(:n) = b(:n) + by_b(p)*0.5_dp*(x(:, p) + x(:, opposite(family, points, p)))
    end do
  end subroutine edges_at

  !> Frame of a corner after displacements, and its derivative (row, component, direction, node) by the mid-surface.
  subroutine turn_frame(family, n, points, point, x, now, frame, present_frame, turning)
    integer, intent(in) :: family, n, points, point
    real(dp), intent(in) :: x(n, 2*points), now(n, 2*points)    !< coordinates at the start, and now
    real(dp), intent(in) :: frame(3, n)                         !< at the start
    real(dp), intent(out) :: present_frame(3, n), turning(3, n, n, points)
    real(dp) :: start(3, 2), present(3, 2), by(points, 2), old(3, 3), turned(3, 3), turned_by(3, n, n, points), area
    call edges_at(family, n, points, point, x, start(:, 1), start(:, 2), by(:, 1), by(:, 2))
    call edges_at(family, n, points, point, now, present(:, 1), present(:, 2), by(:, 1), by(:, 2))
    old = 0
    old(:, :n) = frame(by_normal, :)
    call turned_frame(n, points, start(:n, :n - 1), present(:n, :n - 1), old, by(:, :n - 1), turned, turned_by, area)
    if (.not. area > 0) call stop_with('the area of the mid-surface is', area, point)
    present_frame = turned(by_normal, :n)
    turning = turned_by(by_normal, :, :, :)
  end subroutine turn_frame

  !> End the analysis with a message.
  subroutine stop_with(what, value, point)
    character(len=*), intent(in) :: what
    real(dp), intent(in) :: value
    integer, intent(in) :: point
    character(len=256) :: text
    write (text, '(a,es10.2,a,i0)') what, value, ' at integration point ', point
    call add_message(-3_i4, trim(text))
    call escape()
  end subroutine stop_with
end module host_cohesive
