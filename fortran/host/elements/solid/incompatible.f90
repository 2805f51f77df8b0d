! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Incompatible modes of CPS4I, CPE4I and C3D8I, which let elements with straight edges bend. Their strains are those of
!> core_incompatible_modes, and core_incompatible_mode_search finds them.
!>
!> In large displacements they enhance the deformation gradient (J.C. Simo, F. Armero, Int. J. for Numerical Methods in Engineering
!> 33 (1992) 1413): with the parent coordinate xi_k, its gradient in the middle of the initial element, and the Jacobians j there
!> and at the point
!>
!>     F = v (1 + sum over nodes of u_a (x) grad N_a + sum over k of alpha_k (x) (j0/j) xi_k grad xi_k),
!>     ln v = sum over the modes of the volume of beta (j0/j) (product of parent coordinates)/dim,
!>
!> so that alpha_k acts like the displacement of a node. It turns with the element, and v does not turn at all: a rigid rotation
!> changes no stress. The mean of each mode over the initial element is zero: a uniform deformation needs none. v is in the
!> directions of the displacements; the logarithm of it is linear in its modes, whose strain is the same in any shape.
module host_incompatible
  use core_rotation, only: cross
  use core_small_matrix, only: cofactors, determinant, invert
  use core_incompatible_modes, only: mode_matrix
  use core_strains, only: strain_matrix
  use host_context, only: current
  use host_gradients, only: gradient_of
  use host_kinds, only: dp
  use host_protect, only: escape
  use host_shape, only: parent_place, rule_of, rule_t
  implicit none (type, external)
  private
  public :: modes_t, add_by_modes, begin_modes, enhance, enhanced_strains, gradient_in_the_middle

  type :: modes_t
    real(dp), allocatable :: gradient(:, :, :)   !< (dim, dim, points) of the "nodes" k, in the initial shape
    real(dp), allocatable :: volume(:, :)        !< (modes of the volume, points) their part of each direct strain
    real(dp), allocatable :: start(:), now(:)    !< values at the start of the increment and now: alpha, then beta
  end type modes_t

