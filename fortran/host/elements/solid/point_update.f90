! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> A point of a continuum element: its layer, fields, constants and directions, its stress and tangent, its state and energies.
module host_solid_point
  use host_axes, only: carry_axes, turn_heat, turn_matrix
  use host_coupling, only: coupling_t, find_shape, interpolate_fields, set_temperature, thermal_strain
  use host_hybrid, only: mean_response_t
  use host_initial_stress, only: begin_point
  use host_kinds, only: dp
  use host_kinematics, only: components, point_position, rotated, rotation_of
  use host_materials, only: elastic_bulk_modulus, elastic_energy, has_fields, has_heat_terms, material_t, needs_deformation, &
                            set_constants, stress_update, thickness_strain
  use host_point, only: point_t
  use host_solid_element, only: begins, set_material, solid_t, values_of_point
  use host_solid_kinematics, only: kinematics_t
  use host_usdfld, only: call_usdfld
  implicit none (type, external)
  private
  public :: response_t, energies_t, begin_stress, enter_point, turn_back, turn_point, update_point

  !> A point besides its stress and tangent; directions of the material until these are turned.
  type :: response_t
    real(dp) :: weight = 0                 !< volume, by which forces are integrated
    real(dp) :: thermal(6, 2) = 0          !< strain at the start of the increment and at its end
    real(dp) :: rate(6) = 0                !< derivative of the latter by the temperature
    real(dp) :: middle(3, 3) = 0           !< directions of the strain (rows), if the material is in those of the point
    real(dp) :: stress_by_temperature(6) = 0   !< by thermal strain
    real(dp) :: mean_by_temperature = 0    !< the same of the mean stress
    type(mean_response_t) :: mean
  end type response_t

  !> Sums over the points.
  type :: energies_t
    real(dp) :: elastic = 0      !< now
    real(dp) :: work = 0         !< of the stresses, with what was stored and dissipated before the increment
    real(dp) :: flowed = 0       !< dissipated by networks in the increment
  end type energies_t

