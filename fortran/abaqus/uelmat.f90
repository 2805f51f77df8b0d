! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Entry point of Abaqus/Standard for the continuum elements, U1 and U9.
!>
!> Everything is declared, so that ABA_PARAM.INC and its implicit typing are not needed. The routine sets every entry of RHS and
!> AMATRX, whatever they hold on entry. SVARS and ENERGY change only in calls whose values are kept, LFLAGS(3) = 1 of a general
!> step. In a linear step (LFLAGS(4) = 1) RHS is the effect of the perturbation: zero without loads on the elements, and -AMATRX DU
!> once DU is known (LFLAGS(3) = 100). In *DYNAMIC it is (1 + alpha) G - alpha G_start, PARAMS(1) being alpha.
subroutine uelmat(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, v, a, &
  jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, lflags, mlvarx, ddlmag, &
  mdload, pnewdt, jprops, njprop, period, materiallib)
  use core_kinds, only: dp
  use abaqus_check, only: call_is_good
  use abaqus_continuum_element, only: evaluate_continuum, continuum_forces_at
  use abaqus_layout, only: elements, every_continuum, reals, integers
  use abaqus_lflags, only: asks_for_nothing, asks_for_tangent, give_answer, large_displacements, weight_of_start
  use abaqus_properties, only: row_of, variables_of
  use abaqus_report, only: refuse_type
  implicit none(type, external)
  integer, intent(in) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, npredf, mlvarx
  integer, intent(in) :: mdload, njprop, jdltyp(mdload, *), lflags(*), jprops(*)
  real(dp), intent(inout) :: rhs(mlvarx, *), amatrx(ndofel, ndofel), svars(*), energy(8), pnewdt
  real(dp), intent(in) :: props(*), coords(mcrd, nnode), u(ndofel), du(mlvarx, *), v(ndofel), a(ndofel), time(2), dtime
  real(dp), intent(in) :: params(*), adlmag(mdload, *), predef(2, npredf, nnode), ddlmag(mdload, *), period
  integer, intent(in) :: materiallib(*)
  real(dp) :: residual(ndofel), state(variables_of(row_of(jtype))), energies(8), values(size(reals))
  real(dp) :: before(ndofel), weight
  integer :: options(size(integers)), n, itype
  logical :: good

  rhs(1:ndofel, 1:nrhs) = 0.0_dp
  amatrx = 0.0_dp
  itype = row_of(jtype)
  good = itype > 0
  if (good) good = iand(elements(itype)%family, every_continuum) /= 0
  if (.not. good) then
    call refuse_type(jtype, jelem, 'is not an element with a material: specify MATERIAL= for U1 and U9 only')
    return
  end if
  good = call_is_good(itype, jelem, ndofel, nsvars, nprops, mcrd, nnode, njprop, ndload, props, jprops, &
    values, options)
  if (.not. good) return
  if (asks_for_nothing(lflags)) return

  n = size(state)
  state = svars(1:n)
  energies = energy
  weight = weight_of_start(lflags, params)
  if (abs(weight) > 0.0_dp) then
    call continuum_forces_at(itype, jelem, values, options, coords, u - du(1:ndofel, 1), large_displacements(lflags), state, &
      before, good)
    if (.not. good) return
  end if
  call evaluate_continuum(itype, jelem, values, options, coords, u, predef, npredf, materiallib, large_displacements(lflags), &
    asks_for_tangent(lflags), state, energies, pnewdt, residual, amatrx, good)
  if (.not. good) return
  if (abs(weight) > 0.0_dp) then
    residual = (1.0_dp - weight)*residual + weight*before
    amatrx = (1.0_dp - weight)*amatrx
  end if
  call give_answer(lflags, du(1:ndofel, 1), amatrx, residual, state, energies, rhs(1:ndofel, 1), svars(1:n), energy)
end subroutine uelmat
