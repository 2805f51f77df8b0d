! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The consistent stabilised law t(w; history) + beta w = p with the PPR law, in two unknowns: the shear resultant and the opening,
!> (tau, n).
!>
!> With a sufficient beta, `check_ppr_beta`, the left side is strongly monotone in w, with history and for infinite
!> stiffness too: w_n follows from w_tau by one equation that increases with w_n, and the other equation then increases with w_tau.
!> Both are solved by core_root.
module cohesive_ppr_local_solve
  use core_kinds, only: dp
  use core_root, only: root_search, search_between, searching, advance
  use cohesive_parameters, only: law_parameters
  use cohesive_state, only: point_history, driven_point, resultant_solution
  use cohesive_ppr, only: ppr_component, component_at, damage_at
  implicit none(type, external)
  private
  public :: solve_ppr_law, ppr_trial_of_rest

  !> The equations t_i + b_i w_i = driving_i, and the state of their solution.
  type :: ppr_equations
    real(dp) :: b(2)                  !< beta and viscous part, stress/length
    real(dp) :: driving(2)            !< p without its compressive part, stress
    real(dp) :: largest(2)            !< largest separations: at the start of the increment
    logical :: fixed(2)               !< the damage may not grow
    type(ppr_component) :: parts(2)   !< at the separations
    real(dp) :: w(2)                  !< the separations, length
    logical :: grows(2)               !< beyond the largest separation so far
    logical :: rigid(2)                !< rigid, without a separation
    logical :: solved                 !< both roots were found
    integer :: steps                  !< of the search for w_tau, or of that for w_n where w_tau does not grow
  end type ppr_equations