contains

  !> Set the modes up, which begin with the values at the start of the increment.
  subroutine begin_modes(this, rule, strains, x, start)
    type(modes_t), intent(out) :: this
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: strains
    real(dp), intent(in) :: x(rule%dim, rule%nodes), start(:)
    type(rule_t), pointer :: middle
    real(dp) :: inverse(rule%dim, rule%dim), at_middle, b(size(start), strains)
    integer :: dim, p, k, i
    dim = rule%dim
    this%start = start
    this%now = start
    allocate (this%gradient(dim, dim, rule%points), this%volume(size(start) - dim**2, rule%points))
    middle => rule_of(rule%family, 1)
    call invert(dim, matmul(x, middle%dn(:, :, 1)), inverse, at_middle)
    do p = 1, rule%points
      call mode_matrix(dim, size(start), strains, parent_place(rule, p), inverse, &
                       at_middle/determinant(matmul(x, rule%dn(:, :, p))), b)
      ! the direct strain along i by the displacement along i is the gradient along i
      do i = 1, dim
        do k = 1, dim
          this%gradient(k, i, p) = b(dim*(k - 1) + i, i)
        end do
      end do
      this%volume(:, p) = b(dim**2 + 1:, 1)
    end do
  end subroutine begin_modes

  !> Gradients of the nodes and of the modes, which follow like further nodes, and volumes, both before any displacement on entry
  !> and now at the end; and deformation gradients at both ends of the increment. Leaves the pass if a point is inside out.
  subroutine enhance(this, rule, u, du, g, volume, f)
    type(modes_t), intent(in) :: this
    type(rule_t), intent(in) :: rule
    real(dp), dimension(rule%dim, rule%nodes), intent(in) :: u, du
    real(dp), intent(inout) :: g(rule%nodes + rule%dim, rule%dim, rule%points), volume(rule%points)
    real(dp), intent(out) :: f(3, 3, 2, rule%points)
    real(dp) :: stretch(3, 3), inverse(3, 3)
    integer :: dim, p, n
    dim = rule%dim
    n = rule%nodes
    do p = 1, rule%points
      f(:, :, 1, p) = stretched(dim, deformation(dim, n, u - du, this%start, g(:, :, p)), this%start, this%volume(:, p))
      stretch = deformation(dim, n, u, this%now, g(:, :, p))
      f(:, :, 2, p) = stretched(dim, stretch, this%now, this%volume(:, p))
      volume(p) = volume(p)*determinant(f(:, :, 2, p))
      if (.not. volume(p) > 0) then
        current%distorted = p
        call escape()
      end if
      inverse = transpose(cofactors(stretch))/determinant(stretch)
      g(:, :, p) = matmul(g(:, :, p), inverse(:dim, :dim))
    end do
  end subroutine enhance

  !> Deformation gradient without the modes of the volume.
  pure function deformation(dim, nodes, u, values, g) result(f)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: u(dim, nodes), values(:), g(nodes + dim, dim)
    real(dp) :: f(3, 3)
    integer :: i
    f = gradient_of(dim, dim, nodes, u, g(:nodes, :))
    f(:dim, :dim) = f(:dim, :dim) + matmul(reshape(values(:dim**2), [dim, dim]), g(nodes + 1:, :))
    do i = 1, 3
      f(i, i) = f(i, i) + 1
    end do
  end function deformation

  !> The same with them.
  pure function stretched(dim, deformation, values, volume) result(f)
    integer, intent(in) :: dim
    real(dp), intent(in) :: deformation(3, 3), values(:), volume(:)
    real(dp) :: f(3, 3)
    f = deformation
    f(:dim, :dim) = f(:dim, :dim)*exp(dot_product(values(dim**2 + 1:), volume))
  end function stretched

  !> Strains by all unknowns at a point, transposed: of the nodes, of the modes that act like nodes, of those of the volume.
  pure subroutine enhanced_strains(this, dim, nodes, strains, point, g, b)
    type(modes_t), intent(in) :: this
    integer, intent(in) :: dim, nodes, strains, point
    real(dp), intent(in) :: g(nodes + dim, dim)
    real(dp), intent(out) :: b(dim*(nodes + dim) + size(this%volume, 1), strains)
    integer :: n
    n = dim*(nodes + dim)
    call strain_matrix(dim, dim, nodes + dim, g, b(:n, :))
    b(n + 1:, :dim) = spread(this%volume(:, point), 2, dim)
    b(n + 1:, dim + 1:) = 0
  end subroutine enhanced_strains

  !> Add to the stiffness of the modes the two terms that the usual tangent omits: strain increment and spin belong to the middle of
  !> the increment, not to its end; and the volume changes. The material is isotropic: if strain and state turn, its stress turns
  !> with them.
  pure subroutine add_by_modes(this, dim, strains, point, gradient, g, b, stress, modulus, volume, stiffness)
    type(modes_t), intent(in) :: this
    integer, intent(in) :: dim, strains, point
    real(dp), intent(in) :: gradient(3, 3)       !< of the increment, at its middle
    real(dp), intent(in) :: g(dim, dim)          !< of the modes that act like nodes, now
    real(dp), intent(in) :: b(:, :)              !< (modes, strains)
    real(dp), intent(in) :: stress(strains), modulus(strains, strains), volume
    real(dp), intent(inout) :: stiffness(:, :)
    real(dp), dimension(3, 3) :: full, strain, before, after, change, moved, spin
    real(dp) :: half(3), rate(3), by_mode(strains, size(b, 1))
    integer :: i, k, mode
    full = tensor(dim, stress)
    strain = 0.5_dp*(gradient + transpose(gradient))
    before = -0.5_dp*gradient
    after = 0.5_dp*gradient
    do i = 1, 3
      before(i, i) = before(i, i) + 1
      after(i, i) = after(i, i) + 1
    end do
    half = 0.5_dp*axial(gradient)
    do mode = 1, size(b, 1)
      ! gradient of the change now, and that of the increment's middle
      change = 0
      if (mode <= dim**2) then
        k = (mode - 1)/dim + 1
        i = mod(mode - 1, dim) + 1
        change(i, :dim) = g(k, :)
      else
        do i = 1, dim
          change(i, i) = this%volume(mode - dim**2, point)
        end do
      end if
      moved = matmul(before, matmul(change, after))
      rate = 0.5_dp*axial(moved)
      rate = 2/(1 + dot_product(half, half))*(rate + cross(half, rate))
      spin = cross_matrix(rate)
      moved = 0.5_dp*(moved + transpose(moved) - change - transpose(change)) - matmul(spin, strain) + matmul(strain, spin)
      spin = spin - cross_matrix(axial(change))
      by_mode(:, mode) = matmul(modulus, components_of(dim, strains, moved, 2.0_dp)) &
                         + components_of(dim, strains, matmul(spin, full) - matmul(full, spin), 1.0_dp) &
                         + stress*(change(1, 1) + change(2, 2) + change(3, 3))
    end do
    stiffness = stiffness + volume*matmul(b, by_mode)
  end subroutine add_by_modes

  !> Symmetric tensor of 11, 22, 12 or of 11, 22, 33, 12, 13, 23.
  pure function tensor(dim, values) result(full)
    integer, intent(in) :: dim
    real(dp), intent(in) :: values(:)
    real(dp) :: full(3, 3)
    integer :: i
    full = 0
    do i = 1, dim
      full(i, i) = values(i)
    end do
    full(1, 2) = values(dim + 1)
    full(2, 1) = full(1, 2)
    if (dim == 2) return
    full(1, 3) = values(5)
    full(3, 1) = values(5)
    full(2, 3) = values(6)
    full(3, 2) = values(6)
  end function tensor

  !> The components; shear is the factor of those of shear.
  pure function components_of(dim, strains, full, shear) result(values)
    integer, intent(in) :: dim, strains
    real(dp), intent(in) :: full(3, 3), shear
    real(dp) :: values(strains)
    integer :: i
    do i = 1, dim
      values(i) = full(i, i)
    end do
    values(dim + 1) = shear*full(1, 2)
    if (dim == 3) values(5:6) = shear*[full(1, 3), full(2, 3)]
  end function components_of

  !> Vector of the skew part of a matrix, which is its cross product.
  pure function axial(matrix) result(vector)
    real(dp), intent(in) :: matrix(3, 3)
    real(dp) :: vector(3)
    vector = 0.5_dp*[matrix(3, 2) - matrix(2, 3), matrix(1, 3) - matrix(3, 1), matrix(2, 1) - matrix(1, 2)]
  end function axial

  !> Matrix of the cross product with a vector.
  pure function cross_matrix(vector) result(matrix)
    real(dp), intent(in) :: vector(3)
    real(dp) :: matrix(3, 3)
    matrix = reshape([0.0_dp, vector(3), -vector(2), -vector(3), 0.0_dp, vector(1), vector(2), -vector(1), 0.0_dp], [3, 3])
  end function cross_matrix

  !> Gradient of the displacements of an increment by the places at its middle.
  pure function gradient_in_the_middle(f) result(gradient)
    real(dp), intent(in) :: f(3, 3, 2)      !< at both ends
    real(dp) :: gradient(3, 3), middle(3, 3)
    middle = 0.5_dp*(f(:, :, 1) + f(:, :, 2))
    gradient = matmul(f(:, :, 2) - f(:, :, 1), transpose(cofactors(middle)))/determinant(middle)
  end function gradient_in_the_middle
end module host_incompatible
