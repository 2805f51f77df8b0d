! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Layers: interfaces whose faces are a distance apart in the mesh, such as an adhesive. Points, directions and areas are those of
!> the mid-surface; the thickness does not enter the law, of which alpha is a modulus over the thickness.
!>
!> A small rotation omega of the whole layer moves its top face over the bottom one by omega x H, with the vector H from the bottom
!> to the top. That is no separation. So the separation is taken relative to H as it turns with the mid-surface,
!>
!>     g = N (u - omega x X),    omega x X = -dQ^T X,
!>
!> with the derivative of the rotation Q of `elements_interface_rotation` by the displacements, at none: the limit of what that file
!> does for small ones. It is a matrix times u, and the nodal forces are its transpose times the traction: with the couple of the
!> tractions on both faces, T x H, they have pairs of forces across the layer that hold it, as the shear at the ends of a piece of
!> a continuous layer does.
module elements_interface_layer
  use core_kinds, only: dp
  use core_status, only: status_type, ok, layer_slants, layer_twists
  use elements_interface_faces, only: interface_place, place_points, separation_at, most_apart
  use elements_interface_rotation, only: turn_place, by_displacements
  implicit none(type, external)
  private
  public :: measure_layer, layer_operator, layer_separation

contains

  !> Integration points on the mid-line or mid-surface of two faces that may be apart: as far as they are, the top has to lie over
  !> the bottom node by node, or else the order of the nodes is wrong.
  pure subroutine measure_layer(dim, nodes, points, bottom, top, rule, places, status)
    integer, intent(in) :: dim                                    !< 2 or 3
    integer, intent(in) :: nodes                                  !< of a face
    integer, intent(in) :: points                                 !< as many as nodes, on surfaces with midside nodes one more
    real(dp), intent(in) :: bottom(dim, nodes), top(dim, nodes)   !< original coordinates
    integer, intent(in) :: rule
    type(interface_place), intent(out) :: places(points)
    type(status_type), intent(out) :: status    !< zero_length; layer_slants or layer_twists, with what is too much and its limit
    integer :: faces(nodes, 2), k, i
    real(dp) :: thickness(3), by_node(nodes, dim - 1), lower(dim, dim - 1), upper(dim, dim - 1), aside, along

    ! standard elements know no plies, whose directions need one
    call place_points(dim, nodes, points, 0.5_dp*(bottom + top), rule, [0.0_dp, 0.0_dp, 0.0_dp], places, status)
    if (status%code /= ok .or. .not. maxval(abs(top - bottom)) > most_apart(dim, nodes, bottom)) return
    do k = 1, nodes
      faces(k, :) = [k, nodes + k]
    end do
    do k = 1, points
      thickness = separation_at(dim, places(k), nodes, faces, [bottom, top])
      aside = hypot(thickness(1), thickness(3))
      if (aside > thickness(2)) status = status_type(layer_slants, k, aside, thickness(2))
      if (status%code /= ok) return
      by_node = places(k)%slope(1:nodes, 1:dim - 1)
      lower = matmul(bottom, by_node)
      upper = matmul(top, by_node)
      do i = 1, dim - 1
        aside = norm2(upper(:, i) - lower(:, i))
        along = 0.5_dp*norm2(upper(:, i) + lower(:, i))
        if (aside > along) status = status_type(layer_twists, k, aside, along)
      end do
      if (status%code /= ok) return
    end do
  end subroutine measure_layer

  !> The separation of a layer at a point by its small displacements, (unknowns, components).
  pure subroutine layer_operator(dim, nodes, faces, original, place, jump, matrix, status)
    integer, intent(in) :: dim, nodes, faces(nodes, 2)
    real(dp), intent(in) :: original(:)            !< coordinates about their mean, one node after the other
    type(interface_place), intent(in) :: place
    real(dp), intent(in) :: jump(:, :)             !< N, transposed
    real(dp), intent(out) :: matrix(size(jump, 1), size(jump, 2))
    type(status_type), intent(out) :: status       !< zero_length
    type(interface_place) :: here
    real(dp) :: turning(3, dim, dim, nodes)

    matrix = 0.0_dp
    here = place
    call turn_place(dim, nodes, faces, original, original, here, turning, status)
    if (status%code /= ok) return
    matrix = by_displacements(dim, nodes, faces, place%frame, place%frame, turning, original, jump)
  end subroutine layer_operator

  !> The separation from the two parts of the matrix, both from differences of displacements: a translation opens nothing.
  pure function layer_separation(dim, place, nodes, faces, u, jump, matrix) result(separation)
    integer, intent(in) :: dim
    type(interface_place), intent(in) :: place
    integer, intent(in) :: nodes, faces(nodes, 2)
    real(dp), intent(in) :: u(:)                        !< displacements of the element
    real(dp), intent(in) :: jump(:, :), matrix(:, :)    !< N, transposed, and `layer_operator`
    real(dp) :: separation(3)
    real(dp) :: relative(size(u))
    integer :: a

    do a = 0, size(u) - dim, dim
      relative(a + 1:a + dim) = u(a + 1:a + dim) - u(1:dim)
    end do
    separation = separation_at(dim, place, nodes, faces, u)
    separation(1:dim) = separation(1:dim) + matmul(relative, matrix - jump)
  end function layer_separation

end module elements_interface_layer