contains

  !> Traction, separation and damage of a point, and the derivative of the traction by p.
  pure subroutine solve_ppr_law(law, driven, history, solution)
    type(law_parameters), intent(in) :: law
    type(driven_point), intent(in) :: driven
    type(point_history), intent(in) :: history
    type(resultant_solution), intent(out) :: solution
    type(ppr_equations) :: equations
    real(dp) :: secants(2), fixed(2), stiff

    equations%b = driven%beta + driven%viscous
    equations%driving = [driven%trial(1), max(0.0_dp, driven%trial(2))]
    equations%largest = history%largest
    equations%fixed = [driven%fixed .or. driven%sticks, driven%fixed]
    call solve(law, equations)

    solution%solved = equations%solved
    solution%steps = equations%steps
    solution%largest = history%largest
    where (equations%grows) solution%largest = equations%w
    solution%damage = damage_at(law, solution%largest)
    secants = [equations%parts(1)%secant*equations%parts(2)%share, equations%parts(2)%secant*equations%parts(1)%share]
    solution%separation = equations%w
    solution%recoverable = driven%trial - equations%b*solution%separation
    where (.not. equations%rigid) solution%recoverable = secants*solution%separation
    solution%stabilisation = 0.0_dp
    where (.not. equations%rigid) solution%stabilisation = driven%beta/(secants + driven%beta)
    ! T over p: without separation, T is p
    fixed = 1.0_dp
    where (.not. equations%rigid) fixed = (secants + driven%viscous)/(secants + equations%b)
    solution%share = fixed(1)
    call derive(equations, driven, secants, fixed, solution%by_trial)
    if (.not. driven%closed) return
    stiff = 1.0_dp/(1.0_dp + driven%beta(2)*law%flexibility)
    solution%separation(2) = law%flexibility*stiff*driven%trial(2)
    solution%recoverable(2) = stiff*driven%trial(2)
    solution%stabilisation(2) = 1.0_dp - stiff
    solution%by_trial(:, 2) = [0.0_dp, stiff]
    solution%by_trial(2, 1) = 0.0_dp
  end subroutine solve_ppr_law

  !> Shear of p at which that of w does not change, without friction; for a rigid point the nearest one.
  pure subroutine ppr_trial_of_rest(law, driven, history, p, old, rest, turning)
    type(law_parameters), intent(in) :: law
    type(driven_point), intent(in) :: driven
    type(point_history), intent(in) :: history
    real(dp), intent(in) :: p(2), old(2)   !< shears of p, and of w at the start of the increment
    real(dp), intent(out) :: rest(2)
    real(dp), intent(out) :: turning       !< derivative of the rest by p, across p: it turns along at a rigid point
    type(ppr_component) :: tau, n
    real(dp) :: length, most

    turning = 0.0_dp
    tau = component_at(law, 1, history%largest(1))
    n = component_at(law, 2, history%largest(2))
    if (law%flexibility > 0.0_dp .or. history%largest(1) > 0.0_dp) then
      rest = (tau%secant*n%share + driven%beta(1) + driven%viscous(1))*old
    else
      length = hypot(p(1), p(2))
      most = tau%traction*n%share
      turning = 1.0_dp
      if (length > most) turning = most/length
      rest = p*turning
    end if
  end subroutine ppr_trial_of_rest

  !> Solves for w_tau; w_n follows from every w_tau.
  pure subroutine solve(law, equations)
    type(law_parameters), intent(in) :: law
    type(ppr_equations), intent(inout) :: equations
    type(root_search) :: search
    real(dp) :: residual, slope

    equations%solved = .true.
    equations%steps = 0
    equations%parts(1) = component_at(law, 1, equations%largest(1))
    call solve_for_opening(law, equations)
    call try_without_growth(law, equations, 1)
    if (.not. equations%grows(1)) return

    search = search_for(law, equations, 1)
    do while (searching(search))
      equations%w(1) = search%x
      equations%parts(1) = component_at(law, 1, search%x)
      call solve_for_opening(law, equations)
      call equation_residual(equations, 1, residual, slope)
      if (equations%grows(2)) slope = slope - cross(equations, 1)*cross(equations, 2)/normal_slope(equations)
      call advance(search, residual, slope)
    end do
    equations%solved = equations%solved .and. search%found
    equations%steps = search%steps
  end subroutine solve

  !> Solves for w_n, with the other component fixed.
  pure subroutine solve_for_opening(law, equations)
    type(law_parameters), intent(in) :: law
    type(ppr_equations), intent(inout) :: equations
    type(root_search) :: search
    real(dp) :: residual, slope

    equations%parts(2) = component_at(law, 2, equations%largest(2))
    call try_without_growth(law, equations, 2)
    if (.not. equations%grows(2)) return

    search = search_for(law, equations, 2)
    do while (searching(search))
      equations%w(2) = search%x
      equations%parts(2) = component_at(law, 2, search%x)
      call equation_residual(equations, 2, residual, slope)
      call advance(search, residual, slope)
    end do
    equations%solved = equations%solved .and. search%found
    equations%steps = search%steps
  end subroutine solve_for_opening

  !> Separation of component i at its largest separation so far, and whether it must grow beyond it.
  pure subroutine try_without_growth(law, equations, i)
    type(law_parameters), intent(in) :: law
    type(ppr_equations), intent(inout) :: equations
    integer, intent(in) :: i
    real(dp) :: share

    share = equations%parts(3 - i)%share
    equations%rigid(i) = .not. law%flexibility > 0.0_dp .and. .not. equations%largest(i) > 0.0_dp
    if (equations%rigid(i)) then
      equations%w(i) = 0.0_dp
      equations%grows(i) = equations%driving(i) > equations%parts(i)%traction*share
    else
      equations%w(i) = equations%driving(i)/(equations%parts(i)%secant*share + equations%b(i))
      equations%grows(i) = equations%w(i) > equations%largest(i)
    end if
    equations%grows(i) = equations%grows(i) .and. .not. equations%fixed(i)
    if (equations%grows(i)) equations%rigid(i) = .false.
  end subroutine try_without_growth

  !> The search for w_i that grows: the secant, or the strength of a rigid component, is neither larger than before nor negative.
  !> The root of a stiff law is orders of magnitude smaller than that of a soft one.
  pure function search_for(law, equations, i) result(search)
    type(law_parameters), intent(in) :: law
    type(ppr_equations), intent(in) :: equations
    integer, intent(in) :: i
    type(root_search) :: search
    real(dp) :: lower, upper

    upper = equations%driving(i)/equations%b(i)
    lower = equations%w(i)
    if (.not. law%flexibility > 0.0_dp) lower = max(equations%largest(i), &
      (equations%driving(i) - equations%parts(i)%traction*equations%parts(3 - i)%share)/equations%b(i))
    search = search_between(lower, upper, upper, geometric=.true.)
  end function search_for

  !> t_i + b_i w_i - driving_i and its derivative by w_i.
  pure subroutine equation_residual(equations, i, residual, slope)
    type(ppr_equations), intent(in) :: equations
    integer, intent(in) :: i
    real(dp), intent(out) :: residual, slope

    residual = equations%parts(i)%traction*equations%parts(3 - i)%share + equations%b(i)*equations%w(i) &
      - equations%driving(i)
    slope = equations%parts(i)%slope*equations%parts(3 - i)%share + equations%b(i)
  end subroutine equation_residual

  !> Derivative of t_n + b_n w_n by w_n.
  pure function normal_slope(equations) result(slope)
    type(ppr_equations), intent(in) :: equations
    real(dp) :: slope
    real(dp) :: residual

    call equation_residual(equations, 2, residual, slope)
  end function normal_slope

  !> Derivative of t_i by the other separation.
  pure function cross(equations, i) result(slope)
    type(ppr_equations), intent(in) :: equations
    integer, intent(in) :: i
    real(dp) :: slope

    slope = 0.0_dp
    if (equations%grows(3 - i)) slope = equations%parts(i)%secant*equations%w(i)*equations%parts(3 - i)%by_share
  end function cross

  !> dT/dp = (dt/dw + viscous part) (dt/dw + b)**-1 of an open point, blended with that at fixed damage.
  pure subroutine derive(equations, driven, secants, fixed, by_trial)
    type(ppr_equations), intent(in) :: equations
    type(driven_point), intent(in) :: driven
    real(dp), intent(in) :: secants(2)         !< t_i/w_i
    real(dp), intent(in) :: fixed(2)           !< T_i/p_i
    real(dp), intent(out) :: by_trial(2, 2)
    real(dp) :: a(2, 2), determinant
    integer :: i

    by_trial = 0.0_dp
    do i = 1, 2
      by_trial(i, i) = fixed(i)
    end do
    if (.not. any(equations%grows) .or. driven%secant_share >= 1.0_dp) return

    do i = 1, 2
      a(i, i) = secants(i)
      if (equations%grows(i)) a(i, i) = equations%parts(i)%slope*equations%parts(3 - i)%share
      a(i, 3 - i) = cross(equations, i)
    end do
    by_trial = driven%secant_share*by_trial
    associate (blend => 1.0_dp - driven%secant_share, viscous => driven%viscous)
      if (any(equations%rigid)) then
        do i = 1, 2
          if (equations%rigid(i)) by_trial(i, i) = 1.0_dp
          if (.not. equations%rigid(i)) by_trial(i, i) = by_trial(i, i) &
            + blend*(a(i, i) + viscous(i))/(a(i, i) + equations%b(i))
        end do
      else
        determinant = (a(1, 1) + equations%b(1))*(a(2, 2) + equations%b(2)) - a(1, 2)*a(2, 1)
        do i = 1, 2
          by_trial(i, i) = by_trial(i, i) + blend &
            *((a(i, i) + viscous(i))*(a(3 - i, 3 - i) + equations%b(3 - i)) - a(1, 2)*a(2, 1))/determinant
          ! (a_ij (a_ii + b_i) - (a_ii + viscous_i) a_ij)/determinant, and b is beta and viscous part
          by_trial(i, 3 - i) = blend*a(i, 3 - i)*driven%beta(i)/determinant
        end do
      end if
    end associate
  end subroutine derive

end module cohesive_ppr_local_solve
