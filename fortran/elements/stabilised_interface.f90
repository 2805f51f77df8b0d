! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Stabilised cohesive interface element, equations (16) to (22), in two variants: with four nodes, given the stress of
!> its neighbours, and with eight, the nodes of the two quads that share the interface, whose stress it works out.
module elements_stabilised_interface
  use core_kinds, only: dp
  use core_rotation, only: traction_operator
  use core_quadrature, only: quad_points
  use core_shape_functions, only: line_shape, quad_gradient
  use core_status, only: status_type, ok, inside_out
  use materials_spectral_norm, only: spectral_norm
  use cohesive_parameters, only: law_parameters
  use cohesive_state, only: damage_state, closure_state
  use cohesive_law, only: check_law, check_beta, evolve_damage, stiffness_of
  use cohesive_closure, only: close_consistently
  use cohesive_traction, only: stabilised_traction
  use elements_interface_point, only: interface_options, interface_point, interface_geometry, &
    measure_interface, separation_at, add_point, spread_to_nodes, close_point, close_consistent_point, point_energies, &
    end_of_node, sign_of_node
  use elements_quad4, only: face_point, gauss_of_face, quad4_area
  use elements_face_eigenvalue, only: quad4_face_eigenvalue
  implicit none(type, external)
  private
  public :: stabilisation_type, stabilised_interface_four, stabilised_interface_eight, weigh_sides, evaluate_point
  public :: sample_middle, sample_face, sample_gauss

  !> Where the bulk stress is taken: in the middle of the face, at the face with the xi of the point, or in the Gauss
  !> point of the quad next to it. In a quad the stress varies spuriously along xi; only the middle is free of it.
  integer, parameter :: sample_middle = 0
  integer, parameter :: sample_face = 1
  integer, parameter :: sample_gauss = 2

  !> Faces of the bottom and the top quad that are the interface.
  integer, parameter :: faces(2) = [3, 1]

  !> Parameters of the stabilisation; a zero asks for (21) or (22), a negative
  !> beta for both from the local eigenvalue problem.
  type :: stabilisation_type
    real(dp) :: beta(2)        !< (tau, n), stress/length
    real(dp) :: gamma_bottom   !< weight of the bottom stress; that of the top is 1 - gamma_bottom
  end type stabilisation_type

