! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Large rotations of a continuum element. Its middle turns by Q, the rotation of the polar decomposition of the deformation
!> gradient there; strains are those of the displacements less this rotation,
!>
!>     v = transpose(Q) x - X,
!>
!> with the operators of the original configuration, and small. With the forces f on v, their moment m = sum of y_a x f_a about the
!> middle (y = transpose(Q) x) and the stretch U there, the nodal forces are the derivatives of the same energy by x:
!>
!>     Q (f_a - w x grad N_a),    (tr U - U) w = m,
!>
!> since transpose(Q) dQ is the cross product with (tr U - U)^-1 times the sum of grad N_a x transpose(Q) dx_a: U stays symmetric.
!> So the forces are in equilibrium on the deformed element, the matrix of an elastic one is symmetric, and no energy is lost in
!> rotations. (The element-independent co-rotational formulation: C.A. Felippa, B. Haugen, Computer Methods in Applied Mechanics
!> and Engineering 194 (2005) 2285; this is for solids, with the exact derivative.)
module core_solid_rotation
  use core_kinds, only: dp
  use core_rotation, only: about_mean, cross, polar_rotation
  use core_small_matrix, only: invert
  implicit none(type, external)
  private
  public :: solid_turn, find_turn, turn_forces, turn_stiffness

  !> Rotation of an element of up to eight nodes; in the plane the third components are zero.
  type :: solid_turn
    real(dp) :: rotation(3, 3) = 0.0_dp      !< Q
    real(dp) :: inverse(3, 3) = 0.0_dp       !< of tr U - U
    real(dp) :: place(3, 8) = 0.0_dp         !< y, about its mean
    real(dp) :: gradient(3, 8) = 0.0_dp      !< of the shape functions in the middle of the original element
  end type solid_turn

