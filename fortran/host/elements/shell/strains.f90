! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Strains of shells of three, four and eight nodes, by the displacements of the nodes and what their directors change by.
!>
!> The shell is x(r,s) + z v(r,s): the surface between the nodes, and the director between those of the nodes. A point moves by
!> u + z w, in conventional shells with w = rotation x director, and its strains, linear in z, are
!>
!>     e = sym(x,a . u,b),    k = sym(x,a . w,b + v,a . u,b),    shear = x,a . w + v . u,a
!>
!> along the axes e1, e2 of the tangent plane at the point. They vanish in rigid-body motions, whatever the directors. The shear is
!> that of MITC4 (E.N. Dvorkin, K.-J. Bathe, Engineering Computations 1 (1984) 77) and MITC3 (P.-S. Lee, K.-J. Bathe, Computers
!> and Structures 82 (2004) 945), which take it from the middles of the edges; that of eight nodes, which is integrated at 2 x 2
!> points, is what the displacements give there (O.C. Zienkiewicz, R.L. Taylor, J.M. Too, Int. J. for Numerical Methods in
!> Engineering 3 (1971) 275).
!>
!> The membrane strain of four nodes bends in its plane as J.C. Simo and M.S. Rifai's element with four enhanced modes does (Int. J.
!> for Numerical Methods in Engineering 29 (1990) 1595). The modes are those of the elastic section: of an elastic shell the two are
!> the same, and of any other the strains stay linear in the displacements, pass the patch test and need no unknowns.
module host_shell_strains
  use core_rotation, only: cross
  use core_serendipity, only: quad_places, serendipity_functions
  use core_small_matrix, only: invert, invert_general
  use host_kinds, only: dp
  implicit none (type, external)
  private
  public :: shell_point, shell_middle, shell_place, shell_strains, assumed_shear, by_rotations, drilling_strain, enhance
  public :: tensor_turn

  !> A point of the surface.
  type :: shell_point
    real(dp) :: n(8) = 0            !< shape functions
    real(dp) :: place(3) = 0
    real(dp) :: frame(3, 3) = 0     !< rows: e1, e2 and the normal
    real(dp) :: gradient(8, 2) = 0  !< of the shape functions along e1 and e2
    real(dp) :: jacobian(2, 2) = 0  !< component i of the tangent a: (a, i)
    real(dp) :: parent(2) = 0
    real(dp) :: weight = 0          !< area
    logical :: good = .false.       !< false where there is no area
  end type shell_point

