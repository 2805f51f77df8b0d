! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Kinematics of continuum elements with incompatible modes (host_incompatible), whose values are unknowns behind those of the
!> nodes.
module host_enhanced_kinematics
  use host_forces, only: add_geometric_of => add_geometric, by_volume
  use host_gradients, only: gradients_of_points
  use host_incompatible, only: add_by_modes, enhance, enhanced_strains, gradient_in_the_middle, modes_t
  use host_kinds, only: dp
  use host_solid_element, only: solid_t
  use host_solid_kinematics, only: kinematics_t, make_room, strain_by
  implicit none (type, external)
  private
  public :: enhanced_t

  type, extends(kinematics_t) :: enhanced_t
    type(modes_t) :: modes
    real(dp), allocatable :: g_modes(:, :, :)   !< as g, of the nodes and the modes that act like nodes
    real(dp), allocatable :: exact(:, :)        !< stiffness of the modes by which the tangent is not exact, for their search
  contains
    procedure :: prepare
    procedure :: find_strain
    procedure :: strain_matrix
    procedure :: add_geometric
    procedure :: add_tangent
    procedure :: add_curvature
  end type enhanced_t

contains

  subroutine prepare(this, element)
    class(enhanced_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    integer :: nodes
    nodes = element%nodes
    call make_room(this, element)
    call make_modes(this, element)
    this%exact = 0
    this%interpolates = .true.
    this%now = element%x
    if (element%finite) this%now = element%x + element%u
    call gradients_of_points(element%rule, element%dim, element%x, this%g, this%volume)
    this%g_modes(:nodes, :, :) = this%g
    this%g_modes(nodes + 1:, :, :) = this%modes%gradient
    this%volume_before = this%volume
    if (element%finite) then
      call enhance(this%modes, element%rule, element%u, element%du, this%g_modes, this%volume, this%deformation)
    end if
    this%volume_now = this%volume
  end subroutine prepare

  subroutine make_modes(this, element)
    class(enhanced_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    if (allocated(this%g_modes)) then
      if (all(shape(this%g_modes) == [element%nodes + element%dim, element%dim, element%rule%points]) .and. &
          size(this%exact, 1) == this%others) return
      deallocate (this%g_modes, this%exact)
    end if
    allocate (this%g_modes(element%nodes + element%dim, element%dim, element%rule%points), this%exact(this%others, this%others))
  end subroutine make_modes

  subroutine find_strain(this, element, p, b, strain)
    class(enhanced_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(in) :: b(element%n + this%others, element%strains)
    real(dp), intent(out) :: strain(element%strains)
    if (element%finite) then
      this%gradient = gradient_in_the_middle(this%deformation(:, :, :, p))
      strain = strain_of(element%strains, this%gradient)
    else
      call strain_by(element%n, element%strains, b(:element%n, :), element%u, strain)
      strain = strain + matmul(this%modes%now, b(element%n + 1:, :))
    end if
  end subroutine find_strain

  !> Strains, with engineering shears, of a gradient of displacements: 11, 22, 12 in the plane.
  pure function strain_of(m, gradient) result(strain)
    integer, intent(in) :: m
    real(dp), intent(in) :: gradient(3, 3)
    real(dp) :: strain(m)
    if (m == 3) then
      strain = [gradient(1, 1), gradient(2, 2), gradient(1, 2) + gradient(2, 1)]
    else
      strain = [gradient(1, 1), gradient(2, 2), gradient(3, 3), gradient(1, 2) + gradient(2, 1), &
                gradient(1, 3) + gradient(3, 1), gradient(2, 3) + gradient(3, 2)]
    end if
  end function strain_of

  subroutine strain_matrix(this, element, p, b)
    class(enhanced_t), intent(in) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(out) :: b(element%n + this%others, element%strains)
    call enhanced_strains(this%modes, element%dim, element%nodes, element%strains, p, this%g_modes(:, :, p), b)
  end subroutine strain_matrix

  !> Of nodes and modes; those of the volume turn nothing, so that what the modulus has of them is taken back.
  subroutine add_geometric(this, element, p, b, stress, weight, modulus, stiffness)
    class(enhanced_t), intent(in) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(in) :: b(element%n + this%others, element%strains), stress(element%strains), weight
    real(dp), intent(inout) :: modulus(element%strains, element%strains)
    real(dp), intent(inout) :: stiffness(element%n + this%others, element%n + this%others)
    real(dp) :: part(size(b, 1))
    integer :: dim, turning, i, k
    dim = element%dim
    turning = dim*(element%nodes + dim)
    call add_geometric_of(dim, dim, element%strains, element%nodes + dim, this%g_modes(:, :, p), stress, weight, modulus, &
                          stiffness(:turning, :turning))
    part(:turning) = 2*weight*matmul(b(:turning, :), stress)
    part(turning + 1:) = weight*sum(stress(:dim))*this%modes%volume(:, p)
    do i = 1, size(b, 1) - turning
      k = turning + i
      stiffness(:, k) = stiffness(:, k) + this%modes%volume(i, p)*part
      stiffness(k, :) = stiffness(k, :) + this%modes%volume(i, p)*part
    end do
  end subroutine add_geometric

  !> The search for the modes needs their exact derivatives, as far as there are any.
  subroutine add_tangent(this, element, p, b, stress, weight, modulus, stiffness)
    class(enhanced_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(in) :: b(element%n + this%others, element%strains), stress(element%strains), weight
    real(dp), intent(inout) :: modulus(element%strains, element%strains)
    real(dp), intent(inout) :: stiffness(element%n + this%others, element%n + this%others)
    if (.not. (associated(element%axes) .or. allocated(element%here%hyperelastic))) then
      call add_by_modes(this%modes, element%dim, element%strains, p, this%gradient, this%g_modes(element%nodes + 1:, :, p), &
                        b(element%n + 1:, :), stress, modulus, weight, this%exact)
    end if
    call this%add_geometric(element, p, b, stress, weight, modulus, stiffness)
  end subroutine add_tangent

  subroutine add_curvature(this, element, p, b, unit, multiple, stiffness)
    class(enhanced_t), intent(in) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(in) :: b(element%n + this%others, element%strains), unit(element%strains), multiple
    real(dp), intent(inout) :: stiffness(element%n + this%others, element%n + this%others)
    real(dp) :: modulus(element%strains, element%strains)
    modulus = by_volume(element%strains, element%dim, unit)
    call this%add_geometric(element, p, b, unit, multiple, modulus, stiffness)
    stiffness = stiffness + multiple*matmul(b, matmul(modulus, transpose(b)))
  end subroutine add_curvature
end module host_enhanced_kinematics
