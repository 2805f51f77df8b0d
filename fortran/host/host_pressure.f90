! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Pressure on a face of a continuum element that follows the rotation and the area of the face.
module host_pressure
  use host_kinds, only: dp
  use host_shape, only: radius_of, rule_t
  use core_rotation, only: cross
  implicit none (type, external)
  private
  public :: add_pressure

contains

  !> Add the force that holds a pressure, and its change with the displacements. Nodes are corners, then middles of edges;
  !> outward is 1 where the normal of their order (to the right of an edge) points out of the element, else -1.
  pure subroutine add_pressure(rule, axisymmetric, outward, depth, pressure, x, force, stiffness)
    type(rule_t), intent(in) :: rule     !< of the face
    integer, intent(in) :: outward
    logical, intent(in) :: axisymmetric
    real(dp), intent(in) :: depth        !< thickness, or 2 pi; 1 in space
    real(dp), intent(in) :: pressure, x(rule%dim + 1, rule%nodes)
    real(dp), intent(inout) :: force(rule%dim + 1, rule%nodes)
    real(dp), intent(inout) :: stiffness(rule%dim + 1, rule%nodes, rule%dim + 1, rule%nodes)
    real(dp) :: along(rule%dim + 1, rule%dim), change(rule%dim + 1, rule%dim + 1), radius, weight
    integer :: dim, i, j, k, p
    dim = rule%dim + 1
    do p = 1, rule%points
      along = matmul(x, rule%dn(:, :, p))
      radius = radius_of(rule, p, axisymmetric, x)
      weight = outward*depth*pressure*rule%weight(p)
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
end module host_pressure