contains

  !> Shape functions and their derivatives by the parent coordinates.
  pure subroutine interpolate(nodes, parent, n, dn)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: parent(2)
    real(dp), intent(out) :: n(nodes), dn(nodes, 2)
    if (nodes == 3) then
      n = [1 - sum(parent), parent]
      dn = reshape([-1, 1, 0, -1, 0, 1], [3, 2])
    else
      call serendipity_functions(2, nodes, quad_places(:, :nodes), parent, n, dn)
    end if
  end subroutine interpolate

  !> The middle of the surface.
  pure function shell_middle(nodes, x) result(point)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(3, nodes)
    type(shell_point) :: point
    point = shell_place(nodes, x, middle_of(nodes), 0.0_dp)
  end function shell_middle

  !> Its parent coordinates.
  pure function middle_of(nodes) result(parent)
    integer, intent(in) :: nodes
    real(dp) :: parent(2)
    parent = merge([1.0_dp, 1.0_dp]/3, [0.0_dp, 0.0_dp], nodes == 3)
  end function middle_of

  !> A point by its parent coordinates; weight: of the parent area. Its axes are those of the middle, where e1 is along the first
  !> parent coordinate, turned by the smallest rotation that takes the normal there to the one here: so the response depends neither
  !> on the global axes nor on the node that comes first.
  pure function shell_place(nodes, x, parent, weight) result(point)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(3, nodes), parent(2), weight
    type(shell_point) :: point
    real(dp) :: n(nodes), dn(nodes, 2), along(3, 2), middle(3), normal(3), first(3), area, inverse(2, 2), determinant
    call interpolate(nodes, middle_of(nodes), n, dn)
    along = matmul(x, dn)
    middle = along(:, 1)
    normal = cross(along(:, 1), along(:, 2))
    call interpolate(nodes, parent, n, dn)
    along = matmul(x, dn)
    point%n(:nodes) = n
    point%parent = parent
    point%place = matmul(x, n)
    point%frame(3, :) = cross(along(:, 1), along(:, 2))
    area = norm2(point%frame(3, :))
    if (.not. dot_product(point%frame(3, :), normal) > 0) return
    point%good = .true.
    point%frame(3, :) = point%frame(3, :)/area
    normal = normal/norm2(normal)
    associate (here => point%frame(3, :))
      first = middle - dot_product(middle, here)/(1 + dot_product(normal, here))*(normal + here)
    end associate
    point%frame(1, :) = first/norm2(first)
    point%frame(2, :) = cross(point%frame(3, :), point%frame(1, :))
    point%weight = weight*area
    point%jacobian = matmul(transpose(along), transpose(point%frame(:2, :)))
    call invert(2, point%jacobian, inverse, determinant)
    point%gradient(:nodes, :) = matmul(dn, transpose(inverse))
  end function shell_place

  !> Strains 11, 22, 12 of the surface, curvatures 11, 22, 12 and shear strains 13, 23 (engineering) along the axes of a point, by
  !> displacements of the nodes and changes of their directors.
  pure subroutine shell_strains(nodes, x, v, parent, weight, point, b)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(3, nodes), v(3, nodes)   !< v: directors
    real(dp), intent(in) :: parent(2), weight     !< weight: of the parent area
    type(shell_point), intent(out) :: point
    real(dp), intent(out) :: b(8, 6, nodes)
    integer, parameter :: first(3) = [1, 2, 1], second(3) = [1, 2, 2]
    real(dp) :: slope(3, 2), inverse(2, 2), determinant, shear(2, nodes, nodes), along(2, 6)
    integer :: a, i, j, k, m
    b = 0
    point = shell_place(nodes, x, parent, weight)
    if (.not. point%good) return
    slope = matmul(v, point%gradient(:nodes, :))
    associate (e => point%frame, g => point%gradient)
      do m = 1, 3
        i = first(m)
        j = second(m)
        do k = 1, nodes
          ! e_i . u,j, and the other way round of the shear
          b(m, :3, k) = g(k, j)*e(i, :)
          b(m + 3, :3, k) = g(k, j)*slope(:, i)
          b(m + 3, 4:, k) = g(k, j)*e(i, :)
          if (i == j) cycle
          b(m, :3, k) = b(m, :3, k) + g(k, i)*e(j, :)
          b(m + 3, :3, k) = b(m + 3, :3, k) + g(k, i)*slope(:, j)
          b(m + 3, 4:, k) = b(m + 3, 4:, k) + g(k, i)*e(j, :)
        end do
      end do
    end associate
    call invert(2, point%jacobian, inverse, determinant)
    shear = assumed_shear(nodes, parent)
    do k = 1, nodes
      do a = 1, 2
        along(a, :) = [matmul(v, shear(a, k, :)), matmul(x, shear(a, :, k))]
      end do
      b(7:, :, k) = matmul(inverse, along)
    end do
  end subroutine shell_strains

  !> The same by displacements and rotations, which change directors by rotation x director.
  pure function by_rotations(nodes, v, b) result(found)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: v(3, nodes), b(8, 6, nodes)
    real(dp) :: found(8, 6, nodes)
    integer :: k, m
    found(:, :3, :) = b(:, :3, :)
    do k = 1, nodes
      do m = 1, 8
        found(m, 4:, k) = cross(v(:, k), b(m, 4:, k))
      end do
    end do
  end function by_rotations

  !> Shear strains x,a . v along the parent coordinates a, of three and four nodes from those in the middles of the edges: (a, k, l)
  !> is the factor of the place of node k times the director of node l.
  pure function assumed_shear(nodes, parent) result(shear)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: parent(2)
    real(dp) :: shear(2, nodes, nodes), third(nodes, nodes)
    select case (nodes)
    case (8)
      shear(1, :, :) = shear_along(nodes, parent, 1)
      shear(2, :, :) = shear_along(nodes, parent, 2)
    case (4)
      shear(1, :, :) = 0.5_dp*(1 - parent(2))*shear_along(nodes, [0.0_dp, -1.0_dp], 1) &
                       + 0.5_dp*(1 + parent(2))*shear_along(nodes, [0.0_dp, 1.0_dp], 1)
      shear(2, :, :) = 0.5_dp*(1 - parent(1))*shear_along(nodes, [-1.0_dp, 0.0_dp], 2) &
                       + 0.5_dp*(1 + parent(1))*shear_along(nodes, [1.0_dp, 0.0_dp], 2)
    case default
      shear(1, :, :) = shear_along(nodes, [0.5_dp, 0.0_dp], 1)
      shear(2, :, :) = shear_along(nodes, [0.0_dp, 0.5_dp], 2)
      third = shear(2, :, :) - shear(1, :, :) - shear_along(nodes, [0.5_dp, 0.5_dp], 2) + shear_along(nodes, [0.5_dp, 0.5_dp], 1)
      shear(1, :, :) = shear(1, :, :) + parent(2)*third
      shear(2, :, :) = shear(2, :, :) - parent(1)*third
    end select
  end function assumed_shear

  !> The one along parent coordinate a at a place.
  pure function shear_along(nodes, parent, a) result(shear)
    integer, intent(in) :: nodes, a
    real(dp), intent(in) :: parent(2)
    real(dp) :: shear(nodes, nodes), n(nodes), dn(nodes, 2)
    call interpolate(nodes, parent, n, dn)
    shear = spread(dn(:, a), 2, nodes)*spread(n, 1, nodes)
  end function shear_along

  !> Rotation of the nodes about the normal less that of the surface, by displacements and rotations.
  pure function drilling_strain(nodes, point) result(b)
    integer, intent(in) :: nodes
    type(shell_point), intent(in) :: point
    real(dp) :: b(6, nodes)
    integer :: k
    do k = 1, nodes
      b(:3, k) = 0.5_dp*(point%gradient(k, 2)*point%frame(1, :) - point%gradient(k, 1)*point%frame(2, :))
      b(4:, k) = point%n(k)*point%frame(3, :)
    end do
  end function drilling_strain

  !> Add what the enhanced modes have to the membrane strains at all points of four nodes. stiffness is that of the membrane, along
  !> the axes of each point.
  pure subroutine enhance(points, stiffness, b)
    type(shell_point), intent(in) :: points(:)
    real(dp), intent(in) :: stiffness(:, :, :)   !< (3, 3, points)
    real(dp), intent(inout) :: b(:, :, :)        !< (8, unknowns, points)
    real(dp) :: modes(3, 4, size(points)), h(4, 4), inverse(4, 4), g(4, size(b, 2)), stressed(4, 3)
    type(shell_point) :: middle
    logical :: good
    integer :: p
    middle%jacobian = 0
    do p = 1, size(points)
      ! the mean is that of the middle, where the points are those of Gauss
      middle%jacobian = middle%jacobian + points(p)%jacobian/size(points)
    end do
    h = 0
    g = 0
    do p = 1, size(points)
      modes(:, :, p) = enhanced_modes(middle%jacobian, points(p))
      stressed = points(p)%weight*matmul(transpose(modes(:, :, p)), stiffness(:, :, p))
      h = h + matmul(stressed, modes(:, :, p))
      g = g + matmul(stressed, b(:3, :, p))
    end do
    call invert_general(h, inverse, good)
    g = matmul(inverse, g)
    do p = 1, size(points)
      b(:3, :, p) = b(:3, :, p) - matmul(modes(:, :, p), g)
    end do
  end subroutine enhance

  !> Strains 11, 22, 12 of the four modes at a point: linear along the parent coordinates of the middle, without a mean.
  pure function enhanced_modes(middle, point) result(modes)
    real(dp), intent(in) :: middle(2, 2)
    type(shell_point), intent(in) :: point
    real(dp) :: modes(3, 4), j(2, 2), determinant, shape(3, 4), turn(3, 3)
    call invert(2, middle, j, determinant)
    ! components along the parent coordinates to those along the axes
    turn(1, :) = [j(1, 1)**2, j(1, 2)**2, j(1, 1)*j(1, 2)]
    turn(2, :) = [j(2, 1)**2, j(2, 2)**2, j(2, 1)*j(2, 2)]
    turn(3, :) = [2*j(1, 1)*j(2, 1), 2*j(1, 2)*j(2, 2), j(1, 1)*j(2, 2) + j(1, 2)*j(2, 1)]
    shape = 0
    shape(1, 1) = point%parent(1)
    shape(2, 2) = point%parent(2)
    shape(3, 3:4) = point%parent
    modes = matmul(turn, shape)/point%weight
  end function enhanced_modes

  !> Matrix that turns strains 11, 22, 12 (engineering) to axes at an angle from the first to the second.
  pure function tensor_turn(angle) result(turn)
    real(dp), intent(in) :: angle     !< radians
    real(dp) :: turn(3, 3), c, s
    c = cos(angle)
    s = sin(angle)
    turn(1, :) = [c*c, s*s, c*s]
    turn(2, :) = [s*s, c*c, -c*s]
    turn(3, :) = [-2*c*s, 2*c*s, c*c - s*s]
  end function tensor_turn
end module host_shell_strains
