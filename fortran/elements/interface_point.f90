! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What all interface elements share: geometry, separation, state of a point, nodal forces of a point.
!>
!> Nodes 1 and 2 lie along the bottom edge, 3 and 4 back along the top one (4 on 1, 3 on 2), as in COH2D4. The tangent
!> tau runs from 1 to 2 along the mid-line of the original coordinates, n is tau turned by +90 degrees: bottom to top.
module elements_interface_point
  use core_kinds, only: dp
  use core_quadrature, only: line_points
  use core_rotation, only: line_frame
  use core_shape_functions, only: line_shape
  use core_status, only: status_type, zero_length, edges_apart, ok
  use cohesive_parameters, only: law_parameters
  use cohesive_state, only: point_history, damage_state, closure_state
  use cohesive_law, only: dissipate
  use cohesive_closure, only: dissipate_consistently
  implicit none(type, external)
  private
  public :: interface_options, interface_point, interface_geometry
  public :: measure_interface, separation_at, add_point, spread_to_nodes, close_point, close_consistent_point, point_energies
  public :: end_of_node, sign_of_node, apart

  !> Options every interface element has.
  type :: interface_options
    integer :: rule                 !< gauss_rule or newton_cotes_rule
    integer :: sampling             !< of the bulk stress; of no concern to the standard element
    logical :: consistent_closure   !< the law has a separation of its own; likewise
    real(dp) :: secant_share        !< of the matrix at fixed damage in the tangent, from 0 to 1
  end type interface_options

  !> State of an integration point at the end of the increment; components (tau, n).
  type :: interface_point
    real(dp) :: position(2) = 0.0_dp        !< global x and y
    real(dp) :: traction(2) = 0.0_dp        !< T, stress, tension positive
    real(dp) :: stabilisation(2) = 0.0_dp   !< S
    real(dp) :: jump(2) = 0.0_dp            !< displacement jump g, opening positive
    real(dp) :: stored = 0.0_dp             !< recoverable energy, energy/area
    type(point_history) :: history
  end type interface_point

  !> Mid-line of the interface.
  type :: interface_geometry
    real(dp) :: frame(2, 2)   !< rows tau and n
    real(dp) :: length
    real(dp) :: s(2)          !< the two integration points in (-1, 1), of weight 1
    real(dp) :: ends(2, 2)    !< global coordinates of the left and right end
  end type interface_geometry

  !> Distance of coincident nodes, relative to the length, up to which they count as coincident: what a mesh generator
  !> that prints few digits may cause.
  real(dp), parameter :: apart = 1.0e-4_dp

  !> End of the interface where each of its nodes lies, and its sign in the separation.
  integer, parameter :: end_of_node(4) = [1, 2, 2, 1]
  real(dp), parameter :: sign_of_node(4) = [-1.0_dp, -1.0_dp, 1.0_dp, 1.0_dp]

