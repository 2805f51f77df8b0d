! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Quads of four nodes and bricks of eight: strains by their unknowns, force and stiffness from the stress at their points.
!>
!> The unknowns are the displacements of the nodes, one node after the other, then the incompatible modes, which are found in the
!> element. The 2 x 2 (x 2) Gauss points have the order of Abaqus' CPS4 and C3D8.
module elements_continuum_solid
  use core_cells, only: cell_gradient, is_product
  use core_kinds, only: dp
  use core_mean_dilatation, only: mean_volume_strain, set_volume_strain
  use core_quadrature, only: gauss_abscissa
  use core_serendipity, only: brick_gradient, brick_places, quad_places, quad8_gradient
  use core_shape_functions, only: quad_gradient, quad_shape
  use core_status, only: status_type, ok, inside_out
  use core_incompatible_modes, only: mode_matrix
  use core_strains, only: strain_matrix
  implicit none(type, external)
  private
  public :: incompatible_modes, mean_volume, modes_of
  public :: solid_gradient, node_places, solid_points, solid_shape, solid_strains

  !> Formulations other than strains of the displacements alone, 0: those of C3D8I and of C3D8 in Abaqus.
  integer, parameter :: incompatible_modes = 1
  integer, parameter :: mean_volume = 2

contains

  !> Number of incompatible modes: those of CPS4I, CPE4I and C3D8I.
  pure integer function modes_of(dim, plane, formulation)
    integer, intent(in) :: dim
    integer, intent(in) :: plane           !< 0 for plane stress, 1 for plane strain
    integer, intent(in) :: formulation

    modes_of = 0
    if (formulation == incompatible_modes) modes_of = merge(4 + plane, 13, dim == 2)
  end function modes_of

  !> Derivatives of the shape functions by position in any continuum element; the value of the status is the Jacobian.
  pure subroutine solid_gradient(dim, nodes, coordinates, point, gradient, status)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: coordinates(dim, nodes), point(dim)
    real(dp), intent(out) :: gradient(dim, nodes)
    type(status_type), intent(out) :: status
    real(dp) :: jacobian

    if (.not. is_product(dim, nodes)) then
      call cell_gradient(dim, nodes, coordinates, point, gradient, jacobian)
    else if (dim == 3) then
      call brick_gradient(nodes, coordinates, point, gradient, jacobian)
    else if (nodes == 4) then
      call quad_gradient(coordinates, point, gradient, jacobian)
    else
      call quad8_gradient(coordinates, point, gradient, jacobian)
    end if
    status = status_type(merge(ok, inside_out, jacobian > 0.0_dp), 0, jacobian, 0.0_dp)
  end subroutine solid_gradient

  !> Parent coordinates of the nodes.
  pure function node_places(dim) result(places)
    integer, intent(in) :: dim
    integer :: places(dim, 2**dim)

    if (dim == 2) then
      places = quad_places(:, :4)
    else
      places = brick_places(:, :8)
    end if
  end function node_places

  !> Parent coordinates of the Gauss points, whose weights are 1.
  pure function solid_points(dim) result(points)
    integer, intent(in) :: dim
    real(dp) :: points(dim, 2**dim)
    integer :: i, k

    ! the first direction first
    do k = 1, 2**dim
      do i = 1, dim
        points(i, k) = merge(gauss_abscissa, -gauss_abscissa, btest(k - 1, i - 1))
      end do
    end do
  end function solid_points

  !> Shape functions.
  pure function solid_shape(dim, place) result(shape)
    integer, intent(in) :: dim
    real(dp), intent(in) :: place(dim)      !< parent coordinates
    real(dp) :: shape(2**dim)
    integer :: i, nodes(dim, 2**dim)

    if (dim == 2) then
      shape = quad_shape(place)
      return
    end if
    nodes = node_places(dim)
    shape = 0.5_dp**dim
    do i = 1, dim
      shape = shape*(1.0_dp + place(i)*nodes(i, :))
    end do
  end function solid_shape

  !> Strains by the unknowns, transposed, and Jacobians at places of which the first 2**dim are the Gauss points.
  pure subroutine solid_strains(dim, n, strains, formulation, coordinates, places, b, jacobian, status)
    integer, intent(in) :: dim, n, strains               !< n: unknowns, with those of the modes
    integer, intent(in) :: formulation
    real(dp), intent(in) :: coordinates(dim, 2**dim)
    real(dp), intent(in) :: places(:, :)                 !< parent coordinates, (dim, places)
    real(dp), intent(out) :: b(n, strains, size(places, 2)), jacobian(size(places, 2))
    type(status_type), intent(out) :: status             !< inside_out at a Gauss point, with the Jacobian
    real(dp), parameter :: origin(3) = 0.0_dp
    real(dp) :: gradient(dim, 2**dim), by_node(2**dim, dim), mean(n), to_parent(dim, dim), at_middle
    integer :: k, nodes

    nodes = 2**dim
    to_parent = 0.0_dp
    at_middle = 0.0_dp
    if (formulation == incompatible_modes) then
      call solid_gradient(dim, nodes, coordinates, origin(:dim), gradient, status)
      to_parent = matmul(real(node_places(dim), dp), transpose(gradient))
      at_middle = status%value
    end if
    b = 0.0_dp
    do k = 1, size(places, 2)
      call solid_gradient(dim, nodes, coordinates, places(:, k), gradient, status)
      jacobian(k) = status%value
      if (status%code /= ok .and. k <= nodes) return
      if (status%code /= ok) cycle
      by_node = transpose(gradient)
      call strain_matrix(dim, dim, nodes, by_node, b(:dim*nodes, :, k))
      if (formulation == incompatible_modes) call mode_matrix(dim, n - dim*nodes, strains, places(:, k), to_parent, &
        at_middle/jacobian(k), b(dim*nodes + 1:, :, k))
    end do
    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    if (formulation /= mean_volume) return
    mean = mean_volume_strain(dim, n, strains, nodes, jacobian(:nodes), b(:, :, :nodes))
    do k = 1, size(places, 2)
      call set_volume_strain(dim, n, strains, mean, b(:, :, k))
    end do
  end subroutine solid_strains

end module elements_continuum_solid
