! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Length of the process zone of a self-contained interface element in a large body, in the pure modes
!>
!>     l_II = sqrt(E_n E_t) G_IIc/(2 t**2),    l_I = E_n G_Ic/(2 s**2),
!>
!> with the moduli across (E_n) and along the interface (E_t) and the strengths t and s. Between slender arms, whose height the
!> element does not know, it is shorter. With fibre bridging, s, t and G_c are those of the tip.
!> harness/uel/elements/interfaces/process_zone.py has the sources, and the formulas of the arms.
module elements_process_zone
  use core_cells, only: corners_of
  use core_kinds, only: dp
  use core_status, only: status_type
  use cohesive_parameters, only: law_parameters
  use materials_linear_elasticity, only: engineering_constants, young_modulus
  use elements_interface_faces, only: central_frame
  use elements_interface_point, only: interface_point
  implicit none(type, external)
  private
  public :: failing_point, measure_zone

  !> Dissipated share of the fracture energy from which on a point counts as failing: any law gives a bonded point less.
  real(dp), parameter :: failed = 0.5_dp

contains

  !> Point with the largest damage if it fails, else 0.
  pure integer function failing_point(points, law)
    type(interface_point), intent(in) :: points(:)
    type(law_parameters), intent(in) :: law

    failing_point = maxloc(points%history%damage, dim=1)
    associate (history => points(failing_point)%history)
      ! where the toughness of the mode mix is below both others, half of their sum may be all of it
      if (.not. (sum(history%dissipated/law%toughness) > failed .or. history%damage >= 1.0_dp)) failing_point = 0
    end associate
  end function failing_point

  !> Shortest edge of an interface, to which a mesh is refined whichever way the crack goes, and the zone of a point that has
  !> dissipated these energies: 1/zone is the mean of 1/l_II and 1/l_I with the energies as weights.
  pure subroutine measure_zone(faces, coordinates, direction, materials, law, dissipated, length, zone, share)
    integer, intent(in) :: faces(:, :)                       !< nodes of the bottom and the top face, a column each, corners first
    real(dp), intent(in) :: coordinates(:, :)                !< original ones, (2 or 3, nodes)
    real(dp), intent(in) :: direction(3)                     !< for s, in space; zero: none
    type(engineering_constants), intent(in) :: materials(2)  !< of the solids below and above
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: dissipated(2)                    !< (tau, n), energy/area; zero: in the mode of the shorter zone
    real(dp), intent(out) :: length
    real(dp), intent(out) :: zone                            !< huge where the edge has no length, and so no direction
    real(dp), intent(out) :: share                           !< of mode II, from 0 to 1
    real(dp), dimension(size(coordinates, 1)) :: edge, shortest
    type(status_type) :: status    ! the stiffness of the solids needs the same frame, and has found it
    real(dp) :: frame(3, 3), zones(2), shares(2), across, along
    integer :: corners, k, side

    corners = 2
    if (size(edge) == 3) corners = corners_of(2, size(faces, 1))
    length = huge(1.0_dp)
    do k = 1, corners
      edge = 0.5_dp*(middle(mod(k, corners) + 1) - middle(k))
      if (norm2(edge) >= length) cycle
      length = norm2(edge)
      shortest = edge
    end do
    zone = huge(1.0_dp)
    share = 0.0_dp
    if (.not. length > 0.0_dp) return
    across = huge(1.0_dp)
    along = huge(1.0_dp)
    if (size(edge) == 3) call central_frame(size(faces, 1), coordinates(:, faces(:, 1)), coordinates(:, faces(:, 2)), direction, &
      frame, status)
    do side = 1, 2
      associate (ply => materials(side))
        if (size(edge) == 2) then
          along = min(along, young_modulus(ply, shortest))
          across = min(across, young_modulus(ply, [-shortest(2), shortest(1)]))
        else
          along = min(along, young_modulus(ply, matmul(frame([1, 3], :), shortest)))
          across = min(across, ply%e3)
        end if
      end associate
    end do
    ! where fibres bridge, the zone of the tip alone is the shorter one
    zones = 0.5_dp*[sqrt(across*along), across]*((1.0_dp - law%bridging_energy)*law%toughness) &
      /((1.0_dp - law%bridging_strength)*law%strength)**2
    shares = merge(1.0_dp, 0.0_dp, [zones(1) < zones(2), zones(1) >= zones(2)])
    if (sum(dissipated) > 0.0_dp) shares = min(max(dissipated/sum(dissipated), 0.0_dp), 1.0_dp)
    zone = 1.0_dp/sum(shares/zones)
    share = shares(1)

  contains

    !> Twice the mean of a corner's places on both faces.
    pure function middle(corner)
      integer, intent(in) :: corner
      real(dp) :: middle(size(coordinates, 1))

      middle = coordinates(:, faces(corner, 1)) + coordinates(:, faces(corner, 2))
    end function middle

  end subroutine measure_zone

end module elements_process_zone
