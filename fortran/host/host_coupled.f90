! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in coupled temperature-displacement elements (CPE4T, CAX4T, C3D8T, ...), as a procedure with the arguments of
!> UELMAT: a continuum element (host_solid), and heat conduction with temperatures at its corners.
!>
!> The unknowns are the displacements of all nodes, then the temperatures of the corners. PROPS go on with conductivity and
!> specific heat, JPROPS with the integration points and the family of the temperatures. Without thermal expansion, the two parts
!> interact through the heat terms of UMAT (host_coupling) and through the change of shape, which the tangent leaves out.
!>
!> Heat is conducted through the present shape (Fourier's law, isotropic). It is stored by the initial mass, over time by
!> backward differences, at the corners in elements with straight edges, as in Abaqus (Theory Guide, Uncoupled heat
!> transfer analysis).
module host_coupled
  use core_small_matrix, only: invert
  use host_context, only: initial_stresses
  use host_coupling, only: coupling_t
  use host_inertia, only: scalar_mass
  use host_kinds, only: dp, i4
  use host_shape, only: radius_of, rule_of, rule_t
  use host_solid, only: solid_element
  implicit none (type, external)
  private
  public :: coupled_uelmat

  integer(i4), parameter :: steady_state = 71   !< LFLAGS(1)

contains

  subroutine coupled_uelmat(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                            v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                            lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period, materiallib)
    integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                   lflags(*), mlvarx, mdload, jprops(*), njprop, materiallib
    real(dp), target :: rhs(ndofel), amatrx(ndofel, ndofel), u(ndofel), du(ndofel)
    real(dp) :: svars(*), energy(*), props(nprops), coords(mcrd, nnode), v(*), a(*), time(*), dtime, params(*), adlmag(*), &
                predef(*), ddlmag(*), pnewdt, period
    real(dp) :: force(mcrd*nnode), stiffness(mcrd*nnode, mcrd*nnode), now(mcrd, nnode)
    type(coupling_t) :: coupling
    integer(i4) :: n
    n = mcrd*nnode
    rhs = 0
    amatrx = 0
    coupling%geometry => rule_of(int(jprops(1)), int(jprops(7)))
    coupling%field => rule_of(int(jprops(8)), int(jprops(7)))
    coupling%temperature => u(n + 1:)
    coupling%increment => du(n + 1:)
    coupling%heat => rhs(n + 1:)
    coupling%tangent => amatrx
    call solid_element(force, stiffness, svars, energy, n, nrhs, nsvars, props, coords, mcrd, nnode, u, du, v, a, params, dtime, &
                       predef, npredf, lflags, jprops, materiallib, coupling)
    rhs(:n) = force
    amatrx(:n, :n) = stiffness
    if (any(lflags(3) == [3_i4, 4_i4, initial_stresses])) return
    now = coords
    if (lflags(2) /= 0) now = now + reshape(u(:n), [int(mcrd), int(nnode)])
    associate (t => u(n + 1:), dt => du(n + 1:), thickness => merge(props(1), 1.0_dp, mcrd == 2), axisymmetric => jprops(3) > mcrd)
      call conduct(coupling%geometry, coupling%field, axisymmetric, thickness*props(4), now, t, rhs(n + 1:), &
                   amatrx(n + 1:, n + 1:))
      if (lflags(1) /= steady_state .and. dtime > 0) then
        call store(coupling%geometry, coupling%field, axisymmetric, thickness*props(2)*props(5)/dtime, coords, dt, &
                   rhs(n + 1:), amatrx(n + 1:, n + 1:))
      end if
    end associate
  end subroutine coupled_uelmat

  !> Heat that flows into the corners by conduction, and its tangent.
  pure subroutine conduct(geometry, field, axisymmetric, conductivity, x, t, heat, tangent)
    type(rule_t), intent(in) :: geometry, field   !< of the shape, and of the temperatures
    logical, intent(in) :: axisymmetric
    real(dp), intent(in) :: conductivity   !< times thickness or 2 pi
    real(dp), intent(in) :: x(geometry%dim, geometry%nodes), t(field%nodes)
    real(dp), intent(inout) :: heat(field%nodes), tangent(field%nodes, field%nodes)
    real(dp) :: g(field%nodes, field%dim), matrix(field%nodes, field%nodes), inverse(field%dim, field%dim), determinant
    integer :: p
    matrix = 0
    do p = 1, field%points
      call invert(field%dim, matmul(x, geometry%dn(:, :, p)), inverse, determinant)
      g = matmul(field%dn(:, :, p), inverse)
      determinant = determinant*radius_of(geometry, p, axisymmetric, x)
      matrix = matrix + conductivity*field%weight(p)*determinant*matmul(g, transpose(g))
    end do
    heat = heat - matmul(matrix, t)
    tangent = tangent + matrix
  end subroutine conduct

  !> Heat that warms the corners, and its tangent.
  pure subroutine store(geometry, field, axisymmetric, capacity, x, dt, heat, tangent)
    type(rule_t), intent(in) :: geometry, field
    logical, intent(in) :: axisymmetric
    real(dp), intent(in) :: capacity   !< per volume, times thickness or 2 pi, over the time increment
    real(dp), intent(in) :: x(geometry%dim, geometry%nodes), dt(field%nodes)
    real(dp), intent(inout) :: heat(field%nodes), tangent(field%nodes, field%nodes)
    real(dp) :: matrix(field%nodes, field%nodes)
    call scalar_mass(geometry, field, axisymmetric, capacity, x, matrix)
    heat = heat - matmul(matrix, dt)
    tangent = tangent + matrix
  end subroutine store
end module host_coupled
