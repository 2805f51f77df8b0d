! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Additions to kinematics and material of continuum elements: temperatures at their corners (host_coupling), the pressure of hybrid
!> elements and the projection of the mean stress (host_hybrid), hourglass control (host_hourglass).
module host_solid_extras
  use host_coupling, only: add_heat_source, add_thermal_strain, coupling_t, shares
  use host_hourglass, only: resist_hourglass
  use host_hybrid, only: add_compatibility, begin_pressure, begin_smoothing, keep_temperature, mean_stress, pressure_t, smooth, &
                         smooth_by_temperature, smoothing_change, smoothing_t
  use host_hyperelastic, only: volume_of
  use host_kinds, only: dp
  use host_kinematics, only: components
  use host_materials, only: has_heat_terms, material_t
  use host_point, only: point_t
  use host_solid_element, only: begins, solid_t
  use host_solid_kinematics, only: kinematics_t
  use host_solid_point, only: energies_t, response_t
  use host_thermal, only: call_hetval
  implicit none (type, external)
  private
  public :: extras_t, begin_extras, couple, give_pressure, keep_modulus, resist, smooth_mean_stress, smooth_stresses

  !> Control of the hourglass modes of uniform kinematics.
  type :: hourglass_t
    real(dp) :: parameter = 0            !< hourglass stiffness parameter
    logical :: enhanced = .false.        !< by the moduli of the material in its place
    real(dp), pointer, contiguous :: moduli(:) => null()   !< of the first tangent, zero until it is known; null if there are none
    real(dp) :: tangent(6, 6) = 0        !< mean over the points
  end type hourglass_t

  type :: extras_t
    type(coupling_t), pointer :: coupling => null()
    type(pressure_t), pointer :: pressure => null()
    type(smoothing_t) :: smoothing       !< of elements that are smoothed
    type(hourglass_t) :: hourglass       !< of reduced ones
  end type extras_t

