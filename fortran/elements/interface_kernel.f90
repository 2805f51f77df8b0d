! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Every interface element: a sum over points. With the area w of a point, its jump operator N (g = N u) and, in the
!> stabilised element, its bulk-traction operator B (<sigma>.n = B u),
!>
!>     residual = -sum w N^T T,    tangent = -d(residual)/du = sum w N^T X,    X = dT/dg N + dT/d(<sigma>.n) B,
!>
!> in the components (s, n, t) of `cohesive_shear`, in the plane (tau, n). The elements differ in their points, N and B: (14) and
!> (15) without B, (16) to (22) with it. The complete form of the stabilised element also has the virtual work of the gap
!> e = (T - <sigma>.n)/beta, by which the jump is more than the separation of the law, on the stress of the solids:
!>
!>     residual = -sum w (N^T T + B^T e),    tangent = sum w (N^T X + B^T beta^-1 (X - B)),
!>
!> the derivatives of an energy (`point_energies`), so that no work is gained or lost and the tangent is symmetric where dT/dp is.
module elements_interface_kernel
  use core_kinds, only: dp
  use core_rotation, only: about_mean
  use core_small_matrix, only: add_combination, add_product
  use core_status, only: status_type, ok
  use cohesive_parameters, only: law_parameters
  use cohesive_law, only: check_law, check_beta, raise_beta
  use cohesive_rate, only: begin_rate, suit_steepest_rate
  use cohesive_temperature, only: suit_steepest_temperature
  use elements_bulk_solid, only: solid_type
  use elements_interface_bulk, only: stabilisation_type, stabilise, bulk_operators
  use cohesive_shear, only: mode_of
  use elements_interface_faces, only: interface_place, measure_interface, jump_operator, separation_at
  use elements_interface_point, only: interface_options, interface_point, point_response, standard_point, &
    stabilised_point, point_energies
  use elements_interface_layer, only: measure_layer, layer_operator, layer_separation
  use elements_interface_rotation, only: turn_place, co_rotated, by_displacements, add_turning, turn_faces, co_rotated_solids, &
    solids_by_displacements, add_turning_of_solids
  implicit none(type, external)
  private
  public :: integrate_interface, interface_forces

  real(dp), parameter :: identity(3, 3) = reshape([1.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 1.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 1.0_dp], [3, 3])

