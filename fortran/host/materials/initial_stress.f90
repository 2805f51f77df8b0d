! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Initial stresses of the built-in continuum elements (*INITIAL CONDITIONS, TYPE=STRESS), in a pass of the host's own before
!> the analysis. UMAT gets them in STRESS; built-in materials get the stress-free strain.
module host_initial_stress
  use host_kinds, only: dp
  use host_kinematics, only: components, rotated
  use host_materials, only: elastic_energy, material_t
  use host_point, only: point_t
  use host_umat, only: stress_place
  implicit none (type, external)
  private
  public :: begin_point

contains

  !> Make the stress in SVARS the initial stress of the material at a point, in its history; returns the components that belong to
  !> the strains of the element, in global directions, and adds the elastic energy.
  subroutine begin_point(material, point, volume, state, stress, elastic)
    type(material_t), intent(in) :: material
    type(point_t), intent(in) :: point
    real(dp), intent(in) :: volume, state(:)      !< state: strain, then stress, in the directions of the material
    real(dp), intent(out) :: stress(:)
    real(dp), intent(inout) :: elastic
    real(dp) :: all(size(state)/2), t(material%ntens), strain(material%ntens)
    integer :: n, place(material%ntens)
    n = size(state)/2
    all = state(n + 1:)
    if (material%turned) all = rotated(n, all, transpose(material%axes), 1.0_dp)
    place = components(material%ntens, n)
    t = all(place)
    associate (history => point%history_trial)
      if (allocated(material%user)) then
        history(stress_place:stress_place + material%ntens - 1) = t
      else if (material%prestressed) then
        strain = matmul(material%compliance(:material%ntens, :material%ntens), t)
        history(:6) = 0
        history(place) = -strain
        if (material%ntens == 3) history(3) = -dot_product(material%thickness, t)
      end if
    end associate
    stress = t(components(size(stress), material%ntens))
    elastic = elastic + volume*elastic_energy(material, point, t)
  end subroutine begin_point
end module host_initial_stress
