! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The material library behind MATERIAL_LIB_MECH and the built-in elements: linear elasticity, Mises plasticity with isotropic,
!> kinematic and combined hardening, viscoelasticity, creep, hyperelasticity, viscoelastic networks, UMAT.
!>
!> Stress components: one direction (11), beams with torsion (11, 12), plane stress (11, 22, 12), plane strain (11, 22, 33, 12),
!> three-dimensional (11, 22, 33, 12, 13, 23); shear strains are engineering strains.
module host_materials
  use core_root, only: advance, searching
  use host_backstress, only: backstress_t, combined_solid
  use host_context, only: current, is_dynamic
  use host_creep, only: creep_solid, creep_t, creep_values
  use host_dependence, only: dependence_t, elastic_matrices
  use host_diffusion, only: diffusion_t
  use host_hyperelastic, only: calls_user, hyperelastic_stress, hyperelastic_t, state_variables
  use host_kinds, only: dp, i4
  use host_kinematics, only: components, rotated
  use host_messages, only: add_message
  use host_mises, only: mises_beam, mises_plane_stress, mises_solid
  use host_networks, only: calls_routine, network_stress, networks_t
  use host_point, only: npt_of, point_t
  use host_prony, only: prony_solid, prony_t, prony_values
  use host_protect, only: escape
  use host_expansion, only: expansion_t
  use host_thermal, only: thermal_t
  use host_thickness, only: free_thickness, reduced_change, reduced_stress, reduced_tangent, solid_strain, thickness_search
  use host_uhard, only: user_hardening_t, user_solid
  use host_umat, only: call_umat, incompressible, strain_energy, total, user_material_t
  use host_usdfld, only: user_field_t
  use host_user_creep, only: user_creep_solid, user_creep_t, user_creep_values
  use host_uvarm, only: user_output_t
  implicit none (type, external)
  private
  public :: material_t, define, find_material, empty_library, stress_update, not_solved, elastic_bulk_modulus, elastic_energy, &
            thickness_strain, history_values, has_fields, has_heat_terms, is_viscous, needs_deformation, needs_history, &
            set_constants

  !> Values of the history of a point of a plastic or prestressed material: stress-free strain (6), which is the plastic strain
  !> minus the elastic strain of the initial stress, and equivalent plastic strain. Backstresses follow (host_backstress).
  integer, parameter :: history_values = 7
  !> Room for the history of a point: of 20 terms of a Prony series, or 10 backstresses.
  integer, parameter :: most_values = prony_values + 6*20

  integer, parameter :: visco = 21    !< LFLAGS(1) of *VISCO

  !> PNEWDT if the equations of a point are not solved: Abaqus cuts back a diverging increment by the same factor.
  real(dp), parameter :: smaller = 0.25_dp

  type :: material_t
    integer :: ntens = 0                           !< 1, 2, 3, 4 or 6
    real(dp) :: stiffness(6, 6) = 0                !< (ntens, ntens) of it, global axes
    real(dp) :: compliance(6, 6) = 0               !< its inverse
    real(dp) :: thickness(3) = 0                   !< plane stress: elastic strain 33 = thickness . stress
    real(dp) :: axes(3, 3) = 0                     !< rows: directions of *ORIENTATION
    logical :: turned = .false.                    !< axes are not the global ones
    logical :: local = .false.                     !< all is in the directions of each point (host_axes), axes not used
    real(dp), allocatable :: yield(:, :)           !< (k, 2) yield stress, plastic strain; absent: elastic
    type(backstress_t), allocatable :: backstress  !< kinematic or combined hardening, beside yield
    type(prony_t), allocatable :: prony            !< viscoelasticity
    type(creep_t), allocatable :: creep
    type(user_creep_t), allocatable :: user_creep      !< of CREEP
    type(user_hardening_t), allocatable :: hardening   !< of UHARD
    real(dp) :: young = 0, poisson = 0             !< of a material with plasticity, viscoelasticity or creep, which is isotropic
    logical :: prestressed = .false.               !< it has a history for initial stresses
    type(expansion_t), allocatable :: expansion    !< in global directions, or in those of each point if it is local
    type(hyperelastic_t), allocatable :: hyperelastic   !< then nothing above counts but ntens, axes and local
    type(networks_t), allocatable :: networks      !< beside hyperelastic
    type(user_material_t), allocatable :: user     !< of UMAT; then nothing above counts but ntens
    integer :: variables = 0                       !< field variables, at least
    type(dependence_t), allocatable :: dependence  !< constants above are those of the point that set_constants was called for
    type(user_field_t), allocatable :: user_field  !< of USDFLD
    type(user_output_t), allocatable :: user_output    !< of UVARM, in elements that call it themselves
    type(thermal_t), allocatable :: thermal        !< in elements with temperatures
    type(diffusion_t), allocatable :: diffusion    !< in elements with concentrations
  end type material_t

  type :: shelf_t
    type(material_t), pointer :: material => null()
  end type shelf_t

  type(shelf_t), allocatable, save :: library(:)   !< with room behind the last material
  integer(i4), save :: materials = 0               !< in the library
  integer(i4), save :: emptied = 0                 !< materials that were in it before; their numbers are not used again

