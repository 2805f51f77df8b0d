! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Procedures Python calls (through f2py) to define materials; host/entry/elements.f90 has the others.

!> Make a material known; returns the number that stands for it.
subroutine host_define_material(stiffness, compliance, thickness, axes, constants, hardening, number, ntens, rows)
  use host_kinds, only: dp, i4
  use host_materials, only: define, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: ntens, rows
  real(dp), intent(in) :: stiffness(ntens, ntens), compliance(ntens, ntens)
  real(dp), intent(in) :: thickness(3)        !< plane stress: elastic strain 33 per stress
  real(dp), intent(in) :: axes(3, 3)          !< rows: material directions
  real(dp), intent(in) :: constants(2)        !< Young's modulus and Poisson's ratio of a plastic material
  real(dp), intent(in) :: hardening(2, rows)  !< yield stress and plastic strain; one row of zeros: elastic
  integer(i4), intent(out) :: number
  type(material_t) :: material
  material%ntens = ntens
  material%stiffness(:ntens, :ntens) = stiffness
  material%compliance(:ntens, :ntens) = compliance
  material%thickness = thickness
  material%axes = axes
  material%turned = any(abs(axes - reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])) > 0)
  material%young = constants(1)
  material%poisson = constants(2)
  if (hardening(1, 1) > 0) material%yield = transpose(hardening)
  number = define(material)
end subroutine host_define_material

!> Let the yield surface of a plastic material move, and grow exponentially beside its table.
subroutine host_set_backstresses(number, backstresses, growth, count)
  use host_kinds, only: dp, i4
  use host_materials, only: find_material, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: number, count
  real(dp), intent(in) :: backstresses(2, count)   !< C and gamma of each
  real(dp), intent(in) :: growth(2)                !< Q and b
  type(material_t), pointer :: material
  material => find_material(number)
  allocate (material%backstress)
  material%backstress%moduli = backstresses(1, :)
  material%backstress%recovery = backstresses(2, :)
  material%backstress%growth = growth(1)
  material%backstress%rate = growth(2)
end subroutine host_set_backstresses

!> Let stresses of an isotropic material relax.
subroutine host_set_prony(number, constants, moduli, terms, count)
  use host_kinds, only: dp, i4
  use host_materials, only: find_material, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: number, count
  real(dp), intent(in) :: constants(2)       !< long-term Young's modulus and Poisson's ratio
  real(dp), intent(in) :: moduli(2)          !< instantaneous shear and bulk modulus
  real(dp), intent(in) :: terms(3, count)    !< g, k, tau
  type(material_t), pointer :: material
  material => find_material(number)
  material%young = constants(1)
  material%poisson = constants(2)
  allocate (material%prony)
  material%prony%shear = terms(1, :)
  material%prony%bulk = terms(2, :)
  material%prony%times = terms(3, :)
  material%prony%moduli = moduli
end subroutine host_set_prony

!> Let an isotropic material creep.
subroutine host_set_creep(number, constants, by_time, power_law)
  use host_kinds, only: dp, i4
  use host_materials, only: find_material, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: number
  real(dp), intent(in) :: constants(2)       !< Young's modulus and Poisson's ratio
  integer(i4), intent(in) :: by_time         !< 1: time hardening, 0: strain hardening
  real(dp), intent(in) :: power_law(3)       !< A, n, m
  type(material_t), pointer :: material
  material => find_material(number)
  material%young = constants(1)
  material%poisson = constants(2)
  allocate (material%creep)
  material%creep%by_time = by_time /= 0
  material%creep%factor = power_law(1)
  material%creep%stress_power = power_law(2)
  material%creep%time_power = power_law(3)
end subroutine host_set_creep

!> Let CREEP give the creep law of an isotropic material.
subroutine host_set_user_creep(number, address, name, constants, statev)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_kinds, only: dp, i4, i8
  use host_materials, only: find_material, material_t
  use host_user_creep, only: outputs
  implicit none (type, external)
  integer(i4), intent(in) :: number, statev
  integer(i8), intent(in) :: address
  character(len=80), intent(in) :: name       !< of the material
  real(dp), intent(in) :: constants(2)        !< Young's modulus and Poisson's ratio
  type(material_t), pointer :: material
  material => find_material(number)
  material%young = constants(1)
  material%poisson = constants(2)
  allocate (material%user_creep)
  material%user_creep%address = transfer(int(address, c_intptr_t), material%user_creep%address)
  material%user_creep%name = name
  material%user_creep%statev = statev
  allocate (material%user_creep%reported(outputs + 1), source=.false.)
