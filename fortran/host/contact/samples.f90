! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Samples of a secondary surface, projected onto a face of the main surface.
module host_contact_samples
  use host_kinds, only: dp, i8
  use host_contact_derivatives, only: differentiate
  use host_contact_faces, only: evaluate, foot_t, monomials, polynomial_of
  implicit none (type, external)
  private
  public :: sample_t, new_sample, add_stiffness

  !> Largest number of nodes of two faces.
  integer, parameter :: most = 16

  !> A sample: its foot point, and shares of its nodes, those of the secondary surface first.
  type :: sample_t
    type(foot_t) :: foot
    integer :: nodes
    real(dp) :: motion(most, 0:2)    !< in its motion relative to the foot point (0), and in the tangents (1, 2)
    real(dp) :: load(most, 0:2)      !< in a force on it (0), and the derivatives along the surface (1, 2), apart from the sign
  end type sample_t

contains

  !> Project a sample.
  pure function new_sample(own, shapes, loads, nodes, coordinates, natural) result(sample)
    real(dp), intent(in), contiguous :: own(:)   !< shape functions of its nodes of the secondary surface
    real(dp), intent(in), contiguous :: shapes(:, :), loads(:, :)   !< (terms, nodes) of the face
    integer(i8), intent(in), contiguous :: nodes(:)   !< of the face, from 0
    real(dp), intent(in), contiguous :: coordinates(:, :), natural(:)
    type(sample_t) :: sample
    real(dp) :: values(size(shapes, 1)), first(size(shapes, 1), size(natural))
    real(dp) :: second(size(shapes, 1), size(natural), size(natural))
    integer :: a, k, l
    sample%foot = evaluate(polynomial_of(shapes, nodes, coordinates), size(coordinates, 1), natural)
    call monomials(size(natural), size(shapes, 1), natural, values, first, second)
    l = size(own)
    sample%nodes = l + size(nodes)
    sample%motion = 0
    sample%motion(:l, 0) = own
    sample%load(:, :) = sample%motion
    do k = 1, size(nodes)
      sample%motion(l + k, 0) = -dot_product(values, shapes(:, k))
      sample%load(l + k, 0) = -dot_product(values, loads(:, k))
      do a = 1, size(natural)
        sample%motion(l + k, a) = dot_product(first(:, a), shapes(:, k))
        sample%load(l + k, a) = dot_product(first(:, a), loads(:, k))
      end do
    end do
  end function new_sample

  !> Add the derivatives of the nodal forces of a contact force along the normal and of a friction force that keeps its direction.
  !>
  !> With the total force f, the contact force F and the shares l of node k, its force l_k f changes by
  !> f sum over a of l_k,a dxi_a + l_k F tau_a tilt_a du.
  pure subroutine add_stiffness(sample, d, u, gap, normal_force, friction, matrix)
    type(sample_t), intent(in) :: sample
    integer, intent(in) :: d, u                  !< components of a vector, unknowns
    real(dp), intent(in) :: gap, normal_force, friction(d)
    real(dp), intent(inout) :: matrix(u, u)      !< transposed
    real(dp), dimension(u, sample%foot%along) :: along, across, natural_by, tilt
    real(dp) :: force(d), turned(u, d), moved(u)
    integer :: a, e, k
    associate (foot => sample%foot)
      force = normal_force*foot%normal(:d) - friction
      do a = 1, foot%along
        along(:, a) = spread_out(sample%motion(:sample%nodes, 0), foot%tangents(:d, a))
        across(:, a) = spread_out(sample%motion(:sample%nodes, a), foot%normal(:d))
      end do
      call differentiate(foot, gap, along, across, natural_by, tilt)
      turned = matmul(tilt, transpose(normal_force*foot%tangents(:d, :foot%along)))
      do k = 1, sample%nodes
        moved = matmul(natural_by, sample%load(k, 1:foot%along))
        do e = 1, d
          associate (row => matrix(:, (k - 1)*d + e))
            row = row + (sample%load(k, 0)*turned(:, e) + force(e)*moved)
          end associate
        end do
      end do
    end associate
  end subroutine add_stiffness

  !> Components of a vector at each node, times the share of the node.
  pure function spread_out(shares, vector) result(values)
    real(dp), intent(in), contiguous :: shares(:), vector(:)
    real(dp) :: values(size(shares)*size(vector))
    integer :: k
    do k = 1, size(shares)
      values((k - 1)*size(vector) + 1:k*size(vector)) = shares(k)*vector
    end do
  end function spread_out
end module host_contact_samples