contains

  !> Puts (21) and (22) where beta and gamma are not given.
  pure function weigh_sides(given, norms, areas, length) result(used)
    type(stabilisation_type), intent(in) :: given
    real(dp), intent(in) :: norms(2)   !< |D| of bottom and top, stress
    real(dp), intent(in) :: areas(2)   !< meas(Omega) of bottom and top
    real(dp), intent(in) :: length     !< meas(Gamma)
    type(stabilisation_type) :: used
    real(dp) :: softness(2)

    used = given
    softness = areas/norms
    if (.not. given%gamma_bottom > 0.0_dp) used%gamma_bottom = softness(1)/(softness(1) + softness(2))
    where (.not. given%beta > 0.0_dp) used%beta = 2.0_dp*length &
      *(used%gamma_bottom**2/softness(1) + (1.0_dp - used%gamma_bottom)**2/softness(2))
  end function weigh_sides

  !> Four-node variant. Its tangent is that at constant bulk stress, since what depends on the stress of the neighbours
  !> involves nodes that it does not own: the penalty part S alpha (1 - d), with the derivative of the damage if the
  !> consistent tangent is asked for.
  pure subroutine stabilised_interface_four(law, options, thickness, stabilisation, coordinates, u, bulk_stress, &
    dtime, old, new, residual, tangent, energies, status)
    type(law_parameters), intent(in) :: law
    type(interface_options), intent(in) :: options
    real(dp), intent(in) :: thickness                       !< out of the plane, length
    type(stabilisation_type), intent(in) :: stabilisation   !< beta and gamma, none of them zero
    real(dp), intent(in) :: coordinates(2, 4)               !< original coordinates, length
    real(dp), intent(in) :: u(2, 4)                         !< displacements at the end of the increment, length
    real(dp), intent(in) :: bulk_stress(3, 2)               !< gamma-weighted (s11, s22, s12) of each point
    real(dp), intent(in) :: dtime                           !< duration of the increment
    type(interface_point), intent(in) :: old(2)             !< committed state
    type(interface_point), intent(out) :: new(2)
    real(dp), intent(out) :: residual(2, 4)                 !< force
    real(dp), intent(out) :: tangent(2, 4, 2, 4)            !< force/length
    real(dp), intent(out) :: energies(3)          !< stored T.g/2, dissipated by damage, viscous
    type(status_type), intent(out) :: status
    type(interface_geometry) :: geometry
    real(dp) :: local(2, 2), by_bulk(2, 2), weight, to_traction(2, 3), force(2, 2), matrix(2, 2, 2, 2)
    integer :: k

    residual = 0.0_dp
    tangent = 0.0_dp
    energies = 0.0_dp
    call check_law(law, status)
    if (status%code /= ok) return
    if (options%consistent_closure) call check_beta(law, stabilisation%beta, status)
    if (status%code /= ok) return
    call measure_interface(coordinates, options%rule, geometry, status)
    if (status%code /= ok) return

    force = 0.0_dp
    matrix = 0.0_dp
    weight = 0.5_dp*geometry%length*thickness
    to_traction = traction_operator(geometry%frame)
    do k = 1, 2
      call evaluate_point(law, options, geometry, k, stabilisation%beta, dtime, &
        separation_at(geometry%frame, geometry%s(k), u), matmul(to_traction, bulk_stress(:, k)), &
        old(k), new(k), local, by_bulk)
      call add_point(geometry%frame, geometry%s(k), weight, new(k)%traction, local, force, matrix)
      energies = energies + point_energies(weight, new(k))
    end do
    call spread_to_nodes(force, matrix, residual, tangent)
  end subroutine stabilised_interface_four

  !> Eight-node variant: nodes 1 to 4 are the bottom quad, whose face 3 (node 4 left, 3 right) is the interface, nodes
  !> 5 to 8 the top quad, whose face 1 (node 5 left, 6 right) is the interface. The tangent is exact and unsymmetric.
  pure subroutine stabilised_interface_eight(law, options, thickness, given, stiffness, coordinates, u, dtime, &
    old, new, residual, tangent, energies, status)
    type(law_parameters), intent(in) :: law
    type(interface_options), intent(in) :: options
    real(dp), intent(in) :: thickness               !< out of the plane, length
    type(stabilisation_type), intent(in) :: given   !< beta and gamma, or what they follow from
    real(dp), intent(in) :: stiffness(3, 3, 2)      !< D of bottom and top, stress
    real(dp), intent(in) :: coordinates(2, 8)       !< original coordinates, length
    real(dp), intent(in) :: u(2, 8)                 !< displacements at the end of the increment, length
    real(dp), intent(in) :: dtime                   !< duration of the increment
    type(interface_point), intent(in) :: old(2)     !< committed state
    type(interface_point), intent(out) :: new(2)
    real(dp), intent(out) :: residual(2, 8)         !< force
    real(dp), intent(out) :: tangent(2, 8, 16)      !< -d(residual)/du, force/length
    real(dp), intent(out) :: energies(3)          !< stored T.g/2, dissipated by damage, viscous
    type(status_type), intent(out) :: status
    integer, parameter :: owned(4) = [4, 3, 6, 5]   ! nodes 1 to 4 of the interface
    type(interface_geometry) :: geometry
    type(stabilisation_type) :: used
    real(dp) :: local(2, 2), by_bulk(2, 2), weight, xy(2, 4), u_interface(2, 4), flat(16)
    real(dp) :: bulk(2, 16), stress_part(2, 16, 2), force(2, 2), matrix(2, 2, 2, 2), jump_tangent(2, 4, 2, 4)
    real(dp) :: nodal_force(2, 4)
    integer :: a, b, k

    residual = 0.0_dp
    tangent = 0.0_dp
    energies = 0.0_dp
    call check_law(law, status)
    if (status%code /= ok) return
    do a = 1, 4
      xy(:, a) = coordinates(:, owned(a))
      u_interface(:, a) = u(:, owned(a))
      flat(4*a - 3:4*a) = [u(:, 2*a - 1), u(:, 2*a)]
    end do
    call measure_interface(xy, options%rule, geometry, status)
    if (status%code /= ok) return
    call stabilise(given, stiffness, coordinates, geometry%length, used, status)
    if (status%code /= ok) return
    if (options%consistent_closure) call check_beta(law, used%beta, status)
    if (status%code /= ok) return

    force = 0.0_dp
    matrix = 0.0_dp
    stress_part = 0.0_dp
    weight = 0.5_dp*geometry%length*thickness
    do k = 1, 2
      if (k == 1 .or. options%sampling /= sample_middle) then
        call bulk_traction(options%sampling, geometry, k, used%gamma_bottom, stiffness, coordinates, bulk, status)
        if (status%code /= ok) return
      end if
      call evaluate_point(law, options, geometry, k, used%beta, dtime, &
        separation_at(geometry%frame, geometry%s(k), u_interface), matmul(bulk, flat), old(k), new(k), local, &
        by_bulk)
      call add_point(geometry%frame, geometry%s(k), weight, new(k)%traction, local, force, matrix)
      call add_stress_part(geometry, k, weight, by_bulk, bulk, stress_part)
      energies = energies + point_energies(weight, new(k))
    end do
    call spread_to_nodes(force, matrix, nodal_force, jump_tangent)
    do a = 1, 4
      residual(:, owned(a)) = nodal_force(:, a)
      tangent(:, owned(a), :) = sign_of_node(a)*stress_part(:, :, end_of_node(a))
      do b = 1, 4
        tangent(:, owned(a), 2*owned(b) - 1) = tangent(:, owned(a), 2*owned(b) - 1) + jump_tangent(:, a, 1, b)
        tangent(:, owned(a), 2*owned(b)) = tangent(:, owned(a), 2*owned(b)) + jump_tangent(:, a, 2, b)
      end do
    end do
  end subroutine stabilised_interface_eight

  !> Beta and gamma of the eight-node variant.
  pure subroutine stabilise(given, stiffness, coordinates, length, used, status)
    type(stabilisation_type), intent(in) :: given
    real(dp), intent(in) :: stiffness(3, 3, 2), coordinates(2, 8)
    real(dp), intent(in) :: length              !< meas(Gamma)
    type(stabilisation_type), intent(out) :: used
    type(status_type), intent(out) :: status    !< inside_out: item 1 for the bottom quad, 2 for the top one
    real(dp) :: areas(2), norms(2), lambda(2)
    integer :: side

    used = given
    areas = [quad4_area(coordinates(:, 1:4)), quad4_area(coordinates(:, 5:8))]
    if (.not. minval(areas) > 0.0_dp) then
      status = status_type(inside_out, minloc(areas, 1), minval(areas), 0.0_dp)
      return
    end if
    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    if (minval(given%beta) < 0.0_dp) then
      do side = 1, 2
        call quad4_face_eigenvalue(coordinates(:, 4*side - 3:4*side), faces(side), stiffness(:, :, side), &
          lambda(side), status)
        if (status%code /= ok) then
          status%item = side
          return
        end if
      end do
      ! lambda takes the place of |D| meas(Gamma)/meas(Omega)
      used = weigh_sides(given, lambda, [length, length], length)
    else
      norms = [spectral_norm(stiffness(:, :, 1)), spectral_norm(stiffness(:, :, 2))]
      used = weigh_sides(given, norms, areas, length)
    end if
  end subroutine stabilise

  !> Adds the derivative of the force of point k on the two ends of the top edge by the bulk stress.
  pure subroutine add_stress_part(geometry, k, weight, by_bulk, bulk, matrix)
    type(interface_geometry), intent(in) :: geometry
    integer, intent(in) :: k
    real(dp), intent(in) :: weight
    real(dp), intent(in) :: by_bulk(2, 2)             !< derivative of T by <sigma>.n, (tau, n)
    real(dp), intent(in) :: bulk(2, 16)               !< derivative of <sigma>.n, (tau, n), by the displacements
    real(dp), intent(inout) :: matrix(2, 16, 2)       !< (x and y, displacement, end)
    real(dp) :: shape(2), row(16), part(2, 2)
    integer :: i, j

    shape = weight*line_shape(geometry%s(k))
    part = matmul(transpose(geometry%frame), by_bulk)
    do i = 1, 2
      row = part(i, 1)*bulk(1, :) + part(i, 2)*bulk(2, :)
      do j = 1, 2
        matrix(i, :, j) = matrix(i, :, j) + shape(j)*row
      end do
    end do
  end subroutine add_stress_part

  !> Traction and state of point k, and the derivatives of T by g and by <sigma>.n.
  pure subroutine evaluate_point(law, options, geometry, k, beta, dtime, separation, bulk, old, new, by_jump, by_bulk)
    type(law_parameters), intent(in) :: law
    type(interface_options), intent(in) :: options
    type(interface_geometry), intent(in) :: geometry
    integer, intent(in) :: k
    real(dp), intent(in) :: beta(2), dtime, separation(2)
    real(dp), intent(in) :: bulk(2)                 !< <sigma>.n in (tau, n)
    type(interface_point), intent(in) :: old
    type(interface_point), intent(out) :: new
    real(dp), intent(out) :: by_jump(2, 2)          !< at constant bulk stress
    real(dp), intent(out) :: by_bulk(2, 2)
    type(damage_state) :: state
    type(closure_state) :: closure
    real(dp) :: traction(2), s_of_point(2)

    if (options%consistent_closure) then
      call close_consistently(law, beta, bulk + beta*separation, dtime, options%secant_share, old%history, closure)
      by_bulk = closure%by_trial
      by_jump(:, 1) = beta(1)*by_bulk(:, 1)
      by_jump(:, 2) = beta(2)*by_bulk(:, 2)
      call close_consistent_point(law, geometry, geometry%s(k), old, separation, closure, new)
    else
      call evolve_damage(law, old%history, separation, dtime, state)
      state%slope = (1.0_dp - options%secant_share)*state%slope
      call stabilised_traction(stiffness_of(law), beta, separation, bulk, state%acting, state%slope, traction, &
        s_of_point, by_jump)
      by_bulk = reshape([1.0_dp - s_of_point(1), 0.0_dp, 0.0_dp, 1.0_dp - s_of_point(2)], [2, 2])
      call close_point(law, geometry, geometry%s(k), old, separation, state, traction, s_of_point, new)
    end if
  end subroutine evaluate_point

  !> Matrix that takes the 16 displacements to <sigma>.n in (tau, n) at point k.
  pure subroutine bulk_traction(sampling, geometry, k, gamma_bottom, stiffness, coordinates, matrix, status)
    integer, intent(in) :: sampling
    type(interface_geometry), intent(in) :: geometry
    integer, intent(in) :: k
    real(dp), intent(in) :: gamma_bottom, stiffness(3, 3, 2), coordinates(2, 8)
    real(dp), intent(out) :: matrix(2, 16)
    type(status_type), intent(out) :: status      !< inside_out: item 1 for the bottom quad, 2 for the top one
    real(dp) :: gradient(2, 4), jacobian, by_strain(2, 3), weights(2), t
    integer :: side, a, column

    weights = [gamma_bottom, 1.0_dp - gamma_bottom]
    do side = 1, 2
      ! face 3 of the bottom quad runs against tau
      t = geometry%s(k)
      if (side == 1) t = -t
      call quad_gradient(coordinates(:, 4*side - 3:4*side), sampling_point(faces(side), t, sampling), gradient, &
        jacobian)
      if (.not. jacobian > 0.0_dp) then
        status = status_type(inside_out, side, jacobian, 0.0_dp)
        return
      end if
      by_strain = weights(side)*matmul(traction_operator(geometry%frame), stiffness(:, :, side))
      do a = 1, 4
        column = 8*side - 8 + 2*a
        matrix(:, column - 1) = by_strain(:, 1)*gradient(1, a) + by_strain(:, 3)*gradient(2, a)
        matrix(:, column) = by_strain(:, 2)*gradient(2, a) + by_strain(:, 3)*gradient(1, a)
      end do
    end do
  end subroutine bulk_traction

  !> Parent coordinates of the point of a quad where its stress is taken for the place t of its face.
  pure function sampling_point(face, t, sampling) result(point)
    integer, intent(in) :: face
    real(dp), intent(in) :: t
    integer, intent(in) :: sampling
    real(dp) :: point(2)

    select case (sampling)
    case (sample_face)
      point = face_point(face, t)
    case (sample_gauss)
      point = quad_points(:, gauss_of_face(merge(1, 2, t < 0.0_dp), face))
    case default
      point = face_point(face, 0.0_dp)
    end select
  end function sampling_point

end module elements_stabilised_interface
