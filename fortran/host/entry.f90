! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The procedures Python calls through f2py, which reads them here: names, kinds, shapes and intents
!> are those that Python sees (harness/usersub/_host.pyi, written by stub.py). They only pack and unpack.

!> One pass over a block; see block_t for the arrays.
subroutine host_evaluate(address, material, tensor, jtype, symmetric, want_matrix, kstep, kinc, guards, entries, &
                         iteration, parallel, lflags, time, dtime, period, params, labels, jprops, equations, map, &
                         props, coords, u, du, v, a, counts, kinds, loads, predef, floor, field, svars, svars_trial, energy, &
                         energy_trial, history, history_trial, residual, matrix, flux, pnewdt, energy_sum, &
                         fault, position, array, item, alone, ndofel, nsvars, nprops, njprop, mcrd, nnode, m, n, &
                         nrhs, nnz, values, points, most, nfield, nrate, mload, mfield, fluxes)
  use, intrinsic :: iso_c_binding, only: c_funptr, c_intptr_t
  use host_context, only: initial_stresses
  use host_driver, only: run_block
  use host_element, only: block_t, keeps_state, scalars_t
  use host_kinds, only: dp, i4, i8
  use host_scatter, only: sum_by_field
  implicit none (type, external)
  integer(i8), intent(in) :: address          !< of UEL or UELMAT
  integer(i4), intent(in) :: material         !< its number in the host; with 0 UEL is called, otherwise UELMAT
  integer(i4), intent(in) :: tensor, jtype, kstep, kinc
  integer(i4), intent(in) :: symmetric, want_matrix   !< 0 or 1
  integer(i4), intent(in) :: guards, entries, iteration
  integer(i4), intent(in) :: parallel         !< 0 or 1
  integer(i4), intent(in) :: lflags(7)
  real(dp), intent(in) :: time(2), dtime, period, params(3)
  integer(i4), intent(in) :: ndofel, nsvars, nprops, njprop, mcrd, nnode, m, n, nrhs, nnz, values, points, most, nfield
  integer(i4), intent(in) :: nrate            !< n, or 1 if nothing moves
  integer(i4), intent(in) :: mload, mfield    !< m, or 1 if all elements have the same loads, the same fields
  integer(i4), intent(in), target :: labels(m), jprops(njprop), equations(ndofel, m), map(ndofel, ndofel, m)
  real(dp), intent(in), target :: props(nprops), coords(mcrd, nnode, m), u(n), du(n), v(nrate), a(nrate), svars(nsvars, m), &
                                  energy(8, m), history(values, points, m)
  integer(i4), intent(in), target :: counts(mload), kinds(most, mload)   !< distributed loads: how many, JDLTYP
  real(dp), intent(in), target :: loads(2, most, mload), predef(2, nfield, nnode, mfield)
  real(dp), intent(inout), target :: svars_trial(nsvars, m), energy_trial(8, m), history_trial(values, points, m), &
                                     residual(n, nrhs), matrix(nnz)
  real(dp), intent(in), target :: floor(ndofel)
  integer(i4), intent(in) :: field(ndofel)    !< of each unknown, from 1; 0: none
  integer(i4), intent(in) :: fluxes           !< number of fields
  real(dp), intent(out) :: flux(fluxes, 3)    !< sum of |RHS|, number of terms, the largest one
  real(dp), intent(out) :: pnewdt, energy_sum(8)
  integer(i4), intent(out) :: fault, position, array, item   !< as block_t has them; item is its index
  integer(i4), intent(out) :: alone           !< as block_t has it
  real(dp), target :: by_unknown(ndofel, 3)
  type(block_t), target :: block
  block%address = transfer(int(address, c_intptr_t), block%address)
  block%with_material = material > 0
  block%tensor = tensor
  block%symmetric = symmetric /= 0
  block%want_matrix = want_matrix /= 0
  block%want_residual = any(lflags(3) == [1_i4, 5_i4, 6_i4, 100_i4, initial_stresses])
  block%parallel = parallel /= 0
  block%guards = guards
  block%entries = entries
  block%iteration = iteration
  block%keeps_state = keeps_state(lflags(3))
  block%moves = nrate == n
  block%scalars = scalars_t(ndofel=ndofel, nrhs=nrhs, nsvars=nsvars, nprops=nprops, mcrd=mcrd, nnode=nnode, jtype=jtype, &
                            kstep=kstep, kinc=kinc, npredf=nfield, mlvarx=ndofel, njprop=njprop, material=material, &
                            lflags=lflags, time=time, dtime=dtime, params=params, period=period)
  block%labels => labels
  block%jprops => jprops
  block%equations => equations
  block%map => map
  block%props => props
  block%coords(1:mcrd*nnode, 1:m) => coords
  block%u => u
  block%du => du
  block%v => v
  block%a => a
  block%counts => counts
  block%kinds => kinds
  block%loads => loads
  block%predef(1:2*nfield*nnode, 1:mfield) => predef
  block%svars => svars
  block%svars_trial => svars_trial
  block%energy => energy
  block%energy_trial => energy_trial
  if (values > 1) then   ! f2py passes no empty arrays, so one value stands for none
    block%history => history
    block%history_trial => history_trial
  end if
  by_unknown = 0
  block%residual => residual
  block%matrix => matrix
  block%floor => floor
  block%flux => by_unknown
  call run_block(block)
  call sum_by_field(ndofel, field, by_unknown, fluxes, flux)
  pnewdt = block%pnewdt
  energy_sum = block%energy_sum
  fault = block%fault
  position = block%position
  array = block%array
  item = block%index
  alone = block%alone
