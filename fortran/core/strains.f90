! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Strains of continuum elements by their unknowns, at a point: of the displacements of the nodes, and of incompatible modes.
!> core_mean_dilatation has the mean volume strain of an element (B-bar).
!>
!> Strains are 11, 22, 12 in the plane; 11, 22, 33, 12 in axisymmetric elements; 11, 22, 33, 12, 13, 23 in space (engineering
!> shear). `direct` is the number of direct strains by the displacements: 2 in the plane, else 3.
module core_strains
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: strain_matrix, mode_matrix, condense

contains

  !> Strains by displacements, transposed.
  pure subroutine strain_matrix(dim, direct, nodes, g, b)
    integer, intent(in) :: dim, direct, nodes
    real(dp), intent(in) :: g(nodes, direct)         !< derivatives of the shape functions; about an axis the third is n/r
    real(dp), intent(out) :: b(dim, nodes, direct + 2*dim - 3)
    integer, parameter :: first(3) = [1, 1, 2], second(3) = [2, 3, 3]
    integer :: i

    b = 0.0_dp
    do i = 1, dim
      b(i, :, i) = g(:, i)
    end do
    if (direct > dim) b(1, :, direct) = g(:, direct)
    do i = 1, 2*dim - 3
      b(first(i), :, direct + i) = g(:, second(i))
      b(second(i), :, direct + i) = g(:, first(i))
    end do
  end subroutine strain_matrix

  !> Strains by incompatible modes, transposed, which let elements with straight edges bend.
  !>
  !> The gradient of the displacements is enhanced, not the displacements (J.C. Simo, M.S. Rifai, Int. J. for Numerical
  !> Methods in Engineering 29 (1990) 1595; Abaqus Theory Guide, Continuum elements with incompatible modes): with the parent
  !> coordinate xi_a, its gradient in the middle of the element and the Jacobians j there and at the point
  !>
  !>     H = sum over a of alpha_a (x) (j0/j) xi_a grad xi_a,
  !>
  !> one vector alpha_a for each direction. In plane strain and in space the volume has its own modes, beta (j0/j) times the
  !> products of two and three parent coordinates, in equal parts in each direction, which keep nearly incompressible elements from
  !> locking. These are 4, 5 and 13 modes, as many as CPS4I, CPE4I and C3D8I have in Abaqus. Their mean is zero, so a constant
  !> strain needs none of them, whatever the shape.
  pure subroutine mode_matrix(dim, modes, strains, xi, to_parent, ratio, b)
    integer, intent(in) :: dim, modes, strains
    real(dp), intent(in) :: xi(dim)               !< parent coordinates of the point
    real(dp), intent(in) :: to_parent(dim, dim)   !< gradients of the parent coordinates in the middle, a row each
    real(dp), intent(in) :: ratio                 !< j0/j
    real(dp), intent(out) :: b(modes, strains)
    real(dp) :: products(4)
    integer :: i, k

    ! a direction acts on the strain like a node
    call strain_matrix(dim, dim, dim, reshape([(ratio*xi*to_parent(:, i), i=1, dim)], [dim, dim]), b(:dim**2, :))
    products = xi(1)*xi(2)
    if (dim == 3) products(2:) = [xi(2)*xi(3), xi(3)*xi(1), product(xi)]
    do k = dim**2 + 1, modes
      b(k, :dim) = ratio*products(k - dim**2)/dim
      b(k, dim + 1:) = 0.0_dp
    end do
  end subroutine mode_matrix

  !> Force and stiffness of the nodes, whose unknowns come first, where those after them take the values that leave no force on
  !> them.
  pure subroutine condense(n, inverse, all_force, all_stiffness, force, stiffness)
    integer, intent(in) :: n                                 !< unknowns of the nodes
    real(dp), intent(in) :: inverse(:, :)                    !< of the stiffness of the others
    real(dp), intent(in) :: all_force(:), all_stiffness(:, :)
    real(dp), intent(out) :: force(n), stiffness(n, n)
    real(dp) :: across(n, size(all_force) - n)

    across = matmul(all_stiffness(:n, n + 1:), inverse)
    force = all_force(:n) - matmul(across, all_force(n + 1:))
    stiffness = all_stiffness(:n, :n) - matmul(across, all_stiffness(n + 1:, :n))
  end subroutine condense

end module core_strains
