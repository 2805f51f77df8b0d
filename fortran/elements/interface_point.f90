! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> One integration point of any interface element: traction, its derivatives, state, energies.
module elements_interface_point
  use core_kinds, only: dp
  use core_status, only: status_type, ok, no_root
  use cohesive_parameters, only: law_parameters
  use cohesive_shear, only: mode_of, resultant, shear_direction
  use cohesive_state, only: point_history, damage_state, law_solution
  use cohesive_dissipation, only: dissipate, dissipate_consistently
  use cohesive_law, only: evolve_damage, stiffness_of
  use cohesive_local_solve, only: solve_law
  use cohesive_traction, only: standard_traction, stabilised_traction
  implicit none(type, external)
  private
  public :: interface_options, interface_point, point_response
  public :: standard_point, stabilised_point, point_energies

  !> Options every interface element has.
  type :: interface_options
    integer :: rule                 !< gauss_rule or newton_cotes_rule
    integer :: sampling             !< of the bulk stress; the standard element ignores it
    logical :: consistent_law   !< the law has its own separation; the standard element ignores it
    logical :: complete         !< the gap between jump and separation works on the stress of the element's own solids
    real(dp) :: secant_share        !< of the matrix at fixed damage in the tangent, from 0 to 1
    logical :: finite = .false.     !< large rotations
    logical :: standard = .false.   !< without stabilisation: the faces may be apart
    logical :: cracked = .false.    !< failed from the start: its law does not soften, and asks nothing of beta
    real(dp) :: direction(3) = 0.0_dp   !< in space, s is its projection on the face; zero: that of x
    real(dp) :: initial(3) = 0.0_dp     !< traction of the initial stress of the element's own solids, (s, n, t)
  end type interface_options

  !> State of an integration point at the end of the increment; vectors in the components (s, n, t) of `cohesive_shear`.
  type :: interface_point
    real(dp) :: position(3) = 0.0_dp        !< global x, y and z
    real(dp) :: traction(3) = 0.0_dp        !< T, stress, tension positive
    real(dp) :: stabilisation(2) = 0.0_dp   !< S of shear and opening
    real(dp) :: jump(3) = 0.0_dp            !< displacement jump g, opening positive
    real(dp) :: stored = 0.0_dp             !< recoverable energy, in the complete form that of its gap too, energy/area
    type(point_history) :: history
  end type interface_point

  !> Derivatives of the traction T.
  type :: point_response
    real(dp) :: by_jump(3, 3)   !< dT/dg at constant bulk stress
    real(dp) :: by_bulk(3, 3)   !< dT/d(<sigma>.n); zero in the standard element
  end type point_response

