! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Continuum elements with incompatible modes (host_incompatible): these are sought at the displacements of the nodes, and leave the
!> equations.
module host_condensed_modes
  use core_incompatible_mode_search, only: find_modes, mode_search, most_passes
  use core_rotation, only: about_mean
  use core_small_matrix, only: invert_general
  use core_incompatible_modes, only: condense
  use host_context, only: current, stress_matrix
  use host_enhanced_kinematics, only: enhanced_t
  use host_incompatible, only: begin_modes
  use host_kinds, only: dp, i4
  use host_materials, only: not_solved
  use host_solid_element, only: begins, solid_t
  use host_solid_extras, only: extras_t
  use host_solid_integration, only: integrate
  implicit none (type, external)
  private
  public :: integrate_with_modes

  !> Share of the coordinates that counts as displacement in large displacements: the deformation gradient is rounded to 1e-16 of
  !> one, and forces on modes that come from strains of 1e-15 are none (find_modes has the square root of its limit, 1e-10).
  real(dp), parameter :: rounded = 1e-5_dp

contains

  !> As integrate, for the displacements alone. The initial stress matrix of all unknowns is reduced to the displacements, which the
  !> modes follow as in the tangent.
  subroutine integrate_with_modes(this, kinematics, alpha, force, stiffness, energy)
    type(solid_t), intent(inout) :: this
    type(enhanced_t), intent(inout) :: kinematics
    real(dp), intent(inout) :: alpha(:)      !< values of the modes at the start of the increment, then at its end
    real(dp), intent(inout) :: force(this%n), stiffness(this%n, this%n), energy(8)
    real(dp) :: all_force(this%n + size(alpha)), all_stiffness(this%n + size(alpha), this%n + size(alpha))
    real(dp) :: inverse(size(alpha), size(alpha)), follow(size(alpha), this%n)
    real(dp), target :: added(this%n + size(alpha))
    type(extras_t) :: extras
    integer(i4) :: request
    integer :: n
    n = this%n
    kinematics%others = size(alpha)
    call begin_modes(kinematics%modes, this%rule, this%strains, this%x, alpha)
    request = this%request
    if (.not. begins(this)) this%request = 1
    call search(this, kinematics, alpha, energy, all_force, all_stiffness, inverse)
    if (begins(this)) then
      force = all_force(:n)
      return
    end if
    call condense(n, inverse, all_force, all_stiffness, force, stiffness)
    if (.not. stress_matrix(request)) return
    follow = -matmul(inverse, all_stiffness(n + 1:, :n))
    added = [this%added, matmul(follow, this%added)]
    this%added => added
    this%request = request
    all_stiffness = 0
    call integrate(this, kinematics, extras, all_force, all_stiffness, energy)
    associate (across => matmul(all_stiffness(:n, n + 1:), follow))
      stiffness = all_stiffness(:n, :n) + across + transpose(across) + &
                  matmul(transpose(follow), matmul(all_stiffness(n + 1:, n + 1:), follow))
    end associate
  end subroutine integrate_with_modes

  !> Find the modes in equilibrium, with force and stiffness of all unknowns, and the inverse of the stiffness of the modes.
  subroutine search(this, kinematics, alpha, energy, force, stiffness, inverse)
    type(solid_t), intent(inout) :: this
    type(enhanced_t), intent(inout) :: kinematics
    real(dp), intent(inout) :: alpha(:), energy(8)
    real(dp), intent(out) :: force(:), stiffness(:, :), inverse(:, :)
    real(dp) :: state(size(this%state, 1), size(this%state, 2)), energy_start(8), unknowns(size(force)), all_work, pnewdt
    real(dp), allocatable :: axes(:, :, :, :)
    type(extras_t) :: extras
    type(mode_search) :: progress
    integer :: pass, n
    logical :: settled, good
    n = this%n
    state = this%state
    energy_start = energy
    if (associated(this%axes)) axes = this%axes
    pnewdt = current%pnewdt
    do pass = 1, most_passes
      this%state = state
      energy = energy_start
      if (associated(this%axes)) this%axes = axes
      current%pnewdt = pnewdt
      kinematics%modes%now = alpha
      force = 0
      stiffness = 0
      call integrate(this, kinematics, extras, force, stiffness, energy)
      if (begins(this)) return
      ! the work that forces on modes are compared with; while all displacements are zero, thermal and initial stresses do none,
      ! and the second term counts: the work that the nodal forces would do on free nodes
      unknowns = abs([about_mean(this%dim, reshape(this%u, [n])), alpha])
      if (this%finite) unknowns(:n) = unknowns(:n) + rounded*abs(about_mean(this%dim, reshape(this%x, [n])))
      all_work = dot_product(unknowns, matmul(abs(stiffness), unknowns)) + &
                 sum(force(:n)**2)/max(maxval(abs(stiffness)), tiny(1.0_dp))
      kinematics%exact = kinematics%exact + stiffness(n + 1:, n + 1:)
      call find_modes(progress, force(n + 1:), kinematics%exact, all_work, alpha, inverse, settled, good)
      if (settled .or. .not. good) exit
    end do
    if (.not. (settled .and. good)) call not_solved('the incompatible modes are not in equilibrium')
    ! with what the stiffness has, so that the tangent is of one kind
    if (good) call invert_general(stiffness(n + 1:, n + 1:), inverse, good)
  end subroutine search
end module host_condensed_modes
