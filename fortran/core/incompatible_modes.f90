! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Incompatible modes: their strains at a point, and how they are condensed. Strains are those of core_strains.
module core_incompatible_modes
  use core_kinds, only: dp
  use core_small_matrix, only: add_combination, add_product
  use core_strains, only: strain_matrix
  implicit none(type, external)
  private
  public :: mode_matrix, condense

contains

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
    real(dp) :: products(4), gradient(dim, dim), of_gradient(dim*dim, strains)
    integer :: i, k

    ! a direction acts on the strain like a node
    do i = 1, dim
      gradient(:, i) = ratio*xi*to_parent(:, i)
    end do
    call strain_matrix(dim, dim, dim, gradient, of_gradient)
    b(:dim**2, :) = of_gradient
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
    integer :: modes

    modes = size(all_force) - n
    across = 0.0_dp
    call add_product(n, modes, modes, all_stiffness(:n, n + 1:), -transpose(inverse), across)
    force = all_force(:n)
    call add_combination(n, modes, across, all_force(n + 1:), force)
    stiffness = all_stiffness(:n, :n)
    call add_product(n, n, modes, across, transpose(all_stiffness(n + 1:, :n)), stiffness)
  end subroutine condense

end module core_incompatible_modes
