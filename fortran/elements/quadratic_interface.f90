! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Cohesive interface between eight-node quads: the standard element with the six nodes of two edges, the stabilised one
!> with all sixteen of both quads. The edges may be curved: every integration point has a frame of its own.
module elements_quadratic_interface
  use core_kinds, only: dp
  use core_quadrature, only: gauss_rule, gauss_abscissa
  use core_quadratic_shape, only: line3_shape, line3_slope, three_points, three_weights, outer_abscissa
  use core_rotation, only: line_frame
  use core_status, only: status_type, ok, zero_length, edges_apart
  use materials_spectral_norm, only: spectral_norm
  use cohesive_parameters, only: law_parameters
  use cohesive_state, only: damage_state
  use cohesive_law, only: check_law, check_beta, evolve_damage, stiffness_of
  use cohesive_traction, only: standard_traction
  use elements_interface_point, only: interface_options, interface_point, interface_geometry, close_point, point_energies, &
    apart
  use elements_quad8, only: quad8_traction, quad8_area, quad8_face_eigenvalue
  use elements_stabilised_interface, only: stabilisation_type, weigh_sides, evaluate_point, sample_face, sample_gauss
  implicit none(type, external)
  private
  public :: quadratic_standard, quadratic_stabilised

  !> Nodes of the lower and the upper edge: left, right, middle.
  integer, parameter :: six(3, 2) = reshape([1, 2, 5, 4, 3, 6], [3, 2])
  integer, parameter :: sixteen(3, 2) = reshape([4, 3, 7, 9, 10, 13], [3, 2])

  !> eta of the edge of the bottom and the top quad.
  real(dp), parameter :: eta_of_side(2) = [1.0_dp, -1.0_dp]

  !> An integration point.
  type :: place_type
    real(dp) :: s                         !< in (-1, 1)
    real(dp) :: length                    !< of the interface that it stands for
    real(dp) :: shape(3)                  !< shape functions of left, right, middle
    type(interface_geometry) :: geometry  !< frame and position
  end type place_type