end subroutine host_evaluate

!> Swap the values that the guards of each array (in the order of host_workspace) and, last, unset entries hold.
subroutine host_exchange_guard_values(values)
  use host_driver, only: set_guard_values
  use host_kinds, only: dp
  implicit none (type, external)
  real(dp), intent(inout) :: values(12)
  call set_guard_values(values)
end subroutine host_exchange_guard_values

!> Oldest message of a user routine; level 0 if none is left.
subroutine host_take_message(level, place, text)
  use host_kinds, only: i4
  use host_messages, only: message_t, take_message
  implicit none (type, external)
  integer(i4), intent(out) :: level
  integer(i4), intent(out) :: place(3)        !< element, step, increment
  character(len=2048), intent(out) :: text
  type(message_t) :: message
  call take_message(message)
  level = message%level
  place = [message%element, message%step, message%increment]
  text = message%text
end subroutine host_take_message

!> Name and folder of the job, for GETJOBNAME and GETOUTDIR; units 6 and 7 go to the two named files, shared arrays are dropped.
subroutine host_open_job(name, directory, file6, file7, status)
  use host_context, only: job_name, names_cut, output_directory
  use host_kinds, only: i4
  use host_protect, only: clear_arrays
  use host_units, only: connect_units
  implicit none (type, external)
  character(len=4096), intent(in) :: name, directory
  character(len=2048), intent(in) :: file6, file7
  integer(i4), intent(out) :: status          !< of connect_units
  job_name = name
  output_directory = directory
  names_cut = .false.
  call clear_arrays()
  call connect_units(file6, file7, status)
end subroutine host_open_job

!> Threads that call the elements of the job where that is possible.
subroutine host_set_threads(number)
  use host_context, only: threads
  use host_kinds, only: i4
  implicit none (type, external)
  integer(i4), intent(in) :: number
  threads = number
end subroutine host_set_threads

!> Number of this process, from 0, among those that run the job.
subroutine host_set_rank(number, of)
  use host_context, only: rank, ranks
  use host_kinds, only: i4
  implicit none (type, external)
  integer(i4), intent(in) :: number, of
  rank = number
  ranks = of
end subroutine host_set_rank

!> Time in seconds that one call of a user routine may take; 0: any.
subroutine host_limit_calls(seconds)
  use host_kinds, only: dp
  use host_protect, only: limit_calls
  implicit none (type, external)
  real(dp), intent(in) :: seconds
  call limit_calls(seconds)
end subroutine host_limit_calls

!> Let another process see where user code is, through a file that both have open; failed is 1 if that is not possible.
subroutine host_share(file, failed)
  use, intrinsic :: iso_c_binding, only: c_int
  use host_kinds, only: i4
  use host_protect, only: share
  implicit none (type, external)
  integer(i4), intent(in) :: file
  integer(i4), intent(out) :: failed
  failed = int(share(int(file, c_int)), i4)
end subroutine host_share

!> The library of user routines is loaded from now on (begins = 1), or has been.
subroutine host_loading(begins)
  use, intrinsic :: iso_c_binding, only: c_int
  use host_kinds, only: i4
  use host_protect, only: loading
  implicit none (type, external)
  integer(i4), intent(in) :: begins
  call loading(int(begins, c_int))
