! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> A continuum element in a call: its rule, material and motion, and what is asked for.
module host_solid_element
  use host_context, only: initial_stresses
  use host_kinds, only: dp, i4
  use host_materials, only: find_material, material_t
  use host_point, only: point_t
  use host_shape, only: rule_t
  implicit none (type, external)
  private
  public :: solid_t, begins, set_material, values_of_point

  !> Arrays belong to the caller.
  type :: solid_t
    type(rule_t), pointer :: rule => null()
    integer :: dim = 0, nodes = 0
    integer :: n = 0                    !< displacements of the nodes
    integer :: direct = 0               !< direct strains (host_kinematics)
    integer :: flat = 0                 !< direct strains by these displacements; without that between two planes
    integer :: strains = 0
    integer :: of_state(6) = 0, of_material(6) = 0   !< components in SVARS and of the material, of each strain
    real(dp) :: depth = 1               !< thickness, or the angle of axisymmetric elements; 1 in space
    integer(i4) :: request = 0          !< LFLAGS(3)
    logical :: finite = .false.         !< large displacements
    logical :: hybrid = .false.         !< the pressure is unknown (host_hybrid)
    logical :: smoothed = .false.       !< the mean stress is projected on functions of the pressure
    logical :: deforms = .false.        !< deformation gradients are needed, where displacements are large
    integer :: functions = 0            !< of the pressure, of elements that are not hybrid
    type(material_t), pointer :: material => null()   !< of the first layer
    type(material_t), pointer :: here => null()       !< of the point
    integer(i4), pointer, contiguous :: layers(:, :) => null()   !< (4, points) material, NPT, LAYER, KSPT; null without layers
    real(dp), pointer, contiguous :: x(:, :) => null(), u(:, :) => null()   !< (dim, nodes) before displacements; displacements
    real(dp), pointer, contiguous :: du(:, :) => null()          !< their increments; zero for the initial stress matrix
    real(dp), pointer, contiguous :: added(:) => null()          !< perturbation of all unknowns, whose stress may be asked for
    integer :: fields = 0               !< predefined
    real(dp), pointer, contiguous :: predef(:, :, :) => null()   !< (2, fields, nodes)
    real(dp), pointer, contiguous :: state(:, :) => null()       !< (values_of_point, points)
    real(dp), pointer, contiguous :: axes(:, :, :, :) => null()  !< (3, 3, 2, points), if the material is in them (host_axes)
  end type solid_t

contains

  !> Strains and stresses that SVARS hold for a point.
  pure integer function values_of_point(dim)
    integer, intent(in) :: dim
    values_of_point = merge(8, 12, dim == 2)
  end function values_of_point

  !> Whether the initial stresses are taken.
  pure logical function begins(this)
    type(solid_t), intent(in) :: this
    begins = this%request == initial_stresses
  end function begins

  !> Find the material of a point, and tell the point its layer.
  subroutine set_material(this, point)
    type(solid_t), intent(inout) :: this
    type(point_t), intent(inout) :: point
    this%here => this%material
    if (.not. associated(this%layers)) return
    associate (layer => this%layers(:, point%number))
      this%here => find_material(layer(1))
      point%npt = layer(2)
      point%layer = layer(3)
      point%kspt = layer(4)
    end associate
  end subroutine set_material
end module host_solid_element
