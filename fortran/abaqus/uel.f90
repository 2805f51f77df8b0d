! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Entry point of Abaqus/Standard for the interface elements, all types but U1.
!>
!> Everything is declared, so that ABA_PARAM.INC and its implicit typing are not needed. The routine sets every entry of RHS and
!> AMATRX, whatever they hold on entry. SVARS and ENERGY change only in calls whose values are kept, LFLAGS(3) = 1 of a general
!> step. In a linear step (LFLAGS(4) = 1) RHS is the effect of the perturbation: zero without loads on the elements, and -AMATRX DU
!> once DU is known (LFLAGS(3) = 100).
subroutine uel(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, v, a, &
  jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, lflags, mlvarx, ddlmag, &
  mdload, pnewdt, jprops, njprop, period)
  use core_kinds, only: dp
  use abaqus_check, only: call_is_good
  use abaqus_interface_elements, only: evaluate_interface
  use abaqus_layout, only: elements, reals, integers, variables_of
  use abaqus_report, only: fatal
  implicit none(type, external)
  integer, intent(in) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, npredf, mlvarx
  integer, intent(in) :: mdload, njprop, jdltyp(mdload, *), lflags(*), jprops(*)
  real(dp), intent(inout) :: rhs(mlvarx, *), amatrx(ndofel, ndofel), svars(*), energy(8), pnewdt
  real(dp), intent(in) :: props(*), coords(mcrd, nnode), u(ndofel), du(mlvarx, *), v(ndofel), a(ndofel), time(2), dtime
  real(dp), intent(in) :: params(*), adlmag(mdload, *), predef(2, npredf, nnode), ddlmag(mdload, *), period
  real(dp) :: residual(ndofel), tangent(ndofel, ndofel), state(variables_of(jtype)), energies(8), values(size(reals))
  logical :: good, with_tangent
  integer :: n, options(size(integers))

  rhs(1:ndofel, 1:nrhs) = 0.0_dp
  amatrx = 0.0_dp
  if (jtype < 2 .or. jtype > size(elements)) then
    if (jtype == 1) then
      call fatal(jtype, jelem, 'takes its stress from a material: specify MATERIAL= on *UEL PROPERTY', &
        [integer ::], [real(dp) ::])
    else
      call fatal(jtype, jelem, 'is not an element of this file, which has U1 to U%I', [size(elements)], [real(dp) ::])
    end if
    return
  end if
  good = call_is_good(jtype, jelem, ndofel, nsvars, nprops, mcrd, nnode, njprop, ndload, lflags, props, jprops, &
    values, options)
  if (.not. good) return
  ! neither damping nor mass: those matrices stay zero
  if (lflags(3) == 3 .or. lflags(3) == 4) return

  n = size(state)
  state = svars(1:n)
  with_tangent = lflags(3) /= 5 .and. lflags(3) /= 6
  call evaluate_interface(jtype, jelem, values, options, coords, u, dtime, lflags(2) /= 0, with_tangent, state, energies, &
    residual, tangent, good)
  if (.not. good) return
  if (with_tangent) amatrx = tangent
  if (lflags(4) == 1) then
    if (lflags(3) == 100) rhs(1:ndofel, 1) = -matmul(amatrx, du(1:ndofel, 1))
    return
  end if
  if (lflags(3) /= 2) rhs(1:ndofel, 1) = residual
  if (lflags(3) == 1) then
    svars(1:n) = state
    energy = energies
  end if
end subroutine uel
