! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Faces of contact surfaces: coordinates as polynomials of the natural coordinates xi, and closest point projection.
!>
!> Vectors have three components, of which the third is zero in the plane; one or two natural coordinates are used.
module host_contact_faces
  use host_kinds, only: dp, i8
  implicit none (type, external)
  private
  public :: rounding, foot_t, monomials, size_of, polynomial_of, evaluate, find_frame, det, solve, inside, project

  !> As EQUAL of harness/uel/contact/main_surface.py.
  real(dp), parameter :: rounding = 1e-9_dp
  !> Largest number of Newton iterations of a projection.
  integer, parameter :: steps = 20
  !> Squared area of a piece over its size to the fourth power that is rounding.
  real(dp), parameter :: flat = 1e-14_dp

  !> A point of a face.
  type :: foot_t
    integer :: along                 !< number of natural coordinates
    real(dp) :: at(3)
    real(dp) :: tangents(3, 2)       !< derivatives of `at`
    real(dp) :: second(3, 2, 2)      !< derivatives of the tangents
    real(dp) :: normal(3)            !< of length one
    real(dp) :: metric(2, 2)         !< of the tangents, regularized where an extended face has no area
  end type foot_t

contains

  !> The first ones of 1, xi, xi^2 or 1, xi, eta, xi eta, xi^2, eta^2, xi^2 eta, xi eta^2, and their derivatives.
  pure subroutine monomials(along, terms, natural, values, first, second)
    integer, value :: along, terms               !< 1 and 3, or 2 and 4 or 8
    real(dp), intent(in) :: natural(along)
    real(dp), intent(out) :: values(terms), first(terms, along), second(terms, along, along)
    real(dp) :: xi, eta
    xi = natural(1)
    first = 0
    second = 0
    values(:2) = [1.0_dp, xi]
    first(2, 1) = 1
    if (along == 1) then
      values(3) = xi**2
      first(3, 1) = 2*xi
      second(3, 1, 1) = 2
      return
    end if
    eta = natural(2)
    values(3:4) = [eta, xi*eta]
    first(3, 2) = 1
    first(4, :) = [eta, xi]
    second(4, 1, 2) = 1
    if (terms > 4) then
      values(5:) = [xi**2, eta**2, xi**2*eta, xi*eta**2]
      first(5, 1) = 2*xi
      first(6, 2) = 2*eta
      first(7, :) = [2*xi*eta, xi**2]
      first(8, :) = [eta**2, 2*xi*eta]
      second(5, 1, 1) = 2
      second(6, 2, 2) = 2
      second(7, 1, 1) = 2*eta
      second(8, 2, 2) = 2*xi
      second(7, 1, 2) = 2*xi
      second(8, 1, 2) = 2*eta
    end if
    second(:, 2, 1) = second(:, 1, 2)
  end subroutine monomials

  !> Largest distance of the nodes of a face from their centroid.
  pure function size_of(corners) result(largest)
    real(dp), intent(in), contiguous :: corners(:, :)   !< (d, nodes)
    real(dp) :: largest, centroid(size(corners, 1))
    integer :: k
    centroid = sum(corners, dim=2)/size(corners, 2)
    largest = 0
    do k = 1, size(corners, 2)
      largest = max(largest, sqrt(sum((corners(:, k) - centroid)**2)))
    end do
  end function size_of

  !> Coefficients of the monomials in the coordinates of a face.
  pure function polynomial_of(shapes, nodes, coordinates) result(polynomial)
    real(dp), intent(in), contiguous :: shapes(:, :)   !< (terms, nodes) coefficients of the shape functions
    integer(i8), intent(in), contiguous :: nodes(:)   !< from 0
    real(dp), intent(in), contiguous :: coordinates(:, :)   !< (d, nodes of the model)
    real(dp) :: polynomial(3, size(shapes, 1))
    integer :: j, k, d
    d = size(coordinates, 1)
    polynomial = 0
    do k = 1, size(nodes)
      do j = 1, size(shapes, 1)
        polynomial(:d, j) = polynomial(:d, j) + shapes(j, k)*coordinates(:, nodes(k) + 1)
      end do
    end do
  end function polynomial_of

  !> A point of a face with its frame.
  pure function evaluate(polynomial, dimension, natural) result(foot)
    real(dp), intent(in), contiguous :: polynomial(:, :), natural(:)
    integer, intent(in) :: dimension
    type(foot_t) :: foot
    call interpolate(polynomial, natural, foot)
    call find_frame(dimension, foot)
  end function evaluate

  !> A point of a face with its tangents and their derivatives.
  pure subroutine interpolate(polynomial, natural, foot)
    real(dp), intent(in), contiguous :: polynomial(:, :), natural(:)
    type(foot_t), intent(inout) :: foot
    ! a compiler makes more of loops whose length it knows: linear faces in space
    if (size(polynomial, 2) == 4) then
      call sum_terms(2, 4, polynomial, natural, foot)
    else
      call sum_terms(size(natural), size(polynomial, 2), polynomial, natural, foot)
    end if
  end subroutine interpolate

  !> `interpolate` with its sizes as values, which a call with constants makes known to the compiler.
  pure subroutine sum_terms(along, terms, polynomial, natural, foot)
    integer, value :: along, terms
    real(dp), intent(in) :: polynomial(3, terms), natural(along)
    type(foot_t), intent(inout) :: foot
    real(dp) :: values(terms), first(terms, along), second(terms, along, along)
    integer :: a, b, j
    foot%along = along
    call monomials(along, terms, natural, values, first, second)
    foot%at = 0
    foot%tangents = 0
    foot%second = 0
    do j = 1, terms
      foot%at = foot%at + values(j)*polynomial(:, j)
      do a = 1, along
        foot%tangents(:, a) = foot%tangents(:, a) + first(j, a)*polynomial(:, j)
        do b = 1, along
          foot%second(:, b, a) = foot%second(:, b, a) + second(j, b, a)*polynomial(:, j)
        end do
      end do
    end do
  end subroutine sum_terms

  !> Normal and metric of the tangents.
  pure subroutine find_frame(dimension, foot)
    integer, intent(in) :: dimension
    type(foot_t), intent(inout) :: foot
    real(dp) :: length
    associate (t => foot%tangents, n => foot%normal)
      if (dimension == 2) then
        n = [t(2, 1), -t(1, 1), 0.0_dp]
      else if (foot%along == 1) then
        ! a line in space has none
        n = 0
      else
        n = [t(2, 1)*t(3, 2) - t(3, 1)*t(2, 2), t(3, 1)*t(1, 2) - t(1, 1)*t(3, 2), t(1, 1)*t(2, 2) - t(2, 1)*t(1, 2)]
      end if
      length = sqrt(dot_product(n, n))
      if (length > 0) n = n/length
    end associate
    call find_metric(foot)
  end subroutine find_frame

  !> Metric of the tangents.
  pure subroutine find_metric(foot)
    type(foot_t), intent(inout) :: foot
    real(dp) :: size
    associate (t => foot%tangents)
      foot%metric = 0
      foot%metric(1, 1) = dot_product(t(:, 1), t(:, 1))
      size = foot%metric(1, 1)
      if (foot%along == 2) then
        foot%metric(2, 2) = dot_product(t(:, 2), t(:, 2))
        foot%metric(1, 2) = dot_product(t(:, 1), t(:, 2))
        foot%metric(2, 1) = foot%metric(1, 2)
        size = size + foot%metric(2, 2)
        foot%metric(2, 2) = foot%metric(2, 2) + rounding**2*size
      end if
      foot%metric(1, 1) = foot%metric(1, 1) + rounding**2*size
    end associate
  end subroutine find_metric

  !> Determinant of a matrix of one or two rows.
  pure function det(along, a) result(value)
    integer, intent(in) :: along
    real(dp), intent(in) :: a(2, 2)
    real(dp) :: value
    value = a(1, 1)
    if (along == 2) value = a(1, 1)*a(2, 2) - a(1, 2)*a(2, 1)
  end function det

  !> Solution of a system of one or two equations; zero beyond them.
  pure function solve(along, a, right) result(x)
    integer, intent(in) :: along
    real(dp), intent(in) :: a(2, 2), right(2)
    real(dp) :: x(2)
    if (along == 1) then
      x = [right(1)/a(1, 1), 0.0_dp]
    else
      x = [a(2, 2)*right(1) - a(1, 2)*right(2), a(1, 1)*right(2) - a(2, 1)*right(1)]/det(2, a)
    end if
  end function solve

  !> Natural coordinates of the projection of a point onto an extended face, by Newton's method.
  pure function project(polynomial, low, high, point) result(natural)
    real(dp), intent(in), contiguous :: polynomial(:, :), low(:), high(:)
    real(dp), intent(in) :: point(3)
    real(dp) :: natural(size(low))
    type(foot_t) :: foot
    real(dp) :: gap(3), matrix(2, 2), trace, right(2), change(2), last(size(low))
    integer :: step, a, b, along
    along = size(low)
    natural = 0.5_dp*(low + high)
    do step = 1, steps
      call interpolate(polynomial, natural, foot)
      call find_metric(foot)
      gap = point - foot%at
      matrix = foot%metric
      right = 0
      do a = 1, along
        do b = 1, along
          matrix(b, a) = matrix(b, a) - dot_product(foot%second(:, b, a), gap)
        end do
        right(a) = dot_product(foot%tangents(:, a), gap)
      end do
      ! a descent direction: without the curvature far from a curved face
      if (.not. (det(along, matrix) > 0.1_dp*det(along, foot%metric) .and. matrix(1, 1) + matrix(2, 2) > 0)) then
        matrix = foot%metric
      end if
      trace = foot%metric(1, 1) + foot%metric(2, 2)
      if (det(along, foot%metric) <= flat*trace**along) then
        ! steepest descent on a degenerate face
        matrix = reshape(max(trace, tiny(trace))*[1.0_dp, 0.0_dp, 0.0_dp, 1.0_dp], [2, 2])
      end if
      change = solve(along, matrix, right)
      last = natural
      natural = min(max(last + change(:along), low - 2*(high - low)), high + 2*(high - low))
      ! convergence is quadratic: the next error is rounding
      if (maxval(abs(natural - last)) <= rounding) exit
    end do
  end function project

  !> Natural coordinates clipped to the face.
  pure function inside(natural, low, high, total) result(within)
    real(dp), intent(in), contiguous :: natural(:), low(:), high(:)
    real(dp), intent(in) :: total
    real(dp) :: within(size(natural))
    within = min(max(natural, low), high)
    within = min(max(within - max(sum(within) - total, 0.0_dp)/size(within), low), high)
  end function inside
end module host_contact_faces
