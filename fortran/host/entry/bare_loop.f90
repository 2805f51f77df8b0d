! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The same calls as in host_evaluate, in a plain loop: the benchmark for the driver. Like any loop over the elements of a mesh, it
!> gathers U and DU, sets SVARS and ENERGY to their start values, and adds RHS to the residual.
subroutine host_bare_loop(address, material, jtype, kstep, kinc, lflags, time, dtime, period, labels, jprops, equations, &
                          props, coords, u, du, svars, svars_trial, energy, energy_trial, residual, amatrx, ndofel, &
                          nsvars, nprops, njprop, mcrd, nnode, m, n)
  use, intrinsic :: iso_c_binding, only: c_f_procpointer, c_funptr, c_intptr_t
  use host_interfaces, only: uel_procedure, uelmat_procedure
  use host_kinds, only: dp, i4, i8
  implicit none (type, external)
  integer(i8), intent(in) :: address
  integer(i4), intent(in) :: material, jtype, kstep, kinc   !< as in host_evaluate
  real(dp), intent(in) :: time(2), dtime, period
  integer(i4), intent(in) :: ndofel, nsvars, nprops, njprop, mcrd, nnode, m, n
  integer(i4), intent(in) :: equations(ndofel, m)
  integer(i4), intent(inout) :: lflags(7), labels(m), jprops(njprop)
  real(dp), intent(inout) :: props(nprops), coords(mcrd, nnode, m)
  real(dp), intent(in) :: u(n), du(n), svars(nsvars, m), energy(8, m)
  real(dp), intent(inout) :: svars_trial(nsvars, m), energy_trial(8, m), residual(n), amatrx(ndofel, ndofel)
  procedure(uel_procedure), pointer :: uel
  procedure(uelmat_procedure), pointer :: uelmat
  type(c_funptr) :: pointer
  ! arguments that the element may change
  integer(i4) :: jdltyp(1), place(4), sizes(8), integers
  real(dp) :: clock(4), rates(ndofel), u_element(ndofel), du_element(ndofel), rhs(ndofel), params(3), load(1), &
              predef(2*nnode), pnewdt
  integer :: e
  pointer = transfer(int(address, c_intptr_t), pointer)
  place = [jtype, kstep, kinc, material]
  clock = [time, dtime, period]
  sizes = [ndofel, 1_i4, nsvars, nprops, mcrd, nnode, 0_i4, 1_i4]
  integers = njprop
  jdltyp = 0
  rates = 0
  params = 0
  load = 0
  predef = 0
  pnewdt = 1
  if (material > 0) then
    call c_f_procpointer(pointer, uelmat)
  else
    call c_f_procpointer(pointer, uel)
  end if
  do e = 1, m
    u_element = u(equations(:, e))
    du_element = du(equations(:, e))
    svars_trial(:, e) = svars(:, e)
    energy_trial(:, e) = energy(:, e)
    if (material > 0) then
      call uelmat(rhs, amatrx, svars_trial(:, e), energy_trial(:, e), sizes(1), sizes(2), sizes(3), props, sizes(4), &
                  coords(:, :, e), sizes(5), sizes(6), u_element, du_element, rates, rates, place(1), clock(1:2), clock(3), &
                  place(2), place(3), labels(e), params, sizes(7), jdltyp, load, predef, sizes(8), lflags, sizes(1), load, &
                  sizes(8), pnewdt, jprops, integers, clock(4), place(4))
    else
      call uel(rhs, amatrx, svars_trial(:, e), energy_trial(:, e), sizes(1), sizes(2), sizes(3), props, sizes(4), &
               coords(:, :, e), sizes(5), sizes(6), u_element, du_element, rates, rates, place(1), clock(1:2), clock(3), &
               place(2), place(3), labels(e), params, sizes(7), jdltyp, load, predef, sizes(8), lflags, sizes(1), load, &
               sizes(8), pnewdt, jprops, integers, clock(4))
    end if
    residual(equations(:, e)) = residual(equations(:, e)) + rhs
  end do
end subroutine host_bare_loop
