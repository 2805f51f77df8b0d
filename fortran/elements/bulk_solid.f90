! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> A continuum element next to an interface: traction from its displacements, area or volume, local eigenvalue. Quads have four or
!> eight nodes, bricks eight or 20.
!>
!> The interface is the face where the last parent coordinate (eta, zeta) is 1 in the element below it and -1 in that above; the
!> other parent coordinates are those of the interface.
module elements_bulk_solid
  use core_kinds, only: dp
  use core_quadrature, only: gauss_point
  use core_rotation, only: traction_operator
  use core_serendipity, only: quad8_gradient, brick_gradient
  use core_shape_functions, only: quad_gradient
  use core_status, only: status_type, ok, inside_out
  use core_strains, only: strain_matrix
  use elements_face_eigenvalue, only: face_eigenvalue
  implicit none(type, external)
  private
  public :: solid_gradient, solid_traction, solid_size, solid_face_eigenvalue

contains

  !> Matrix that takes the displacements of an element to sigma.n in the components of a frame at a point.
  pure subroutine solid_traction(dim, nodes, coordinates, point, frame, stiffness, matrix, status)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: coordinates(dim, nodes)
    real(dp), intent(in) :: point(dim)                            !< parent coordinates
    real(dp), intent(in) :: frame(3, 3)                           !< rows tau, n and zero, or s, n and t
    real(dp), intent(in) :: stiffness(3*(dim - 1), 3*(dim - 1))   !< D, stress
    real(dp), intent(out) :: matrix(dim, dim*nodes)
    type(status_type), intent(out) :: status                      !< inside_out with the Jacobian
    real(dp) :: gradient(dim, nodes), by_strain(dim, 3*(dim - 1))
    integer :: a

    call solid_gradient(dim, nodes, coordinates, point, gradient, status)
    by_strain = matmul(traction_operator(dim, frame), stiffness)
    if (dim == 2) then
      do a = 1, nodes
        matrix(:, 2*a - 1) = by_strain(:, 1)*gradient(1, a) + by_strain(:, 3)*gradient(2, a)
        matrix(:, 2*a) = by_strain(:, 2)*gradient(2, a) + by_strain(:, 3)*gradient(1, a)
      end do
    else
      do a = 1, nodes
        matrix(:, 3*a - 2) = by_strain(:, 1)*gradient(1, a) + by_strain(:, 4)*gradient(2, a) + by_strain(:, 5)*gradient(3, a)
        matrix(:, 3*a - 1) = by_strain(:, 2)*gradient(2, a) + by_strain(:, 4)*gradient(1, a) + by_strain(:, 6)*gradient(3, a)
        matrix(:, 3*a) = by_strain(:, 3)*gradient(3, a) + by_strain(:, 5)*gradient(1, a) + by_strain(:, 6)*gradient(2, a)
      end do
    end if
  end subroutine solid_traction

  !> Area or volume.
  pure subroutine solid_size(dim, nodes, coordinates, value, status)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: coordinates(dim, nodes)
    real(dp), intent(out) :: value
    type(status_type), intent(out) :: status        !< inside_out with the area or a Jacobian
    real(dp) :: gradient(dim, nodes), point(dim), weight
    integer :: k, per_side

    value = 0.0_dp
    if (dim == 2 .and. nodes == 4) then
      value = quad_area(coordinates(:, 1:4))
      status = status_type(merge(ok, inside_out, value > 0.0_dp), 0, value, 0.0_dp)
      return
    end if
    per_side = points_per_side(dim, nodes)
    do k = 1, per_side**dim
      call gauss_point(dim, per_side, k, point, weight)
      call solid_gradient(dim, nodes, coordinates, point, gradient, status)
      if (status%code /= ok) return
      value = value + weight*status%value
    end do
  end subroutine solid_size

  !> Area of a quad of four nodes; negative where they run clockwise.
  pure function quad_area(coordinates) result(area)
    real(dp), intent(in) :: coordinates(2, 4)
    real(dp) :: area
    real(dp) :: diagonal_13(2), diagonal_24(2)

    diagonal_13 = coordinates(:, 3) - coordinates(:, 1)
    diagonal_24 = coordinates(:, 4) - coordinates(:, 2)
    area = 0.5_dp*(diagonal_13(1)*diagonal_24(2) - diagonal_13(2)*diagonal_24(1))
  end function quad_area

  !> lambda of a face, see elements_face_eigenvalue; with as many points along each direction as an edge has nodes. The traction of
  !> a point is that of the samples in the element that stand for it.
  pure subroutine solid_face_eigenvalue(dim, nodes, coordinates, points, samples, shares, frames, areas, stiffness, lambda, &
    joint, status)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: coordinates(dim, nodes)
    integer, intent(in) :: points                     !< of the face
    real(dp), intent(in) :: samples(:, :, :)          !< (dim, samples, points) parent coordinates
    real(dp), intent(in) :: shares(:, :)              !< (samples, points) of the samples
    real(dp), intent(in) :: frames(3, 3, points)
    real(dp), intent(in) :: areas(points)             !< of the face that each of them stands for
    real(dp), intent(in) :: stiffness(3*(dim - 1), 3*(dim - 1))   !< D, stress
    real(dp), intent(out) :: lambda(2)                !< of shear and normal traction, stress/length
    real(dp), intent(out) :: joint                    !< of both, see there
    type(status_type), intent(out) :: status          !< inside_out with the Jacobian
    real(dp) :: energy(dim*nodes, dim*nodes), traction(dim*points, dim*nodes), part(dim, dim*nodes)
    integer :: i, k

    lambda = 0.0_dp
    joint = 2.0_dp
    call strain_energy(dim, nodes, coordinates, stiffness, energy, status)
    if (status%code /= ok) return
    traction = 0.0_dp
    do k = 1, points
      do i = 1, size(shares, 1)
        if (.not. abs(shares(i, k)) > 0.0_dp) cycle
        call solid_traction(dim, nodes, coordinates, samples(:, i, k), frames(:, :, k), stiffness, part, status)
        if (status%code /= ok) return
        traction(dim*(k - 1) + 1:dim*k, :) = traction(dim*(k - 1) + 1:dim*k, :) + (sqrt(areas(k))*shares(i, k))*part
      end do
    end do
    call face_eigenvalue(coordinates, energy, traction, lambda, joint, status)
  end subroutine solid_face_eigenvalue

  !> Stiffness matrix, in the plane for thickness 1.
  pure subroutine strain_energy(dim, nodes, coordinates, stiffness, energy, status)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: coordinates(dim, nodes), stiffness(3*(dim - 1), 3*(dim - 1))
    real(dp), intent(out) :: energy(dim*nodes, dim*nodes)
    type(status_type), intent(out) :: status
    real(dp) :: gradient(dim, nodes), b(dim*nodes, 3*(dim - 1)), point(dim), weight
    integer :: k, per_side

    energy = 0.0_dp
    per_side = points_per_side(dim, nodes)
    do k = 1, per_side**dim
      call gauss_point(dim, per_side, k, point, weight)
      call solid_gradient(dim, nodes, coordinates, point, gradient, status)
      if (status%code /= ok) return
      call strain_matrix(dim, dim, nodes, transpose(gradient), b)
      energy = energy + (weight*status%value)*matmul(b, matmul(stiffness, transpose(b)))
    end do
  end subroutine strain_energy

  !> Of the rule of full integration: as many along each direction as an edge has nodes.
  pure integer function points_per_side(dim, nodes)
    integer, intent(in) :: dim, nodes

    points_per_side = merge(2, 3, nodes == 2**dim)
  end function points_per_side

  !> Derivatives of the shape functions by position; the value of the status is the Jacobian.
  pure subroutine solid_gradient(dim, nodes, coordinates, point, gradient, status)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: coordinates(dim, nodes), point(dim)
    real(dp), intent(out) :: gradient(dim, nodes)
    type(status_type), intent(out) :: status
    real(dp) :: jacobian

    if (dim == 3) then
      call brick_gradient(nodes, coordinates, point, gradient, jacobian)
    else if (nodes == 4) then
      call quad_gradient(coordinates, point, gradient, jacobian)
    else
      call quad8_gradient(coordinates, point, gradient, jacobian)
    end if
    status = status_type(merge(ok, inside_out, jacobian > 0.0_dp), 0, jacobian, 0.0_dp)
  end subroutine solid_gradient

end module elements_bulk_solid
