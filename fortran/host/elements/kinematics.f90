! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Gradients and rotations at the points of the built-in continuum elements.
!>
!> `direct` is the number of direct strains: 2 in the plane; 3 in space, and in axisymmetric elements, which have the hoop
!> strain u_r/r beside those of the plane: direction 1 is the radius, 2 the axis. Their volumes are per angle.
module host_kinematics
  use core_small_matrix, only: cofactors
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_messages, only: add_message
  use host_protect, only: escape
  use host_shape, only: is_quadratic, radius_of, rule_of, rule_t
  implicit none (type, external)
  private
  public :: components, gradients, mean_gradients, point_position, rotation_of, rotated, size_of

contains

  !> Derivatives of the shape functions by the coordinates in a point, where the element is axisymmetric also the
  !> functions over the radius; and the volume of the point. Leaves the pass if the element is inside out: a deformed element is too
  !> distorted, which a smaller increment may avoid; an undeformed one is an error in the mesh.
  subroutine gradients(rule, direct, point, x, g, volume)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: direct, point
    real(dp), intent(in) :: x(rule%dim, rule%nodes)
    real(dp), intent(out) :: g(rule%nodes, direct), volume
    real(dp) :: determinant, radius
    character(len=160) :: text
    radius = radius_of(rule, point, direct > rule%dim, x)
    if (rule%dim == 2) then
      call plane_gradients(rule%nodes, x, rule%dn(:, :, point), g(:, :2), determinant)
      if (direct > rule%dim) g(:, 3) = rule%n(:, point)/radius
    else
      call space_gradients(rule%nodes, x, rule%dn(:, :, point), g, determinant)
    end if
    volume = rule%weight(point)*determinant*radius
    if (determinant > 0 .and. radius > 0) return
    if (current%deformed) then
      current%distorted = merge(-point, point, determinant > 0)
      call escape()
    end if
    write (text, '(a,i0,a,es10.2,a)') 'the element is inside out at its integration point ', point, &
      ' (Jacobian', determinant*radius, '); its nodes must run counter-clockwise'
    if (rule%dim == 3) text = trim(text)//' as seen from its other side'
    call add_message(-3_i4, trim(text))
    call escape()
  end subroutine gradients

  !> Derivatives by the coordinates from those by the parent coordinates, and the determinant of the Jacobian.
  pure subroutine plane_gradients(nodes, x, dn, g, determinant)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(2, nodes), dn(nodes, 2)
    real(dp), intent(out) :: g(nodes, 2), determinant
    real(dp) :: j(2, 2)
    integer :: k
    j = 0
    do k = 1, nodes
      j(:, 1) = j(:, 1) + x(:, k)*dn(k, 1)
      j(:, 2) = j(:, 2) + x(:, k)*dn(k, 2)
    end do
    determinant = j(1, 1)*j(2, 2) - j(1, 2)*j(2, 1)
    do k = 1, nodes
      g(k, 1) = (dn(k, 1)*j(2, 2) - dn(k, 2)*j(2, 1))/determinant
      g(k, 2) = (dn(k, 2)*j(1, 1) - dn(k, 1)*j(1, 2))/determinant
    end do
  end subroutine plane_gradients

  !> The same in space.
  pure subroutine space_gradients(nodes, x, dn, g, determinant)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(3, nodes), dn(nodes, 3)
    real(dp), intent(out) :: g(nodes, 3), determinant
    real(dp) :: j(3, 3), c(3, 3)
    integer :: i, k
    j = 0
    do i = 1, 3
      do k = 1, nodes
        j(:, i) = j(:, i) + x(:, k)*dn(k, i)
      end do
    end do
    c = cofactors(j)
    determinant = dot_product(j(:, 1), c(:, 1))
    do i = 1, 3
      g(:, i) = (dn(:, 1)*c(i, 1) + dn(:, 2)*c(i, 2) + dn(:, 3)*c(i, 3))/determinant
    end do
  end subroutine space_gradients

  !> Mean of the gradients over the volume of a four- or eight-node element, and the volume: the uniform strain of
  !> D.P. Flanagan, T. Belytschko, Int. J. for Numerical Methods in Engineering 17 (1981) 679.
  subroutine mean_gradients(family, direct, x, g, volume)
    integer, intent(in) :: family, direct
    real(dp), intent(in) :: x(:, :)                !< (dimension, nodes)
    real(dp), intent(out) :: g(:, :), volume       !< (nodes, direct)
    real(dp) :: part(size(g, 1), size(g, 2)), weight
    type(rule_t), pointer :: rule
    integer :: point
    ! as many points as nodes: two in each direction
    rule => rule_of(family, size(x, 2))
    g = 0
    volume = 0
    do point = 1, rule%points
      call gradients(rule, direct, point, x, part, weight)
      g = g + weight*part
      volume = volume + weight
    end do
    g = g/volume
  end subroutine mean_gradients

  !> Places of m strains (three in the plane: 11, 22, 12) among n components.
  pure function components(m, n) result(place)
    integer, intent(in) :: m, n
    integer :: place(m), k
    place = [(k, k=1, m)]
    if (m == 3 .and. n > 3) place(3) = 4
  end function components

  !> Coordinates of an integration point.
  pure function point_position(rule, point, x) result(place)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: point
    real(dp), intent(in) :: x(:, :)     !< (dimension, nodes)
    real(dp) :: place(3)
    place = 0
    place(:size(x, 1)) = matmul(x, rule%n(:, point))
  end function point_position

  !> Rotation of an increment from the gradient (3, 3) of its displacements at its middle (T.J.R. Hughes, J. Winget,
  !> Int. J. for Numerical Methods in Engineering 15 (1980) 1862): (1 - W/2)^-1 (1 + W/2).
  pure function rotation_of(gradient) result(rotation)
    real(dp), intent(in) :: gradient(3, 3)
    real(dp) :: rotation(3, 3), half(3), dyad(3, 3), cross(3, 3), s
    integer :: i
    ! W/2 is the cross product with this vector
    half = 0.25_dp*[gradient(3, 2) - gradient(2, 3), gradient(1, 3) - gradient(3, 1), gradient(2, 1) - gradient(1, 2)]
    s = dot_product(half, half)
    dyad = spread(half, 2, 3)*spread(half, 1, 3)
    cross = reshape([0.0_dp, half(3), -half(2), -half(3), 0.0_dp, half(1), half(2), -half(1), 0.0_dp], [3, 3])
    rotation = 2*(cross + dyad)
    do i = 1, 3
      rotation(i, i) = rotation(i, i) + 1 - s
    end do
    rotation = rotation/(1 + s)
  end function rotation_of

  !> A symmetric tensor turned by a rotation; n = 3: 11, 22, 12, n = 4: 11, 22, 33, 12, n = 6: 11, 22, 33, 12, 13, 23.
  !> shear is the factor of shear components: 1 of stresses, 2 of engineering strains.
  pure function rotated(n, tensor, rotation, shear) result(turned)
    integer, intent(in) :: n
    real(dp), intent(in) :: tensor(n), rotation(3, 3), shear
    real(dp) :: turned(n), full(3, 3)
    integer :: direct
    direct = merge(2, 3, n == 3)
    full = 0
    full(1, 1) = tensor(1)
    full(2, 2) = tensor(2)
    if (direct == 3) full(3, 3) = tensor(3)
    full(1, 2) = tensor(direct + 1)/shear
    if (n == 6) full(1, 3) = tensor(5)/shear
    if (n == 6) full(2, 3) = tensor(6)/shear
    full(2, 1) = full(1, 2)
    full(3, 1) = full(1, 3)
    full(3, 2) = full(2, 3)
    full = matmul(rotation, matmul(full, transpose(rotation)))
    turned(:2) = [full(1, 1), full(2, 2)]
    if (direct == 3) turned(3) = full(3, 3)
    turned(direct + 1) = shear*full(1, 2)
    if (n == 6) turned(5:6) = shear*[full(1, 3), full(2, 3)]
  end function rotated

  !> A typical length across the element in its plane or in space, half of it if there are midside nodes.
  pure function size_of(rule, direct, x, volume) result(length)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: direct
    real(dp), intent(in) :: x(rule%dim, rule%nodes), volume(rule%points)
    real(dp) :: length
    integer :: p
    length = sum([(volume(p)/radius_of(rule, p, direct > rule%dim, x), p=1, rule%points)])**(1.0_dp/rule%dim)
    if (is_quadratic(rule)) length = length/2
  end function size_of
end module host_kinematics
