! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Tangent terms from the change of the mean volume strain, in elements whose points all have that mean.
!>
!> The forces of a pressure that is the same in an element are the pressure times the derivatives of the volume by the
!> displacements, so that its tangent has the second derivatives: they are those of the points' own volume strains.
module host_mean_dilatation_tangent
  use core_strains, only: strain_matrix
  use host_forces, only: add_geometric, add_point, by_volume
  use host_kinds, only: dp
  use host_kinematics, only: gradients
  use host_shape, only: rule_of, rule_t
  implicit none (type, external)
  private
  public :: add_mean_volume, add_uniform_volume

contains

  !> Of all points, with their gradients g and strain matrices b, which have the mean volume strain. w are the volumes that make up
  !> the forces: those before any displacement times the change of the whole volume.
  subroutine add_mean_volume(dim, direct, m, nodes, points, g, b, stress, w, volume, stiffness)
    integer, intent(in) :: dim, direct, m, nodes, points    !< m: number of strains
    real(dp), intent(in) :: g(nodes, direct, points), b(dim*nodes, m, points), stress(m, points), w(points)
    real(dp), intent(in) :: volume(points)                  !< of the points now
    real(dp), intent(inout) :: stiffness(dim*nodes, dim*nodes)
    real(dp) :: own(dim*nodes, m), pressure(points), none(m, m), unit(m)
    integer :: p
    none = 0
    unit = 0
    unit(:direct) = 1
    ! the mean strain is in equal parts in the direct ones
    pressure = w*sum(stress(:direct, :), 1)/direct
    do p = 1, points
      call strain_matrix(dim, direct, nodes, g(:, :, p), own)
      ! what turns the stress is the strain of the point
      call add_tangent(dim, direct, m, nodes, g(:, :, p), own, stress(:, p), w(p), none, stiffness)
      call add_tangent(dim, direct, m, nodes, g(:, :, p), b(:, :, p), stress(:, p), -w(p), none, stiffness)
      ! the mean volume strain changes by that of all points, and the point's own goes
      call add_curvature(dim, direct, m, nodes, g(:, :, p), own, unit, &
                         sum(pressure)*volume(p)/sum(volume) - pressure(p), stiffness)
      call add_square(sum(own(:, :direct), 2), pressure(p), stiffness)
    end do
    call add_square(sum(b(:, :direct, 1), 2), -sum(pressure), stiffness)
  end subroutine add_mean_volume

  !> Of the only point of an element, whose strain matrix b has the change of the volume of the whole.
  subroutine add_uniform_volume(family, direct, m, x, g, b, stress, volume, depth, stiffness)
    integer, intent(in) :: family, direct, m
    real(dp), intent(in) :: x(:, :)                   !< (dimension, nodes), now
    real(dp), intent(in) :: g(:, :), b(:, :), stress(m), volume
    real(dp), intent(in) :: depth                     !< factor of the volumes of points: the angle of axisymmetric elements
    real(dp), intent(inout) :: stiffness(:, :)
    real(dp) :: own(size(b, 1), m), part(size(x, 2), direct), weight, pressure, unit(m)
    type(rule_t), pointer :: rule
    integer :: point, dim, nodes
    dim = size(x, 1)
    nodes = size(x, 2)
    ! in equal parts in the directions of the displacements
    pressure = sum(stress(:dim))/dim
    unit = 0
    unit(:direct) = 1
    call add_curvature(dim, direct, m, nodes, g, b, unit, -pressure*volume, stiffness)
    ! as many points as nodes: two in each direction
    rule => rule_of(family, nodes)
    do point = 1, rule%points
      call gradients(rule, direct, point, x, part, weight)
      call strain_matrix(dim, direct, nodes, part, own)
      call add_curvature(dim, direct, m, nodes, part, own, unit, pressure*depth*weight, stiffness)
    end do
  end subroutine add_uniform_volume

  !> Tangent of a given multiple of a stress, volume included, with these gradients and strains.
  subroutine add_curvature(dim, direct, m, nodes, g, b, stress, multiple, stiffness)
    integer, intent(in) :: dim, direct, m, nodes
    real(dp), intent(in) :: g(nodes, direct), b(dim*nodes, m), stress(m), multiple
    real(dp), intent(inout) :: stiffness(dim*nodes, dim*nodes)
    call add_tangent(dim, direct, m, nodes, g, b, stress, multiple, by_volume(m, direct, stress), stiffness)
  end subroutine add_curvature

  !> Tangent of a stress with these gradients and strains; modulus is that of the Jaumann rate of the Kirchhoff stress.
  subroutine add_tangent(dim, direct, m, nodes, g, b, stress, volume, modulus, stiffness)
    integer, intent(in) :: dim, direct, m, nodes
    real(dp), intent(in) :: g(nodes, direct), b(dim*nodes, m), stress(m), volume, modulus(m, m)
    real(dp), intent(inout) :: stiffness(dim*nodes, dim*nodes)
    real(dp) :: turning(m, m), none(m), no_force(dim*nodes)
    turning = modulus
    none = 0
    no_force = 0
    call add_geometric(dim, direct, m, nodes, g, stress, volume, turning, stiffness)
    call add_point(dim*nodes, m, b, none, volume*turning, no_force, stiffness)
  end subroutine add_tangent

  pure subroutine add_square(vector, factor, stiffness)
    real(dp), intent(in) :: vector(:), factor
    real(dp), intent(inout) :: stiffness(:, :)
    integer :: k
    do k = 1, size(vector)
      stiffness(:, k) = stiffness(:, k) + factor*vector(k)*vector
    end do
  end subroutine add_square
end module host_mean_dilatation_tangent