contains

  !> The rotation, and the displacements less it.
  pure subroutine find_turn(dim, nodes, gradient, coordinates, u, turn, moved, good)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: gradient(dim, nodes)     !< of the shape functions in the middle of the original element
    real(dp), intent(in) :: coordinates(dim*nodes), u(dim*nodes)
    type(solid_turn), intent(out) :: turn
    real(dp), intent(out) :: moved(dim*nodes)        !< v
    logical, intent(out) :: good                     !< false where the middle is inside out
    real(dp) :: deformation(3, 3), stretch(3, 3), moment(3, 3), present(3, 8), determinant
    integer :: i

    present = 0.0_dp
    present(:dim, :nodes) = reshape(about_mean(dim, coordinates + u), [dim, nodes])
    turn%gradient(:dim, :nodes) = gradient
    deformation = matmul(present, transpose(turn%gradient))
    if (dim == 2) deformation(3, 3) = 1.0_dp
    moved = 0.0_dp
    call polar_rotation(deformation, turn%rotation, good)
    if (.not. good) return
    turn%place = matmul(transpose(turn%rotation), present)
    moved = reshape(turn%place(:dim, :nodes), [dim*nodes]) - about_mean(dim, coordinates)
    stretch = matmul(transpose(turn%rotation), deformation)
    moment = -stretch
    do i = 1, 3
      moment(i, i) = moment(i, i) + stretch(1, 1) + stretch(2, 2) + stretch(3, 3)
    end do
    call invert(3, moment, turn%inverse, determinant)
  end subroutine find_turn

  !> Nodal forces from those on v.
  pure function turn_forces(dim, nodes, turn, force) result(turned)
    integer, intent(in) :: dim, nodes
    type(solid_turn), intent(in) :: turn
    real(dp), intent(in) :: force(dim*nodes)
    real(dp) :: turned(dim*nodes)
    real(dp) :: local(3, nodes), full(3, nodes)

    full = in_space(dim, nodes, force)
    local = matmul(turn%rotation, less_moment(nodes, turn, full, spin_of(nodes, turn, full)))
    turned = reshape(local(:dim, :), [dim*nodes])
  end function turn_forces

  !> Their derivative by the displacements.
  pure function turn_stiffness(dim, nodes, turn, force, stiffness) result(turned)
    integer, intent(in) :: dim, nodes
    type(solid_turn), intent(in) :: turn
    real(dp), intent(in) :: force(dim*nodes), stiffness(dim*nodes, dim*nodes)   !< on v, and its derivative by v
    real(dp) :: turned(dim*nodes, dim*nodes)
    real(dp), dimension(dim*nodes, dim*nodes) :: moves, changes
    real(dp), dimension(3, nodes) :: full, nodal, move, change, column
    real(dp) :: turns(3, dim*nodes), w(3), stretch(3, 3), moment(3)
    integer :: a, i, k

    full = in_space(dim, nodes, force)
    w = spin_of(nodes, turn, full)
    nodal = less_moment(nodes, turn, full, w)
    do a = 1, nodes
      do i = 1, dim
        ! columns belong to displacements along the axes that Q turns
        k = dim*(a - 1) + i
        turns(:, k) = matmul(turn%inverse, cross(turn%gradient(:, a), axis(i)))
        move = -crossed(nodes, turns(:, k), turn%place)
        move(i, a) = move(i, a) + 1.0_dp
        moves(:, k) = reshape(move(:dim, :), [dim*nodes])
      end do
    end do
    changes = matmul(stiffness, moves)
    do k = 1, dim*nodes
      move = in_space(dim, nodes, moves(:, k))
      change = in_space(dim, nodes, changes(:, k))
      moment = 0.0_dp
      do a = 1, nodes
        moment = moment + cross(move(:, a), full(:, a)) + cross(turn%place(:, a), change(:, a))
      end do
      stretch = matmul(move, transpose(turn%gradient(:, :nodes)))
      moment = moment - (stretch(1, 1) + stretch(2, 2) + stretch(3, 3))*w + 0.5_dp*matmul(stretch + transpose(stretch), w)
      column = crossed(nodes, turns(:, k), nodal) + less_moment(nodes, turn, change, matmul(turn%inverse, moment))
      column = matmul(turn%rotation, column)
      turned(:, k) = reshape(column(:dim, :), [dim*nodes])
    end do
    do a = 0, dim*(nodes - 1), dim
      turned(:, a + 1:a + dim) = matmul(turned(:, a + 1:a + dim), transpose(turn%rotation(:dim, :dim)))
    end do
  end function turn_stiffness

  !> w of the header.
  pure function spin_of(nodes, turn, force) result(w)
    integer, intent(in) :: nodes
    type(solid_turn), intent(in) :: turn
    real(dp), intent(in) :: force(3, nodes)
    real(dp) :: w(3)
    real(dp) :: moment(3)
    integer :: a

    moment = 0.0_dp
    do a = 1, nodes
      moment = moment + cross(turn%place(:, a), force(:, a))
    end do
    w = matmul(turn%inverse, moment)
  end function spin_of

  !> f_a - w x grad N_a.
  pure function less_moment(nodes, turn, force, w) result(rest)
    integer, intent(in) :: nodes
    type(solid_turn), intent(in) :: turn
    real(dp), intent(in) :: force(3, nodes), w(3)
    real(dp) :: rest(3, nodes)

    rest = force - crossed(nodes, w, turn%gradient)
  end function less_moment

  !> w x vector of each node.
  pure function crossed(nodes, w, vectors) result(products)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: w(3), vectors(3, nodes)
    real(dp) :: products(3, nodes)
    integer :: a

    do a = 1, nodes
      products(:, a) = cross(w, vectors(:, a))
    end do
  end function crossed

  !> Values of the unknowns of the nodes as vectors in space.
  pure function in_space(dim, nodes, values) result(vectors)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: values(dim*nodes)
    real(dp) :: vectors(3, nodes)

    vectors = 0.0_dp
    vectors(:dim, :) = reshape(values, [dim, nodes])
  end function in_space

  !> Unit vector.
  pure function axis(i) result(unit)
    integer, intent(in) :: i
    real(dp) :: unit(3)

    unit = 0.0_dp
    unit(i) = 1.0_dp
  end function axis

end module core_solid_rotation