contains

  !> Residual (external minus internal force), tangent and state at the end of the increment.
  !>
  !> Without stabilisation it is the standard element. The stabilised one takes the bulk stress from its own solids or from its
  !> neighbours. In the latter case its tangent holds the bulk stress constant, since the
  !> derivative of that stress involves nodes that the element does not own.
  pure subroutine integrate_interface(dim, points, faces, law, options, thickness, coordinates, u, dtime, with_tangent, &
    old, new, residual, tangent, energies, status, stabilisation, solids, neighbours)
    integer, intent(in) :: dim                                !< 2 or 3
    integer, intent(in) :: points                             !< integration points
    integer, intent(in) :: faces(:, :)                        !< nodes of the bottom and the top face, a column each
    type(law_parameters), intent(in) :: law
    type(interface_options), intent(in) :: options
    real(dp), intent(in) :: thickness                         !< out of the plane, length; 1 in space
    real(dp), intent(in) :: u(:)                              !< displacements at the end of the increment, length
    real(dp), intent(in) :: coordinates(dim, size(u)/dim)     !< original coordinates, length
    real(dp), intent(in) :: dtime                             !< duration of the increment
    logical, intent(in) :: with_tangent
    type(interface_point), intent(in) :: old(points)    !< committed state
    type(interface_point), intent(out) :: new(points)
    real(dp), intent(out) :: residual(size(u))                !< force
    real(dp), intent(inout) :: tangent(size(u), size(u))      !< to which -d(residual)/du, force/length, is added if wanted
    real(dp), intent(out) :: energies(3)                      !< stored, dissipated by damage and friction, viscous
    type(status_type), intent(out) :: status                  !< its item is the point, the mode or the side
    type(stabilisation_type), intent(inout), optional :: stabilisation   !< beta and gamma, or what they follow from; on exit those
                                                                         !< that act
    type(solid_type), intent(in), optional :: solids(2)          !< its own, bottom and top, in the order of its nodes
    real(dp), intent(in), optional :: neighbours(3, 3, points)   !< weighted nominal stress of each point: its product with the
                                                                 !< original normal is the traction per original area
    type(interface_place) :: places(points)
    type(stabilisation_type) :: used
    type(point_response) :: response
    type(interface_place) :: here, turned(2)
    type(law_parameters) :: of_point
    ! operators by the displacements are transposed, (unknowns, components), so that loops over unknowns are along the memory
    real(dp), dimension(size(u), dim, points) :: jumps, bulks, changes, changes_of_gap
    real(dp) :: at_rest(dim, points)
    real(dp), dimension(size(u), dim) :: jump
    real(dp), dimension(size(u)) :: moved, original, shifted, force
    real(dp) :: turning(3, dim, dim, size(faces, 1)), turning_faces(3, dim, dim, size(faces, 1), 2)
    real(dp) :: bulk_traction(3), gap(3), separation(3), directions(3, 3), area
    logical :: layer, opposite
    integer :: i, k, nodes, split

    residual = 0.0_dp
    energies = 0.0_dp
    bulk_traction = 0.0_dp
    call check_law(law, status)
    if (status%code /= ok) return
    nodes = size(faces, 1)
    call measure_faces(dim, nodes, points, faces, options, coordinates, places, layer, status)
    if (status%code /= ok) return
    opposite = .not. (options%finite .or. layer)
    if (.not. opposite) original = about_mean(dim, reshape(coordinates, [size(u)]))
    if (options%finite) shifted = about_mean(dim, reshape(coordinates, [size(u)]) + u)
    split = 0
    if (present(solids)) split = dim*solids(1)%nodes
    if (present(stabilisation)) then
      if (present(solids) .and. .not. stabilisation%known) then
        call stabilise(stabilisation, options%sampling, options%rule, dim, solids, points, faces, options%direction, coordinates, &
          used, status)
        if (status%code /= ok) return
        stabilisation = used
      end if
      if (options%consistent_law .and. .not. options%cracked .and. .not. stabilisation%known) then
        call suit_law(law, stabilisation, status)
      end if
      if (status%code /= ok) return
      if (present(solids)) then
        call bulk_operators(options%sampling, dim, places, stabilisation%gamma_bottom, solids, faces, &
          options%initial, coordinates, bulks, at_rest, status)
        if (status%code /= ok) return
      end if
    end if

    of_point = law
    moved = u
    directions = identity
    do k = 1, points
      call begin_rate(of_point, old(k)%history%separation, dtime)
      new(k)%position = places(k)%position
      if (options%finite) then
        here = places(k)
        call turn_place(dim, nodes, faces, original, shifted, here, turning, status)
        if (status%code /= ok) return
        moved = co_rotated(dim, places(k)%frame, here%frame, original, shifted)
      end if
      separation = separation_at(dim, places(k), nodes, faces, moved)
      jump = jump_operator(dim, places(k), nodes, faces, size(u))
      if (layer .and. .not. options%finite) then
        call layer_operator(dim, nodes, faces, original, places(k), jump, jumps(:, :, k), status)
        if (status%code /= ok) return
        separation = layer_separation(dim, places(k), nodes, faces, u, jump, jumps(:, :, k))
        jump = jumps(:, :, k)
      end if
      gap = 0.0_dp
      if (present(stabilisation)) then
        if (present(solids)) then
          if (options%finite) then
            call turn_faces(dim, nodes, faces, original, shifted, places(k), turned, turning_faces, status)
            if (status%code /= ok) return
            moved = co_rotated_solids(dim, split, places(k)%frame, turned, original, shifted)
          end if
          do i = 1, dim
            bulk_traction(i) = dot_product(moved, bulks(:, i, k)) + at_rest(i, k)
          end do
        else
          bulk_traction = matmul(neighbours(:, :, k), places(k)%frame(2, :))
          if (options%finite) then
            bulk_traction = matmul(here%frame, bulk_traction)
          else
            bulk_traction = matmul(places(k)%frame, bulk_traction)
          end if
        end if
        call stabilised_point(of_point, options, dtime, stabilisation%beta, separation, bulk_traction, old(k), new(k), response, &
          status)
        if (status%code /= ok) then
          status%item = k
          return
        end if
        if (options%complete) gap = (new(k)%traction - bulk_traction)/stabilisation%beta(mode_of)
      else
        call standard_point(of_point, options, dtime, separation, old(k), new(k), response)
      end if
      area = places(k)%area*thickness
      energies = energies + point_energies(area, new(k))
      if (options%finite) then
        force = matmul(jump, new(k)%traction(1:dim))
        jump = by_displacements(dim, nodes, faces, places(k)%frame, here%frame, turning, shifted, jump)
        if (with_tangent) call add_turning(area, dim, nodes, faces, places(k), here, turning, original, shifted, force, tangent)
        if (present(solids)) then
          force = matmul(bulks(:, :, k), gap(1:dim))
          bulks(:, :, k) = solids_by_displacements(dim, nodes, faces, split, places(k)%frame, turned, turning_faces, shifted, &
            bulks(:, :, k))
          if (with_tangent .and. options%complete) call add_turning_of_solids(area, dim, nodes, faces, split, places(k), turned, &
            turning_faces, original, shifted, force, tangent)
        end if
      end if
      call add_combination(size(u), dim, jump, -area*new(k)%traction, residual)
      if (options%complete) call add_combination(size(u), dim, bulks(:, :, k), -area*gap, residual)
      if (.not. with_tangent) cycle
      jumps(:, :, k) = jump
      if (opposite) directions = transpose(places(k)%frame)
      changes(:, :, k) = 0.0_dp
      call add_response(matmul(directions, area*response%by_jump), matmul(directions, area*response%by_bulk), changes(:, :, k))
      if (.not. options%complete) cycle
      do i = 1, 3
        response%by_jump(i, :) = (area/stabilisation%beta(mode_of(i)))*response%by_jump(i, :)
        response%by_bulk(i, :) = (area/stabilisation%beta(mode_of(i)))*(response%by_bulk(i, :) - identity(i, :))
      end do
      changes_of_gap(:, :, k) = 0.0_dp
      call add_response(response%by_jump, response%by_bulk, changes_of_gap(:, :, k))
    end do
    if (.not. with_tangent) return
    if (opposite) then
      call add_opposite_forces(dim, nodes, points, faces, size(u), places, changes, tangent)
    else
      call add_product(size(u), size(u), dim*points, jumps, changes, tangent)
    end if
    if (options%complete) call add_product(size(u), size(u), dim*points, bulks, changes_of_gap, tangent)

  contains

    !> Adds what changes of the jump and the bulk traction of point k make of a vector there, by the displacements.
    pure subroutine add_response(by_jump, by_bulk, change)
      real(dp), intent(in) :: by_jump(3, 3), by_bulk(3, 3)
      real(dp), intent(inout) :: change(size(u), dim)

      call add_product(size(u), dim, dim, jumps(:, :, k), by_jump(1:dim, 1:dim), change)
      if (present(solids)) call add_product(size(u), dim, dim, bulks(:, :, k), by_bulk(1:dim, 1:dim), change)
    end subroutine add_response

  end subroutine integrate_interface

  !> Residual of tractions that are known, such as those at the start of an increment, at the displacements that they belong to.
  pure subroutine interface_forces(dim, points, faces, options, thickness, coordinates, u, known, residual, status, &
    stabilisation, solids)
    integer, intent(in) :: dim                                !< 2 or 3
    integer, intent(in) :: points                             !< integration points
    integer, intent(in) :: faces(:, :)                        !< nodes of the bottom and the top face, a column each
    type(interface_options), intent(in) :: options
    real(dp), intent(in) :: thickness                         !< out of the plane, length; 1 in space
    real(dp), intent(in) :: u(:)                              !< displacements, length
    real(dp), intent(in) :: coordinates(dim, size(u)/dim)     !< original coordinates, length
    type(interface_point), intent(in) :: known(points)        !< their tractions count
    real(dp), intent(out) :: residual(size(u))                !< force
    type(status_type), intent(out) :: status
    type(stabilisation_type), intent(in), optional :: stabilisation   !< of the complete form: beta and gamma that acted
    type(solid_type), intent(in), optional :: solids(2)               !< of the complete form: its own, bottom and top
    type(interface_place) :: places(points), here, turned(2)
    real(dp) :: turning(3, dim, dim, size(faces, 1)), turning_faces(3, dim, dim, size(faces, 1), 2), gap(3), area
    real(dp), dimension(size(u)) :: original, shifted, moved
    real(dp) :: bulks(size(u), dim, points), at_rest(dim, points)
    real(dp), dimension(size(u), dim) :: jump, bulk
    logical :: layer
    integer :: k, nodes

    residual = 0.0_dp
    nodes = size(faces, 1)
    call measure_faces(dim, nodes, points, faces, options, coordinates, places, layer, status)
    if (status%code /= ok) return
    original = about_mean(dim, reshape(coordinates, [size(u)]))
    shifted = about_mean(dim, reshape(coordinates, [size(u)]) + u)
    if (options%complete) then
      call bulk_operators(options%sampling, dim, places, stabilisation%gamma_bottom, solids, faces, options%initial, &
        coordinates, bulks, at_rest, status)
      if (status%code /= ok) return
    end if
    do k = 1, points
      here = places(k)
      moved = u
      if (options%finite) then
        call turn_place(dim, nodes, faces, original, shifted, here, turning, status)
        if (status%code /= ok) return
      end if
      area = places(k)%area*thickness
      jump = jump_operator(dim, places(k), nodes, faces, size(u))
      if (options%finite) then
        jump = by_displacements(dim, nodes, faces, places(k)%frame, here%frame, turning, shifted, jump)
      else if (layer) then
        call layer_operator(dim, nodes, faces, original, places(k), jump, bulk, status)
        if (status%code /= ok) return
        jump = bulk
      end if
      call add_combination(size(u), dim, jump, -area*known(k)%traction, residual)
      if (.not. options%complete) cycle
      bulk = bulks(:, :, k)
      if (options%finite) then
        call turn_faces(dim, nodes, faces, original, shifted, places(k), turned, turning_faces, status)
        if (status%code /= ok) return
        moved = co_rotated_solids(dim, dim*solids(1)%nodes, places(k)%frame, turned, original, shifted)
      end if
      gap(1:dim) = (known(k)%traction(1:dim) - matmul(moved, bulk) - at_rest(:, k))/stabilisation%beta(mode_of(1:dim))
      if (options%finite) bulk = solids_by_displacements(dim, nodes, faces, dim*solids(1)%nodes, places(k)%frame, turned, &
        turning_faces, shifted, bulk)
      call add_combination(size(u), dim, bulk, -area*gap, residual)
    end do
  end subroutine interface_forces

  !> Integration points between two faces that coincide or, of standard elements, may be a layer apart.
  pure subroutine measure_faces(dim, nodes, points, faces, options, coordinates, places, layer, status)
    integer, intent(in) :: dim, nodes, points, faces(nodes, 2)
    type(interface_options), intent(in) :: options
    real(dp), intent(in) :: coordinates(:, :)           !< original ones of the element
    type(interface_place), intent(out) :: places(points)
    logical, intent(out) :: layer                       !< their coordinates are not the same
    type(status_type), intent(out) :: status            !< of `measure_layer` or `measure_interface`
    real(dp), dimension(dim, nodes) :: bottom, top

    bottom = coordinates(:, faces(:, 1))
    top = coordinates(:, faces(:, 2))
    layer = options%standard .and. any(abs(top - bottom) > 0.0_dp)
    if (layer) then
      call measure_layer(dim, nodes, points, bottom, top, options%rule, places, status)
    else
      call measure_interface(dim, nodes, points, bottom, top, options%rule, options%direction, places, status)
    end if
  end subroutine measure_faces

  !> Raises an estimate of beta to what the consistent law needs; a beta of the deck has to suffice.
  pure subroutine suit_law(law, stabilisation, status)
    type(law_parameters), intent(in) :: law
    type(stabilisation_type), intent(inout) :: stabilisation
    type(status_type), intent(out) :: status    !< small_beta
    type(law_parameters) :: steepest
    real(dp) :: beta(2)

    ! beta stays, temperatures and rates do not
    steepest = law
    call suit_steepest_temperature(steepest)
    call suit_steepest_rate(steepest)
    call check_beta(steepest, stabilisation%beta, status)
    if (status%code == ok .or. all(stabilisation%given)) return
    beta = stabilisation%beta
    call raise_beta(steepest, .not. stabilisation%given, stabilisation%beta)
    where (stabilisation%beta > beta) stabilisation%estimate = beta
    call check_beta(steepest, stabilisation%beta, status)
  end subroutine suit_law

  !> Adds the change of the nodal forces to a matrix where they are the tractions times the shape functions, opposite on both faces.
  pure subroutine add_opposite_forces(dim, nodes, points, faces, n, places, changes, matrix)
    integer, intent(in) :: dim, nodes, points, faces(nodes, 2)
    integer, intent(in) :: n                               !< unknowns
    type(interface_place), intent(in) :: places(points)
    real(dp), intent(in) :: changes(n, dim, points)        !< of the force at each point, along global axes
    real(dp), intent(inout) :: matrix(n, n)
    real(dp) :: shapes(nodes, points), on_nodes(n, dim, nodes)
    integer :: a, i, k, bottom, top

    do k = 1, points
      shapes(:, k) = places(k)%shape(1:nodes)
    end do
    on_nodes = 0.0_dp
    call add_product(n*dim, nodes, points, changes, shapes, on_nodes)
    do a = 1, nodes
      do i = 1, dim
        bottom = dim*(faces(a, 1) - 1) + i
        top = dim*(faces(a, 2) - 1) + i
        matrix(bottom, :) = matrix(bottom, :) - on_nodes(:, i, a)
        matrix(top, :) = matrix(top, :) + on_nodes(:, i, a)
      end do
    end do
  end subroutine add_opposite_forces

end module elements_interface_kernel
