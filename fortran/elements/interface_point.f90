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
  use cohesive_law, only: law_parameters, point_history, damage_state, dissipate
  implicit none(type, external)
  private
  public :: interface_options, interface_point, interface_geometry
  public :: measure_interface, jump_coefficients, separation_at, add_point, close_point, point_energies
  public :: consistent_tangent, secant_tangent

  integer, parameter :: consistent_tangent = 0
  integer, parameter :: secant_tangent = 1

  !> Options every interface element has.
  type :: interface_options
    integer :: rule       !< gauss_rule or newton_cotes_rule
    integer :: tangent    !< consistent_tangent or secant_tangent
    integer :: sampling   !< of the bulk stress; of no concern to the standard element
  end type interface_options

  !> State of an integration point at the end of the increment; components (tau, n).
  type :: interface_point
    real(dp) :: position(2) = 0.0_dp        !< global x and y
    real(dp) :: traction(2) = 0.0_dp        !< T, stress, tension positive
    real(dp) :: stabilisation(2) = 0.0_dp   !< S
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

contains

  !> Geometry of the interface between coincident edges.
  pure subroutine measure_interface(coordinates, rule, geometry, status)
    real(dp), intent(in) :: coordinates(2, 4)   !< original coordinates of nodes 1 to 4
    integer, intent(in) :: rule
    type(interface_geometry), intent(out) :: geometry
    type(status_type), intent(out) :: status    !< zero_length, or edges_apart with the distance and its limit
    real(dp) :: distance

    geometry%ends(:, 1) = 0.5_dp*(coordinates(:, 1) + coordinates(:, 4))
    geometry%ends(:, 2) = 0.5_dp*(coordinates(:, 2) + coordinates(:, 3))
    geometry%s = line_points(rule)
    call line_frame(geometry%ends(:, 1), geometry%ends(:, 2), geometry%frame, geometry%length)
    distance = maxval(abs(coordinates(:, [4, 3]) - coordinates(:, [1, 2])))
    if (.not. geometry%length > 0.0_dp) then
      status = status_type(zero_length, 0, geometry%length, 0.0_dp)
    else if (distance > apart*geometry%length) then
      status = status_type(edges_apart, 0, distance, apart*geometry%length)
    else
      status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    end if
  end subroutine measure_interface

  !> Coefficients of the nodes 1 to 4 in the separation u_top - u_bottom at s.
  pure function jump_coefficients(s) result(coefficients)
    real(dp), intent(in) :: s
    real(dp) :: coefficients(4)
    real(dp) :: shape(2)

    shape = line_shape(s)
    coefficients = [-shape(1), -shape(2), shape(2), shape(1)]
  end function jump_coefficients

  !> Separation (tau, n) from the displacements of nodes 1 to 4.
  pure function separation_at(frame, coefficients, u) result(separation)
    real(dp), intent(in) :: frame(2, 2), coefficients(4), u(2, 4)
    real(dp) :: separation(2)
    real(dp) :: jump(2)

    ! pairwise, so that equal displacements of coincident nodes give zero to the last bit
    jump = coefficients(4)*(u(:, 4) - u(:, 1)) + coefficients(3)*(u(:, 3) - u(:, 2))
    separation(1) = frame(1, 1)*jump(1) + frame(1, 2)*jump(2)
    separation(2) = frame(2, 1)*jump(1) + frame(2, 2)*jump(2)
  end function separation_at

  !> Adds what a point contributes to the residual and, where only nodes 1 to 4 matter, to the tangent.
  pure subroutine add_point(frame, coefficients, weight, traction, tangent_local, residual, tangent)
    real(dp), intent(in) :: frame(2, 2)
    real(dp), intent(in) :: coefficients(4)
    real(dp), intent(in) :: weight                !< area of the point
    real(dp), intent(in) :: traction(2)           !< (tau, n)
    real(dp), intent(in) :: tangent_local(2, 2)   !< dT/dg in (tau, n)
    real(dp), intent(inout) :: residual(2, 4)
    real(dp), intent(inout) :: tangent(2, 4, 2, 4)
    real(dp) :: force(2), matrix(2, 2)
    integer :: a, b

    force = weight*matmul(traction, frame)
    matrix = weight*matmul(transpose(frame), matmul(tangent_local, frame))
    do b = 1, 4
      residual(:, b) = residual(:, b) - coefficients(b)*force
      do a = 1, 4
        tangent(:, a, 1, b) = tangent(:, a, 1, b) + (coefficients(a)*coefficients(b))*matrix(:, 1)
        tangent(:, a, 2, b) = tangent(:, a, 2, b) + (coefficients(a)*coefficients(b))*matrix(:, 2)
      end do
    end do
  end subroutine add_point

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
    new%history%separation = separation
    new%history%damage = state%damage
    new%history%damage_max = state%damage_max
    call dissipate(law, old%history, separation, state, new%history%dissipated, new%history%viscous)
  end subroutine close_point

  !> Energies of a point: stored T.g/2, dissipated by damage, dissipated by the viscous overstress.
  pure function point_energies(weight, point) result(energies)
    real(dp), intent(in) :: weight   !< area of the point
    type(interface_point), intent(in) :: point
    real(dp) :: energies(3)

    energies(1) = 0.5_dp*weight*(point%traction(1)*point%history%separation(1) &
      + point%traction(2)*point%history%separation(2))
    energies(2) = weight*(point%history%dissipated(1) + point%history%dissipated(2))
    energies(3) = weight*point%history%viscous
  end function point_energies

end module elements_interface_point
