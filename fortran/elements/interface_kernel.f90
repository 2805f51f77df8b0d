! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Every interface element: a sum over points. With the area w of a point, its jump operator N (g = N u) and, in the
!> stabilised element, its bulk-traction operator B (<sigma>.n = B u),
!>
!>     residual = -sum w N^T T,    tangent = -d(residual)/du = sum w N^T (dT/dg N + dT/d(<sigma>.n) B),
!>
!> in the components (s, n, t) of `cohesive_shear`, in the plane (tau, n). The elements differ in their points, N and B: (14) and
!> (15) without B, (16) to (22) with it.
module elements_interface_kernel
  use core_kinds, only: dp
  use core_rotation, only: traction_operator
  use core_status, only: status_type, ok
  use cohesive_parameters, only: law_parameters
  use cohesive_law, only: check_law, check_beta
  use elements_interface_bulk, only: stabilisation_type, stabilise, bulk_operator
  use elements_interface_faces, only: interface_place, measure_interface, turn_place, jump_operator, separation_at, face_shape
  use elements_interface_point, only: interface_options, interface_point, point_response, standard_point, &
    stabilised_point, point_energies
  implicit none(type, external)
  private
  public :: integrate_interface

contains

  !> Residual (external minus internal force), tangent and state at the end of the increment.
  !>
  !> Without stabilisation it is the standard element. The stabilised one takes the bulk stress from its own quads or bricks, whose
  !> stiffness it receives, or from its neighbours. In the latter case its tangent holds the bulk stress constant, since the
  !> derivative of that stress involves nodes that the element does not own.
  !>
  !> With large rotations the frame of a point goes with the mid-surface, which turns by Q. Everything acts on the displacements less
  !> this rotation, transpose(Q) x - X, with the operators of the original configuration; the nodal forces of the point turn with
  !> Q. The strain of the bulk is small: P N = Q sigma N to its first order.
  pure subroutine integrate_interface(dim, points, faces, solid, law, options, thickness, coordinates, u, dtime, with_tangent, &
    old, new, residual, tangent, energies, status, stabilisation, stiffness, neighbours)
    integer, intent(in) :: dim                                !< 2 or 3
    integer, intent(in) :: points                             !< integration points, and nodes of a face
    integer, intent(in) :: faces(points, 2)                   !< nodes of the bottom and the top face
    integer, intent(in) :: solid                              !< nodes of each of its own elements, the bottom one first; 0 without
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
    real(dp), intent(out) :: tangent(size(u), size(u))        !< -d(residual)/du, force/length; zero if not wanted
    real(dp), intent(out) :: energies(3)                      !< stored, dissipated by damage and friction, viscous
    type(status_type), intent(out) :: status                  !< its item is the point, the mode or the side
    type(stabilisation_type), intent(in), optional :: stabilisation    !< beta and gamma, or what they follow from
    real(dp), intent(in), optional :: stiffness(:, :, :)         !< D of the bottom and the top element, global axes, stress
    real(dp), intent(in), optional :: neighbours(3, points)      !< weighted (s11, s22, s12) of each point
    type(interface_place) :: places(points)
    type(stabilisation_type) :: used
    type(point_response) :: response
    real(dp) :: jump(dim, size(u)), bulk(dim, size(u)), by_displacement(dim, size(u)), bulk_traction(3), separation(3), area
    real(dp) :: turning(3, dim, dim, points), moved(size(u)), original(size(u)), shifted(size(u))
    type(interface_place) :: here
    integer :: k

    residual = 0.0_dp
    tangent = 0.0_dp
    energies = 0.0_dp
    bulk_traction = 0.0_dp
    if (options%finite) then
      original = about_mean(dim, reshape(coordinates, [size(u)]))
      shifted = about_mean(dim, reshape(coordinates, [size(u)]) + u)
    end if
    call check_law(law, status)
    if (status%code /= ok) return
    call measure_interface(dim, points, coordinates(:, faces(:, 1)), coordinates(:, faces(:, 2)), options%rule, places, &
      status)
    if (status%code /= ok) return
    if (present(stabilisation)) then
      used = stabilisation
      if (present(stiffness)) call stabilise(stabilisation, dim, solid, points, faces, coordinates, &
        stiffness, used, status)
      if (status%code /= ok) return
      if (options%consistent_law) call check_beta(law, used%beta, status)
      if (status%code /= ok) return
    end if

    do k = 1, points
      new(k)%position = places(k)%position
      here = places(k)
      moved = u
      if (options%finite) then
        call turn_place(dim, points, middle_of(dim, points, faces, original), middle_of(dim, points, faces, shifted), here, &
          turning, status)
        if (status%code /= ok) return
        moved = co_rotated(dim, places(k)%frame, here%frame, original, shifted)
      end if
      separation = separation_at(dim, places(k), points, faces, moved)
      if (present(stabilisation)) then
        if (present(stiffness)) then
          call bulk_operator(options%sampling, dim, places(k), used%gamma_bottom, solid, stiffness, coordinates, bulk, &
            status)
          if (status%code /= ok) return
          bulk_traction(1:dim) = matmul(bulk, moved)
        else
          bulk_traction(1:dim) = matmul(traction_operator(dim, places(k)%frame), neighbours(:, k))
        end if
        call stabilised_point(law, options, dtime, used%beta, separation, bulk_traction, old(k), new(k), response, status)
        if (status%code /= ok) then
          status%item = k
          return
        end if
      else
        call standard_point(law, options, dtime, separation, old(k), new(k), response)
      end if
      area = places(k)%area*thickness
      energies = energies + point_energies(area, new(k))
      jump = jump_operator(dim, here, points, faces, size(u))
      residual = residual - area*matmul(new(k)%traction(1:dim), jump)
      if (.not. with_tangent) cycle
      if (options%finite) jump = jump_operator(dim, places(k), points, faces, size(u))
      by_displacement = matmul(response%by_jump(1:dim, 1:dim), jump)
      if (present(stiffness)) by_displacement = by_displacement + matmul(response%by_bulk(1:dim, 1:dim), bulk)
      if (options%finite) then
        by_displacement = by_displacements(dim, points, faces, places(k)%frame, here%frame, turning, shifted, by_displacement)
        call add_turning(area, dim, points, faces, face_shape(dim, points, places(k)%parent), new(k)%traction, turning, tangent)
        jump = jump_operator(dim, here, points, faces, size(u))
      end if
      call add_product(area, jump, by_displacement, tangent)
    end do
  end subroutine integrate_interface

  !> Nodes of the mid-line or mid-surface, from coordinates of the element's nodes, one node after the other.
  pure function middle_of(dim, nodes, faces, coordinates) result(middle)
    integer, intent(in) :: dim, nodes, faces(nodes, 2)
    real(dp), intent(in) :: coordinates(:)
    real(dp) :: middle(dim, nodes)
    integer :: a, i

    do a = 1, nodes
      do i = 1, dim
        middle(i, a) = 0.5_dp*(coordinates(dim*(faces(a, 1) - 1) + i) + coordinates(dim*(faces(a, 2) - 1) + i))
      end do
    end do
  end function middle_of

  !> Coordinates about their mean: of two configurations that differ by a translation they are the same.
  pure function about_mean(dim, coordinates) result(centred)
    integer, intent(in) :: dim
    real(dp), intent(in) :: coordinates(:)
    real(dp) :: centred(size(coordinates))
    integer :: i

    do i = 1, dim
      centred(i::dim) = coordinates(i::dim) - dim*sum(coordinates(i::dim))/size(coordinates)
    end do
  end function about_mean

  !> Displacements less the rotation of a point: transpose(Q) x - X, with Q from the original to the present frame.
  pure function co_rotated(dim, frame, turned, original, present) result(u)
    integer, intent(in) :: dim
    real(dp), intent(in) :: frame(3, 3), turned(3, 3)      !< rows of the original and the present frame
    real(dp), intent(in) :: original(:), present(:)        !< coordinates about their means
    real(dp) :: u(size(original))
    real(dp) :: back(dim, dim)
    integer :: a

    back = matmul(transpose(frame(1:dim, 1:dim)), turned(1:dim, 1:dim))
    do a = 0, size(original) - dim, dim
      u(a + 1:a + dim) = matmul(back, present(a + 1:a + dim)) - original(a + 1:a + dim)
    end do
  end function co_rotated

  !> Derivative by the displacements of what a matrix makes of the co-rotated ones. A node of the mid-surface moves by half of what
  !> each of its two nodes does.
  pure function by_displacements(dim, nodes, faces, frame, turned, turning, present, matrix) result(derivative)
    integer, intent(in) :: dim, nodes, faces(nodes, 2)
    real(dp), intent(in) :: frame(3, 3), turned(3, 3)
    real(dp), intent(in) :: turning(3, dim, dim, nodes)    !< row of the present frame, component, direction, node
    real(dp), intent(in) :: present(:)                     !< coordinates about their mean
    real(dp), intent(in) :: matrix(:, :)
    real(dp) :: derivative(size(matrix, 1), size(matrix, 2))
    real(dp) :: back(dim, dim), moved(size(present)), change(size(matrix, 1))
    integer :: a, i, q, side, column

    back = matmul(transpose(frame(1:dim, 1:dim)), turned(1:dim, 1:dim))
    do a = 0, size(present) - dim, dim
      derivative(:, a + 1:a + dim) = matmul(matrix(:, a + 1:a + dim), back)
    end do
    do q = 1, nodes
      do i = 1, dim
        back = matmul(transpose(frame(1:dim, 1:dim)), turning(1:dim, :, i, q))
        do a = 0, size(present) - dim, dim
          moved(a + 1:a + dim) = matmul(back, present(a + 1:a + dim))
        end do
        change = 0.5_dp*matmul(matrix, moved)
        do side = 1, 2
          column = dim*(faces(q, side) - 1) + i
          derivative(:, column) = derivative(:, column) + change
        end do
      end do
    end do
  end function by_displacements

  !> Adds to the tangent how the nodal forces of a point turn with the frame of its traction.
  pure subroutine add_turning(area, dim, nodes, faces, shape, traction, turning, tangent)
    real(dp), intent(in) :: area
    integer, intent(in) :: dim, nodes, faces(nodes, 2)
    real(dp), intent(in) :: shape(nodes), traction(3)
    real(dp), intent(in) :: turning(3, dim, dim, nodes)      !< row of the frame, component, direction, node
    real(dp), intent(inout) :: tangent(:, :)
    real(dp) :: part(dim)
    integer :: q, i, a, side, column, row

    do q = 1, nodes
      do i = 1, dim
        do a = 1, nodes
          part = (0.5_dp*area*shape(a))*matmul(traction, turning(:, :, i, q))
          do side = 1, 2
            column = dim*(faces(q, side) - 1) + i
            row = dim*(faces(a, 1) - 1)
            tangent(row + 1:row + dim, column) = tangent(row + 1:row + dim, column) - part
            row = dim*(faces(a, 2) - 1)
            tangent(row + 1:row + dim, column) = tangent(row + 1:row + dim, column) + part
          end do
        end do
      end do
    end do
  end subroutine add_turning

  !> Adds area N^T x to a matrix.
  pure subroutine add_product(area, jump, x, matrix)
    real(dp), intent(in) :: area
    real(dp), intent(in) :: jump(:, :), x(:, :)     !< (2 or 3, unknowns)
    real(dp), intent(inout) :: matrix(:, :)
    integer :: i, j

    do j = 1, size(x, 2)
      do i = 1, size(x, 1)
        matrix(:, j) = matrix(:, j) + (area*x(i, j))*jump(i, :)
      end do
    end do
  end subroutine add_product

end module elements_interface_kernel
