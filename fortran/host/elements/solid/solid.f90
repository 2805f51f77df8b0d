! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in continuum elements (CPS, CPE, CAX, C3D, CPEG). harness/uel/model/element_types.py lists the types.
!>
!> An element is composed of kinematics (host_solid_kinematics), the update of its points (host_solid_point) and additions
!> (host_solid_extras), in the loop of host_solid_integration.
!>
!> Values of PROPS and JPROPS: solid, composite and generalised in built_in.toml.
!>
!> CPE4, CAX4 and C3D8 replace the volume strain of the points by its mean over the element, as Abaqus does. CPS4R, CPE4R, CAX4R
!> and C3D8R have the uniform strain and hourglass control (host_hourglass), enhanced or with the hourglass stiffness parameter. If
!> the element has more unknowns than its nodes have displacements, the others are its pressure (host_hybrid).
!>
!> Large displacements: Cauchy stress, rotated and updated increment by increment with the strain and the rotation at the middle of
!> the increment (Jaumann rate; Hughes and Winget). The tangent leaves out the change of the volume and of the middle of the
!> increment. Incompatible modes are part of the deformation gradient (host_incompatible).
!>
!> Generalised plane strain (host_planes): behind the displacements of the nodes come the three unknowns of the reference node.
!>
!> Hyperelastic materials take their stress from the deformation gradient, divided by the stretch of *EXPANSION, the same in all
!> directions (Analysis User's Guide, Hyperelastic behavior of rubberlike materials). Forces are derivatives of the energy, the
!> tangent those of the forces (host_mean_dilatation_tangent); where the volume strain is the mean, the points share the change of
!> the volume.
!>
!> The initial stress matrix (host_context) is the geometric part of the tangent in large displacements, also where displacements
!> are small.
!>
!> With layers MATERIALLIB is the material of the first layer. Then all materials are in the directions of the points.
!>
!> The last of the predefined fields is the initial temperature; thermal strain is that of *EXPANSION since then.
!>
!> SVARS hold, for each point, E11 E22 E33 E12 S11 S22 S33 S12, in space with 13 and 23 after 12, in the directions of
!> *ORIENTATION where the section has one, as Abaqus prints them; in dynamic analyses then the forces of the last two
!> increments; then the directions of each point, if the material is in them (host_axes); last the incompatible modes, or the
!> moduli of the first tangent.
module host_solid
  use host_adapter, only: element_t, keep_forces
  use host_axes, only: values_of_axes
  use host_condensed_modes, only: integrate_with_modes
  use host_enhanced_kinematics, only: enhanced_t
  use host_hybrid, only: pressure_t
  use host_kinds, only: dp
  use host_kinematics, only: components
  use host_layout, only: j_composite_layers, j_solid_direct, j_solid_enhanced, j_solid_family, j_solid_mass_points, &
                         j_solid_modes, j_solid_points, j_solid_pressures, p_generalised_origin, p_solid_density, p_solid_depth, &
                         p_solid_hourglass
  use host_materials, only: needs_deformation
  use host_mean_dilatation, only: mean_dilatation_t
  use host_planes, only: between_planes_t, planes
  use host_shape, only: is_multilinear, rule_of
  use host_solid_element, only: begins, solid_t, values_of_point
  use host_solid_extras, only: extras_t
  use host_solid_integration, only: integrate
  use host_solid_kinematics, only: kinematics_t
  use host_solid_mass, only: mass_matrix
  use host_standard_kinematics, only: standard_t
  use host_uniform_kinematics, only: uniform_t
  implicit none (type, external)
  private
  public :: add_solid, describe, generalised, kinematics_of, solid

  integer, parameter :: of_first_tangent = 2   !< enhanced hourglass control with moduli of the first tangent

  ! kinematics of the elements of this thread, one after the other
  type(standard_t), target, save :: standard
  type(mean_dilatation_t), target, save :: mean_dilatation
  type(uniform_t), target, save :: uniform
  type(between_planes_t), target, save :: between
  type(enhanced_t), target, save :: enhanced
  !$omp threadprivate(standard, mean_dilatation, uniform, between, enhanced)

contains

  subroutine solid(element)
    type(element_t), intent(inout) :: element
    type(solid_t) :: this
    type(extras_t) :: extras
    call describe(this, element)
    this%hybrid = element%n > this%n
    if (size(element%jprops) >= j_composite_layers) then
      this%layers(1:4, 1:this%rule%points) => element%jprops(j_composite_layers:)
    end if
    call add_solid(this, extras, element, size(element%svars))
  end subroutine solid

  !> The same between two planes.
  subroutine generalised(element)
    type(element_t), intent(inout) :: element
    type(solid_t) :: this
    type(extras_t) :: extras
    call describe(this, element)
    call set_planes(this, element)
    call add_solid(this, extras, element, size(element%svars))
  end subroutine generalised

  !> Take from a call the rule, the material and the motion of the element, and what is asked of it.
  subroutine describe(this, element)
    type(solid_t), intent(inout) :: this
    type(element_t), intent(in) :: element
    this%rule => rule_of(int(element%jprops(j_solid_family)), int(element%jprops(j_solid_points)))
    this%material => element%material
    this%dim = this%rule%dim
    this%nodes = this%rule%nodes
    this%n = this%dim*this%nodes
    this%direct = element%jprops(j_solid_direct)
    this%flat = this%direct
    call set_strains(this, this%direct + 2*this%dim - 3)
    this%depth = merge(element%props(p_solid_depth), 1.0_dp, this%dim == 2)
    this%finite = element%finite
    this%request = element%request
    this%x => element%coords
    this%u(1:this%dim, 1:this%nodes) => element%u
    this%du(1:this%dim, 1:this%nodes) => element%du
    this%added => element%added
    this%fields = element%fields
    this%predef => element%predef
    this%state(1:values_of_point(this%dim), 1:this%rule%points) => element%svars
  end subroutine describe

  !> Add force, stiffness and mass of the displacements, and those of a pressure or of the planes.
  subroutine add_solid(this, extras, element, last)
    type(solid_t), intent(inout) :: this
    type(extras_t), intent(inout) :: extras
    type(element_t), intent(inout) :: element
    integer, intent(in) :: last                !< of SVARS that are described above
    class(kinematics_t), pointer :: kinematics
    integer :: behind, modes
    modes = element%jprops(j_solid_modes)
    behind = last - modes + 1
    if (element%jprops(j_solid_enhanced) == of_first_tangent) then
      behind = behind - 2
      extras%hourglass%moduli => element%svars(behind:behind + 1)
    end if
    if (this%material%local) then
      behind = behind - values_of_axes*this%rule%points
      this%axes(1:3, 1:3, 1:2, 1:this%rule%points) => element%svars(behind:)
    end if
    call keep_forces(element, size(this%state) + 1, behind)
    if (element%has_mass) call add_mass(this, element)
    if (.not. element%has_forces) return
    extras%hourglass%parameter = element%props(p_solid_hourglass)
    extras%hourglass%enhanced = element%jprops(j_solid_enhanced) /= 0
    call set_pressure(this, int(element%jprops(j_solid_pressures)))
    kinematics => kinematics_of(this)
    if (modes > 0) then
      call integrate_with_modes(this, enhanced, element%svars(last - modes + 1:last), element%rhs, element%amatrx, element%energy)
    else if (this%n + kinematics%others < element%n) then
      call integrate_part(this, kinematics, extras, element)
    else
      call integrate(this, kinematics, extras, element%rhs, element%amatrx, element%energy)
    end if
  end subroutine add_solid

  !> Add the mass.
  subroutine add_mass(this, element)
    type(solid_t), intent(in) :: this
    type(element_t), intent(inout) :: element
    real(dp) :: mass(this%n, this%n)
    call mass_matrix(rule_of(int(element%jprops(j_solid_family)), int(element%jprops(j_solid_mass_points))), &
                     this%flat > this%dim, element%props(p_solid_density)*this%depth, this%x, mass)
    element%mass(:this%n, :this%n) = mass
  end subroutine add_mass

  !> Its strains among the components of SVARS and of the material.
  pure subroutine set_strains(this, strains)
    type(solid_t), intent(inout) :: this
    integer, intent(in) :: strains
    this%strains = strains
    this%of_state(:strains) = components(strains, 2*this%dim)
    this%of_material(:strains) = components(strains, this%material%ntens)
  end subroutine set_strains

  !> Whether the mean stress is projected on so many functions of the pressure, and what depends on that.
  subroutine set_pressure(this, functions)
    type(solid_t), intent(inout) :: this
    integer, intent(in) :: functions
    this%functions = merge(0, functions, this%hybrid)
    this%smoothed = this%functions > 0 .and. this%rule%points > 1 .and. .not. begins(this)
    this%deforms = needs_deformation(this%material) .or. this%material%local .or. this%smoothed .or. this%hybrid
  end subroutine set_pressure

  !> Put the element between two planes.
  subroutine set_planes(this, element)
    type(solid_t), intent(inout) :: this
    type(element_t), intent(in) :: element
    this%direct = 3
    this%flat = 2
    call set_strains(this, 4)
    between%bounds%origin = element%props(p_generalised_origin)
    between%bounds%length = element%props(p_solid_depth)
    between%bounds%w = element%u(this%n + 1:)
    between%bounds%dw = element%du(this%n + 1:)
    between%others = planes
  end subroutine set_planes

  !> Kinematics of an element without incompatible modes.
  function kinematics_of(this) result(kinematics)
    type(solid_t), intent(in) :: this
    class(kinematics_t), pointer :: kinematics
    logical :: averaged
    ! full integration of elements with straight edges locks if the volume is preserved, but not in plane stress
    averaged = this%rule%points > 1 .and. is_multilinear(this%rule) .and. this%material%ntens /= 3
    averaged = averaged .and. .not. (this%hybrid .or. this%rule%reduced .or. this%functions > 0)
    if (this%flat < this%direct) then
      between%averaged = averaged
      kinematics => between
    else if (this%rule%reduced) then
      kinematics => uniform
    else if (averaged) then
      kinematics => mean_dilatation
    else
      kinematics => standard
    end if
  end function kinematics_of

  !> As integrate, where further unknowns come after the displacements, of a pressure (host_hybrid) or of another field.
  subroutine integrate_part(this, kinematics, extras, element)
    type(solid_t), intent(inout) :: this
    class(kinematics_t), intent(inout) :: kinematics
    type(extras_t), intent(inout) :: extras
    type(element_t), intent(inout) :: element
    real(dp) :: stiffness(this%n, this%n)
    type(pressure_t), target :: pressure
    integer :: n
    n = this%n
    stiffness = 0
    if (this%hybrid) then
      pressure%factors = element%u(n + 1:)
      pressure%added = element%added(n + 1:)
      extras%pressure => pressure
    end if
    call integrate(this, kinematics, extras, element%rhs, stiffness, element%energy)
    element%amatrx(:n, :n) = stiffness
    if (.not. this%hybrid) return
    element%rhs(n + 1:, 1) = pressure%residual
    if (element%of_stress) return
    element%amatrx(:n, n + 1:) = pressure%by_displacements
    element%amatrx(n + 1:, :n) = transpose(pressure%by_displacements)
    element%amatrx(n + 1:, n + 1:) = pressure%by_factors
  end subroutine integrate_part
end module host_solid