end subroutine host_loading

!> Flush what user routines have printed to units 6 and 7; with `finish` the units are also closed. lost is 1 if a call that was
!> left has them locked.
subroutine host_flush(finish, lost)
  use host_kinds, only: i4
  use host_units, only: flush_units
  implicit none (type, external)
  integer(i4), intent(in) :: finish
  integer(i4), intent(out) :: lost
  call flush_units(finish /= 0, lost)
end subroutine host_flush

!> Call UEXTERNALDB; left = 1 if it ended the analysis.
subroutine host_external_database(address, lop, lrestart, time, dtime, kstep, kinc, left)
  use host_external, only: call_external_database
  use host_kinds, only: dp, i4, i8
  implicit none (type, external)
  integer(i8), intent(in) :: address
  integer(i4), intent(in) :: lop, lrestart, kstep, kinc
  real(dp), intent(in) :: time(2), dtime
  integer(i4), intent(out) :: left
  call call_external_database(address, lop, lrestart, time, dtime, kstep, kinc, left)
end subroutine host_external_database

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

!> Make a flux (film = 0) or a film known; returns the number that stands for it.
subroutine host_define_heat_load(film, address, surface, jltyp, number)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_heat_loads, only: define_heat_load, heat_load_t
  use host_kinds, only: i4, i8
  implicit none (type, external)
  integer(i4), intent(in) :: film, jltyp
  integer(i8), intent(in) :: address          !< of DFLUX or FILM; 0: the deck gives the magnitudes
  character(len=80), intent(in) :: surface
  integer(i4), intent(out) :: number
  type(heat_load_t) :: load
  load%film = film /= 0
  load%by_user = address /= 0
  load%address = transfer(int(address, c_intptr_t), load%address)
  load%surface = surface
  load%jltyp = jltyp
  allocate (load%reported(1), load%spoilt(1), source=.false.)
  number = define_heat_load(load)
end subroutine host_define_heat_load

!> Call UVARM at all material points of a block of built-in elements.
subroutine host_uvarm_pass(address, names, axes, counts, place, clock, labels, coords, svars, history, uvar, left, element, &
                           point, mcrd, nnode, variables, points, values, nuvarm, m, each, every)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_context, only: current
  use host_kinds, only: dp, i4, i8
  use host_uvarm, only: run_uvarm, uvarm_pass_t
  implicit none (type, external)
  integer(i8), intent(in) :: address
  character(len=80), intent(in) :: names(2)   !< of the material and its orientation
  integer(i4), intent(in) :: each, every      !< points and m, or 1 if all have the same directions
  real(dp), intent(in), target :: axes(3, 3, each, every)   !< rows: material directions
  integer(i4), intent(in) :: counts(4)        !< stress components, STATEV, family of the elements, 1: material in the directions
  integer(i4), intent(in) :: place(2)         !< step, increment
  real(dp), intent(in) :: clock(3)            !< step time, total time at the start of the increment, time increment
  integer(i4), intent(in) :: mcrd, nnode, variables, points, values, nuvarm, m
  integer(i4), intent(in), target :: labels(m)
  real(dp), intent(in), target :: coords(mcrd, nnode, m), svars(variables, points, m), history(values, points, m)
  real(dp), intent(inout), target :: uvar(nuvarm, points, m)
  integer(i4), intent(out) :: left            !< 1 if the routine ended the analysis
  integer(i4), intent(out) :: element, point  !< of the last call
  type(uvarm_pass_t) :: pass
  pass%address = transfer(int(address, c_intptr_t), pass%address)
  pass%material = names(1)
  pass%orientation = names(2)
  pass%axes => axes
  pass%local = counts(4) /= 0
  pass%tensor = counts(1)
  pass%statev = counts(2)
  pass%family = counts(3)
  pass%kstep = place(1)
  pass%kinc = place(2)
  pass%time = clock(:2)
  pass%dtime = clock(3)
  pass%labels => labels
  pass%coords => coords
  pass%svars => svars
  pass%history => history
  pass%uvar => uvar
  call run_uvarm(pass, left)
  element = current%element
  point = current%point
end subroutine host_uvarm_pass

