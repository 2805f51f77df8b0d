! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Local frames of lines, surfaces and plies, and the rotation of a deformation.
module core_rotation
  use core_kinds, only: dp
  use core_small_matrix, only: add_product, invert
  implicit none(type, external)
  private
  public :: about_mean, cross, line_frame, surface_frame, ply_axes, turned_frame, frame_curvature
  public :: polar_rotation, traction_operator, strain_rotation

  !> Angle from the normal of a surface to a direction from which no direction in it follows: nearer to the normal, half a degree of
  !> either turns the projection by six degrees or more.
  real(dp), parameter, public :: least_degrees = 5.0_dp

  real(dp), parameter :: degree = acos(-1.0_dp)/180.0_dp

contains

  !> Frame of a line: rows tau (from start to finish) and n (tau rotated by +90 degrees), and its length. The frame of a line of
  !> zero length is zero.
  pure subroutine line_frame(start, finish, frame, length)
    real(dp), intent(in) :: start(2), finish(2)
    real(dp), intent(out) :: frame(2, 2)
    real(dp), intent(out) :: length
    real(dp) :: along(2)

    along = finish - start
    length = hypot(along(1), along(2))
    frame = 0.0_dp
    if (length > 0.0_dp) then
      frame(1, :) = along/length
      frame(2, :) = [-frame(1, 2), frame(1, 1)]
    end if
  end subroutine line_frame

  !> Frame of a surface from two vectors in it, and the area that they span: rows s, n and t, where n is along their cross
  !> product, s the projection of a direction, without one of the global x axis (of the z axis where x is within 0.1 degrees of n),
  !> and t = n x s. The frame of a surface without area is zero.
  pure subroutine surface_frame(first, second, frame, area, direction, degrees)
    real(dp), intent(in) :: first(3), second(3)
    real(dp), intent(out) :: frame(3, 3)
    real(dp), intent(out) :: area
    real(dp), intent(in), optional :: direction(3)    !< of any length; zero: none
    real(dp), intent(out), optional :: degrees        !< from the direction to the line of n, 90 without a direction: where it is
                                                      !< less than `least_degrees`, s is that without a direction
    real(dp), parameter :: smallest_sine = 1.745328e-3_dp   ! of 0.1 degrees
    real(dp) :: normal(3), along(3), unit(3), angle
    integer :: axis

    frame = 0.0_dp
    if (present(degrees)) degrees = 90.0_dp
    normal = cross(first, second)
    area = norm2(normal)
    if (.not. area > 0.0_dp) return
    normal = normal/area
    axis = merge(1, 3, normal(2)**2 + normal(3)**2 >= smallest_sine**2)
    along = -normal(axis)*normal
    along(axis) = along(axis) + 1.0_dp
    if (present(direction)) then
      if (norm2(direction) > 0.0_dp) then
        unit = direction/norm2(direction)
        angle = atan2(norm2(cross(normal, unit)), abs(dot_product(normal, unit)))/degree
        if (present(degrees)) degrees = angle
        if (.not. angle < least_degrees) along = unit - dot_product(normal, unit)*normal
      end if
    end if
    frame(1, :) = along/norm2(along)
    frame(2, :) = normal
    frame(3, :) = cross(normal, frame(1, :))
  end subroutine surface_frame

  !> Axes 1, 2 and 3 of a ply in a surface: rows.
  pure function ply_axes(frame, angle) result(axes)
    real(dp), intent(in) :: frame(3, 3)   !< rows s, n and t: n is axis 3
    real(dp), intent(in) :: angle         !< of axis 1 from s to t, degrees
    real(dp) :: axes(3, 3)
    real(dp) :: c, s

    c = cos(angle*degree)
    s = sin(angle*degree)
    axes(1, :) = c*frame(1, :) + s*frame(3, :)
    axes(2, :) = c*frame(3, :) - s*frame(1, :)
    axes(3, :) = frame(2, :)
  end function ply_axes

  !> Frame of a line or surface that has moved, and its derivative by the nodes that it depends on. In the surface the frame
  !> turns by the rotation of the polar decomposition of its deformation, whatever direction s has: with the images p1 and p2
  !> of s and t, s is along p1 + p2 x n.
  pure subroutine turned_frame(dim, nodes, start, now, frame, by_node, turned, turning, measure)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: start(dim, dim - 1)       !< vectors in it at the start
    real(dp), intent(in) :: now(dim, dim - 1)         !< these vectors now
    real(dp), intent(in) :: frame(3, 3)               !< rows s, n and t, or tau, n and zero, at the start
    real(dp), intent(in) :: by_node(nodes, dim - 1)   !< how much of a displacement of each node the vectors have
    real(dp), intent(out) :: turned(3, 3)             !< rows as in `frame`
    real(dp), intent(out) :: turning(3, dim, dim, nodes)   !< derivative: row, component, direction, node
    real(dp), intent(out) :: measure                  !< length or area of the vectors now; without one the rest is zero
    real(dp) :: shares(2, 2), second(3), line(3), normal(3), unit(3), length, slope(3, 3)
    integer :: i, q

    turned = 0.0_dp
    turning = 0.0_dp
    if (dim == 2) then
      measure = hypot(now(1, 1), now(2, 1))
      if (.not. measure > 0.0_dp) return
      turned(1, 1:2) = now(:, 1)/measure
      turned(2, 1:2) = [-turned(1, 2), turned(1, 1)]
      do q = 1, nodes
        do i = 1, 2
          ! the part across the line, which is along n
          turning(1, :, i, q) = (by_node(q, 1)/measure*turned(2, i))*turned(2, 1:2)
          turning(2, :, i, q) = -(by_node(q, 1)/measure*turned(2, i))*turned(1, 1:2)
        end do
      end do
      return
    end if
    normal = cross(now(:, 1), now(:, 2))
    measure = norm2(normal)
    if (.not. measure > 0.0_dp) return
    normal = normal/measure
    shares = shares_of_axes(start, frame)
    second = matmul(now, shares(:, 2))
    line = matmul(now, shares(:, 1)) + cross(second, normal)
    length = norm2(line)
    line = line/length
    turned(1, :) = line
    turned(2, :) = normal
    turned(3, :) = cross(normal, line)
    do q = 1, nodes
      do i = 1, 3
        unit = 0.0_dp
        unit(i) = 1.0_dp
        slope(2, :) = (by_node(q, 1)*cross(unit, now(:, 2)) + by_node(q, 2)*cross(now(:, 1), unit))/measure
        slope(2, :) = slope(2, :) - dot_product(slope(2, :), normal)*normal
        slope(1, :) = (dot_product(shares(:, 1), by_node(q, :))*unit &
          + dot_product(shares(:, 2), by_node(q, :))*cross(unit, normal) + cross(second, slope(2, :)))/length
        slope(1, :) = slope(1, :) - dot_product(slope(1, :), line)*line
        slope(3, :) = cross(slope(2, :), line) + cross(normal, slope(1, :))
        turning(:, :, i, q) = slope
      end do
    end do
  end subroutine turned_frame

  !> Shares of two vectors in a surface in its axes s and t, a column each.
  pure function shares_of_axes(start, frame) result(shares)
    real(dp), intent(in) :: start(3, 2)     !< the vectors
    real(dp), intent(in) :: frame(3, 3)     !< rows s, n and t
    real(dp) :: shares(2, 2)
    real(dp) :: gram(2, 2), inverse(2, 2), determinant

    gram = matmul(transpose(start), start)
    call invert(2, gram, inverse, determinant)
    shares = matmul(inverse, matmul(transpose(start), transpose(frame([1, 3], :))))
  end function shares_of_axes

  !> Second derivative, by the nodes, of the sum of moments*F over the entries of the frame F of `turned_frame`.
  pure function frame_curvature(dim, nodes, start, now, frame, by_node, turned, turning, moments) result(curvature)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: start(dim, dim - 1), now(dim, dim - 1), frame(3, 3), by_node(nodes, dim - 1)   !< as there
    real(dp), intent(in) :: turned(3, 3), turning(3, dim, dim*nodes)   !< its results; the nodes one after the other
    real(dp), intent(in) :: moments(3, 3)            !< row of the frame, component
    real(dp) :: curvature(dim*nodes, dim*nodes)
    real(dp) :: plane(3, 2), shares(2, 2), second_by_node(nodes), length, measure
    real(dp), dimension(3) :: line, normal, second, along, across, rest, change
    real(dp), dimension(dim*nodes) :: stretch, stretch_of_normal
    real(dp), dimension(3, dim*nodes) :: of_line, of_normal, crossed, of_second
    integer :: i, j, q, p, row, column

    of_line = 0.0_dp
    of_line(1:dim, :) = turning(1, :, :)
    if (dim == 2) then
      measure = norm2(now(:, 1))
      do q = 1, nodes
        stretch(2*q - 1:2*q) = (by_node(q, 1)/measure)*turned(1, 1:2)
      end do
      ! the normal is the line, turned by 90 degrees
      curvature = unit_curvature(turned(1, :), of_line, stretch, moments(1, :) + [moments(2, 2), -moments(2, 1), 0.0_dp])
      return
    end if
    of_normal = turning(2, :, :)
    plane = now
    line = turned(1, :)
    normal = turned(2, :)
    shares = shares_of_axes(start, frame)
    second = matmul(plane, shares(:, 2))
    second_by_node = matmul(by_node, shares(:, 2))
    length = norm2(matmul(plane, shares(:, 1)) + cross(second, normal))
    measure = norm2(cross(plane(:, 1), plane(:, 2)))
    do q = 1, nodes
      do i = 1, 3
        row = 3*(q - 1) + i
        change = second_by_node(q)*cross(unit_vector(i), normal) + cross(second, of_normal(:, row))
        change(i) = change(i) + dot_product(shares(:, 1), by_node(q, :))
        stretch(row) = dot_product(line, change)/length
      end do
      stretch_of_normal(3*q - 2:3*q) = (by_node(q, 1)*cross(plane(:, 2), normal) + by_node(q, 2)*cross(normal, plane(:, 1))) &
        /measure
    end do
    ! the third row is the cross product of normal and line; `across` works on the second derivative of p1 + p2 x n
    along = moments(1, :) + cross(moments(3, :), normal)
    across = (along - dot_product(along, line)*line)/length
    rest = moments(2, :) + cross(line, moments(3, :)) + cross(across, second)
    curvature = unit_curvature(line, of_line, stretch, along) + unit_curvature(normal, of_normal, stretch_of_normal, rest)
    rest = (rest - dot_product(rest, normal)*normal)/measure
    do column = 1, 3*nodes
      crossed(:, column) = cross(of_line(:, column), moments(3, :))
      of_second(:, column) = cross(of_normal(:, column), across)
    end do
    do column = 1, 3*nodes
      p = (column + 2)/3
      j = column - 3*(p - 1)
      do row = 1, 3*nodes
        q = (row + 2)/3
        i = row - 3*(q - 1)
        curvature(row, column) = curvature(row, column) + dot_product(of_normal(:, row), crossed(:, column)) &
          + dot_product(of_normal(:, column), crossed(:, row)) &
          + second_by_node(q)*of_second(i, column) + second_by_node(p)*of_second(j, row)
        if (i == j) cycle
        ! unit vectors i and j have the third one, or its opposite, as their cross product
        curvature(row, column) = curvature(row, column) + (by_node(q, 1)*by_node(p, 2) - by_node(p, 1)*by_node(q, 2)) &
          *merge(rest(6 - i - j), -rest(6 - i - j), mod(j - i + 3, 3) == 1)
      end do
    end do
  end function frame_curvature

  !> Unit vector along a global axis.
  pure function unit_vector(axis) result(vector)
    integer, intent(in) :: axis
    real(dp) :: vector(3)

    vector = 0.0_dp
    vector(axis) = 1.0_dp
  end function unit_vector

  !> Second derivative of force.unit, where unit = L/|L|, less that of L itself.
  pure function unit_curvature(unit, turning, stretch, force) result(curvature)
    real(dp), intent(in) :: unit(3)
    real(dp), intent(in) :: turning(:, :)   !< (3, unknowns) derivative of unit
    real(dp), intent(in) :: stretch(:)      !< that of log |L|
    real(dp), intent(in) :: force(3)
    real(dp) :: curvature(size(stretch), size(stretch))
    real(dp), dimension(size(stretch), 5) :: first, second   ! factors of the terms of a sum of products

    second(:, 1:3) = transpose(turning)
    first(:, 1:3) = -dot_product(unit, force)*second(:, 1:3)
    first(:, 4) = -stretch
    second(:, 4) = force(1)*second(:, 1) + force(2)*second(:, 2) + force(3)*second(:, 3)
    first(:, 5) = -second(:, 4)
    second(:, 5) = stretch
    curvature = 0.0_dp
    call add_product(size(stretch), size(stretch), 5, first, second, curvature)
  end function unit_curvature

  !> Rotation of the polar decomposition of a deformation gradient, by Newton's method for the square root (N.J. Higham,
  !> Functions of Matrices, 2008, 8.3).
  pure subroutine polar_rotation(deformation, rotation, good)
    real(dp), intent(in) :: deformation(3, 3)
    real(dp), intent(out) :: rotation(3, 3)
    logical, intent(out) :: good             !< false where the determinant is not positive, or an entry is NaN or infinite
    integer, parameter :: most_passes = 100  ! a stretch halves in each pass until it is about 1; then convergence is quadratic
    real(dp) :: inverse(3, 3), determinant, last(3, 3)
    integer :: pass

    rotation = deformation
    do pass = 1, most_passes
      last = rotation
      call invert(3, last, inverse, determinant)
      good = determinant > 0.0_dp .and. all(abs(last) <= huge(1.0_dp))
      if (.not. good) return
      rotation = 0.5_dp*(last + transpose(inverse))
      ! the next pass would change it by the square of this
      if (maxval(abs(rotation - last)) < 1.0e-9_dp) return
    end do
    good = .false.
  end subroutine polar_rotation

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

  !> Cross product.
  pure function cross(a, b) result(c)
    real(dp), intent(in) :: a(3), b(3)
    real(dp) :: c(3)

    c(1) = a(2)*b(3) - a(3)*b(2)
    c(2) = a(3)*b(1) - a(1)*b(3)
    c(3) = a(1)*b(2) - a(2)*b(1)
  end function cross

  !> Matrix that takes stress, in the plane (11, 22, 12), in space (11, 22, 33, 12, 13, 23), to the traction sigma.n in the
  !> components of the rows of a frame, of which n is the second one.
  pure function traction_operator(dim, frame) result(matrix)
    integer, intent(in) :: dim                !< 2 or 3
    real(dp), intent(in) :: frame(3, 3)       !< rows tau, n and zero, or s, n and t
    real(dp) :: matrix(dim, 3*(dim - 1))
    integer :: i

    do i = 1, dim
      matrix(i, :) = symmetric_product(dim, frame(i, :), frame(2, :))
    end do
  end function traction_operator

  !> Row that takes a stress to a.sigma.b.
  pure function symmetric_product(dim, a, b) result(row)
    integer, intent(in) :: dim
    real(dp), intent(in) :: a(3), b(3)
    real(dp) :: row(3*(dim - 1))

    row(1) = a(1)*b(1)
    row(2) = a(2)*b(2)
    if (dim == 2) then
      row(3) = a(1)*b(2) + a(2)*b(1)
      return
    end if
    row(3) = a(3)*b(3)
    row(4) = a(1)*b(2) + a(2)*b(1)
    row(5) = a(1)*b(3) + a(3)*b(1)
    row(6) = a(2)*b(3) + a(3)*b(2)
  end function symmetric_product

  !> Matrix that takes strains (11, 22, 33, 12, 13, 23; engineering shear) to those along the rows of a rotation.
  pure function strain_rotation(axes) result(matrix)
    real(dp), intent(in) :: axes(3, 3)
    real(dp) :: matrix(6, 6)
    integer, parameter :: first(6) = [1, 2, 3, 1, 1, 2], second(6) = [1, 2, 3, 2, 3, 3]
    integer :: i

    do i = 1, 6
      matrix(i, :) = symmetric_product(3, axes(first(i), :), axes(second(i), :))
      ! a shear strain counts twice, on both sides
      matrix(i, 4:6) = 0.5_dp*matrix(i, 4:6)
      if (i > 3) matrix(i, :) = 2.0_dp*matrix(i, :)
    end do
  end function strain_rotation

end module core_rotation
