! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The cross-section of a beam whose material is integrated over its section points.
!>
!> Stresses are S11, and S12 of torsion where the material has two (host_materials): the strain of a point is that of the section
!> there, less thermal expansion, its shear strain the twist times the lever of the point
!> (harness/uel/elements/families/beam_points.py). All other stresses are zero. Transverse shear, and torsion where the material
!> has one stress, are elastic and not in here.
module host_beam_section
  use host_context, only: current, output_variables
  use host_coupling, only: interpolate_fields, thermal_strain
  use host_kinds, only: dp, i4
  use host_materials, only: elastic_energy, has_fields, material_t, set_constants, stress_update
  use host_point, only: move_to, point_t
  use host_shape, only: rule_t
  use host_usdfld, only: call_usdfld
  use host_uvarm, only: keep_uvar
  implicit none (type, external)
  private
  public :: place_t, energies_t, section_response, values_of_point

  !> Where a section is.
  type :: place_t
    integer :: point = 0           !< integration point, from 1
    real(dp) :: axes(3, 3) = 0     !< columns t, 1, 2, as they are now
    real(dp) :: line(3) = 0        !< the line of the nodes there
    real(dp) :: centroid(2) = 0    !< along 1 and 2
    real(dp) :: weight = 0         !< length along the axis
    real(dp) :: length = 0         !< of the element
  end type place_t

  type :: energies_t
    real(dp) :: elastic = 0        !< now
    real(dp) :: work = 0           !< of the stresses in the increment
  end type energies_t

  real(dp), parameter :: identity(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])

contains

  !> Values of SVARS for a section point: strains, stresses, and with *PLASTIC plastic strains and the equivalent one.
  pure integer function values_of_point(material)
    type(material_t), intent(in) :: material
    values_of_point = 2*material%ntens
    if (allocated(material%yield)) values_of_point = 3*material%ntens + 1
  end function values_of_point

  !> Add what the stresses of the section points make to forces and stiffness of the section, both by the strains of host_beam.
  subroutine section_response(material, rule, place, sections, points, fields, predef, strain, force, stiffness, state, energies)
    type(material_t), intent(inout) :: material
    type(rule_t), intent(in) :: rule
    type(place_t), intent(in) :: place
    integer, intent(in) :: sections, fields
    real(dp), intent(in) :: points(4, sections)              !< place from the nodes along 1 and 2, area, lever
    real(dp), intent(in) :: predef(2, fields, rule%nodes)    !< of the nodes of the family
    real(dp), intent(in) :: strain(6)
    real(dp), intent(inout) :: force(6), stiffness(6, 6)
    real(dp), intent(inout), target :: state(:, :)           !< (values, sections)
    type(energies_t), intent(inout) :: energies
    real(dp) :: b(material%ntens, 6), total(material%ntens), stress(material%ntens), tangent(material%ntens, material%ntens)
    real(dp) :: thermal(6, 2), rate(6), volume, arm(2)
    type(point_t) :: point
    integer :: k, n
    n = material%ntens
    point%npt = int(place%point, i4)
    thermal = 0
    if (allocated(material%expansion)) then
      thermal = thermal_strain(rule, place%point, fields, material%expansion, predef, .true., rate)
    end if
    do k = 1, sections
      arm = points(:2, k) - place%centroid
      b = 0
      b(1, [1, 4, 5]) = [1.0_dp, arm(2), -arm(1)]
      b(n, 6) = merge(points(4, k), 0.0_dp, n == 2)
      total = matmul(b, strain)
      point%kspt = int(k, i4)
      call move_to(point, (place%point - 1)*sections + k)
      if (has_fields(material)) then
        point%length = place%length
        point%place = place%line + matmul(place%axes(:, 2:), points(:2, k))
        call interpolate_fields(rule, place%point, fields, predef, material%variables, point)
      end if
      if (current%flags(3) == output_variables) then
        call keep_uvar(material%user_output, n, point, transpose(place%axes), identity, state(:2*n, k))
        cycle
      end if
      if (allocated(material%user_field)) then
        call call_usdfld(material%user_field, n, point, transpose(place%axes), identity, .true., state(:2*n, k))
      end if
      if (allocated(material%dependence)) call set_constants(material, point)
      total(1) = total(1) - thermal(1, 2)
      call stress_update(material, point, total, stress, tangent)
      volume = place%weight*points(3, k)
      energies%elastic = energies%elastic + volume*elastic_energy(material, point, stress)
      total(1) = total(1) + thermal(1, 2)
      associate (old => state(:n, k), before => state(n + 1:2*n, k))
        ! trapezoidal rule, exact where the response is linear
        energies%work = energies%work + volume*0.5_dp*(dot_product(stress + before, total - old) &
                                                       - (stress(1) + before(1))*(thermal(1, 2) - thermal(1, 1)))
        old = total
        before = stress
      end associate
      if (allocated(material%yield)) then
        state(2*n + 1, k) = point%history_trial(1)
        if (n == 2) state(2*n + 2, k) = point%history_trial(4)
        state(3*n + 1, k) = point%history_trial(7)
      end if
      force = force + points(3, k)*matmul(stress, b)
      stiffness = stiffness + points(3, k)*matmul(transpose(b), matmul(tangent, b))
    end do
  end subroutine section_response
end module host_beam_section
