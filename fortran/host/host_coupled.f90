! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in coupled temperature-displacement elements (CPE4T, CAX4T, C3D8T, ...), as a procedure with the arguments of
!> UELMAT: a continuum element (host_solid), and heat conduction with temperatures at its corners.
!>
!> The unknowns are the displacements of all nodes, then the temperatures of the corners. PROPS go on with conductivity and
!> specific heat. Without thermal expansion the two parts see each other through what UMAT says of heat (host_coupling), and
!> through the change of shape, which the tangent leaves out.
!>
!> Heat is conducted through the present shape (Fourier's law, isotropic). It is stored by the initial mass, over time by
!> backward differences, at the corners in elements with straight edges, as in Abaqus (Theory Guide, Uncoupled heat
!> transfer analysis).
module host_coupled
  use core_small_matrix, only: invert
  use host_context, only: initial_stresses
  use host_coupling, only: coupling_t, thermal_points
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
    associate (t => u(n + 1:), dt => du(n + 1:), thickness => merge(props(1), 1.0_dp, mcrd == 2), axisymmetric => jprops(2) > mcrd)
      call conduct(int(mcrd), int(nnode), size(t), int(jprops(1)), axisymmetric, thickness*props(4), now, t, rhs(n + 1:), &
                   amatrx(n + 1:, n + 1:))
      if (lflags(1) /= steady_state .and. dtime > 0) then
        call store(int(mcrd), int(nnode), size(t), int(jprops(1)), axisymmetric, thickness*props(2)*props(5)/dtime, coords, dt, &
                   rhs(n + 1:), amatrx(n + 1:, n + 1:))
      end if
    end associate
  end subroutine coupled_uelmat

  !> Heat that flows into the corners by conduction, and its tangent.
  subroutine conduct(dim, nodes, corners, points, axisymmetric, conductivity, x, t, heat, tangent)
    integer, intent(in) :: dim, nodes, corners, points
    logical, intent(in) :: axisymmetric
    real(dp), intent(in) :: conductivity   !< times thickness or 2 pi
    real(dp), intent(in) :: x(dim, nodes), t(corners)
    real(dp), intent(inout) :: heat(corners), tangent(corners, corners)
    real(dp) :: g(corners, dim), matrix(corners, corners), inverse(dim, dim), determinant
    type(rule_t), pointer :: geometry, field
    integer :: p
    call rules(dim, nodes, corners, points, axisymmetric, geometry, field)
    matrix = 0
    do p = 1, field%points
      call invert(dim, matmul(x, geometry%dn(:, :, p)), inverse, determinant)
      g = matmul(field%dn(:, :, p), inverse)
      determinant = determinant*radius_of(geometry, p, axisymmetric, x)
      matrix = matrix + conductivity*field%weight(p)*determinant*matmul(g, transpose(g))
    end do
    heat = heat - matmul(matrix, t)
    tangent = tangent + matrix
  end subroutine conduct

  !> Heat that the corners take to become warmer, and its tangent.
  subroutine store(dim, nodes, corners, points, axisymmetric, capacity, x, dt, heat, tangent)
    integer, intent(in) :: dim, nodes, corners, points
    logical, intent(in) :: axisymmetric
    real(dp), intent(in) :: capacity   !< per volume, times thickness or 2 pi, over the time increment
    real(dp), intent(in) :: x(dim, nodes), dt(corners)
    real(dp), intent(inout) :: heat(corners), tangent(corners, corners)
    real(dp) :: matrix(corners, corners), inverse(dim, dim), determinant, weight
    type(rule_t), pointer :: geometry, field
    integer :: k, p
    call rules(dim, nodes, corners, points, axisymmetric, geometry, field)
    matrix = 0
    do p = 1, field%points
      call invert(dim, matmul(x, geometry%dn(:, :, p)), inverse, determinant)
      weight = capacity*field%weight(p)*determinant*radius_of(geometry, p, axisymmetric, x)
      do k = 1, corners
        if (nodes == corners) then
          matrix(k, k) = matrix(k, k) + weight*field%n(k, p)
        else
          matrix(:, k) = matrix(:, k) + weight*field%n(k, p)*field%n(:, p)
        end if
      end do
    end do
    heat = heat - matmul(matrix, dt)
    tangent = tangent + matrix
  end subroutine store

  !> Integration points with the functions of the shape and of the temperature.
  subroutine rules(dim, nodes, corners, points, axisymmetric, geometry, field)
    integer, intent(in) :: dim, nodes, corners, points
    logical, intent(in) :: axisymmetric
    type(rule_t), pointer, intent(out) :: geometry, field
    integer :: count
    count = thermal_points(dim, nodes, points, axisymmetric)
    geometry => rule_of(dim, nodes, count)
    field => rule_of(dim, corners, count)
  end subroutine rules
end module host_coupled
