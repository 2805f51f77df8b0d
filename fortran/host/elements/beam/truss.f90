! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in trusses (T2D2, T3D2). harness/uel/elements/families/discrete.py gives what they need.
!>
!> Values of PROPS, JPROPS and SVARS: built_in.toml. In dynamic analyses SVARS go on with the forces of the last two increments; the
!> material history, if there is one, holds STATEV, and of UMAT what host_umat says. With NLGEOM the strain is the logarithm of the
!> stretch and the volume stays (Abaqus Theory Guide, Truss elements).
module host_truss
  use host_adapter, only: element_t, keep_forces
  use host_bar, only: bar_forces, bar_of, bar_t, initial_length
  use host_coupling, only: interpolate_fields
  use host_kinds, only: dp
  use host_layout, only: j_truss_family, p_truss_area, p_truss_density, s_truss_e11, s_truss_pe11, s_truss_peeq, s_truss_s11, &
                         truss_values
  use host_materials, only: elastic_energy, has_fields, material_t, set_constants, stress_update
  use host_mises, only: mises_uniaxial
  use host_point, only: move_to, point_t
  use host_shape, only: rule_of
  use host_usdfld, only: call_usdfld
  implicit none (type, external)
  private
  public :: truss

contains

  subroutine truss(element)
    type(element_t), intent(inout) :: element
    real(dp) :: pull, slope
    type(bar_t) :: bar
    type(point_t) :: point
    integer :: i
    call keep_forces(element, truss_values + 1, size(element%svars) + 1)
    associate (props => element%props)
      do i = 1, merge(element%n, 0, element%has_mass)
        element%mass(i, i) = 0.5_dp*props(p_truss_area)*props(p_truss_density)*initial_length(element%mcrd, element%coords)
      end do
      if (.not. element%has_forces) return
      bar = bar_of(element%mcrd, element%finite, element%coords, element%u)
      call move_to(point, 1)
      if (has_fields(element%material)) call set_fields(element, bar, point)
      call truss_force(element%material, point, props(p_truss_area), bar, element%svars, pull, slope, element%energy)
    end associate
    call bar_forces(element%mcrd, bar, element%request, pull, slope, element%added, element%rhs, element%amatrx)
  end subroutine truss

  !> Temperature and field variables of the point, as USDFLD leaves them, and the elastic constants at them.
  subroutine set_fields(element, bar, point)
    type(element_t), intent(inout) :: element
    type(bar_t), intent(in) :: bar
    type(point_t), intent(inout) :: point
    real(dp), parameter :: no_directions(3, 3) = 0
    associate (material => element%material, dim => element%mcrd, x => element%coords)
      point%length = bar%now
      point%place = 0
      point%place(:dim) = sum(x, 2)/2
      if (bar%finite) point%place(:dim) = sum(x + reshape(element%u, [dim, 2]), 2)/2
      call interpolate_fields(rule_of(int(element%jprops(j_truss_family)), 1), 1, element%fields, element%predef, &
                              material%variables, point)
      if (allocated(material%user_field)) then
        call call_usdfld(material%user_field, material%ntens, point, no_directions, no_directions, .true., &
                            element%svars(:truss_values))
      end if
      if (allocated(material%dependence)) call set_constants(material, point)
    end associate
  end subroutine set_fields

  !> Force of a truss and its derivative by the elongation; UMAT, or Mises plasticity in one direction where there is a table.
  subroutine truss_force(material, point, area, bar, state, pull, slope, energy)
    type(material_t), intent(in) :: material
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: area
    type(bar_t), intent(in) :: bar
    real(dp), intent(inout) :: state(truss_values), energy(8)
    real(dp), intent(out) :: pull, slope
    real(dp) :: strain, stress, modulus, volume, work, elastic, found(1), tangent(1, 1)
    associate (young => material%young, length => bar%length, now => bar%now)
      volume = area*length
      strain = bar%elongation/length
      if (bar%finite) strain = log(now/length)
      if (allocated(material%user)) then
        ! without deformation gradients (User Subroutines Guide, UMAT), and nothing turns along the line
        call stress_update(material, point, [strain], found, tangent)
        stress = found(1)
        modulus = tangent(1, 1)
        elastic = elastic_energy(material, point, found)
      else
        stress = young*strain
        modulus = young
        if (allocated(material%yield)) then
          call mises_uniaxial(young, material%yield, strain, state(s_truss_pe11), state(s_truss_peeq), stress, modulus)
        end if
        elastic = 0.5_dp*stress**2/young
      end if
      ! trapezoidal rule, exact where the response is linear
      work = energy(2) + energy(4) + 0.5_dp*volume*(stress + state(s_truss_s11))*(strain - state(s_truss_e11))
      state(s_truss_e11) = strain
      state(s_truss_s11) = stress
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