contains

  !> Add a material; returns its number, which is what MATERIALLIB holds.
  function define(material) result(number)
    type(material_t), intent(in) :: material
    integer(i4) :: number
    type(shelf_t), allocatable :: larger(:)
    if (.not. allocated(library)) allocate (library(16))
    if (materials == size(library)) then
      ! not [library, ...]: its temporary copy would lie on the stack, with all materials in it
      allocate (larger(2*materials))
      larger(:materials) = library
      call move_alloc(larger, library)
    end if
    materials = materials + 1_i4
    allocate (library(materials)%material, source=material)
    number = emptied + materials
  end function define

  !> Take all materials out of the library.
  subroutine empty_library()
    integer :: k
    do k = 1, int(materials)
      deallocate (library(k)%material)
    end do
    emptied = emptied + materials
    materials = 0
  end subroutine empty_library

  !> The material with that number, null if there is none.
  function find_material(number) result(material)
    integer(i4), intent(in) :: number
    type(material_t), pointer :: material
    material => null()
    if (number > emptied .and. number - emptied <= materials) material => library(number - emptied)%material
  end function find_material

  !> Whether it depends on temperature and field variables, or on the place of its points.
  pure logical function has_fields(material)
    type(material_t), intent(in) :: material
    has_fields = allocated(material%user) .or. allocated(material%dependence) .or. allocated(material%user_field) .or. &
                 has_heat_terms(material) .or. allocated(material%user_creep) .or. allocated(material%user_output)
    if (allocated(material%hyperelastic)) has_fields = has_fields .or. calls_user(material%hyperelastic)
    if (allocated(material%networks)) has_fields = has_fields .or. calls_routine(material%networks)
  end function has_fields

  !> Whether UMAT or HETVAL generate heat in elements with temperatures, or UMAT or UHARD have stresses that depend on them.
  pure logical function has_heat_terms(material)
    type(material_t), intent(in) :: material
    has_heat_terms = allocated(material%user) .or. allocated(material%hardening)
    if (allocated(material%thermal)) has_heat_terms = has_heat_terms .or. allocated(material%thermal%source)
  end function has_heat_terms

  !> Whether stresses depend on time: what they dissipate is ENERGY(3).
  pure logical function is_viscous(material)
    type(material_t), intent(in) :: material
    is_viscous = allocated(material%prony) .or. allocated(material%creep) .or. allocated(material%user_creep) .or. &
                 allocated(material%networks)
  end function is_viscous

  !> Whether the history has plastic strains.
  pure logical function is_plastic(material)
    type(material_t), intent(in) :: material
    is_plastic = allocated(material%yield) .or. allocated(material%hardening)
  end function is_plastic

  !> Whether stresses take the deformation gradients of the point.
  pure logical function needs_deformation(material)
    type(material_t), intent(in) :: material
    needs_deformation = allocated(material%user) .or. allocated(material%hyperelastic)
  end function needs_deformation

  !> Whether stresses take the history of the point. Those of hyperelastic materials with STATEV do as well.
  pure logical function needs_history(material)
    type(material_t), intent(in) :: material
    needs_history = is_plastic(material) .or. allocated(material%user) .or. material%prestressed .or. is_viscous(material)
  end function needs_history

  !> Elastic constants for the temperature and field variables of the point at the end of the increment. Leaves the pass if they are
  !> not positive definite.
  subroutine set_constants(material, point)
    type(material_t), intent(inout) :: material
    type(point_t), intent(in) :: point
    real(dp) :: constants(material%dependence%constants)
    logical :: definite
    character(len=160) :: text
    integer :: n
    n = material%ntens
    call elastic_matrices(material%dependence, n, point%fields(:, 1) + point%fields(:, 2), material%stiffness(:n, :n), &
                          material%compliance(:n, :n), material%thickness, constants, definite)
    material%young = constants(1)
    material%poisson = constants(2)
    if (definite) return
    write (text, '(a,i0,a)') '*ELASTIC: the constants at integration point ', npt_of(point), &
      ', interpolated from the table, are not positive definite'
    call add_message(-3_i4, text)
    call escape()
  end subroutine set_constants

  !> Stress and tangent at the end of the increment; the history of the point goes from committed to trial.
  subroutine stress_update(material, point, strain, stress, tangent)
    type(material_t), intent(in) :: material
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: strain(material%ntens)                          !< total, at the end of the increment
    real(dp), intent(out) :: stress(material%ntens)
    real(dp), intent(out) :: tangent(material%ntens, material%ntens)
    real(dp) :: old(most_values)
    integer :: n, k, first, last
    logical :: solved
    character(len=120) :: text
    n = material%ntens
    if (allocated(material%networks)) then
      call networks(material%networks, material%hyperelastic, allocated(material%user_field), n, point, stress, tangent)
      return
    end if
    if (allocated(material%hyperelastic)) then
      call hyperelastic(material%hyperelastic, allocated(material%user_field), n, point, stress, tangent)
      return
    end if
    if (.not. needs_history(material)) then
      call linear(material, strain, stress, tangent)
      if (point%hybrid) call add_mean_stress(point, n, stress, tangent)
      return
    end if
    if (allocated(material%user)) then
      if (.not. allocated(material%user_field)) point%history_trial = point%history
      call call_umat(material%user, n, point, strain, stress, tangent)
      call hybrid_response(material%user, point, n, stress, tangent)
      return
    end if
    call places_of_tensors(material, first, last)
    old(:last) = point%history(:last)
    if (point%finite) then
      ! strains and stresses of the history rotate with the material
      old(:6) = rotated(6, old(:6), point%rotation, 2.0_dp)
      do k = first, last, 6
        old(k:k + 5) = rotated(6, old(k:k + 5), point%rotation, 1.0_dp)
      end do
    end if
    solved = .true.
    associate (new => point%history_trial)
      if (is_viscous(material) .or. allocated(material%backstress) .or. allocated(material%hardening)) then
        call inelastic(material, point, n, strain, old(:last), stress, tangent, new(:last), solved)
      else if (.not. allocated(material%yield)) then
        new(:history_values) = old(:history_values)
        call linear(material, strain - old(components(n, 6)), stress, tangent)
      else if (n < 3) then
        call mises_beam(material%young, material%poisson, material%yield, n, old(:last), strain, stress, tangent, new, solved)
      else if (n == 3) then
        call mises_plane_stress(material%young, material%poisson, material%yield, old(:last), strain, stress, tangent, new, solved)
      else
        call mises_solid(material%young, material%poisson, material%yield, n, old(:last), strain, stress, tangent, new)
      end if
    end associate
    if (solved) return
    if (is_viscous(material)) then
      write (text, '(a,i0)') '*CREEP or *VISCOELASTIC: the stress is not found at integration point ', point%number
    else
      write (text, '(a,i0)') '*PLASTIC: the return to the yield surface does not converge at integration point ', point%number
    end if
    call not_solved(text)
  end subroutine stress_update

  !> Where the history of a point has stress tensors, six values each, and its last value without STATEV.
  pure subroutine places_of_tensors(material, first, last)
    type(material_t), intent(in) :: material
    integer, intent(out) :: first, last
    first = history_values + 1
    last = history_values
    if (allocated(material%backstress)) then
      last = last + 6*size(material%backstress%moduli)
    else if (allocated(material%prony)) then
      first = prony_values + 1
      last = prony_values + 6*size(material%prony%times)
    else if (allocated(material%creep)) then
      first = creep_values + 1
      last = creep_values
    else if (allocated(material%user_creep)) then
      first = user_creep_values + 1
      last = user_creep_values
    end if
  end subroutine places_of_tensors

  !> Laws that are written for plane strain and three dimensions; in plane stress the strain 33 is sought that needs no stress 33.
  subroutine inelastic(material, point, n, strain, old, stress, tangent, new, solved)
    type(material_t), intent(in) :: material
    type(point_t), intent(inout) :: point
    integer, intent(in) :: n
    real(dp), intent(in) :: strain(n), old(:)
    real(dp), intent(out) :: stress(n), tangent(n, n), new(:)
    logical, intent(out) :: solved
    type(thickness_search) :: search
    real(dp) :: solid(4), modulus(4, 4), scale
    real(dp), allocatable :: statev(:)
    integer :: first, last
    statev = states_of_law(material, point)
    if (n > 3) then
      call solid_law(material, point, statev, n, strain, old, stress, tangent, new, solved)
      return
    end if
    call places_of_tensors(material, first, last)
    associate (poisson => material%poisson)
      scale = 4*(sum(abs(strain)) + sum(abs(old(:6))) + sum(abs(old(first:last)))*2*(1 + poisson)/material%young)
      search = free_thickness(old(3) - poisson/(1 - poisson)*sum(strain(:2) - old(:2)), max(scale, epsilon(scale)))
    end associate
    do while (searching(search%root))
      call solid_law(material, point, statev, 4, solid_strain(search, strain), old, solid, modulus, new, solved)
      if (.not. solved) exit
      call advance(search%root, solid(3), modulus(3, 3))
    end do
    solved = solved .and. search%root%found
    stress = reduced_stress(solid)
    tangent = reduced_tangent(modulus)
    if (allocated(material%hardening)) then
      associate (by_temperature => point%heat%stress_by_temperature)
        by_temperature(:3) = reduced_change(by_temperature(:4), modulus)
      end associate
    end if
  end subroutine inelastic

  !> STATEV of UHARD or CREEP at the start of the increment, or as USDFLD has left them.
  function states_of_law(material, point) result(statev)
    type(material_t), intent(in) :: material
    type(point_t), intent(in) :: point
    real(dp), allocatable :: statev(:)
    integer :: count, first
    count = 0
    if (allocated(material%hardening)) count = material%hardening%statev
    if (allocated(material%user_creep)) count = material%user_creep%statev
    first = size(point%history) - count + 1
    statev = point%history(first:)
    if (allocated(material%user_field)) statev = point%history_trial(first:)
  end function states_of_law

  !> Plane strain (n = 4) and three dimensions (n = 6).
  subroutine solid_law(material, point, statev, n, strain, old, stress, tangent, new, solved)
    type(material_t), intent(in) :: material
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: statev(:)      !< of UHARD or CREEP
    integer, intent(in) :: n
    real(dp), intent(in) :: strain(n), old(:)
    real(dp), intent(out) :: stress(n), tangent(n, n), new(:)
    logical, intent(out) :: solved
    real(dp) :: start, elapsed
    solved = .true.
    if (allocated(material%prony)) then
      elapsed = viscous_time()
      call prony_solid(material%prony, elapsed, n, old, strain, stress, tangent, new)
    else if (allocated(material%creep)) then
      start = max(current%time(2), 0.0_dp)
      elapsed = merge(current%dtime, 0.0_dp, current%procedure == visco)
      call creep_solid(material%creep, material%young, material%poisson, [start, start + elapsed], n, old, strain, stress, &
                       tangent, new, solved)
    else if (allocated(material%user_creep)) then
      elapsed = merge(current%dtime, 0.0_dp, current%procedure == visco)
      call user_creep_solid(material%user_creep, material%young, material%poisson, elapsed, point, statev, n, old, strain, stress, &
                            tangent, new, solved)
    else if (allocated(material%hardening)) then
      call user_solid(material%hardening, material%young, material%poisson, point, statev, n, old, strain, stress, tangent, &
                      new, solved)
    else
      call combined_solid(material%backstress, material%young, material%poisson, material%yield, n, old, strain, stress, &
                          tangent, new, solved)
    end if
  end subroutine solid_law

  !> Time of the increment in which stresses relax.
  real(dp) function viscous_time()
    viscous_time = merge(current%dtime, 0.0_dp, current%procedure == visco .or. is_dynamic(current%procedure))
  end function viscous_time

  !> Networks; the history of the point goes from committed to trial, but for STATEV that USDFLD had before.
  subroutine networks(items, law, had_them, n, point, stress, tangent)
    type(networks_t), intent(in) :: items
    type(hyperelastic_t), intent(in) :: law
    logical, intent(in) :: had_them
    integer, intent(in) :: n
    type(point_t), intent(inout) :: point
    real(dp), intent(out) :: stress(n), tangent(n, n)
    real(dp) :: statev(items%statev)
    logical :: solved
    integer :: last
    character(len=120) :: text
    last = size(point%history) - items%statev
    associate (old => point%history, new => point%history_trial)
      statev = old(last + 1:)
      if (had_them) statev = new(last + 1:)
      call network_stress(items, law, n, point, viscous_time(), old(:last), statev, stress, tangent, new(:last), solved)
      new(last + 1:) = statev
    end associate
    if (solved) return
    write (text, '(a,i0)') '*VISCOELASTIC, NONLINEAR: the stress is not found at integration point ', point%number
    call not_solved(text)
  end subroutine networks

  !> Hyperelasticity; the STATEV of UHYPER and UANISOHYPER_INV go from committed to trial, unless USDFLD had them before.
  subroutine hyperelastic(law, had_them, n, point, stress, tangent)
    type(hyperelastic_t), intent(in) :: law
    logical, intent(in) :: had_them
    integer, intent(in) :: n
    type(point_t), intent(inout) :: point
    real(dp), intent(out) :: stress(n), tangent(n, n)
    real(dp) :: statev(state_variables(law))
    logical :: solved
    integer :: first
    character(len=120) :: text
    if (size(statev) > 0) then
      first = size(point%history) - size(statev) + 1
      if (.not. had_them) point%history_trial = point%history
      statev = point%history_trial(first:)
    end if
    call hyperelastic_stress(law, n, point, statev, stress, tangent, solved)
    if (size(statev) > 0) point%history_trial(first:) = statev
    if (solved) return
    write (text, '(a,i0)') '*HYPERELASTIC: the stretches are too large for numbers at integration point ', point%number
    call not_solved(text)
  end subroutine hyperelastic

  !> What hybrid elements make of the stress and the tangent of UMAT, by its formulation.
  pure subroutine hybrid_response(user, point, n, stress, tangent)
    type(user_material_t), intent(in) :: user
    type(point_t), intent(in) :: point
    integer, intent(in) :: n
    real(dp), intent(inout) :: stress(n), tangent(n, n)
    if (user%hybrid == total) then
      ! what the rate of the stress times the volume has of the mean stress
      if (point%finite) tangent(:3, :3) = tangent(:3, :3) + sum(stress(:3))/3
    else if (user%hybrid == incompressible) then
      stress(:3) = stress(:3) - sum(stress(:3))/3
      call add_mean_stress(point, n, stress, tangent)
    end if
  end subroutine hybrid_response

  !> Add the mean stress that the element gives to the stress of an incompressible elastic point, and what its forces change by as
  !> the volume changes.
  pure subroutine add_mean_stress(point, n, stress, tangent)
    type(point_t), intent(in) :: point
    integer, intent(in) :: n
    real(dp), intent(inout) :: stress(n), tangent(n, n)
    stress(:3) = stress(:3) + point%mean_stress
    if (point%finite) tangent(:3, :3) = tangent(:3, :3) + point%mean_stress
  end subroutine add_mean_stress

  !> Warn that a local solve has not come to its end, and ask for a smaller increment.
  subroutine not_solved(text)
    character(len=*), intent(in) :: text
    call add_message(-1_i4, text)
    current%pnewdt = min(current%pnewdt, smaller)
  end subroutine not_solved

  !> Linear elasticity.
  pure subroutine linear(material, strain, stress, tangent)
    type(material_t), intent(in) :: material
    real(dp), intent(in) :: strain(material%ntens)
    real(dp), intent(out) :: stress(material%ntens), tangent(material%ntens, material%ntens)
    integer :: i, j
    stress = 0
    do j = 1, material%ntens
      do i = 1, material%ntens
        tangent(i, j) = material%stiffness(i, j)
        stress(i) = stress(i) + material%stiffness(i, j)*strain(j)
      end do
    end do
  end subroutine linear

  !> Elastic strain energy per volume, after stress_update of the point.
  real(dp) function elastic_energy(material, point, stress)
    type(material_t), intent(in) :: material
    type(point_t), intent(in) :: point
    real(dp), intent(in) :: stress(material%ntens)
    integer :: i, j
    elastic_energy = 0
    if (allocated(material%hyperelastic)) then
      elastic_energy = point%energy
      return
    end if
    if (allocated(material%user)) then
      elastic_energy = point%history_trial(strain_energy)
      return
    end if
    if (allocated(material%prony)) then
      elastic_energy = point%history_trial(7)
      return
    end if
    do j = 1, material%ntens
      do i = 1, material%ntens
        elastic_energy = elastic_energy + 0.5_dp*stress(i)*material%compliance(i, j)*stress(j)
      end do
    end do
  end function elastic_energy

  !> Mean stress by a unit of volume strain in equal parts of the directions; zero of materials whose elastic energy does not
  !> follow from the stress, and in plane stress.
  pure real(dp) function elastic_bulk_modulus(material)
    type(material_t), intent(in) :: material
    elastic_bulk_modulus = 0
    if (allocated(material%hyperelastic) .or. allocated(material%user) .or. material%ntens < 4) return
    elastic_bulk_modulus = sum(material%stiffness(:3, :3))/9
  end function elastic_bulk_modulus

  !> Strain 33 in plane stress, after stress_update of the point; zero with UMAT, which does not give it.
  real(dp) function thickness_strain(material, point, stress)
    type(material_t), intent(in) :: material
    type(point_t), intent(in) :: point
    real(dp), intent(in) :: stress(3)
    thickness_strain = 0
    ! with viscoelasticity the history has the whole strain
    if (.not. allocated(material%prony)) thickness_strain = dot_product(material%thickness, stress)
    if (is_plastic(material) .or. material%prestressed .or. is_viscous(material)) then
      thickness_strain = thickness_strain + point%history_trial(3)
    end if
  end function thickness_strain
end module host_materials