end subroutine host_set_user_creep

!> Give a material thermal expansion.
subroutine host_set_expansion(number, table, zero, n)
  use host_kinds, only: dp, i4
  use host_materials, only: find_material, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: number, n
  real(dp), intent(in) :: table(7, n), zero   !< as expansion_t has them
  type(material_t), pointer :: material
  material => find_material(number)
  allocate (material%expansion)
  material%expansion%table = table
  material%expansion%zero = zero
end subroutine host_set_expansion

!> Compliance (11, 22, 33, 12, 13, 23; engineering shear) from E1, E2, E3, nu12, nu13, nu23, G12, G13, G23.
subroutine host_compliance(constants, compliance)
  use host_dependence, only: compliance_of
  use host_kinds, only: dp
  implicit none (type, external)
  real(dp), intent(in) :: constants(9)
  real(dp), intent(out) :: compliance(6, 6)
  compliance = compliance_of(constants)
end subroutine host_compliance

!> Give the points of a material other than UMAT a history for initial stresses.
subroutine host_set_prestressed(number)
  use host_kinds, only: i4
  use host_materials, only: find_material, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: number
  type(material_t), pointer :: material
  material => find_material(number)
  material%prestressed = .true.
end subroutine host_set_prestressed

!> Let a material take strains and give stresses in the directions of each point.
subroutine host_set_local(number)
  use host_kinds, only: i4
  use host_materials, only: find_material, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: number
  type(material_t), pointer :: material
  material => find_material(number)
  material%local = .true.
end subroutine host_set_local

!> Let the elastic constants of a material depend on temperature and field variables.
subroutine host_set_dependence(number, constants, turn, table, rows, columns)
  use host_kinds, only: dp, i4
  use host_materials, only: find_material, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: number, constants, rows, columns
  real(dp), intent(in) :: turn(6, 6)          !< stress components in global axes to those of the material
  real(dp), intent(in) :: table(columns, rows)   !< as dependence_t has it
  type(material_t), pointer :: material
  material => find_material(number)
  allocate (material%dependence)
  material%dependence%constants = constants
  material%dependence%turn = turn
  material%dependence%table = table
  material%variables = max(material%variables, columns - constants - 1)
end subroutine host_set_dependence

!> Let USDFLD give the field variables of a material.
subroutine host_set_user_field(number, address, names, statev, room, axes)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_kinds, only: dp, i4, i8
  use host_materials, only: find_material, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: number, statev
  integer(i4), intent(in) :: room             !< as user_field_t has it
  integer(i8), intent(in) :: address
  character(len=80), intent(in) :: names(2)   !< of the material and its orientation
  real(dp), intent(in) :: axes(3, 3)          !< rows: material directions
  type(material_t), pointer :: material
  material => find_material(number)
  allocate (material%user_field)
  material%user_field%address = transfer(int(address, c_intptr_t), material%user_field%address)
  material%user_field%material = names(1)
  material%user_field%orientation = names(2)
  material%user_field%statev = statev
  material%user_field%room = room
  material%user_field%plastic = allocated(material%yield) .or. allocated(material%hardening)
  material%axes = axes
  material%variables = max(material%variables, 1)
end subroutine host_set_user_field

!> Let UVARM give output variables of a material in elements that call it themselves.
subroutine host_set_user_output(number, address, names, counts)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_kinds, only: i4, i8
  use host_materials, only: find_material, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: number
  integer(i8), intent(in) :: address
  character(len=80), intent(in) :: names(2)   !< of the material and its orientation
  integer(i4), intent(in) :: counts(4)        !< count, width, statev and room of user_output_t
  type(material_t), pointer :: material
  material => find_material(number)
  allocate (material%user_output)
  material%user_output%address = transfer(int(address, c_intptr_t), material%user_output%address)
  material%user_output%material = names(1)
  material%user_output%orientation = names(2)
  material%user_output%count = counts(1)
  material%user_output%width = counts(2)
  material%user_output%statev = counts(3)
  material%user_output%room = counts(4)
  material%user_output%plastic = allocated(material%yield) .or. allocated(material%hardening)
end subroutine host_set_user_output

