! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Hourglass control of elements with four or eight nodes that have one integration point, or one for each section point of layers.
!> Section points through the layers resist bending of the stack by themselves. That Abaqus controls all patterns of such elements
!> nevertheless is inferred.
!>
!> h is a pattern of 1 and -1 at the nodes, B the mean gradients of the shape functions over the volume V before any
!> displacement. gamma = h - B (x h) is the part of the pattern that is in no linear displacement, q = u gamma is the hourglass
!> displacement (D.P. Flanagan, T. Belytschko, Int. J. for Numerical Methods in Engineering 17 (1981) 679). With large displacements
!> F^T q takes the place of q, with the mean deformation gradient F = 1 + u B. The energy is q K q/2.
!>
!> Total stiffness, which is Abaqus/Standard's own choice: K is diagonal, of the parameter r (0.005 times the shear modulus
!> unless the deck has another)
!>
!>   in the plane and about an axis   r V sum(B**2)/(h gamma)**2, the sum over both directions
!>   in space                         0.2357 r V sum(B(:, i)**2) in direction i
!>
!> How this is known: *HOURGLASS STIFFNESS, and reactions and displacements of single elements that public codes have of
!> Abaqus: skewed CAX4RT with and without NLGEOM and skewed C3D8RT with it (R2018x), a C3D8R brick (2024), square CPS4R
!> (2018). For CPE4R, and CPS4R of other shapes, it is inferred.
!>
!> Enhanced: K is that of the assumed strains of T. Belytschko, L.P. Bindeman, Computer Methods in Applied Mechanics and
!> Engineering 88 (1991) 311 and 105 (1993) 225, to which enhanced assumed strains reduce: of a strain that is linear in a parent
!> coordinate, the components in the direction of this coordinate are free. The stress is uniaxial along the other edge, in space
!> plane in the two other edges, and rectangles and bricks bend exactly. Directions are those of the edges in the middle of the
!> element, so the result is the same in rotated and in sheared elements. About an axis it is that of plane strain: the wall of a
!> cylinder bends exactly, and the hoop strain by hourglass displacements, smaller by the size of the element over the radius, is
!> left out. That Abaqus uses these values is inferred from its manual, which names enhanced assumed strains. With hyperelastic
!> materials the shear modulus is that of the present tangent, so that K has no derivative in the tangent of the element:
!> deformation gradients that Abaqus 2020 prints for a block of 512 C3D8R are nearer to that than to the initial modulus
!> (harness/uel/procedures/fidelity.md).
module host_hourglass
  use host_kinds, only: dp
  use host_shape, only: hourglass_shapes, rule_of, rule_t
  implicit none (type, external)
  private
  public :: resist_hourglass

  integer, parameter :: modes_of(3) = [0, 1, 4]           !< hourglass patterns by the dimension
  real(dp), parameter :: factor_in_space = 0.2357_dp     !< sqrt(2)/6 in four digits, as Abaqus has it