contains

  !> Standard element, equations (14) and (15). Nodes 1 and 2 lie at the ends of the bottom edge, 4 on 1 and 3 on 2 at
  !> those of the top edge, 5 in the middle of the bottom edge and 6 on it.
  pure subroutine quadratic_standard(law, options, thickness, coordinates, u, dtime, old, new, residual, tangent, &
    energies, status)
    type(law_parameters), intent(in) :: law
    type(interface_options), intent(in) :: options
    real(dp), intent(in) :: thickness             !< out of the plane, length
    real(dp), intent(in) :: coordinates(2, 6)     !< original coordinates, length
    real(dp), intent(in) :: u(12)                 !< displacements at the end of the increment, length
    real(dp), intent(in) :: dtime                 !< duration of the increment
    type(interface_point), intent(in) :: old(3)   !< committed state
    type(interface_point), intent(out) :: new(3)
    real(dp), intent(out) :: residual(12)         !< force
    real(dp), intent(out) :: tangent(12, 12)      !< -d(residual)/du, force/length
    real(dp), intent(out) :: energies(3)          !< stored T.g/2, dissipated by damage, viscous
    type(status_type), intent(out) :: status
    type(place_type) :: places(3)
    type(damage_state) :: state
    real(dp) :: jump(2, 12), separation(2), traction(2), local(2, 2)
    integer :: k

    residual = 0.0_dp
    tangent = 0.0_dp
    energies = 0.0_dp
    call check_law(law, status)
    if (status%code /= ok) return
    call measure(coordinates(:, six(:, 1)), coordinates(:, six(:, 2)), options%rule, places, status)
    if (status%code /= ok) return
    do k = 1, 3
      jump = jump_operator(places(k), six, 6)
      separation = matmul(jump, u)
      call evolve_damage(law, old(k)%history, separation, dtime, state)
      state%slope = (1.0_dp - options%secant_share)*state%slope
      call standard_traction(stiffness_of(law), separation, state%acting, state%slope, traction, local)
      call close_point(law, places(k)%geometry, 0.0_dp, old(k), separation, state, traction, [1.0_dp, 1.0_dp], new(k))
      call add_point(jump, places(k)%length*thickness, traction, matmul(local, jump), residual, tangent)
      energies = energies + point_energies(places(k)%length*thickness, new(k))
    end do
  end subroutine quadratic_standard

  !> Stabilised element, equations (16) to (22) or the consistent closure. Nodes 1 to 8 are the bottom quad, whose edge
  !> 4-7-3 is the interface, 9 to 16 the top quad, whose edge 9-13-10 is the interface. Exact, unsymmetric tangent.
  pure subroutine quadratic_stabilised(law, options, thickness, given, stiffness, coordinates, u, dtime, old, new, &
    residual, tangent, energies, status)
    type(law_parameters), intent(in) :: law
    type(interface_options), intent(in) :: options
    real(dp), intent(in) :: thickness               !< out of the plane, length
    type(stabilisation_type), intent(in) :: given   !< beta and gamma, or what they follow from
    real(dp), intent(in) :: stiffness(3, 3, 2)      !< D of bottom and top, stress
    real(dp), intent(in) :: coordinates(2, 16)      !< original coordinates, length
    real(dp), intent(in) :: u(32)                   !< displacements at the end of the increment, length
    real(dp), intent(in) :: dtime                   !< duration of the increment
    type(interface_point), intent(in) :: old(3)     !< committed state
    type(interface_point), intent(out) :: new(3)
    real(dp), intent(out) :: residual(32)           !< force
    real(dp), intent(out) :: tangent(32, 32)        !< -d(residual)/du, force/length
    real(dp), intent(out) :: energies(3)            !< stored T.g/2, dissipated by damage, viscous
    type(status_type), intent(out) :: status
    type(place_type) :: places(3)
    type(stabilisation_type) :: used
    real(dp) :: jump(2, 32), bulk(2, 32), by_jump(2, 2), by_bulk(2, 2)
    integer :: k

    residual = 0.0_dp
    tangent = 0.0_dp
    energies = 0.0_dp
    call check_law(law, status)
    if (status%code /= ok) return
    call measure(coordinates(:, sixteen(:, 1)), coordinates(:, sixteen(:, 2)), options%rule, places, status)
    if (status%code /= ok) return
    call stabilise(given, stiffness, coordinates, used, status)
    if (status%code /= ok) return
    if (options%consistent_closure) call check_beta(law, used%beta, status)
    if (status%code /= ok) return
    do k = 1, 3
      jump = jump_operator(places(k), sixteen, 16)
      call bulk_traction(options%sampling, places(k), used%gamma_bottom, stiffness, coordinates, bulk, status)
      if (status%code /= ok) return
      call evaluate_point(law, options, places(k)%geometry, 1, used%beta, dtime, matmul(jump, u), matmul(bulk, u), &
        old(k), new(k), by_jump, by_bulk)
      call add_point(jump, places(k)%length*thickness, new(k)%traction, matmul(by_jump, jump) + matmul(by_bulk, bulk), &
        residual, tangent)
      energies = energies + point_energies(places(k)%length*thickness, new(k))
    end do
  end subroutine quadratic_stabilised

  !> Integration points on the mid-line of two coincident edges (left, right, middle).
  pure subroutine measure(bottom, top, rule, places, status)
    real(dp), intent(in) :: bottom(2, 3), top(2, 3)   !< original coordinates
    integer, intent(in) :: rule
    type(place_type), intent(out) :: places(3)
    type(status_type), intent(out) :: status          !< zero_length, or edges_apart with the distance and its limit
    real(dp) :: middle(2, 3), distance, edge, s(3), w(3), slope(2), origin(2), along
    integer :: k

    middle = 0.5_dp*(bottom + top)
    edge = maxval(abs(bottom(:, 2) - bottom(:, 1)))
    distance = maxval(abs(top - bottom))
    s = three_points(rule)
    w = three_weights(rule)
    origin = 0.0_dp
    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    if (.not. edge > 0.0_dp) then
      status = status_type(zero_length, 0, edge, 0.0_dp)
    else if (distance > apart*edge) then
      status = status_type(edges_apart, 0, distance, apart*edge)
    end if
    if (status%code /= ok) return
    do k = 1, 3
      slope = matmul(middle, line3_slope(s(k)))
      ! a middle node that is too near to an end turns the edge back
      along = dot_product(slope, middle(:, 2) - middle(:, 1))
      if (.not. along > 0.0_dp) then
        status = status_type(zero_length, 0, along, 0.0_dp)
        return
      end if
      places(k)%s = s(k)
      places(k)%shape = line3_shape(s(k))
      call line_frame(origin, slope, places(k)%geometry%frame, places(k)%geometry%length)
      places(k)%length = w(k)*places(k)%geometry%length
      places(k)%geometry%s = 0.0_dp
      places(k)%geometry%ends(:, 1) = matmul(middle, places(k)%shape)
      places(k)%geometry%ends(:, 2) = places(k)%geometry%ends(:, 1)
    end do
  end subroutine measure

  !> Matrix that takes the displacements to the separation (tau, n).
  pure function jump_operator(place, owned, nodes) result(matrix)
    type(place_type), intent(in) :: place
    integer, intent(in) :: owned(3, 2)   !< nodes of the bottom and the top edge
    integer, intent(in) :: nodes         !< of the element
    real(dp) :: matrix(2, 2*nodes)
    real(dp), parameter :: sign_of_side(2) = [-1.0_dp, 1.0_dp]
    integer :: a, side, column

    matrix = 0.0_dp
    do side = 1, 2
      do a = 1, 3
        column = 2*owned(a, side)
        matrix(:, column - 1:column) = (sign_of_side(side)*place%shape(a))*place%geometry%frame
      end do
    end do
  end function jump_operator

  !> Adds what a point pulls the two edges together with, and its derivative.
  pure subroutine add_point(jump, weight, traction, by_displacement, residual, tangent)
    real(dp), intent(in) :: jump(:, :)              !< separation from displacements
    real(dp), intent(in) :: weight                  !< area of the point
    real(dp), intent(in) :: traction(2)             !< (tau, n)
    real(dp), intent(in) :: by_displacement(:, :)   !< its derivative by the displacements
    real(dp), intent(inout) :: residual(:), tangent(:, :)

    residual = residual - weight*matmul(traction, jump)
    tangent = tangent + weight*matmul(transpose(jump), by_displacement)
  end subroutine add_point

  !> Beta and gamma.
  pure subroutine stabilise(given, stiffness, coordinates, used, status)
    type(stabilisation_type), intent(in) :: given
    real(dp), intent(in) :: stiffness(3, 3, 2), coordinates(2, 16)
    type(stabilisation_type), intent(out) :: used
    type(status_type), intent(out) :: status    !< inside_out: item 1 for the bottom quad, 2 for the top one
    type(place_type) :: places(3)
    real(dp) :: areas(2), norms(2), lengths(3), frames(2, 2, 3), xy(2, 8)
    integer :: side, k
    logical :: local

    used = given
    local = minval(given%beta) < 0.0_dp
    call measure(coordinates(:, sixteen(:, 1)), coordinates(:, sixteen(:, 2)), gauss_rule, places, status)
    if (status%code /= ok) return
    do k = 1, 3
      lengths(k) = places(k)%length
      frames(:, :, k) = places(k)%geometry%frame
    end do
    do side = 1, 2
      xy = coordinates(:, 8*side - 7:8*side)
      if (local) then
        ! lambda takes the place of |D| meas(Gamma)/meas(Omega)
        areas(side) = sum(lengths)
        call quad8_face_eigenvalue(xy, eta_of_side(side), frames, lengths, stiffness(:, :, side), norms(side), status)
      else
        norms(side) = spectral_norm(stiffness(:, :, side))
        call quad8_area(xy, areas(side), status)
      end if
      if (status%code /= ok) then
        status%item = side
        return
      end if
    end do
    used = weigh_sides(given, norms, areas, sum(lengths))
  end subroutine stabilise

  !> Matrix that takes the 32 displacements to <sigma>.n in (tau, n) at a point.
  pure subroutine bulk_traction(sampling, place, gamma_bottom, stiffness, coordinates, matrix, status)
    integer, intent(in) :: sampling
    type(place_type), intent(in) :: place
    real(dp), intent(in) :: gamma_bottom, stiffness(3, 3, 2), coordinates(2, 16)
    real(dp), intent(out) :: matrix(2, 32)
    type(status_type), intent(out) :: status      !< inside_out: item 1 for the bottom quad, 2 for the top one
    real(dp) :: weights(2), points(2, 2), shares(2), part(2, 16)
    integer :: side, i

    matrix = 0.0_dp
    weights = [gamma_bottom, 1.0_dp - gamma_bottom]
    do side = 1, 2
      call sample(sampling, place%s, eta_of_side(side), points, shares)
      do i = 1, 2
        call quad8_traction(coordinates(:, 8*side - 7:8*side), points(:, i), place%geometry%frame, &
          stiffness(:, :, side), part, status)
        if (status%code /= ok) then
          status%item = side
          return
        end if
        matrix(:, 16*side - 15:16*side) = matrix(:, 16*side - 15:16*side) + (weights(side)*shares(i))*part
      end do
    end do
  end subroutine bulk_traction

  !> Points (xi, eta) of a quad whose stresses, in these shares, are taken for the place s of its edge: the edge itself,
  !> the next one of 3 x 3 Gauss points, or the line through the stress of the edge at xi = +-1/sqrt(3), where it is most
  !> accurate in an eight-node quad (Barlow 1976), as the middle is in one of four nodes.
  pure subroutine sample(sampling, s, eta, points, shares)
    integer, intent(in) :: sampling
    real(dp), intent(in) :: s, eta
    real(dp), intent(out) :: points(2, 2), shares(2)

    points(2, :) = eta
    points(1, :) = s
    shares = 0.5_dp
    select case (sampling)
    case (sample_face)
      return
    case (sample_gauss)
      points(1, :) = merge(sign(outer_abscissa, s), 0.0_dp, abs(s) > 0.5_dp)
      points(2, :) = eta*outer_abscissa
    case default
      points(1, :) = [-gauss_abscissa, gauss_abscissa]
      shares = 0.5_dp*(1.0_dp + s*points(1, :)/gauss_abscissa**2)
    end select
  end subroutine sample

end module elements_quadratic_interface
