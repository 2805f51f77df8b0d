! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Entry point of Abaqus/Standard for the interface elements, all types but U1 and U9.
!>
!> Everything is declared, so that ABA_PARAM.INC and its implicit typing are not needed. The routine sets every entry of RHS and
!> AMATRX, whatever they hold on entry. SVARS and ENERGY change only in calls whose values are kept, LFLAGS(3) = 1 of a general
!> step; in these, elements with PACING or FATIGUE lower PNEWDT to limit the next increment or to repeat this one. In a linear step
!> (LFLAGS(4) = 1) RHS is the effect of the perturbation: zero without loads on the elements, and -AMATRX DU once DU is known
!> (LFLAGS(3) = 100). In *DYNAMIC it is (1 + alpha) G - alpha G_start, PARAMS(1) being alpha.
subroutine uel(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, v, a, &
  jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, lflags, mlvarx, ddlmag, &
  mdload, pnewdt, jprops, njprop, period)
  use core_kinds, only: dp
  use cohesive_parameters, only: load_cycles
  use abaqus_check, only: call_is_good
  use abaqus_cycles, only: count_cycles
  use abaqus_interface_elements, only: evaluate_interface, interface_forces_at
  use abaqus_layout, only: elements, every_continuum, names_of_types, reals, integers
  use abaqus_lflags, only: asks_for_nothing, asks_for_tangent, give_answer, is_linear_step, large_displacements, weight_of_start, &
    values_are_kept
  use abaqus_properties, only: row_of, variables_of
  use abaqus_report, only: fatal, refuse_type
  use abaqus_temperatures, only: warn_if_heated
  implicit none(type, external)
  integer, intent(in) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, npredf, mlvarx
  integer, intent(in) :: mdload, njprop, jdltyp(mdload, *), lflags(*), jprops(*)
  real(dp), intent(inout) :: rhs(mlvarx, *), amatrx(ndofel, ndofel), svars(*), energy(8), pnewdt
  real(dp), intent(in) :: props(*), coords(mcrd, nnode), u(ndofel), du(mlvarx, *), v(ndofel), a(ndofel), time(2), dtime
  real(dp), intent(in) :: params(*), adlmag(mdload, *), predef(2, npredf, nnode), ddlmag(mdload, *), period
  real(dp) :: residual(ndofel), state(variables_of(row_of(jtype))), energies(8), values(size(reals))
  real(dp) :: before(ndofel), temperatures(2, nnode), weight, growth
  type(load_cycles) :: cycles
  logical :: good
  integer :: n, itype, options(size(integers))

  rhs(1:ndofel, 1:nrhs) = 0.0_dp
  amatrx = 0.0_dp
  itype = row_of(jtype)
  if (itype == 0) then
    call refuse_type(jtype, jelem, 'is not an element of this file, which has ' // names_of_types)
    return
  else if (iand(elements(itype)%family, every_continuum) /= 0) then
    call fatal(itype, jelem, 'takes its stress from a material: specify MATERIAL= on *UEL PROPERTY', &
      [integer ::], [real(dp) ::])
    return
  end if
  good = call_is_good(itype, jelem, ndofel, nsvars, nprops, mcrd, nnode, njprop, ndload, props, jprops, &
    values, options)
  if (.not. good) return
  if (asks_for_nothing(lflags)) return
  call warn_if_heated(itype, jelem, values, npredf, predef)
  temperatures = 0.0_dp
  if (npredf > 0) temperatures = predef(:, 1, :)

  n = size(state)
  state = svars(1:n)
  weight = weight_of_start(lflags, params)
  if (abs(weight) > 0.0_dp) then
    call interface_forces_at(itype, jelem, values, options, coords, u - du(1:ndofel, 1), &
      temperatures(1, :) - temperatures(2, :), large_displacements(lflags), state, before, good)
    if (.not. good) return
  end if
  call count_cycles(itype, jelem, values, options, lflags, kstep, dtime, npredf, predef, cycles, good)
  if (.not. good) return
  ! a linear step perturbs a state, in no time
  call evaluate_interface(itype, jelem, values, options, coords, u, temperatures, merge(0.0_dp, dtime, is_linear_step(lflags)), &
    cycles, large_displacements(lflags), asks_for_tangent(lflags), state, energies, residual, amatrx, growth, good)
  if (.not. good) amatrx = 0.0_dp
  if (.not. good) return
  if (values_are_kept(lflags)) pnewdt = min(pnewdt, growth)
  if (abs(weight) > 0.0_dp) then
    residual = (1.0_dp - weight)*residual + weight*before
    amatrx = (1.0_dp - weight)*amatrx
  end if
  call give_answer(lflags, du(1:ndofel, 1), amatrx, residual, state, energies, rhs(1:ndofel, 1), svars(1:n), energy)
end subroutine uel
