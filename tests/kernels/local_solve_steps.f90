! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Solves a law for many trial tractions and counts the steps.
subroutine local_solve_steps(kind, count, trials, histories, beta, searches, total, most, unsolved) bind(c)
  use, intrinsic :: iso_c_binding, only: c_double, c_int
  use cohesive_local_solve, only: solve_law
  use cohesive_parameters, only: law_parameters
  use cohesive_state, only: law_solution, point_history
  implicit none(type, external)
  integer(c_int), value :: kind, count
  real(c_double), intent(in) :: trials(3, count), histories(count), beta(2)
  integer(c_int), intent(out) :: searches   !< trials for which a root is sought
  integer(c_int), intent(out) :: total, most, unsolved
  type(law_parameters) :: law
  type(law_solution) :: state
  type(point_history) :: history
  integer :: i

  ! the paper's carbon/epoxy, with an infinite stiffness
  law%kind = kind
  law%flexibility = 0
  law%ratio = 1
  law%strength = [60, 30]
  law%toughness = [1.002_c_double, 0.26_c_double]
  law%viscosity = 0
  law%eta = 1.45_c_double
  law%bridging_strength = [0.15_c_double, 0.1_c_double]
  law%bridging_energy = [0.3_c_double, 0.5_c_double]
  ! a plateau up to 0.2, (0.5, 0.2), the end at 1: the area is 0.2 + 0.18 + 0.05, and the lines fall by 0, 0.8/0.3 and 0.4
  law%ramps = 3
  law%ramp_end(:3) = [0.2_c_double, 0.5_c_double, 1.0_c_double]/0.43_c_double
  law%ramp_height(:3) = [-0.8_c_double/0.3_c_double*0.2_c_double, (0.8_c_double/0.3_c_double - 0.4_c_double)*0.5_c_double, &
    0.4_c_double]
  searches = 0
  total = 0
  most = 0
  unsolved = 0
  do i = 1, count
    history%damage = histories(i)
    call solve_law(law, beta, trials(:, i), 1.0_c_double, 0.0_c_double, history, state)
    if (state%steps > 0) searches = searches + 1
    total = total + state%steps
    most = max(most, state%steps)
    if (.not. state%solved) unsolved = unsolved + 1
  end do
end subroutine local_solve_steps
