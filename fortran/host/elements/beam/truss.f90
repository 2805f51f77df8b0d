! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in trusses (T2D2, T3D2) as a procedure with the arguments of UELMAT. harness/uel/elements/families/discrete.py gives
!> what they need.
!>
!> PROPS hold area and density, JPROPS the family of the line (host_shape). SVARS hold strain, stress, plastic strain and
!> equivalent plastic strain, in dynamic analyses then the forces of the last two increments; the material history, if there is
!> one, STATEV, and of UMAT what host_umat says. With NLGEOM the strain is the logarithm of the stretch and the volume stays (Abaqus
!> Theory Guide, Truss elements).
module host_truss
  use host_bar, only: bar_forces, bar_of, bar_t, initial_length
  use host_context, only: current
  use host_coupling, only: interpolate_fields
  use host_inertia, only: respond
  use host_kinds, only: dp, i4
  use host_materials, only: elastic_energy, find_material, has_fields, material_t, set_constants, stress_update
  use host_mises, only: mises_uniaxial
  use host_shape, only: rule_of
  use host_usdfld, only: call_usdfld
  implicit none (type, external)
  private
  public :: truss_uelmat

  integer, parameter :: states = 4   !< values of SVARS of the point

contains

  subroutine truss_uelmat(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                          v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                          lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period, materiallib)
    integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                   lflags(*), mlvarx, mdload, jprops(*), njprop, materiallib
    real(dp) :: rhs(*), amatrx(*), svars(*), energy(*), props(*), coords(*), u(*), du(*), v(*), a(*), time(*), dtime, &
                params(*), adlmag(*), predef(*), ddlmag(*), pnewdt, period
    real(dp) :: mass(ndofel, ndofel), old(ndofel, 2), pull, slope
    type(material_t), pointer :: material
    type(bar_t) :: bar
    integer :: i, n
    n = ndofel
    rhs(1:n*nrhs) = 0
    amatrx(1:n*n) = 0
    mass = 0
    do i = 1, n
      mass(i, i) = 0.5_dp*props(1)*props(2)*initial_length(int(mcrd), coords)
    end do
    old = 0
    if (nsvars > states) old = reshape(svars(states + 1:states + 2*n), [n, 2])
    if (lflags(3) /= 3 .and. lflags(3) /= 4) then
      material => find_material(materiallib)
      bar = bar_of(int(mcrd), lflags(2) /= 0, coords, u)
      if (has_fields(material)) then
        call set_fields(material, int(jprops(1)), int(mcrd), bar, coords, u, int(npredf), predef, svars)
      end if
      call truss_force(material, props(1), bar, svars, pull, slope, energy)
      if (allocated(current%fields)) deallocate (current%fields)
      call bar_forces(int(mcrd), bar, lflags(3), pull, slope, du, rhs, amatrx)
    end if
    call respond(n, lflags, params, dtime, v, a, mass, old, rhs, amatrx, energy(1))
    if (nsvars > states) svars(states + 1:states + 2*n) = reshape(old, [2*n])
  end subroutine truss_uelmat

  !> Temperature and field variables of the point, as USDFLD leaves them, and the elastic constants at them.
  subroutine set_fields(material, family, dim, bar, x, u, fields, predef, state)
    type(material_t), intent(inout) :: material
    integer, intent(in) :: family, dim, fields
    type(bar_t), intent(in) :: bar
    real(dp), intent(in) :: x(dim, 2), u(dim, 2), predef(2, fields, 2)
    real(dp), intent(in), target :: state(states)
    real(dp), parameter :: no_directions(3, 3) = 0
    current%length = bar%now
    current%place = 0
    current%place(:dim) = sum(x, 2)/2
    if (bar%finite) current%place(:dim) = sum(x + u, 2)/2
    call interpolate_fields(rule_of(family, 1), 1, fields, predef, material%variables)
    if (allocated(material%user_field)) then
      call call_usdfld(material%user_field, material%ntens, 1_i4, no_directions, no_directions, .true., state)
    end if
    if (allocated(material%dependence)) call set_constants(material, 1)
  end subroutine set_fields

  !> Force of a truss and its derivative by the elongation; UMAT, or Mises plasticity in one direction where there is a table.
  subroutine truss_force(material, area, bar, state, pull, slope, energy)
    type(material_t), intent(in) :: material
    real(dp), intent(in) :: area
    type(bar_t), intent(in) :: bar
    real(dp), intent(inout) :: state(states), energy(8)
    real(dp), intent(out) :: pull, slope
    real(dp) :: strain, stress, modulus, volume, work, elastic, found(1), tangent(1, 1)
    logical :: valid
    associate (young => material%young, length => bar%length, now => bar%now)
      volume = area*length
      strain = bar%elongation/length
      if (bar%finite) strain = log(now/length)
      if (allocated(material%user)) then
        ! without deformation gradients (User Subroutines Guide, UMAT), and nothing turns along the line
        current%finite = .false.
        call stress_update(material, 1_i4, [strain], found, tangent, valid)
        stress = found(1)
        modulus = tangent(1, 1)
        elastic = elastic_energy(material, 1_i4, found)
      else
        stress = young*strain
        modulus = young
        if (allocated(material%yield)) then
          call mises_uniaxial(young, material%yield, strain, state(3), state(4), stress, modulus)
        end if
        elastic = 0.5_dp*stress**2/young
      end if
      ! trapezoidal rule, exact where the response is linear
      work = energy(2) + energy(4) + 0.5_dp*volume*(stress + state(2))*(strain - state(1))
      state(1:2) = [strain, stress]
      energy(2) = volume*elastic
      energy(4) = work - energy(2)
      pull = area*stress
      slope = area*modulus/length
      if (bar%finite) then
        pull = pull*length/now
        slope = volume*(modulus - stress)/now**2
      end if
    end associate
  end subroutine truss_force
end module host_truss