contains

  !> Add force and tangent of the hourglass control; its energy.
  subroutine resist_hourglass(rule, b, volume, parameter, enhanced, finite, x, u, force, stiffness, energy)
    type(rule_t), intent(in) :: rule                  !< reduced
    real(dp), intent(in) :: b(rule%nodes, rule%dim), volume    !< mean gradients and volume before any displacement
    real(dp), intent(in) :: parameter                 !< hourglass stiffness parameter of the total stiffness
    real(dp), intent(in) :: enhanced(:)               !< Young's modulus and Poisson's ratio instead; none: total stiffness
    logical, intent(in) :: finite                     !< large displacements
    real(dp), intent(in) :: x(rule%dim, rule%nodes), u(rule%dim, rule%nodes)
    real(dp), intent(inout) :: force(rule%dim, rule%nodes), stiffness(rule%dim*rule%nodes, rule%dim*rule%nodes), energy
    real(dp), dimension(rule%nodes, modes_of(rule%dim)) :: h, gamma
    real(dp) :: q(rule%dim, modes_of(rule%dim)), k(rule%dim, modes_of(rule%dim), rule%dim, modes_of(rule%dim))
    type(rule_t), pointer :: middle
    integer :: dim
    dim = rule%dim
    middle => rule_of(rule%family, 1)
    h = hourglass_shapes(dim)
    gamma = h - matmul(b, matmul(x, h))
    q = matmul(u, gamma)
    if (size(enhanced) > 0) then
      call enhanced_stiffness(dim, volume, enhanced(1), enhanced(2), matmul(x, middle%dn(:, :, 1)), k)
    else
      call total_stiffness(dim, volume*parameter, b, dot_product(h(:, 1), gamma(:, 1)), k)
    end if
    if (finite) then
      call add_large(dim, modes_of(dim), b, gamma, q, k, u, force, stiffness, energy)
    else
      call add_small(dim, modes_of(dim), gamma, q, k, force, stiffness, energy)
    end if
  end subroutine resist_hourglass

  !> Force, tangent and energy of small displacements.
  pure subroutine add_small(dim, modes, gamma, q, k, force, stiffness, energy)
    integer, intent(in) :: dim, modes
    real(dp), intent(in) :: gamma(2**dim, modes), q(dim, modes), k(dim, modes, dim, modes)
    real(dp), intent(inout) :: force(dim, 2**dim), stiffness(dim*2**dim, dim*2**dim), energy
    real(dp) :: modal(dim, modes), part(2**dim)
    integer :: i, j, mode, node
    energy = 0
    do mode = 1, modes
      do i = 1, dim
        modal(i, mode) = sum(k(:, :, i, mode)*q)
      end do
      energy = energy + 0.5_dp*sum(modal(:, mode)*q(:, mode))
      do node = 1, 2**dim
        force(:, node) = force(:, node) + modal(:, mode)*gamma(node, mode)
      end do
      do j = 1, dim
        do i = 1, dim
          if (.not. any(abs(k(i, :, j, mode)) > 0)) cycle
          part = matmul(gamma, k(i, :, j, mode))
          do node = 1, 2**dim
            stiffness(i::dim, dim*(node - 1) + j) = stiffness(i::dim, dim*(node - 1) + j) + part*gamma(node, mode)
          end do
        end do
      end do
    end do
  end subroutine add_small

  !> The same of large displacements.
  pure subroutine add_large(dim, modes, b, gamma, q, k, u, force, stiffness, energy)
    integer, intent(in) :: dim, modes
    real(dp), intent(in) :: b(2**dim, dim), gamma(2**dim, modes), q(dim, modes), k(dim*modes, dim*modes), u(dim, 2**dim)
    real(dp), intent(inout) :: force(dim*2**dim), stiffness(dim*2**dim, dim*2**dim), energy
    real(dp) :: f(dim, dim), moved(dim*modes), modal(dim*modes), slope(dim*2**dim, dim*modes), part(dim*2**dim)
    real(dp) :: between(2**dim, 2**dim)
    integer :: i, j, mode, n
    f = matmul(u, b)
    do i = 1, dim
      f(i, i) = f(i, i) + 1
    end do
    ! change of (F^T q)_i with the displacements
    do mode = 1, modes
      do i = 1, dim
        n = (mode - 1)*dim + i
        moved(n) = dot_product(f(:, i), q(:, mode))
        do j = 1, dim
          slope(j::dim, n) = f(j, i)*gamma(:, mode) + q(j, mode)*b(:, i)
        end do
      end do
    end do
    modal = matmul(k, moved)
    energy = 0.5_dp*dot_product(moved, modal)
    force = force + matmul(slope, modal)
    do n = 1, dim*modes
      part = matmul(slope, k(:, n))
      do i = 1, size(part)
        stiffness(:, i) = stiffness(:, i) + part*slope(i, n)
      end do
    end do
    between = matmul(matmul(gamma, transpose(reshape(modal, [dim, modes]))), transpose(b))
    between = between + transpose(between)
    do i = 1, dim
      stiffness(i::dim, i::dim) = stiffness(i::dim, i::dim) + between
    end do
  end subroutine add_large

  !> Diagonal stiffness by the gradients.
  pure subroutine total_stiffness(dim, modulus, b, norm, k)
    integer, intent(in) :: dim
    real(dp), intent(in) :: modulus           !< parameter times volume
    real(dp), intent(in) :: b(2**dim, dim)
    real(dp), intent(in) :: norm              !< h gamma
    real(dp), intent(out) :: k(dim, modes_of(dim), dim, modes_of(dim))
    integer :: i, mode
    k = 0
    do mode = 1, modes_of(dim)
      do i = 1, dim
        k(i, mode, i, mode) = factor_in_space*modulus*sum(b(:, i)**2)
        if (dim == 2) k(i, mode, i, mode) = modulus*sum(b**2)/norm**2
      end do
    end do
  end subroutine total_stiffness

  !> Stiffness of assumed strains, isotropic.
  pure subroutine enhanced_stiffness(dim, volume, young, poisson, edge, k)
    integer, intent(in) :: dim
    real(dp), intent(in) :: volume, young     !< in plane strain Young's modulus over 1 - nu^2, which is that along an edge
    real(dp), intent(in) :: poisson
    real(dp), intent(in) :: edge(dim, dim)    !< of the parallelogram in the middle
    real(dp), intent(out) :: k(dim*modes_of(dim), dim*modes_of(dim))
    real(dp) :: strain(3, dim*modes_of(dim)), plane(3, 3), along(1, dim*modes_of(dim))
    integer :: i, j, across
    k = 0
    if (dim == 2) then
      do i = 1, dim
        call strain_along(edge(:, i), 0, along)
        k = k + volume/3*young*matmul(transpose(along), along)
      end do
    else
      plane = young/(1 - poisson**2)*reshape([1.0_dp, poisson, 0.0_dp, poisson, 1.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, &
                                              (1 - poisson)/2], [3, 3])
      do across = 1, dim
        i = mod(across, 3) + 1
        j = mod(across + 1, 3) + 1
        call strain_between(edge(:, i), edge(:, j), pattern_of(i, across), pattern_of(j, across), strain)
        k = k + volume/3*matmul(transpose(strain), matmul(plane, strain))
        call strain_along(edge(:, across), 3*dim, along)
        k = k + volume/9*young*matmul(transpose(along), along)
      end do
    end if
    k = k/4.0_dp**dim       ! hourglass displacements are sums over the nodes
  end subroutine enhanced_stiffness

  !> Pattern that is the product of two parent coordinates.
  pure integer function pattern_of(i, j)
    integer, intent(in) :: i, j
    pattern_of = 6 - i - j
  end function pattern_of

  !> Strain along an edge, by hourglass displacements of which `before` come first.
  pure subroutine strain_along(edge, before, strain)
    real(dp), intent(in) :: edge(:)
    integer, intent(in) :: before
    real(dp), intent(out) :: strain(:, :)
    strain = 0
    strain(1, before + 1:before + size(edge)) = edge/dot_product(edge, edge)
  end subroutine strain_along

  !> Strains 11, 22 and 12 (engineering shear) in the plane of two edges, by the hourglass displacements of two patterns:
  !> the symmetric part of displacement times gradient, which is dual to the edges in their plane.
  pure subroutine strain_between(first, second, pattern_1, pattern_2, strain)
    real(dp), intent(in) :: first(3), second(3)
    integer, intent(in) :: pattern_1, pattern_2     !< that vary along the first, and along the second edge
    real(dp), intent(out) :: strain(3, 12)
    real(dp) :: axes(3, 2), g(2, 2), dual(2, 2)
    integer :: k, place
    axes(:, 1) = first/norm2(first)
    axes(:, 2) = second - dot_product(second, axes(:, 1))*axes(:, 1)
    axes(:, 2) = axes(:, 2)/norm2(axes(:, 2))
    g(:, 1) = matmul(first, axes)
    g(:, 2) = matmul(second, axes)
    dual(:, 1) = [g(2, 2), -g(1, 2)]
    dual(:, 2) = [-g(2, 1), g(1, 1)]
    dual = dual/(g(1, 1)*g(2, 2) - g(1, 2)*g(2, 1))
    strain = 0
    do k = 1, 2
      place = 3*(merge(pattern_1, pattern_2, k == 1) - 1)
      strain(1, place + 1:place + 3) = axes(:, 1)*dual(1, k)
      strain(2, place + 1:place + 3) = axes(:, 2)*dual(2, k)
      strain(3, place + 1:place + 3) = axes(:, 1)*dual(2, k) + axes(:, 2)*dual(1, k)
    end do
  end subroutine strain_between
end module host_hourglass
