! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Kinematics of continuum elements: gradients, strain matrices, volumes and deformation gradients of all points, the strain of
!> each, and what the stress adds to the tangent. The loop over the points (host_solid_integration) knows no more of them.
!>
!> The unknowns are the displacements of the nodes, then those of the kinematics. Extensions give `prepare`, `find_strain` and
!> `add_geometric`, and override the rest where it differs.
module host_solid_kinematics
  use host_forces, only: add_point, by_volume
  use host_kinds, only: dp
  use host_solid_element, only: solid_t
  implicit none (type, external)
  private
  public :: kinematics_t, make_room, strain_by

  !> Of one element after the other: arrays stay, so that like elements do not allocate them again.
  type, abstract :: kinematics_t
    integer :: others = 0                    !< unknowns besides the displacements
    logical :: averaged = .false.            !< the volume strain of the points is its mean over the element
    logical :: interpolates = .false.        !< thermal strain is that of the point also in elements with straight edges
    real(dp), allocatable :: now(:, :)       !< (dim, nodes) places of the nodes; in small displacements those before
    real(dp), allocatable :: g(:, :, :)      !< (nodes, direct, points) gradients of the shape functions now
    real(dp), allocatable :: b(:, :, :)      !< (displacements, strains, points) strains by the displacements now
    real(dp), allocatable :: volume(:)       !< (points) now, without the depth; what forces are integrated with
    real(dp), allocatable :: volume_now(:)   !< the same of the points alone, where they share the volume
    real(dp), allocatable :: volume_before(:)   !< before any displacement; in large ones if the element deforms
    real(dp), allocatable :: deformation(:, :, :, :)   !< (3, 3, 2, points) gradients at both ends, if the element deforms
    real(dp) :: gradient(3, 3) = 0           !< of the increment at its middle, at the point of find_strain; in large displacements
    real(dp), allocatable :: g_start(:, :)   !< (nodes, direct) before any displacement, for the hourglass control
    real(dp) :: volume_start = 0             !< volume of g_start
  contains
    procedure(prepare), deferred :: prepare
    procedure(find_strain), deferred :: find_strain
    procedure(add_geometric), deferred :: add_geometric
    procedure :: strain_matrix
    procedure :: add_tangent
    procedure :: add_curvature
    procedure :: finish
  end type kinematics_t

  abstract interface
    !> Find what all points have.
    subroutine prepare(this, element)
      import :: kinematics_t, solid_t
      class(kinematics_t), intent(inout) :: this
      type(solid_t), intent(in) :: element
    end subroutine prepare

    !> Strain of a point: the total one in small displacements, that of the increment in large ones, with its gradient.
    subroutine find_strain(this, element, p, b, strain)
      import :: dp, kinematics_t, solid_t
      class(kinematics_t), intent(inout) :: this
      type(solid_t), intent(in) :: element
      integer, intent(in) :: p
      real(dp), intent(in) :: b(element%n + this%others, element%strains)   !< of strain_matrix
      real(dp), intent(out) :: strain(element%strains)
    end subroutine find_strain

    !> Add the change of the force for a stress that rotates with the material and keeps its magnitude, to stiffness and modulus
    !> (host_forces).
    subroutine add_geometric(this, element, p, b, stress, weight, modulus, stiffness)
      import :: dp, kinematics_t, solid_t
      class(kinematics_t), intent(in) :: this
      type(solid_t), intent(in) :: element
      integer, intent(in) :: p
      real(dp), intent(in) :: b(element%n + this%others, element%strains), stress(element%strains), weight
      real(dp), intent(inout) :: modulus(element%strains, element%strains)
      real(dp), intent(inout) :: stiffness(element%n + this%others, element%n + this%others)
    end subroutine add_geometric
  end interface

contains

  !> Strains by all unknowns, transposed.
  subroutine strain_matrix(this, element, p, b)
    class(kinematics_t), intent(in) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(out) :: b(element%n + this%others, element%strains)
    b(:element%n, :) = this%b(:, :, p)
  end subroutine strain_matrix

  !> Add the geometric stiffness of the stress in large displacements; the modulus gets its part too.
  subroutine add_tangent(this, element, p, b, stress, weight, modulus, stiffness)
    class(kinematics_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(in) :: b(element%n + this%others, element%strains), stress(element%strains), weight
    real(dp), intent(inout) :: modulus(element%strains, element%strains)
    real(dp), intent(inout) :: stiffness(element%n + this%others, element%n + this%others)
    call this%add_geometric(element, p, b, stress, weight, modulus, stiffness)
  end subroutine add_tangent

  !> Add the tangent of a given multiple of a stress, volume included.
  subroutine add_curvature(this, element, p, b, unit, multiple, stiffness)
    class(kinematics_t), intent(in) :: this
    type(solid_t), intent(in) :: element
    integer, intent(in) :: p
    real(dp), intent(in) :: b(element%n + this%others, element%strains), unit(element%strains), multiple
    real(dp), intent(inout) :: stiffness(element%n + this%others, element%n + this%others)
    real(dp) :: modulus(element%strains, element%strains), none(element%strains), no_force(element%n + this%others)
    modulus = by_volume(element%strains, element%direct, unit)
    none = 0
    no_force = 0
    call this%add_geometric(element, p, b, unit, multiple, modulus, stiffness)
    call add_point(size(no_force), element%strains, b, none, multiple*modulus, no_force, stiffness)
  end subroutine add_curvature

  !> Add what the tangent has of all points together.
  subroutine finish(this, element, stiffness)
    class(kinematics_t), intent(in) :: this
    type(solid_t), intent(in) :: element
    real(dp), intent(inout) :: stiffness(element%n + this%others, element%n + this%others)
  end subroutine finish

  !> Strains of unknowns by their strain matrix.
  pure subroutine strain_by(n, m, b, u, strain)
    integer, intent(in) :: n, m
    real(dp), intent(in) :: b(n, m), u(n)
    real(dp), intent(out) :: strain(m)
    integer :: k
    do k = 1, m
      strain(k) = sum(b(:, k)*u)
    end do
  end subroutine strain_by

  !> Make the arrays of the size of an element.
  subroutine make_room(this, element)
    class(kinematics_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    integer :: points
    points = element%rule%points
    if (allocated(this%b)) then
      if (all(shape(this%b) == [element%n, element%strains, points]) .and. size(this%g, 1) == element%nodes &
          .and. size(this%g, 2) == element%direct) return
      deallocate (this%now, this%g, this%b, this%volume, this%volume_now, this%volume_before, this%deformation, this%g_start)
    end if
    allocate (this%now(element%dim, element%nodes), this%g(element%nodes, element%direct, points), &
              this%b(element%n, element%strains, points), this%volume(points), this%volume_now(points), &
              this%volume_before(points), this%deformation(3, 3, 2, points), this%g_start(element%nodes, element%direct))
  end subroutine make_room
end module host_solid_kinematics