contains

  !> Begin the sums over the points.
  subroutine begin_extras(this, element, kinematics, point)
    type(extras_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    class(kinematics_t), intent(in) :: kinematics
    type(point_t), intent(inout) :: point
    if (element%smoothed) then
      call begin_smoothing(this%smoothing, element%rule, element%functions, element%x, kinematics%volume_before, &
                           element%n + kinematics%others)
    end if
    if (element%hybrid) then
      call begin_pressure(this%pressure, element%rule, element%x, kinematics%volume_before*element%depth)
      point%hybrid = .true.
    end if
  end subroutine begin_extras

  !> Give a point the mean stress of a hybrid element, and add it to the residual of the pressure: the change of its volume now, by
  !> the displacements less that of the material.
  subroutine give_pressure(this, element, kinematics, point, response, strain)
    type(extras_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    class(kinematics_t), intent(in) :: kinematics
    type(point_t), intent(inout) :: point
    type(response_t), intent(in) :: response
    real(dp), intent(in) :: strain(:)
    real(dp) :: expanded, of_material(2), difference, before
    integer :: p
    if (.not. element%hybrid) return
    p = point%number
    ! change of the volume of a hyperelastic material by free expansion
    expanded = 1
    if (allocated(element%here%hyperelastic)) expanded = (1 + response%thermal(1, 2))**3
    point%mean_stress = mean_stress(this%pressure, p)*expanded
    before = kinematics%volume_before(p)*element%depth
    of_material = [1, 0]
    if (allocated(element%here%hyperelastic)) of_material = volume_of(element%here%hyperelastic, point%mean_stress)
    difference = before*sum(strain(:element%direct))
    if (element%finite) difference = response%weight - before*expanded*of_material(1)
    call add_compatibility(this%pressure, p, difference, response%weight*sum(kinematics%b(:, :element%direct, p), 2), &
                           before*expanded**2*of_material(2))
  end subroutine give_pressure

  !> Add the heat of a point, and how its stress depends on the temperatures.
  subroutine couple(this, element, kinematics, point, response)
    type(extras_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    class(kinematics_t), intent(in) :: kinematics
    type(point_t), intent(inout) :: point
    type(response_t), intent(in) :: response
    real(dp), allocatable :: by_corners(:)
    integer :: p
    if (.not. associated(this%coupling) .or. begins(element)) return
    p = point%number
    associate (coupling => this%coupling, here => element%here, b => kinematics%b(:, :, p), m => element%strains)
      if (has_heat_terms(here)) then
        if (allocated(here%thermal%source)) call call_hetval(here%thermal%source, point)
        call add_heat_source(coupling, response%weight, b, point%heat, element%of_material(:m))
      end if
      if (allocated(here%expansion)) then
        call add_thermal_strain(coupling, response%weight, b, point%heat, response%stress_by_temperature(:m), &
                                response%rate(components(here%ntens, 6)), shares(element%rule, p, .false., coupling))
      end if
      if (.not. element%smoothed) return
      by_corners = coupling%shape(:size(coupling%heat))*sum(point%heat%stress_by_temperature(:3))/3
      if (allocated(here%expansion)) then
        by_corners = by_corners + shares(element%rule, p, .false., coupling)*response%mean_by_temperature
      end if
      call keep_temperature(this%smoothing, p, by_corners)
    end associate
  end subroutine couple

  !> Add to the stresses of all points, whose matrix is asked for, what the projection changes.
  subroutine smooth_stresses(this, element, stresses)
    type(extras_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    real(dp), intent(inout) :: stresses(:, :)
    integer :: p
    if (.not. element%smoothed) return
    this%smoothing%change = smoothing_change(this%smoothing)
    do p = 1, size(stresses, 2)
      stresses(:, p) = stresses(:, p) + this%smoothing%change(p)*this%smoothing%mean(p)%unit(:size(stresses, 1))
    end do
  end subroutine smooth_stresses

  !> Project the mean stress: add what that changes of forces, tangent, state and energies.
  subroutine smooth_mean_stress(this, element, kinematics, force, stiffness, energies)
    type(extras_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    class(kinematics_t), intent(in) :: kinematics
    real(dp), intent(inout) :: force(element%n + kinematics%others)
    real(dp), intent(inout) :: stiffness(element%n + kinematics%others, element%n + kinematics%others)
    type(energies_t), intent(inout) :: energies
    real(dp) :: b(element%n + kinematics%others, element%strains)
    integer :: p
    if (.not. element%smoothed) return
    call smooth(this%smoothing, force, stiffness)
    if (associated(this%coupling)) then
      call smooth_by_temperature(this%smoothing, this%coupling%tangent(:element%n, element%n + 1:))
    end if
    do p = 1, element%rule%points
      associate (change => this%smoothing%change(p), weight => this%smoothing%weight(p), of_point => this%smoothing%mean(p), &
                 stress => element%state(size(element%state, 1)/2 + 1:, p))
        if (element%finite) then
          call kinematics%strain_matrix(element, p, b)
          call kinematics%add_curvature(element, p, b, of_point%unit(:element%strains), weight*change, stiffness)
        end if
        energies%elastic = energies%elastic + weight*change*of_point%compressibility*(of_point%stress + 0.5_dp*change)
        energies%work = energies%work + weight*change*of_point%work
        stress = stress + change*of_point%unit_state(:size(stress))
      end associate
    end do
  end subroutine smooth_mean_stress

  !> Keep the modulus of a point for the hourglass control.
  subroutine keep_modulus(this, element, kinematics, p, modulus)
    type(extras_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    class(kinematics_t), intent(in) :: kinematics
    integer, intent(in) :: p
    real(dp), intent(in) :: modulus(element%strains, element%strains)
    if (.not. element%rule%reduced) return
    associate (tangent => this%hourglass%tangent(:element%strains, :element%strains))
      tangent = tangent + kinematics%volume(p)/sum(kinematics%volume)*modulus
    end associate
  end subroutine keep_modulus

  !> Add force and tangent of the hourglass control, and find its energy.
  subroutine resist(this, element, kinematics, force, stiffness, energy)
    type(hourglass_t), intent(inout) :: this
    type(solid_t), intent(in) :: element
    class(kinematics_t), intent(in) :: kinematics
    real(dp), intent(inout) :: force(:), stiffness(:, :), energy
    integer :: dim, m, n
    dim = element%dim
    m = element%strains
    n = element%n
    if (associated(this%moduli)) then
      if (.not. any(abs(this%moduli) > 0)) this%moduli = isotropic_part(dim, this%tangent(:m, :m))
    end if
    if (.not. element%rule%reduced) return
    call resist_hourglass(element%rule, kinematics%g_start(:, :dim), kinematics%volume_start*element%depth, this%parameter, &
                          enhanced_constants(this, element%material, dim, this%tangent(:m, :m)), element%finite, element%x, &
                          element%u, force(:n), stiffness(:n, :n), energy)
  end subroutine resist

  !> Young's modulus and Poisson's ratio of an isotropic material for the enhanced hourglass control, the modulus in plane
  !> strain over 1 - nu^2; none without that control. Of hyperelastic materials the shear modulus is that of the present tangent,
  !> as long as it is positive, and Poisson's ratio the initial one.
  pure function enhanced_constants(this, material, dim, tangent) result(constants)
    type(hourglass_t), intent(in) :: this
    type(material_t), intent(in) :: material
    integer, intent(in) :: dim
    real(dp), intent(in) :: tangent(:, :)
    real(dp), allocatable :: constants(:)
    real(dp) :: young, poisson, shear
    allocate (constants(0))
    if (.not. this%enhanced) return
    if (associated(this%moduli)) then
      constants = this%moduli
      return
    end if
    young = 1/material%compliance(1, 1)
    poisson = -material%compliance(1, 2)*young
    if (allocated(material%hyperelastic) .and. .not. allocated(material%networks)) then
      shear = shear_part(dim, tangent)
      if (shear > 0) young = 2*(1 + poisson)*shear
    end if
    if (material%ntens == 4) young = young/(1 - poisson**2)
    constants = [young, poisson]
  end function enhanced_constants

  !> Shear modulus of the isotropic part of a tangent, which is its mean over all directions (Voigt), or those of the plane.
  pure real(dp) function shear_part(dim, tangent)
    integer, intent(in) :: dim
    real(dp), intent(in) :: tangent(:, :)    !< direct components, then engineering shears
    real(dp) :: trace, cross
    integer :: i, n
    n = size(tangent, 1)
    trace = sum([(tangent(i, i), i=1, dim)])
    cross = sum(tangent(:dim, :dim)) - trace
    if (dim == 2) then
      shear_part = (trace - cross + 4*tangent(n, n))/8
    else
      shear_part = (trace - cross/2 + 3*(tangent(4, 4) + tangent(5, 5) + tangent(6, 6)))/15
    end if
  end function shear_part

  !> Young's modulus and Poisson's ratio of the isotropic part of a tangent; in the plane the modulus along an edge whose other
  !> direction is free, and 0. Zero unless the part is positive.
  pure function isotropic_part(dim, tangent) result(moduli)
    integer, intent(in) :: dim
    real(dp), intent(in) :: tangent(:, :)    !< direct components, then engineering shears
    real(dp) :: moduli(2), bulk, shear
    moduli = 0
    bulk = sum(tangent(:dim, :dim))/dim**2
    shear = shear_part(dim, tangent)
    if (.not. (bulk > 0 .and. shear > 0)) return
    if (dim == 2) then
      moduli(1) = 4*bulk*shear/(bulk + shear)
    else
      moduli = [9*bulk*shear/(3*bulk + shear), (3*bulk - 2*shear)/(2*(3*bulk + shear))]
    end if
  end function isotropic_part
end module host_solid_extras