!> Make a material of UMAT known; returns the number that stands for it.
subroutine host_define_user_material(umat, name, ntens, hybrid, statev, room, constants, count, number, n)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_kinds, only: dp, i4, i8
  use host_materials, only: define, material_t
  use host_umat, only: outputs
  implicit none (type, external)
  integer(i8), intent(in) :: umat             !< address
  character(len=80), intent(in) :: name
  integer(i4), intent(in) :: n, ntens
  integer(i4), intent(in) :: hybrid           !< formulation in hybrid elements (host_umat)
  integer(i4), intent(in) :: statev, room     !< as user_material_t has them
  real(dp), intent(in) :: constants(n)
  integer(i4), intent(in) :: count            !< of the constants: f2py passes no empty arrays
  integer(i4), intent(out) :: number
  type(material_t) :: material
  material%ntens = ntens
  allocate (material%user)
  material%user%umat = transfer(int(umat, c_intptr_t), material%user%umat)
  material%user%name = name
  material%user%hybrid = hybrid
  material%user%statev = statev
  material%user%room = room
  material%user%constants = constants(:count)
  allocate (material%user%reported(outputs), material%user%spoilt(outputs), source=.false.)
  number = define(material)
end subroutine host_define_user_material

!> Make a hyperelastic material known; returns the number that stands for it.
subroutine host_define_hyperelastic(ntens, polynomial, ogden, volumetric, logarithmic, moduli, number)
  use host_kinds, only: dp, i4
  use host_materials, only: define, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: ntens            !< 4 or 6
  real(dp), intent(in) :: polynomial(7, 7)    !< of the powers 0 to 6 of I1 - 3 and I2 - 3
  real(dp), intent(in) :: ogden(2, 6)         !< mu and alpha; mu = 0: no term
  real(dp), intent(in) :: volumetric(6)       !< 1/D
  integer(i4), intent(in) :: logarithmic      !< 1: the volumetric energy of Arruda and Boyce
  real(dp), intent(in) :: moduli(2)           !< initial Young's modulus and Poisson's ratio, for hourglass control
  integer(i4), intent(out) :: number
  type(material_t) :: material
  material%ntens = ntens
  allocate (material%hyperelastic)
  material%hyperelastic%polynomial = polynomial
  material%hyperelastic%ogden = ogden
  material%hyperelastic%volumetric = volumetric
  material%hyperelastic%logarithmic = logarithmic == 1
  material%compliance(1, 1) = 1/moduli(1)
  material%compliance(1, 2) = -moduli(2)/moduli(1)
  number = define(material)
end subroutine host_define_hyperelastic

!> Give a hyperelastic material networks that creep.
subroutine host_set_networks(number, ratios, laws, constants, statev, count)
  use host_kinds, only: dp, i4
  use host_materials, only: find_material, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: number, count, statev
  real(dp), intent(in) :: ratios(count)
  integer(i4), intent(in) :: laws(count)
  real(dp), intent(in) :: constants(5, count)   !< laws, constants: as network_t has them
  type(material_t), pointer :: material
  integer :: k
  material => find_material(number)
  allocate (material%networks)
  allocate (material%networks%items(count))
  material%networks%statev = statev
  ! up to rounding of ratios whose sum is one
  material%networks%equilibrium = max(1 - sum(ratios), 0.0_dp)
  do k = 1, count
    material%networks%items(k)%ratio = ratios(k)
    material%networks%items(k)%law = laws(k)
    material%networks%items(k)%constants = constants(:, k)
  end do
end subroutine host_set_networks

!> Let UCREEPNETWORK give the creep of a network, or UTRSNETWORK its reduced time.
subroutine host_set_network_routine(number, network, address, name, shifts, constants, count, n)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_kinds, only: dp, i4, i8
  use host_materials, only: find_material, material_t
  use host_network_routines, only: network_routine_t, outputs
  implicit none (type, external)
  integer(i4), intent(in) :: number, n
  integer(i4), intent(in) :: network          !< NETWORKID
  integer(i8), intent(in) :: address
  character(len=80), intent(in) :: name       !< of the material
  integer(i4), intent(in) :: shifts           !< 1: UTRSNETWORK
  real(dp), intent(in) :: constants(n)
  integer(i4), intent(in) :: count            !< of the constants: f2py passes no empty arrays
  type(material_t), pointer :: material
  type(network_routine_t) :: routine
  material => find_material(number)
  routine%address = transfer(int(address, c_intptr_t), routine%address)
  routine%routine = merge('UTRSNETWORK  ', 'UCREEPNETWORK', shifts == 1)
  routine%material = name
  routine%network = network
  routine%constants = constants(:count)
  allocate (routine%reported(outputs), routine%spoilt(outputs), source=.false.)
  if (shifts == 1) then
    material%networks%items(network)%shift = routine
  else
    material%networks%items(network)%user = routine
  end if
