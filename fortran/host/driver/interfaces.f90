! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Interfaces of the procedures a user's file supplies, with the arguments of Abaqus in their order.
module host_interfaces
  use host_kinds, only: dp, i4
  implicit none (type, external)
  private
  public :: uel_procedure, uelmat_procedure, uexternaldb_procedure

  abstract interface
    subroutine uel_procedure(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                             v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                             lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period)
      import :: dp, i4
      real(dp) :: rhs(*), amatrx(*), svars(*), energy(*), props(*), coords(*), u(*), du(*), v(*), a(*), time(*), dtime, &
                  params(*), adlmag(*), predef(*), ddlmag(*), pnewdt, period
      integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                     lflags(*), mlvarx, mdload, jprops(*), njprop
    end subroutine uel_procedure

    subroutine uelmat_procedure(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                                v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                                lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period, materiallib)
      import :: dp, i4
      real(dp) :: rhs(*), amatrx(*), svars(*), energy(*), props(*), coords(*), u(*), du(*), v(*), a(*), time(*), dtime, &
                  params(*), adlmag(*), predef(*), ddlmag(*), pnewdt, period
      integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                     lflags(*), mlvarx, mdload, jprops(*), njprop, materiallib
    end subroutine uelmat_procedure

    subroutine uexternaldb_procedure(lop, lrestart, time, dtime, kstep, kinc)
      import :: dp, i4
      integer(i4) :: lop, lrestart, kstep, kinc
      real(dp) :: time(*), dtime
    end subroutine uexternaldb_procedure
  end interface
end module host_interfaces