contains

  !> Geometry of the interface between coincident edges.
  pure subroutine measure_interface(coordinates, rule, geometry, status)
    real(dp), intent(in) :: coordinates(2, 4)   !< original coordinates of nodes 1 to 4
    integer, intent(in) :: rule
    type(interface_geometry), intent(out) :: geometry
    type(status_type), intent(out) :: status    !< zero_length, or edges_apart with the distance and its limit
    real(dp) :: distance, edge

    geometry%ends(:, 1) = 0.5_dp*(coordinates(:, 1) + coordinates(:, 4))
    geometry%ends(:, 2) = 0.5_dp*(coordinates(:, 2) + coordinates(:, 3))
    geometry%s = line_points(rule)
    call line_frame(geometry%ends(:, 1), geometry%ends(:, 2), geometry%frame, geometry%length)
    distance = maxval(abs(coordinates(:, [4, 3]) - coordinates(:, [1, 2])))
    edge = maxval(abs(coordinates(:, 2) - coordinates(:, 1)))
    if (.not. edge > 0.0_dp) then
      status = status_type(zero_length, 0, edge, 0.0_dp)
    else if (distance > apart*edge) then
      status = status_type(edges_apart, 0, distance, apart*edge)
    else
      status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    end if
  end subroutine measure_interface

  !> Separation (tau, n) at s from the displacements of nodes 1 to 4.
  pure function separation_at(frame, s, u) result(separation)
    real(dp), intent(in) :: frame(2, 2), s, u(2, 4)
    real(dp) :: separation(2)
    real(dp) :: shape(2), jump(2)

    shape = line_shape(s)
    jump = shape(1)*(u(:, 4) - u(:, 1)) + shape(2)*(u(:, 3) - u(:, 2))
    separation(1) = frame(1, 1)*jump(1) + frame(1, 2)*jump(2)
    separation(2) = frame(2, 1)*jump(1) + frame(2, 2)*jump(2)
  end function separation_at

  !> Adds the force of a point on the left and right end of the top edge, and its derivative by the separation there.
  pure subroutine add_point(frame, s, weight, traction, tangent, force, matrix)
    real(dp), intent(in) :: frame(2, 2)
    real(dp), intent(in) :: s
    real(dp), intent(in) :: weight                  !< area of the point
    real(dp), intent(in) :: traction(2)             !< (tau, n)
    real(dp), intent(in) :: tangent(2, 2)           !< dT/dg in (tau, n)
    real(dp), intent(inout) :: force(2, 2)          !< (x and y, end)
    real(dp), intent(inout) :: matrix(2, 2, 2, 2)   !< (x and y, end, x and y, end)
    real(dp) :: shape(2), global_force(2), global_tangent(2, 2), by_y(2)
    integer :: i, j

    shape = line_shape(s)
    global_force = to_global(frame, traction)
    global_tangent(:, 1) = to_global(frame, tangent(:, 1))
    global_tangent(:, 2) = to_global(frame, tangent(:, 2))
    ! now by the components of the separation along x and y
    by_y = global_tangent(:, 1)*frame(1, 2) + global_tangent(:, 2)*frame(2, 2)
    global_tangent(:, 1) = global_tangent(:, 1)*frame(1, 1) + global_tangent(:, 2)*frame(2, 1)
    global_tangent(:, 2) = by_y
    do j = 1, 2
      force(:, j) = force(:, j) + (weight*shape(j))*global_force
      do i = 1, 2
        matrix(:, i, 1, j) = matrix(:, i, 1, j) + (weight*shape(i)*shape(j))*global_tangent(:, 1)
        matrix(:, i, 2, j) = matrix(:, i, 2, j) + (weight*shape(i)*shape(j))*global_tangent(:, 2)
      end do
    end do
  end subroutine add_point

  !> Residual and tangent of nodes 1 to 4 from the sums of `add_point`: top and bottom are pulled together.
  pure subroutine spread_to_nodes(force, matrix, residual, tangent)
    real(dp), intent(in) :: force(2, 2), matrix(2, 2, 2, 2)
    real(dp), intent(out) :: residual(2, 4)
    real(dp), intent(out) :: tangent(2, 4, 2, 4)
    integer :: a, b, j

    do b = 1, 4
      residual(:, b) = -sign_of_node(b)*force(:, end_of_node(b))
      do j = 1, 2
        do a = 1, 4
          tangent(:, a, j, b) = (sign_of_node(a)*sign_of_node(b))*matrix(:, end_of_node(a), j, end_of_node(b))
        end do
      end do
    end do
  end subroutine spread_to_nodes

  !> Global components of a vector given in (tau, n).
  pure function to_global(frame, local) result(global)
    real(dp), intent(in) :: frame(2, 2), local(2)
    real(dp) :: global(2)

    global(1) = frame(1, 1)*local(1) + frame(2, 1)*local(2)
    global(2) = frame(1, 2)*local(1) + frame(2, 2)*local(2)
  end function to_global

  !> State of a point at the end of the increment.
  pure subroutine close_point(law, geometry, s, old, separation, state, traction, stabilisation, new)
    type(law_parameters), intent(in) :: law
    type(interface_geometry), intent(in) :: geometry
    real(dp), intent(in) :: s
    type(interface_point), intent(in) :: old
    real(dp), intent(in) :: separation(2)
    type(damage_state), intent(in) :: state
    real(dp), intent(in) :: traction(2), stabilisation(2)
    type(interface_point), intent(out) :: new
    real(dp) :: shape(2)

    shape = line_shape(s)
    new%position = shape(1)*geometry%ends(:, 1) + shape(2)*geometry%ends(:, 2)
    new%traction = traction
    new%stabilisation = stabilisation
    new%jump = separation
    new%stored = 0.5_dp*(traction(1)*separation(1) + traction(2)*separation(2))
    new%history%separation = separation
    new%history%damage = state%damage
    new%history%damage_max = state%damage_max
    new%history%largest = state%largest
    call dissipate(law, old%history, separation, state, new%history%dissipated, new%history%viscous)
  end subroutine close_point

  !> State of a point of the consistent closure at the end of the increment.
  pure subroutine close_consistent_point(law, geometry, s, old, separation, state, new)
    type(law_parameters), intent(in) :: law
    type(interface_geometry), intent(in) :: geometry
    real(dp), intent(in) :: s
    type(interface_point), intent(in) :: old
    real(dp), intent(in) :: separation(2)   !< displacement jump
    type(closure_state), intent(in) :: state
    type(interface_point), intent(out) :: new
    real(dp) :: shape(2)

    shape = line_shape(s)
    new%position = shape(1)*geometry%ends(:, 1) + shape(2)*geometry%ends(:, 2)
    new%traction = state%traction
    new%stabilisation = state%stabilisation
    new%jump = separation
    new%stored = 0.5_dp*(state%recoverable(1)*state%separation(1) + state%recoverable(2)*state%separation(2))
    new%history%separation = state%separation
    new%history%damage = state%damage
    new%history%damage_max = state%damage
    new%history%largest = state%largest
    call dissipate_consistently(law, old%history, old%traction, state, new%history%dissipated, new%history%viscous, &
      new%history%rubbed)
  end subroutine close_consistent_point

  !> Energies of a point: stored, dissipated by damage and friction, dissipated by the viscous overstress.
  pure function point_energies(weight, point) result(energies)
    real(dp), intent(in) :: weight   !< area of the point
    type(interface_point), intent(in) :: point
    real(dp) :: energies(3)

    energies(1) = weight*point%stored
    energies(2) = weight*(point%history%dissipated(1) + point%history%dissipated(2) + point%history%rubbed)
    energies(3) = weight*point%history%viscous
  end function point_energies

end module elements_interface_point