end subroutine host_set_network_routine

!> Make a hyperelastic material of UHYPER known; returns the number that stands for it.
subroutine host_define_user_potential(uhyper, name, ntens, statev, constants, count, number, n)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_kinds, only: dp, i4, i8
  use host_materials, only: define, material_t
  use host_uhyper, only: outputs
  implicit none (type, external)
  integer(i8), intent(in) :: uhyper           !< address
  character(len=80), intent(in) :: name
  integer(i4), intent(in) :: n, ntens         !< ntens: 4 or 6
  integer(i4), intent(in) :: statev
  real(dp), intent(in) :: constants(n)
  integer(i4), intent(in) :: count            !< of the constants: f2py passes no empty arrays
  integer(i4), intent(out) :: number
  type(material_t) :: material
  material%ntens = ntens
  allocate (material%hyperelastic)
  allocate (material%hyperelastic%user)
  associate (user => material%hyperelastic%user)
    user%uhyper = transfer(int(uhyper, c_intptr_t), user%uhyper)
    user%name = name
    user%statev = statev
    user%constants = constants(:count)
    allocate (user%reported(outputs), user%spoilt(outputs), source=.false.)
  end associate
  number = define(material)
end subroutine host_define_user_potential

!> Make a hyperelastic material with preferred directions known; returns the number that stands for it.
subroutine host_define_anisotropic(ntens, directions, fibres, holzapfel, compliance, number, m)
  use host_kinds, only: dp, i4
  use host_materials, only: define, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: m, ntens         !< ntens: 4 or 6
  real(dp), intent(in) :: directions(3, m)    !< in the axes of the material at the start
  integer(i4), intent(in) :: fibres           !< of the directions: f2py passes no empty arrays
  real(dp), intent(in) :: holzapfel(4)        !< C10, k1, k2, kappa
  real(dp), intent(in) :: compliance          !< D
  integer(i4), intent(out) :: number
  type(material_t) :: material
  material%ntens = ntens
  allocate (material%hyperelastic)
  material%hyperelastic%logarithmic = .true.
  if (compliance > 0) material%hyperelastic%volumetric(1) = 1/compliance
  allocate (material%hyperelastic%anisotropic)
  material%hyperelastic%anisotropic%directions = directions(:, :fibres)
  material%hyperelastic%anisotropic%holzapfel = holzapfel
  number = define(material)
end subroutine host_define_anisotropic

!> Let UANISOHYPER_INV give the energy of a hyperelastic material with preferred directions.
subroutine host_set_user_invariants(number, uanisohyper, name, statev, constants, count, n)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_kinds, only: dp, i4, i8
  use host_materials, only: find_material, material_t
  use host_uanisohyper, only: outputs
  implicit none (type, external)
  integer(i4), intent(in) :: n, number
  integer(i8), intent(in) :: uanisohyper      !< address
  character(len=80), intent(in) :: name
  integer(i4), intent(in) :: statev
  real(dp), intent(in) :: constants(n)
  integer(i4), intent(in) :: count            !< of the constants: f2py passes no empty arrays
  type(material_t), pointer :: material
  material => find_material(number)
  allocate (material%hyperelastic%anisotropic%user)
  associate (user => material%hyperelastic%anisotropic%user)
    user%uanisohyper = transfer(int(uanisohyper, c_intptr_t), user%uanisohyper)
    user%name = name
    user%statev = statev
    user%constants = constants(:count)
    allocate (user%reported(outputs), user%spoilt(outputs), source=.false.)
  end associate
end subroutine host_set_user_invariants

