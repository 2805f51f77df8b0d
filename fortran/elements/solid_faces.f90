! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Faces of quads of four nodes and bricks of eight, as Abaqus counts them in CPS4 and C3D8, and the places on a face where an
!> interface may need the stress: the nodes of the face, the Gauss points next to them, and the middle.
module elements_solid_faces
  use core_kinds, only: dp
  use core_quadrature, only: gauss_abscissa
  use elements_continuum_solid, only: node_places
  implicit none(type, external)
  private
  public :: face_nodes, gauss_of_face, face_places, node_place, gauss_place, middle_place, serves

  integer, parameter :: quad_faces(2, 4) = reshape([1, 2, 2, 3, 3, 4, 4, 1], [2, 4])
  integer, parameter :: brick_faces(4, 6) = reshape( &
    [1, 2, 3, 4, 5, 8, 7, 6, 1, 5, 6, 2, 2, 6, 7, 3, 3, 7, 8, 4, 4, 8, 5, 1], [4, 6])

  !> Gauss point next to a node.
  integer, parameter :: gauss_of_node(8) = [1, 2, 4, 3, 5, 6, 8, 7]

contains

  !> Nodes of a face.
  pure function face_nodes(dim, face) result(nodes)
    integer, intent(in) :: dim, face
    integer :: nodes(2**(dim - 1))

    if (dim == 2) then
      nodes = quad_faces(:, face)
    else
      nodes = brick_faces(:, face)
    end if
  end function face_nodes

  !> Gauss points of the element next to the nodes of a face.
  pure function gauss_of_face(dim, face) result(points)
    integer, intent(in) :: dim, face
    integer :: points(2**(dim - 1))

    points = gauss_of_node(face_nodes(dim, face))
  end function gauss_of_face

  !> Parent coordinates of the places on a face.
  pure function face_places(dim, face) result(places)
    integer, intent(in) :: dim, face
    real(dp) :: places(dim, 2**dim + 1)
    real(dp) :: corners(dim, 2**(dim - 1)), middle(dim)
    integer :: i, nodes(dim, 2**dim)

    nodes = node_places(dim)
    corners = nodes(:, face_nodes(dim, face))
    middle = sum(corners, 2)/size(corners, 2)
    do i = 1, size(corners, 2)
      places(:, node_place(i)) = corners(:, i)
      places(:, gauss_place(dim, i)) = middle + gauss_abscissa*(corners(:, i) - middle)
    end do
    places(:, middle_place(dim)) = middle
  end function face_places

  !> Position among the places of node i of the face.
  pure integer function node_place(i)
    integer, intent(in) :: i

    node_place = i
  end function node_place

  !> Of the Gauss point of the face next to node i of it.
  pure integer function gauss_place(dim, i)
    integer, intent(in) :: dim, i

    gauss_place = 2**(dim - 1) + i
  end function gauss_place

  !> Of the middle.
  pure integer function middle_place(dim)
    integer, intent(in) :: dim

    middle_place = 2**dim + 1
  end function middle_place

  !> Whether the Gauss point of the element next to node i of the face stands for a place: it is the one next to it. All of them
  !> stand for the middle.
  pure logical function serves(dim, i, place)
    integer, intent(in) :: dim, i, place

    serves = any(place == [node_place(i), gauss_place(dim, i), middle_place(dim)])
  end function serves

end module elements_solid_faces
