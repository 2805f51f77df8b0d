! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Gradients of displacements, strain matrices and deformation gradients at the points of an element.
module host_gradients
  use core_mean_dilatation, only: mean_volume_strain, set_volume_strain
  use core_small_matrix, only: cofactors, determinant
  use core_strains, only: strain_matrix
  use host_kinds, only: dp
  use host_kinematics, only: gradients, mean_gradients
  use host_shape, only: rule_t
  implicit none (type, external)
  private
  public :: all_gradients, average_volume_strain, carry, find_deformation, gradient_of, gradients_of_points

  real(dp), parameter :: identity(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])

contains

  !> Gradients, strain matrices and volumes of all points.
  subroutine all_gradients(rule, direct, strains, averaged, x, g, b, volume)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: direct, strains
    logical, intent(in) :: averaged    !< the volume strain of the points is its mean
    real(dp), intent(in) :: x(rule%dim, rule%nodes)
    real(dp), intent(out) :: g(rule%nodes, direct, rule%points), b(rule%dim*rule%nodes, strains, rule%points)
    real(dp), intent(out) :: volume(rule%points)
    integer :: p
    call gradients_of_points(rule, direct, x, g, volume)
    do p = 1, rule%points
      call strain_matrix(rule%dim, direct, rule%nodes, g(:, :, p), b(:, :, p))
    end do
    if (averaged) call average_volume_strain(rule, direct, strains, volume, b)
  end subroutine all_gradients

  !> Give all points the mean volume strain of the first direct strains.
  pure subroutine average_volume_strain(rule, direct, strains, volume, b)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: direct, strains
    real(dp), intent(in) :: volume(rule%points)
    real(dp), intent(inout) :: b(rule%dim*rule%nodes, strains, rule%points)
    real(dp) :: mean(rule%dim*rule%nodes)
    integer :: p
    mean = mean_volume_strain(direct, rule%dim*rule%nodes, strains, rule%points, volume, b)
    do p = 1, rule%points
      call set_volume_strain(direct, rule%dim*rule%nodes, strains, mean, b(:, :, p))
    end do
  end subroutine average_volume_strain

  !> Gradients and volumes of all points. Where one stands for all of a quadrilateral or hexahedron they are the mean ones; those of
  !> section points of layers differ from the mean as they do at the points, so that their own mean is that of the element.
  subroutine gradients_of_points(rule, direct, x, g, volume)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: direct
    real(dp), intent(in) :: x(rule%dim, rule%nodes)
    real(dp), intent(out) :: g(rule%nodes, direct, rule%points), volume(rule%points)
    real(dp) :: mean(rule%nodes, direct), whole, own(rule%nodes, direct)
    integer :: p
    if (rule%reduced) call mean_gradients(rule%family, direct, x, mean, whole)
    if (rule%reduced .and. rule%points == 1) then
      g(:, :, 1) = mean
      volume = whole
      return
    end if
    do p = 1, rule%points
      call gradients(rule, direct, p, x, g(:, :, p), volume(p))
    end do
    if (.not. rule%reduced) return
    own = 0
    do p = 1, rule%points
      own = own + volume(p)/sum(volume)*g(:, :, p)
    end do
    g = g + spread(mean - own, 3, rule%points)
    volume = volume*(whole/sum(volume))
  end subroutine gradients_of_points

  !> With large displacements elements of one point take the shape of the strain from the mean deformation gradient
  !> F = 1 + u g_start, so that the gradients are those before any displacement times its inverse; and its volume from
  !> the mean of the gradients now, the difference in equal parts to the directions of the displacements. So does Abaqus
  !> R2018x (reactions of C3D8RT and CAX4RT); in the plane the two are the same.
  pure subroutine carry(dim, direct, strains, nodes, g_start, u, g, b)
    integer, intent(in) :: dim, direct, strains, nodes
    real(dp), intent(in) :: g_start(nodes, direct), u(dim, nodes)
    real(dp), intent(inout) :: g(nodes, direct), b(dim, nodes, strains)     !< on entry the mean now
    real(dp) :: f(3, 3), c(3, 3), change(dim, nodes)
    integer :: i
    change = sum(b(:, :, :direct), 3)
    f = identity + gradient_of(dim, direct, nodes, u, g_start)
    c = cofactors(f)/determinant(f)
    g(:, :dim) = matmul(g_start(:, :dim), transpose(c(:dim, :dim)))
    if (direct > dim) g(:, direct) = g_start(:, direct)/f(3, 3)
    call strain_matrix(dim, direct, nodes, g, b)
    change = (change - sum(b(:, :, :direct), 3))/dim
    do i = 1, dim
      b(:, :, i) = b(:, :, i) + change
    end do
  end subroutine carry

  !> Gradient (3, 3) of displacements.
  pure function gradient_of(dim, direct, nodes, u, g) result(gradient)
    integer, intent(in) :: dim, direct, nodes
    real(dp), intent(in) :: u(dim, nodes), g(nodes, direct)
    real(dp) :: gradient(3, 3)
    gradient = 0
    gradient(:dim, :dim) = matmul(u, g(:, :dim))
    if (direct > dim) gradient(3, 3) = dot_product(u(1, :), g(:, 3))
  end function gradient_of

  !> Deformation gradients of all points at both ends of the increment; with the mean change of volume where it
  !> is averaged.
  subroutine find_deformation(rule, direct, averaged, x, u, du, f, initial)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: direct
    logical, intent(in) :: averaged
    real(dp), dimension(rule%dim, rule%nodes), intent(in) :: x, u, du
    real(dp), intent(out) :: f(3, 3, 2, rule%points)
    real(dp), intent(out) :: initial(rule%points)   !< volumes of the points before any displacement
    real(dp) :: g(rule%nodes, direct, rule%points), total, swept(2)
    integer :: p, k
    total = 0
    swept = 0
    call gradients_of_points(rule, direct, x, g, initial)
    do p = 1, rule%points
      f(:, :, 1, p) = identity + gradient_of(rule%dim, direct, rule%nodes, u - du, g(:, :, p))
      f(:, :, 2, p) = identity + gradient_of(rule%dim, direct, rule%nodes, u, g(:, :, p))
      total = total + initial(p)
      do k = 1, 2
        swept(k) = swept(k) + initial(p)*determinant(f(:, :, k, p))
      end do
    end do
    do p = 1, merge(rule%points, 0, averaged)
      do k = 1, 2
        f(:direct, :direct, k, p) = f(:direct, :direct, k, p)*(swept(k)/total/determinant(f(:, :, k, p)))**(1.0_dp/direct)
      end do
    end do
  end subroutine find_deformation

end module host_gradients
