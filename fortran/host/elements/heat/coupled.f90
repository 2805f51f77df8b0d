! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in coupled temperature-displacement elements (CPE4T, CAX4T, C3D8T, ...), as a procedure with the arguments of
!> UELMAT: a continuum element (host_solid), and heat conduction with temperatures at its corners.
!>
!> The unknowns are the displacements of all nodes, then the temperatures of the corners. JPROPS go on with the family of the
!> temperatures and their integration points; SVARS with the heat flux of each of these, then the energies of UMATHT. The two
!> parts interact through thermal expansion, the heat terms of UMAT and HETVAL (host_coupling) and the change of shape, which the
!> tangent leaves out. The heat is that of host_conduction.
module host_coupled
  use host_conduction, only: body_t, conduct, is_steady
  use host_context, only: initial_stresses
  use host_coupling, only: coupling_t
  use host_kinds, only: dp, i4
  use host_materials, only: find_material
  use host_shape, only: rule_of
  use host_solid, only: solid_element
  implicit none (type, external)
  private
  public :: coupled_uelmat

contains

  subroutine coupled_uelmat(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                            v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                            lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period, materiallib)
    integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                   lflags(*), mlvarx, mdload, jprops(*), njprop, materiallib
    real(dp), target :: rhs(ndofel), amatrx(ndofel, ndofel), u(ndofel), du(ndofel)
    real(dp) :: svars(nsvars), energy(*), props(nprops), coords(mcrd, nnode), v(*), a(*), time(*), dtime, params(*), adlmag(*), &
                predef(*), ddlmag(*), pnewdt, period
    real(dp) :: force(mcrd*nnode), stiffness(mcrd*nnode, mcrd*nnode), now(mcrd, nnode)
    type(coupling_t) :: coupling
    type(body_t) :: body
    integer(i4) :: n, own
    n = mcrd*nnode
    rhs = 0
    amatrx = 0
    coupling%geometry => rule_of(int(jprops(1)), int(jprops(8)))
    coupling%field => rule_of(int(jprops(9)), int(jprops(8)))
    coupling%temperature => u(n + 1:)
    coupling%increment => du(n + 1:)
    coupling%heat => rhs(n + 1:)
    coupling%tangent => amatrx
    own = nsvars - (mcrd + 1_i4)*int(coupling%field%points, i4)
    call solid_element(force, stiffness, svars, energy, n, nrhs, own, props, coords, mcrd, nnode, u, du, v, a, params, dtime, &
                       predef, npredf, lflags, jprops, materiallib, coupling)
    rhs(:n) = force
    amatrx(:n, :n) = stiffness
    if (any(lflags(3) == [3_i4, 4_i4, initial_stresses])) return
    now = coords
    if (lflags(2) /= 0) now = now + reshape(u(:n), [int(mcrd), int(nnode)])
    body%geometry => coupling%geometry
    body%field => coupling%field
    body%states = jprops(2)
    body%direct = jprops(3)
    body%depth = merge(props(1), 1.0_dp, mcrd == 2)
    body%dtime = merge(0.0_dp, dtime, is_steady(lflags(1)))
    ! they are the hidden ones behind those of the stresses
    associate (flux => svars(own + 1:own + mcrd*body%field%points), energies => svars(nsvars - body%field%points + 1:nsvars))
      call conduct(body, find_material(materiallib), now, coords, int(npredf), predef, u(n + 1:), du(n + 1:), flux, energies, &
                   rhs(n + 1:), amatrx(n + 1:, n + 1:))
    end associate
  end subroutine coupled_uelmat
end module host_coupled