!> Let UHARD give the yield stress of an isotropic material.
subroutine host_set_user_hardening(number, uhard, name, young, poisson, statev, constants, count, n)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_kinds, only: dp, i4, i8
  use host_materials, only: find_material, material_t
  use host_uhard, only: outputs
  implicit none (type, external)
  integer(i4), intent(in) :: number, n
  integer(i8), intent(in) :: uhard            !< address
  character(len=80), intent(in) :: name
  real(dp), intent(in) :: young, poisson
  integer(i4), intent(in) :: statev
  real(dp), intent(in) :: constants(n)
  integer(i4), intent(in) :: count            !< of the constants: f2py passes no empty arrays
  type(material_t), pointer :: material
  material => find_material(number)
  material%young = young
  material%poisson = poisson
  allocate (material%hardening)
  associate (law => material%hardening)
    law%uhard = transfer(int(uhard, c_intptr_t), law%uhard)
    law%name = name
    law%statev = statev
    law%constants = constants(:count)
    allocate (law%reported(outputs), source=.false.)
  end associate
end subroutine host_set_user_hardening

!> Make a material known that has nothing yet; returns the number that stands for it.
subroutine host_define_empty_material(number)
  use host_kinds, only: i4
  use host_materials, only: define, material_t
  implicit none (type, external)
  integer(i4), intent(out) :: number
  type(material_t) :: material
  number = define(material)
end subroutine host_define_empty_material

!> Give a material the constants of conduction and storage of heat.
subroutine host_set_thermal(number, density, counts, conductivity, specific_heat, latent_heat, n, m, k)
  use host_kinds, only: dp, i4
  use host_materials, only: find_material, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: number, n, m, k
  real(dp), intent(in) :: density
  integer(i4), intent(in) :: counts(3)        !< rows of the tables: f2py passes no empty arrays
  real(dp), intent(in) :: conductivity(2, n), specific_heat(2, m), latent_heat(3, k)   !< as thermal_t has them
  type(material_t), pointer :: material
  material => find_material(number)
  allocate (material%thermal)
  material%thermal%density = density
  material%thermal%conductivity = conductivity(:, :counts(1))
  material%thermal%specific_heat = specific_heat(:, :counts(2))
  material%thermal%latent_heat = latent_heat(:, :counts(3))
end subroutine host_set_thermal

!> Give a material the constants of the diffusion of another one through it.
subroutine host_set_diffusion(number, fick, absolute_zero, axes, counts, diffusivity, solubility, soret, pressure, n, m, k, j)
  use host_kinds, only: dp, i4
  use host_materials, only: find_material, material_t
  implicit none (type, external)
  integer(i4), intent(in) :: number, fick, n, m, k, j
  real(dp), intent(in) :: absolute_zero, axes(3, 3)
  integer(i4), intent(in) :: counts(4)        !< rows of the tables: f2py passes no empty arrays
  real(dp), intent(in) :: diffusivity(8, n), solubility(2, m), soret(3, k), pressure(3, j)   !< as diffusion_t has them
  type(material_t), pointer :: material
  material => find_material(number)
  allocate (material%diffusion)
  associate (law => material%diffusion)
    law%fick = fick /= 0
    law%absolute_zero = absolute_zero
    law%axes = axes
    law%diffusivity = diffusivity(:, :counts(1))
    law%solubility = solubility(:, :counts(2))
    law%soret = soret(:, :counts(3))
    law%pressure = pressure(:, :counts(4))
  end associate
end subroutine host_set_diffusion

!> Let HETVAL (flows = 0) generate heat in a material with thermal constants, or UMATHT (1) conduct and store it.
subroutine host_set_user_thermal(number, flows, address, name, statev, constants, count, n)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_kinds, only: dp, i4, i8
  use host_materials, only: find_material, material_t
  use host_thermal, only: flow_outputs, heat_outputs, user_thermal_t
  implicit none (type, external)
  integer(i4), intent(in) :: number, flows, statev, n
  integer(i8), intent(in) :: address
  character(len=80), intent(in) :: name       !< of the material
  real(dp), intent(in) :: constants(n)
  integer(i4), intent(in) :: count            !< of the constants: f2py passes no empty arrays
  type(material_t), pointer :: material
  type(user_thermal_t) :: user
  integer :: outputs
  material => find_material(number)
  outputs = merge(heat_outputs, flow_outputs, flows == 0)
  user%address = transfer(int(address, c_intptr_t), user%address)
  user%material = name
  user%statev = statev
  user%constants = constants(:count)
  allocate (user%reported(outputs), user%spoilt(outputs), source=.false.)
  if (flows == 0) then
    material%thermal%source = user
  else
    material%thermal%flow = user
  end if
end subroutine host_set_user_thermal
