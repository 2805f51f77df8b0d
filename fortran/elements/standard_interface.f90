! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Standard cohesive interface element, equations (14) and (15): zero thickness, four nodes, two points.
module elements_standard_interface
  use core_kinds, only: dp
  use core_status, only: status_type, ok
  use cohesive_parameters, only: law_parameters
  use cohesive_state, only: damage_state
  use cohesive_law, only: check_law, evolve_damage, stiffness_of
  use cohesive_traction, only: standard_traction
  use elements_interface_point, only: interface_options, interface_point, interface_geometry, &
    measure_interface, separation_at, add_point, spread_to_nodes, close_point, point_energies
  implicit none(type, external)
  private
  public :: standard_interface

contains

  !> Residual (external minus internal force), tangent and state at the end of the increment.
  pure subroutine standard_interface(law, options, thickness, coordinates, u, dtime, old, new, residual, tangent, &
    energies, status)
    type(law_parameters), intent(in) :: law
    type(interface_options), intent(in) :: options
    real(dp), intent(in) :: thickness             !< out of the plane, length
    real(dp), intent(in) :: coordinates(2, 4)     !< original coordinates, length
    real(dp), intent(in) :: u(2, 4)               !< displacements at the end of the increment, length
    real(dp), intent(in) :: dtime                 !< duration of the increment
    type(interface_point), intent(in) :: old(2)   !< committed state
    type(interface_point), intent(out) :: new(2)
    real(dp), intent(out) :: residual(2, 4)       !< force
    real(dp), intent(out) :: tangent(2, 4, 2, 4)  !< -d(residual)/du, force/length
    real(dp), intent(out) :: energies(3)          !< stored T.g/2, dissipated by damage, viscous
    type(status_type), intent(out) :: status
    type(interface_geometry) :: geometry
    type(damage_state) :: state
    real(dp) :: separation(2), traction(2), local(2, 2), force(2, 2), matrix(2, 2, 2, 2), weight
    integer :: k

    residual = 0.0_dp
    tangent = 0.0_dp
    energies = 0.0_dp
    call check_law(law, status)
    if (status%code /= ok) return
    call measure_interface(coordinates, options%rule, geometry, status)
    if (status%code /= ok) return

    force = 0.0_dp
    matrix = 0.0_dp
    weight = 0.5_dp*geometry%length*thickness
    do k = 1, 2
      separation = separation_at(geometry%frame, geometry%s(k), u)
      call evolve_damage(law, old(k)%history, separation, dtime, state)
      state%slope = (1.0_dp - options%secant_share)*state%slope
      call standard_traction(stiffness_of(law), separation, state%acting, state%slope, traction, local)
      call add_point(geometry%frame, geometry%s(k), weight, traction, local, force, matrix)
      ! S = 1 turns the stabilised weak form into the standard one
      call close_point(law, geometry, geometry%s(k), old(k), separation, state, traction, [1.0_dp, 1.0_dp], new(k))
      energies = energies + point_energies(weight, new(k))
    end do
    call spread_to_nodes(force, matrix, residual, tangent)
  end subroutine standard_interface

end module elements_standard_interface
