! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in generalised plane strain elements (CPEG4, CPEG8, ...), as a procedure with the arguments of UELMAT: a continuum element
!> (host_solid) between two planes (host_planes).
!>
!> The unknowns are the displacements of all nodes, then those of the reference node. PROPS go on with the place of this node;
!> PROPS(1) is the length of its fibre before any displacement.
module host_generalised
  use host_kinds, only: dp, i4
  use host_planes, only: planes_t
  use host_solid, only: solid_element
  implicit none (type, external)
  private
  public :: generalised_uelmat

  integer, parameter :: of_solid = 3   !< PROPS of host_solid

contains

  subroutine generalised_uelmat(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                                v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                                lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period, materiallib)
    integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                   lflags(*), mlvarx, mdload, jprops(*), njprop, materiallib
    real(dp) :: rhs(*), amatrx(*), svars(*), energy(*), props(nprops), coords(mcrd, nnode), u(*), du(*), v(*), a(*), time(*), &
                dtime, params(*), adlmag(*), predef(*), ddlmag(*), pnewdt, period
    type(planes_t) :: bounds
    bounds%origin = props(of_solid + 1:)
    bounds%length = props(1)
    call solid_element(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, coords, mcrd, nnode, u, du, v, a, params, dtime, &
                       predef, npredf, lflags, jprops, materiallib, bounds=bounds)
  end subroutine generalised_uelmat
end module host_generalised