!> Call SDVINI at all points of a block.
subroutine host_sdvini_pass(address, family, labels, coords, statev, left, element, point, mcrd, nnode, nstatv, points, m)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_context, only: current
  use host_kinds, only: dp, i4, i8
  use host_sdvini, only: run_sdvini, sdvini_pass_t
  implicit none (type, external)
  integer(i8), intent(in) :: address
  integer(i4), intent(in) :: family           !< of built-in elements with integration points, else 0
  integer(i4), intent(in) :: mcrd, nnode, nstatv, points, m
  integer(i4), intent(in), target :: labels(m)
  real(dp), intent(in), target :: coords(mcrd, nnode, m)
  real(dp), intent(inout), target :: statev(nstatv, points, m)
  integer(i4), intent(out) :: left            !< 1 if the routine ended the analysis
  integer(i4), intent(out) :: element, point  !< of the last call
  type(sdvini_pass_t) :: pass
  pass%address = transfer(int(address, c_intptr_t), pass%address)
  pass%family = family
  pass%labels => labels
  pass%coords => coords
  pass%statev => statev
  call run_sdvini(pass, left)
  element = current%element
  point = current%point
end subroutine host_sdvini_pass

!> Call SIGINI at all points of a block.
subroutine host_sigini_pass(address, element_type, family, labels, coords, sigma, left, element, point, mcrd, nnode, ntens, &
                            points, m)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_context, only: current
  use host_kinds, only: dp, i4, i8
  use host_sigini, only: run_sigini, sigini_pass_t
  implicit none (type, external)
  integer(i8), intent(in) :: address
  character(len=80), intent(in) :: element_type
  integer(i4), intent(in) :: family           !< of the elements
  integer(i4), intent(in) :: mcrd, nnode, ntens, points, m
  integer(i4), intent(in), target :: labels(m)
  real(dp), intent(in), target :: coords(mcrd, nnode, m)
  real(dp), intent(inout), target :: sigma(ntens, points, m)
  integer(i4), intent(out) :: left            !< 1 if the routine ended the analysis
  integer(i4), intent(out) :: element, point  !< of the last call
  type(sigini_pass_t) :: pass
  pass%address = transfer(int(address, c_intptr_t), pass%address)
  pass%element_type = element_type
  pass%family = family
  pass%labels => labels
  pass%coords => coords
  pass%sigma => sigma
  call run_sigini(pass, left)
  element = current%element
  point = current%point
end subroutine host_sigini_pass

!> Call ORIENT at all points of a block.
subroutine host_orient_pass(address, name, family, labels, nodes, coords, t, left, element, point, mcrd, nnode, points, m)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_context, only: current
  use host_kinds, only: dp, i4, i8
  use host_orient, only: orient_pass_t, run_orient
  implicit none (type, external)
  integer(i8), intent(in) :: address
  character(len=80), intent(in) :: name       !< of the orientation
  integer(i4), intent(in) :: family
  integer(i4), intent(in) :: mcrd, nnode, points, m
  integer(i4), intent(in), target :: labels(m), nodes(nnode, m)
  real(dp), intent(in), target :: coords(mcrd, nnode, m)
  real(dp), intent(inout), target :: t(3, 3, points, m)
  integer(i4), intent(out) :: left            !< 1 if the routine ended the analysis
  integer(i4), intent(out) :: element, point  !< of the last call
  type(orient_pass_t) :: pass
  pass%address = transfer(int(address, c_intptr_t), pass%address)
  pass%name = name
  pass%family = family
  pass%labels => labels
  pass%nodes => nodes
  pass%coords => coords
  pass%t => t
  call run_orient(pass, left)
  element = current%element
  point = current%point
end subroutine host_orient_pass

!> Call DISP (1), DLOAD (2), UTEMP (3) or UFIELD (4) at all places.
subroutine host_value_pass(routine, address, place, time, places, coords, temperatures, values, left, last, rows, n)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_kinds, only: dp, i4, i8
  use host_values, only: run_values, value_pass_t
  implicit none (type, external)
  integer(i4), intent(in) :: routine
  integer(i8), intent(in) :: address
  integer(i4), intent(in) :: place(2)         !< step, increment
  real(dp), intent(in) :: time(3)             !< step and total time at the end of the increment, time increment
  integer(i4), intent(in) :: rows, n
  integer(i4), intent(in), target :: places(rows, n)   !< as value_pass_t has them
  real(dp), intent(in), target :: coords(3, n), temperatures(2, n)
  real(dp), intent(inout), target :: values(n)
  integer(i4), intent(out) :: left            !< 1 if the routine ended the analysis
  integer(i4), intent(out) :: last            !< place of the last call
  type(value_pass_t) :: pass
  pass%routine = routine
  pass%address = transfer(int(address, c_intptr_t), pass%address)
  pass%kstep = place(1)
  pass%kinc = place(2)
  pass%time = time(:2)
  pass%dtime = time(3)
  pass%places => places
  pass%coords => coords
  pass%temperatures => temperatures
  pass%values => values
  call run_values(pass, left)
  last = pass%last
