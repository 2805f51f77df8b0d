! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Pressures and tractions on a face of an element that follow the rotation and the area of the face.
module host_followers
  use core_rotation, only: cross
  use core_small_matrix, only: invert
  use host_kinds, only: dp
  use host_polar, only: cross_complex => cross, polar_axes, step
  use host_shape, only: radius_of, rule_t
  implicit none (type, external)
  private
  public :: add_pressure, add_traction

contains

  !> Add the force that holds a pressure, and its change with the displacements. Nodes are corners, then middles of edges;
  !> outward is 1 where the normal of their order (to the right of an edge) points out of the element, else -1.
  pure subroutine add_pressure(rule, axisymmetric, outward, depth, pressure, x, force, stiffness)
    type(rule_t), intent(in) :: rule     !< of the face
    integer, intent(in) :: outward
    logical, intent(in) :: axisymmetric
    real(dp), intent(in) :: depth        !< thickness, or 2 pi; 1 in space
    real(dp), intent(in) :: pressure(rule%points), x(rule%dim + 1, rule%nodes)
    real(dp), intent(inout) :: force(rule%dim + 1, rule%nodes)
    real(dp), intent(inout) :: stiffness(rule%dim + 1, rule%nodes, rule%dim + 1, rule%nodes)
    real(dp) :: along(rule%dim + 1, rule%dim), change(rule%dim + 1, rule%dim + 1), radius, weight
    integer :: dim, i, j, k, p
    dim = rule%dim + 1
    do p = 1, rule%points
      along = matmul(x, rule%dn(:, :, p))
      radius = radius_of(rule, p, axisymmetric, x)
      weight = outward*depth*pressure(p)*rule%weight(p)
      associate (n => rule%n(:, p), dn => rule%dn(:, :, p), normal => area_of(dim, along))
        do k = 1, rule%nodes
          force(:, k) = force(:, k) + weight*radius*n(k)*normal
        end do
        do j = 1, rule%nodes
          do i = 1, dim
            change(:, i) = radius*area_change(dim, along, i, dn(j, :))
          end do
          if (axisymmetric) change(:, 1) = change(:, 1) + n(j)*normal
          do k = 1, rule%nodes
            stiffness(:, k, :, j) = stiffness(:, k, :, j) + weight*n(k)*change
          end do
        end do
      end associate
    end do
  end subroutine add_pressure

  !> Add the force that holds a traction, per present area, and its change with the displacements. Its direction turns by the
  !> rotation in the polar decomposition of the deformation of the face (Analysis User's Guide, Distributed loads).
  pure subroutine add_traction(rule, axisymmetric, shear, depth, traction, direction, start, x, force, stiffness)
    type(rule_t), intent(in) :: rule        !< of the face
    logical, intent(in) :: axisymmetric
    logical, intent(in) :: shear            !< only the part of the direction along the face counts, with the length 1
    real(dp), intent(in) :: depth           !< thickness, or 2 pi; 1 in space
    real(dp), intent(in) :: traction, direction(rule%dim + 1)
    real(dp), intent(in) :: start(rule%dim + 1, rule%nodes), x(rule%dim + 1, rule%nodes)
    real(dp), intent(inout) :: force(rule%dim + 1, rule%nodes)
    real(dp), intent(inout) :: stiffness(rule%dim + 1, rule%nodes, rule%dim + 1, rule%nodes)
    complex(dp) :: along(3, 2), now(rule%dim + 1, rule%nodes), load(rule%dim + 1)
    real(dp) :: by_parent(2, 2), components(3)
    integer :: i, j, k, p
    do p = 1, rule%points
      call start_of(rule, p, start, direction, by_parent, components)
      if (shear) components = [components(:2)/norm2(components(:2)), 0.0_dp]
      do j = 1, rule%nodes
        do i = 1, rule%dim + 1
          now = x
          now(i, j) = now(i, j) + cmplx(0.0_dp, step, dp)
          along = in_space(rule%dim, matmul(now, rule%dn(:, :, p)))
          load = size_of(cross_complex(along(:, 1), along(:, 2)))*turned(matmul(along, by_parent), components)
          load = -rule%weight(p)*depth*traction*load
          if (axisymmetric) load = load*sum(rule%n(:, p)*now(1, :))
          do k = 1, rule%nodes
            stiffness(:, k, i, j) = stiffness(:, k, i, j) + rule%n(k, p)*aimag(load)/step
          end do
        end do
      end do
      ! the last step has not changed the real part
      do k = 1, rule%nodes
        force(:, k) = force(:, k) + rule%n(k, p)*real(load, dp)
      end do
    end do

  contains

    pure function turned(along, components) result(vector)
      complex(dp), intent(in) :: along(3, 2)
      real(dp), intent(in) :: components(3)
      complex(dp) :: vector(rule%dim + 1), whole(3)
      whole = matmul(polar_axes(along), components)
      vector = whole(:rule%dim + 1)
    end function turned
  end subroutine add_traction

  !> Of the face at the start: two unit vectors in it by its tangents along the parent coordinates, in columns, and the components
  !> of a direction along them and the normal.
  pure subroutine start_of(rule, point, x, direction, by_parent, components)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: point
    real(dp), intent(in) :: x(rule%dim + 1, rule%nodes), direction(rule%dim + 1)
    real(dp), intent(out) :: by_parent(2, 2), components(3)
    real(dp) :: along(3, 2), axes(3, 3), inverse(2, 2), determinant, whole(3)
    along = real(in_space(rule%dim, cmplx(matmul(x, rule%dn(:, :, point)), kind=dp)), dp)
    axes(:, 1) = along(:, 1)/norm2(along(:, 1))
    axes(:, 3) = cross(along(:, 1), along(:, 2))
    axes(:, 3) = axes(:, 3)/norm2(axes(:, 3))
    axes(:, 2) = cross(axes(:, 3), axes(:, 1))
    call invert(2, matmul(transpose(axes(:, :2)), along), inverse, determinant)
    by_parent = inverse
    whole = 0
    whole(:rule%dim + 1) = direction
    components = matmul(whole, axes)
  end subroutine start_of

  !> Tangents of a face; those of an edge in the plane are beside the normal of the plane.
  pure function in_space(dim, along) result(tangents)
    integer, intent(in) :: dim
    complex(dp), intent(in) :: along(dim + 1, dim)
    complex(dp) :: tangents(3, 2)
    tangents = 0
    tangents(:dim + 1, :dim) = along
    if (dim == 1) tangents(3, 2) = 1
  end function in_space

  pure complex(dp) function size_of(a)
    complex(dp), intent(in) :: a(3)
    size_of = sqrt(sum(a*a))
  end function size_of

  !> Normal times area per parent area, from the derivatives of the position.
  pure function area_of(dim, along) result(area)
    integer, intent(in) :: dim
    real(dp), intent(in) :: along(dim, dim - 1)
    real(dp) :: area(dim)
    if (dim == 2) then
      area = [along(2, 1), -along(1, 1)]
    else
      area = cross(along(:, 1), along(:, 2))
    end if
  end function area_of

  !> Its change if a node moves in direction i, whose function has the slopes dn.
  pure function area_change(dim, along, i, dn) result(change)
    integer, intent(in) :: dim, i
    real(dp), intent(in) :: along(dim, dim - 1), dn(dim - 1)
    real(dp) :: change(dim), unit(dim)
    unit = 0
    unit(i) = 1
    if (dim == 2) then
      change = [unit(2), -unit(1)]*dn(1)
    else
      change = cross(unit, along(:, 2))*dn(1) + cross(along(:, 1), unit)*dn(2)
    end if
  end function area_change
end module host_followers