contains

  !> Enter a point: find its material, its fields as USDFLD leaves them, the constants at them, and its thermal strain.
  subroutine enter_point(this, kinematics, coupling, point, response)
    type(solid_t), intent(inout) :: this
    class(kinematics_t), intent(in) :: kinematics
    type(coupling_t), intent(in), pointer :: coupling
    type(point_t), intent(inout) :: point
    type(response_t), intent(inout) :: response
    real(dp) :: axes(3, 3)
    integer :: p
    p = point%number
    call set_material(this, point)
    if (associated(coupling)) call find_shape(coupling, this%direct, this%rule%points, p, kinematics%now)
    if (has_fields(this%here)) then
      point%place = point_position(this%rule, p, kinematics%now)
      call interpolate_fields(this%rule, p, this%fields, this%predef, this%here%variables, point)
      if (associated(coupling)) call set_temperature(coupling, point)
    end if
    if (allocated(this%here%user_field) .and. .not. begins(this)) then
      axes = this%here%axes
      if (associated(this%axes)) axes = this%axes(:, :, 2, p)
      call call_usdfld(this%here%user_field, this%here%ntens, point, axes, axes, this%here%local, this%state(:, p))
    end if
    if (allocated(this%here%dependence)) call set_constants(this%here, point)
    response%thermal = 0
    response%rate = 0
    if (.not. allocated(this%here%expansion)) return
    response%thermal = thermal_strain(this%rule, p, this%fields, this%here%expansion, this%predef, kinematics%interpolates, &
                                      response%rate, coupling)
  end subroutine enter_point

  !> Tell the point its rotation and deformation in large displacements, and carry its directions.
  subroutine turn_point(this, kinematics, point, response)
    type(solid_t), intent(in) :: this
    class(kinematics_t), intent(in) :: kinematics
    type(point_t), intent(inout) :: point
    type(response_t), intent(inout) :: response
    integer :: p
    p = point%number
    if (this%finite) then
      point%rotation = rotation_of(kinematics%gradient)
      if (associated(this%axes)) then
        call carry_axes(point, kinematics%deformation(:, :, :, p), this%axes(:, :, 2, p), response%middle)
        point%turn = matmul(this%axes(:, :, 2, p), transpose(this%axes(:, :, 1, p)))
      else if (needs_deformation(this%here)) then
        point%deformation = kinematics%deformation(:, :, :, p)
        point%turn = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])
      end if
    else if (associated(this%axes)) then
      response%middle = this%axes(:, :, 1, p)
      this%axes(:, :, 2, p) = response%middle
    end if
  end subroutine turn_point

  !> Take the initial stress of a point.
  subroutine begin_stress(this, point, weight, stress, modulus, energies)
    type(solid_t), intent(in) :: this
    type(point_t), intent(in) :: point
    real(dp), intent(in) :: weight
    real(dp), intent(out) :: stress(this%strains), modulus(this%strains, this%strains)
    type(energies_t), intent(inout) :: energies
    call begin_point(this%here, point, weight, this%state(:, point%number), stress, energies%elastic)
    if (associated(this%axes)) then
      stress = rotated(this%strains, stress, transpose(this%axes(:, :, 2, point%number)), 1.0_dp)
    end if
    modulus = 0
    energies%work = energies%elastic
  end subroutine begin_stress

  !> Find stress and tangent of a point in the directions of its material, keep its state, and add its part of the energies. The
  !> strain comes in global directions.
  subroutine update_point(this, point, strain, stress, modulus, response, energies)
    type(solid_t), intent(in) :: this
    type(point_t), intent(inout) :: point
    real(dp), intent(inout) :: strain(this%strains)
    real(dp), intent(out) :: stress(this%strains), modulus(this%strains, this%strains)
    type(response_t), intent(inout) :: response
    type(energies_t), intent(inout) :: energies
    real(dp) :: total(this%here%ntens), t(this%here%ntens), tangent(this%here%ntens, this%here%ntens), stretch
    real(dp) :: old(values_of_point(this%dim))
    integer :: j, k, n
    n = size(old)/2
    if (associated(this%axes)) call turn_strain(n, this%of_state(:this%strains), response%middle, strain)
    old = this%state(:, point%number)
    if (this%finite) then
      old(:n) = rotated(n, old(:n), point%rotation, 2.0_dp)
      old(n + 1:) = rotated(n, old(n + 1:), point%rotation, 1.0_dp)
    end if
    total = 0
    do k = 1, this%strains
      total(this%of_material(k)) = strain(k)
      if (this%finite) total(this%of_material(k)) = old(this%of_state(k)) + strain(k)
    end do
    call find_stress(this%here, point, response%thermal, total, t, tangent, stretch)
    do k = 1, this%strains
      stress(k) = t(this%of_material(k))
      do j = 1, this%strains
        modulus(j, k) = tangent(this%of_material(j), this%of_material(k))
      end do
    end do
    call find_derivatives(this, tangent, stretch, response)
    call find_mean(this, t, tangent, response%mean)
    call store(this, point, old, total, t, response, energies)
    if (allocated(this%here%networks)) energies%flowed = energies%flowed + response%weight*point%dissipated
  end subroutine update_point

  !> Stress and tangent of the material, whose thermal strain is free; stretch: of the free expansion of a hyperelastic material.
  subroutine find_stress(material, point, thermal, total, stress, tangent, stretch)
    type(material_t), intent(in) :: material
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: thermal(6, 2)
    real(dp), intent(inout) :: total(material%ntens)     !< strain, which stays up to rounding
    real(dp), intent(out) :: stress(material%ntens), tangent(material%ntens, material%ntens), stretch
    real(dp) :: stretches(2)
    integer :: k
    stretches = 1
    if (allocated(material%hyperelastic)) then
      stretches = 1 + thermal(1, :)
      do k = 1, 2
        point%deformation(:, :, k) = point%deformation(:, :, k)/stretches(k)
      end do
    end if
    stretch = stretches(2)
    if (allocated(material%expansion)) total = total - thermal(components(material%ntens, 6), 2)
    call stress_update(material, point, total, stress, tangent)
    if (allocated(material%expansion)) total = total + thermal(components(material%ntens, 6), 2)
    if (.not. allocated(material%hyperelastic)) return
    ! its energy is that of the volume before the expansion
    stress = stress/stretch**3
    tangent = tangent/stretch**3
    point%energy = point%energy/stretch**3
  end subroutine find_stress

  !> Derivatives of the stress, and of the mean stress, by thermal strain.
  pure subroutine find_derivatives(this, tangent, stretch, response)
    type(solid_t), intent(in) :: this
    real(dp), intent(in) :: tangent(this%here%ntens, this%here%ntens), stretch
    type(response_t), intent(inout) :: response
    real(dp) :: rate(this%here%ntens)
    response%stress_by_temperature = 0
    response%mean_by_temperature = 0
    if (.not. allocated(this%here%expansion)) return
    rate = matmul(tangent, response%rate(components(size(rate), 6)))/stretch
    response%stress_by_temperature(:this%strains) = -rate(this%of_material(:this%strains))
    response%mean_by_temperature = -sum(rate(:merge(2, 3, size(rate) == 3)))/3
  end subroutine find_derivatives

  !> Mean stress of a point, its derivatives by the strains, and the stress (unit) that a unit of the pressure beyond it causes
  !> (host_hybrid).
  pure subroutine find_mean(this, stress, tangent, mean)
    type(solid_t), intent(in) :: this
    real(dp), intent(in) :: stress(this%here%ntens), tangent(this%here%ntens, this%here%ntens)
    type(mean_response_t), intent(out) :: mean
    real(dp) :: bulk, unit(this%here%ntens)
    integer :: direct, j, k
    direct = merge(2, 3, size(unit) == 3)
    mean%stress = sum(stress(:direct))/3
    unit = 0
    unit(:direct) = 1
    bulk = elastic_bulk_modulus(this%here)
    if (bulk > 0) then
      mean%compressibility = 1/bulk
      unit = sum(this%here%stiffness(:size(unit), :3), 2)/(3*bulk)
    end if
    do k = 1, this%strains
      j = this%of_material(k)
      mean%by_strains(k) = sum(tangent(:direct, j))/3
      mean%unit(k) = unit(j)
      mean%unit_state(this%of_state(k)) = unit(j)
    end do
    if (size(unit) == 4) mean%unit_state(3) = unit(3)
  end subroutine find_mean

  !> Keep strain and stress of a point, and add its part of the energies.
  subroutine store(this, point, old, total, stress, response, energies)
    type(solid_t), intent(in) :: this
    type(point_t), intent(in) :: point
    real(dp), intent(in) :: old(:)             !< strain and stress before, as SVARS have them
    real(dp), intent(in) :: total(this%here%ntens), stress(this%here%ntens)
    type(response_t), intent(inout) :: response
    type(energies_t), intent(inout) :: energies
    real(dp), dimension(size(old)/2) :: e_new, t_new, free, unit
    integer :: k, n
    n = size(e_new)
    e_new = 0
    t_new = 0
    do k = 1, this%strains
      e_new(this%of_state(k)) = total(this%of_material(k))
      t_new(this%of_state(k)) = stress(this%of_material(k))
    end do
    unit = response%mean%unit_state(:n)
    associate (material => this%here, volume => response%weight, e_old => old(:n), t_old => old(n + 1:))
      energies%elastic = energies%elastic + volume*elastic_energy(material, point, stress)
      if (material%ntens == 3) e_new(3) = thickness_strain(material, point, stress) + response%thermal(3, 2)
      if (material%ntens == 4) t_new(3) = stress(3)
      if (material%turned) then
        e_new = rotated(n, e_new, material%axes, 2.0_dp)
        t_new = rotated(n, t_new, material%axes, 1.0_dp)
        unit = rotated(n, unit, material%axes, 1.0_dp)
      end if
      ! trapezoidal rule, exact where the response is linear
      energies%work = energies%work + volume*0.5_dp*dot_product(t_new + t_old, e_new - e_old)
      response%mean%work = 0.5_dp*dot_product(unit, e_new - e_old)
      if (allocated(material%expansion)) then
        free = response%thermal(:n, 2) - response%thermal(:n, 1)
        if (material%turned) free = rotated(n, free, material%axes, 2.0_dp)
        energies%work = energies%work - volume*0.5_dp*dot_product(t_new + t_old, free)
        response%mean%work = response%mean%work - 0.5_dp*dot_product(unit, free)
      end if
    end associate
    response%mean%unit_state(:n) = unit
    this%state(:n, point%number) = e_new
    this%state(n + 1:, point%number) = t_new
  end subroutine store

  !> Strain of a point, from global directions to those of axes (rows).
  pure subroutine turn_strain(n, place, axes, strain)
    integer, intent(in) :: n, place(:)      !< number of components, and those that the strain has
    real(dp), intent(in) :: axes(3, 3)
    real(dp), intent(inout) :: strain(:)
    real(dp) :: all(n)
    all = 0
    all(place) = strain
    all = rotated(n, all, axes, 2.0_dp)
    strain = all(place)
  end subroutine turn_strain

  !> Turn stress and tangent of a point, the heat terms of UMAT and UHARD, and what depends on its temperature, from the directions
  !> of the point to global ones.
  subroutine turn_back(this, point, stress, modulus, response)
    type(solid_t), intent(in) :: this
    type(point_t), intent(inout) :: point
    real(dp), intent(inout) :: stress(this%strains), modulus(this%strains, this%strains)
    type(response_t), intent(inout) :: response
    real(dp) :: turn(this%strains, this%strains), axes(3, 3)
    integer :: m
    if (.not. associated(this%axes)) return
    m = this%strains
    axes = this%axes(:, :, 2, point%number)
    turn = turn_matrix(m, axes)
    stress = matmul(transpose(turn), stress)
    modulus = matmul(transpose(turn), matmul(modulus, turn))
    response%mean%by_strains(:m) = matmul(response%mean%by_strains(:m), turn)
    response%mean%unit(:m) = matmul(response%mean%unit(:m), turn)
    if (has_heat_terms(this%here)) call turn_heat(this%here%ntens, axes, point%heat)
    if (.not. allocated(this%here%expansion)) return
    response%rate = rotated(6, response%rate, transpose(axes), 2.0_dp)
    response%stress_by_temperature(:m) = rotated(m, response%stress_by_temperature(:m), transpose(axes), 1.0_dp)
  end subroutine turn_back
end module host_solid_point
