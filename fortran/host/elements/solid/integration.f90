! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The loop over the points of a continuum element: kinematics, the material of each point, and what the element has besides.
module host_solid_integration
  use host_context, only: added_stress, current, stress_matrix
  use host_forces, only: add_point
  use host_hybrid, only: keep_point, mean_stress_added
  use host_kinds, only: dp
  use host_kinematics, only: size_of
  use host_materials, only: has_fields, is_viscous
  use host_point, only: heat_t, move_to, point_t
  use host_solid_element, only: begins, solid_t
  use host_solid_extras, only: begin_extras, couple, extras_t, give_pressure, keep_modulus, resist, smooth_mean_stress, &
                               smooth_stresses
  use host_solid_kinematics, only: kinematics_t, strain_by
  use host_solid_point, only: begin_stress, energies_t, enter_point, response_t, turn_back, turn_point, update_point
  implicit none (type, external)
  private
  public :: integrate

contains

  !> Add force, tangent, state and energies; of the initial stresses without a tangent; or the initial stress matrix (host_context).
  subroutine integrate(this, kinematics, extras, force, stiffness, energy)
    type(solid_t), intent(inout) :: this
    class(kinematics_t), intent(inout) :: kinematics
    type(extras_t), intent(inout) :: extras
    real(dp), intent(inout) :: force(this%n + kinematics%others)
    real(dp), intent(inout) :: stiffness(this%n + kinematics%others, this%n + kinematics%others), energy(8)
    real(dp) :: b(size(force), this%strains), stress(this%strains), modulus(this%strains, this%strains)
    real(dp) :: stresses(this%strains, this%rule%points), weights(this%rule%points)
    type(point_t) :: point
    type(response_t) :: response
    type(energies_t) :: energies
    integer :: p
    call begin(this, kinematics, extras, point, energy, energies)
    do p = 1, this%rule%points
      call move_to(point, p)
      call enter_point(this, kinematics, extras%coupling, point, response)
      call kinematics%strain_matrix(this, p, b)
      call respond_at(this, kinematics, extras, point, b, stress, modulus, response, energies)
      if (stress_matrix(this%request)) then
        stresses(:, p) = stress
        weights(p) = response%weight
        cycle
      end if
      if (this%finite) call kinematics%add_tangent(this, p, b, stress, response%weight, modulus, stiffness)
      call add_point(size(force), this%strains, b, response%weight*stress, response%weight*modulus, force, stiffness)
    end do
    if (stress_matrix(this%request)) then
      call smooth_stresses(extras, this, stresses)
      call add_stress_matrix(this, kinematics, stresses, weights, stiffness)
      return
    end if
    call kinematics%finish(this, stiffness)
    call smooth_mean_stress(extras, this, kinematics, force, stiffness, energies)
    call keep_energies(this, energies, energy)
    call resist(extras%hourglass, this, kinematics, force, stiffness, energy(6))
  end subroutine integrate

  !> Begin with what all points have.
  subroutine begin(this, kinematics, extras, point, energy, energies)
    type(solid_t), intent(in) :: this
    class(kinematics_t), intent(inout) :: kinematics
    type(extras_t), intent(inout) :: extras
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: energy(8)
    type(energies_t), intent(inout) :: energies
    ! the first pass of an analysis, without displacements, sees the initial shape
    current%deformed = this%finite .and. any(abs(this%u) > 0)
    call kinematics%prepare(this)
    point%finite = this%finite
    if (has_fields(this%material) .or. associated(this%layers)) then
      point%length = size_of(this%rule, this%flat, kinematics%now, kinematics%volume_now)
    end if
    call begin_extras(extras, this, kinematics, point)
    energies%work = energy(2) + energy(dissipated(this))
  end subroutine begin

  !> Position of the dissipated energy in ENERGY.
  pure integer function dissipated(this)
    type(solid_t), intent(in) :: this
    dissipated = merge(3, 4, is_viscous(this%material))
  end function dissipated

  !> Stress and tangent of a point in global directions; state, energies and sums of the element have its part.
  subroutine respond_at(this, kinematics, extras, point, b, stress, modulus, response, energies)
    type(solid_t), intent(inout) :: this
    class(kinematics_t), intent(inout) :: kinematics
    type(extras_t), intent(inout) :: extras
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: b(this%n + kinematics%others, this%strains)
    real(dp), intent(out) :: stress(this%strains), modulus(this%strains, this%strains)
    type(response_t), intent(inout) :: response
    type(energies_t), intent(inout) :: energies
    real(dp) :: strain(this%strains)
    integer :: p
    p = point%number
    call kinematics%find_strain(this, p, b, strain)
    call turn_point(this, kinematics, point, response)
    response%weight = kinematics%volume(p)*this%depth
    call give_pressure(extras, this, kinematics, point, response, strain)
    if (begins(this)) then
      call begin_stress(this, point, response%weight, stress, modulus, energies)
    else
      if (associated(extras%coupling)) point%heat = heat_t()
      call update_point(this, point, strain, stress, modulus, response, energies)
      call keep_modulus(extras, this, kinematics, p, modulus)
      call turn_back(this, point, stress, modulus, response)
    end if
    ! in plane stress the thickness changes
    if (this%finite .and. this%here%ntens == 3) response%weight = response%weight*exp(this%state(3, p))
    call couple(extras, this, kinematics, point, response)
    if (this%request == added_stress) then
      call strain_by(size(b, 1), this%strains, b, this%added, strain)
      stress = matmul(modulus, strain)
      response%mean%stress = dot_product(response%mean%by_strains(:this%strains), strain)
      if (this%hybrid) stress(:this%direct) = stress(:this%direct) + mean_stress_added(extras%pressure, p)
    end if
    if (this%smoothed) then
      call keep_point(extras%smoothing, p, response%weight, this%direct, this%finite, response%mean, b)
    end if
  end subroutine respond_at

  !> Add the initial stress matrix of these stresses: the geometric part of the tangent in large displacements.
  subroutine add_stress_matrix(this, kinematics, stresses, weights, stiffness)
    type(solid_t), intent(in) :: this
    class(kinematics_t), intent(in) :: kinematics
    real(dp), intent(in) :: stresses(this%strains, this%rule%points), weights(this%rule%points)
    real(dp), intent(inout) :: stiffness(this%n + kinematics%others, this%n + kinematics%others)
    real(dp) :: b(this%n + kinematics%others, this%strains), modulus(this%strains, this%strains)
    integer :: p
    do p = 1, this%rule%points
      modulus = 0
      call kinematics%strain_matrix(this, p, b)
      call kinematics%add_geometric(this, p, b, stresses(:, p), weights(p), modulus, stiffness)
      stiffness = stiffness + weights(p)*matmul(b, matmul(modulus, transpose(b)))
    end do
  end subroutine add_stress_matrix

  !> Keep the elastic energy and what is dissipated.
  subroutine keep_energies(this, energies, energy)
    type(solid_t), intent(in) :: this
    type(energies_t), intent(in) :: energies
    real(dp), intent(inout) :: energy(8)
    real(dp) :: work
    work = energies%work
    ! networks of a hyperelastic material alone dissipate, and the trapezoidal rule is not exact
    if (allocated(this%material%hyperelastic)) work = energies%elastic + energy(dissipated(this)) + energies%flowed
    energy(2) = energies%elastic
    energy(dissipated(this)) = work - energies%elastic
  end subroutine keep_energies
end module host_solid_integration