contains

  !> Equations (8) to (15): the standard element.
  pure subroutine standard_point(law, options, dtime, jump, old, new, response)
    type(law_parameters), intent(in) :: law
    type(interface_options), intent(in) :: options
    real(dp), intent(in) :: dtime                     !< duration of the increment
    real(dp), intent(in) :: jump(3)                   !< g
    type(interface_point), intent(in) :: old
    type(interface_point), intent(inout) :: new       !< its position is known
    type(point_response), intent(out) :: response
    type(damage_state) :: state

    call evolve_damage(law, old%history, resultant(jump), dtime, state)
    state%slope = (1.0_dp - options%secant_share)*state%slope
    response%by_bulk = 0.0_dp
    call standard_traction(stiffness_of(law), jump, shear_direction(jump), state%acting, state%slope, new%traction, &
      response%by_jump)
    ! S = 1 turns the stabilised weak form into the standard one
    new%stabilisation = 1.0_dp
    call store_damage(law, old, jump, state, new)
  end subroutine standard_point

  !> Equations (16) to (18), or the consistent law.
  pure subroutine stabilised_point(law, options, dtime, beta, jump, bulk, old, new, response, status)
    type(law_parameters), intent(in) :: law
    type(interface_options), intent(in) :: options
    real(dp), intent(in) :: dtime
    real(dp), intent(in) :: beta(2)                   !< (tau, n), stress/length
    real(dp), intent(in) :: jump(3)                   !< g
    real(dp), intent(in) :: bulk(3)                   !< <sigma>.n
    type(interface_point), intent(in) :: old
    type(interface_point), intent(inout) :: new       !< its position is known
    type(point_response), intent(out) :: response
    type(status_type), intent(out) :: status          !< no_root
    type(damage_state) :: state
    type(law_solution) :: solution
    integer :: i

    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    if (options%consistent_law) then
      call solve_law(law, beta, bulk + beta(mode_of)*jump, dtime, options%secant_share, old%history, solution)
      if (.not. solution%solved) status = status_type(no_root, 0, 0.0_dp, 0.0_dp)
      response%by_bulk = solution%by_trial
      do i = 1, 3
        response%by_jump(:, i) = beta(mode_of(i))*solution%by_trial(:, i)
      end do
      call store_solution(law, old, jump, solution, new)
      ! of the springs beta between the jump and the separation, and of the stress that works on their gap
      if (options%complete) new%stored = new%stored + 0.5_dp*sum((new%traction**2 - bulk**2)/beta(mode_of))
    else
      call evolve_damage(law, old%history, resultant(jump), dtime, state)
      state%slope = (1.0_dp - options%secant_share)*state%slope
      call stabilised_traction(stiffness_of(law), beta, jump, shear_direction(jump), bulk, state%acting, state%slope, &
        new%traction, new%stabilisation, response%by_jump)
      response%by_bulk = 0.0_dp
      do i = 1, 3
        response%by_bulk(i, i) = 1.0_dp - new%stabilisation(mode_of(i))
      end do
      call store_damage(law, old, jump, state, new)
    end if
  end subroutine stabilised_point

  !> State of a point whose damage is that of the displacement jump.
  pure subroutine store_damage(law, old, jump, state, new)
    type(law_parameters), intent(in) :: law
    type(interface_point), intent(in) :: old
    real(dp), intent(in) :: jump(3)
    type(damage_state), intent(in) :: state
    type(interface_point), intent(inout) :: new       !< traction is known

    new%jump = jump
    new%stored = 0.5_dp*dot_product(new%traction, jump)
    new%history%separation = jump
    new%history%damage = state%damage
    new%history%damage_max = state%damage_max
    new%history%largest = state%largest
    new%history%cycled = state%cycled
    call dissipate(law, old%history, jump, state, new%history%dissipated, new%history%viscous, new%history%spent)
  end subroutine store_damage

  !> State of a point of the consistent law.
  pure subroutine store_solution(law, old, jump, state, new)
    type(law_parameters), intent(in) :: law
    type(interface_point), intent(in) :: old
    real(dp), intent(in) :: jump(3)
    type(law_solution), intent(in) :: state
    type(interface_point), intent(inout) :: new

    new%traction = state%traction
    new%stabilisation = state%stabilisation
    new%jump = jump
    new%stored = 0.5_dp*dot_product(state%recoverable, state%separation)
    new%history%separation = state%separation
    new%history%damage = state%damage
    new%history%damage_max = state%damage
    new%history%largest = state%largest
    new%history%cycled = state%cycled
    call dissipate_consistently(law, old%history, old%traction, state, new%history%dissipated, new%history%viscous, &
      new%history%friction_work, new%history%spent)
  end subroutine store_solution

  !> Energies of a point: stored, dissipated by damage and friction, dissipated by the viscous overstress.
  pure function point_energies(weight, point) result(energies)
    real(dp), intent(in) :: weight   !< area of the point
    type(interface_point), intent(in) :: point
    real(dp) :: energies(3)

    energies(1) = weight*point%stored
    energies(2) = weight*(point%history%dissipated(1) + point%history%dissipated(2) + point%history%friction_work)
    energies(3) = weight*point%history%viscous
  end function point_energies

end module elements_interface_point
