! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The procedures Python calls through f2py, which reads them here: names, kinds, shapes and intents
!> are those that Python sees (harness/uel/usersub/_host.pyi, written by stub.py). They only pack and unpack.

!> One pass over a block; see block_t for the arrays.
subroutine host_evaluate(address, material, jtype, tensor, labels, jprops, equations, map, props, coords, svars, energy, &
                         history, svars_trial, energy_trial, history_trial, symmetric, want_matrix, guards, entries, parallel, &
                         kstep, kinc, iteration, time, dtime, period, params, lflags, u, du, v, a, counts, kinds, loads, predef, &
                         floor, field, fluxes, residual, matrix, flux, pnewdt, energy_sum, fault, position, array, item, alone, &
                         ndofel, nsvars, nprops, njprop, mcrd, nnode, m, n, nrhs, nnz, values, points, most, nfield, nrate, &
                         mload, mfield)
  use, intrinsic :: iso_c_binding, only: c_funptr, c_intptr_t
  use host_block, only: block_t, keeps_state, scalars_t
  use host_built_in, only: is_built_in
  use host_context, only: initial_stresses
  use host_driver, only: run_block
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
  block%built_in = is_built_in(block%address)
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

!> Name and folder of the job, for GETJOBNAME and GETOUTDIR; units 6 and 7 go to the two named files, shared arrays are dropped, and
!> the materials of earlier jobs if no other one is open.
subroutine host_open_job(name, directory, file6, file7, alone, status)
  use host_context, only: job_name, names_cut, output_directory
  use host_kinds, only: i4
  use host_materials, only: empty_library
  use host_protect, only: clear_arrays
  use host_units, only: connect_units
  implicit none (type, external)
  character(len=4096), intent(in) :: name, directory
  character(len=2048), intent(in) :: file6, file7
  integer(i4), intent(in) :: alone            !< 1: no other job of this process is open
  integer(i4), intent(out) :: status          !< of connect_units
  job_name = name
  output_directory = directory
  names_cut = .false.
  call clear_arrays()
  if (alone /= 0) call empty_library()
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

!> Make a flux, a film or radiation known; returns the number that stands for it.
subroutine host_define_heat_load(law, address, surface, jltyp, absolute_zero, stefan_boltzmann, number)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_heat_loads, only: define_heat_load, heat_load_t
  use host_kinds, only: dp, i4, i8
  implicit none (type, external)
  integer(i4), intent(in) :: law              !< as in host_heat_loads
  integer(i4), intent(in) :: jltyp
  integer(i8), intent(in) :: address          !< of DFLUX or FILM; 0: the deck gives the magnitudes
  character(len=80), intent(in) :: surface
  real(dp), intent(in) :: absolute_zero, stefan_boltzmann
  integer(i4), intent(out) :: number
  type(heat_load_t) :: load
  load%law = law
  load%absolute_zero = absolute_zero
  load%stefan_boltzmann = stefan_boltzmann
  load%by_user = address /= 0
  load%address = transfer(int(address, c_intptr_t), load%address)
  load%surface = surface
  load%jltyp = jltyp
  allocate (load%reported(1), load%spoilt(1), source=.false.)
  number = define_heat_load(load)
end subroutine host_define_heat_load

!> Address of a built-in element by its name (host_built_in), 0 if there is none.
subroutine host_element_address(name, address)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_built_in, only: address_of
  use host_kinds, only: i8
  implicit none (type, external)
  character(len=16), intent(in) :: name
  integer(i8), intent(out) :: address
  address = int(transfer(address_of(name), 1_c_intptr_t), i8)
end subroutine host_element_address