end subroutine host_value_pass

!> Call UAMP for an amplitude.
subroutine host_uamp_call(address, name, clock, props, svars, info, sensors, names, counts, given, value, define, left, nprop, &
                          nsvar, nsensor)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_kinds, only: dp, i4, i8
  use host_uamp, only: run_uamp, uamp_call_t
  implicit none (type, external)
  integer(i8), intent(in) :: address
  character(len=80), intent(in) :: name
  real(dp), intent(in) :: clock(4)            !< step and total time at the end of the increment, its length, the old value
  integer(i4), intent(in) :: nprop, nsvar, nsensor
  real(dp), intent(in), target :: props(nprop), sensors(nsensor)
  real(dp), intent(inout), target :: svars(nsvar)
  integer(i4), intent(in) :: info(5)          !< lFlagsInfo, increment
  character(len=80), intent(in), target :: names(nsensor)
  integer(i4), intent(in) :: counts(3)        !< nProps, nSvars, nSensor: the arrays may be longer
  real(dp), intent(in) :: given               !< value on entry
  real(dp), intent(out) :: value
  integer(i4), intent(out) :: define(6)       !< lFlagsDefine
  integer(i4), intent(out) :: left            !< 1 if the routine ended the analysis
  type(uamp_call_t) :: arguments
  arguments%address = transfer(int(address, c_intptr_t), arguments%address)
  arguments%name = name
  arguments%time = clock(:2)
  arguments%dtime = clock(3)
  arguments%old = clock(4)
  arguments%info = info(:4)
  arguments%value = given
  arguments%nprops = counts(1)
  arguments%nsvars = counts(2)
  arguments%nsensor = counts(3)
  arguments%props => props
  arguments%svars => svars
  arguments%sensors => sensors
  arguments%names => names
  call run_uamp(arguments, info(5), left)
  value = arguments%value
  define = arguments%define
end subroutine host_uamp_call

!> Address of built-in elements: 1 continuum, 2 coupled temperature-displacement, 3 cohesive, 4 springs and masses, 5 heat
!> transfer, 6 heat that enters, 7 shells, 8 beams, 9 piezoelectric, 10 trusses, 11 generalised plane strain, 12 beams whose
!> material is integrated over the section, 13 membranes, 14 mass diffusion.
subroutine host_element_address(elements, address)
  use, intrinsic :: iso_c_binding, only: c_funloc, c_funptr, c_intptr_t
  use host_beam, only: beam_uel, beam_uelmat
  use host_cohesive, only: cohesive_uel
  use host_conduction, only: heat_uelmat
  use host_coupled, only: coupled_uelmat
  use host_discrete, only: discrete_uel
  use host_generalised, only: generalised_uelmat
  use host_heat_loads, only: heat_load_uel
  use host_kinds, only: i4, i8
  use host_mass_diffusion, only: mass_diffusion_uelmat
  use host_membrane, only: membrane_uelmat
  use host_piezoelectric, only: piezoelectric_uelmat
  use host_shell, only: shell_uelmat
  use host_solid, only: solid_uelmat
  use host_truss, only: truss_uelmat
  implicit none (type, external)
  integer(i4), intent(in) :: elements
  integer(i8), intent(out) :: address
  type(c_funptr) :: all(14)
  all = [c_funloc(solid_uelmat), c_funloc(coupled_uelmat), c_funloc(cohesive_uel), c_funloc(discrete_uel), c_funloc(heat_uelmat), &
         c_funloc(heat_load_uel), c_funloc(shell_uelmat), c_funloc(beam_uel), c_funloc(piezoelectric_uelmat), &
         c_funloc(truss_uelmat), c_funloc(generalised_uelmat), c_funloc(beam_uelmat), c_funloc(membrane_uelmat), &
         c_funloc(mass_diffusion_uelmat)]
  address = int(transfer(all(elements), 1_c_intptr_t), i8)
end subroutine host_element_address
