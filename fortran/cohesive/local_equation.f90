! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The scalar unknown of the consistent law, x = 1/(K + min b), and what follows from it: damage, direction and shares of p.
!> `cohesive_local_solve` has the equations.
module cohesive_local_equation
  use core_kinds, only: dp
  use cohesive_parameters, only: law_parameters
  use cohesive_state, only: driven_point
  implicit none(type, external)
  private
  public :: law_equation, equation_of, shares, direction_at, remainder_at
  public :: damage_of, damage_at_secant, at_damage, softening_stiffness

  !> The scalar equation: b, and p/ratio without its compressive part.
  type :: law_equation
    real(dp) :: b(2)         !< (beta + viscous part)/ratio, stress/length
    real(dp) :: least        !< smaller one of b
    real(dp) :: driving(2)   !< p/ratio, stress
  end type law_equation

contains

  !> The scalar equation of a point.
  pure function equation_of(law, driven) result(equation)
    type(law_parameters), intent(in) :: law
    type(driven_point), intent(in) :: driven
    type(law_equation) :: equation

    equation%b = (driven%beta + driven%viscous)/law%ratio
    equation%least = minval(equation%b)
    equation%driving = 0.0_dp
  end function equation_of

  !> t and ratio w as shares of p, for the damage at x.
  pure subroutine shares(law, driven, equation, x, stiff, soft)
    type(law_parameters), intent(in) :: law
    type(driven_point), intent(in) :: driven
    type(law_equation), intent(in) :: equation
    real(dp), intent(in) :: x
    real(dp), intent(out) :: stiff(2)   !< t_i/p_i
    real(dp), intent(out) :: soft(2)    !< w_i/p_i, length/stress

    stiff = remainder_at(equation%least, x)/(1.0_dp + (equation%b - equation%least)*x)
    soft = x/(1.0_dp + (equation%b - equation%least)*x)/law%ratio
    if (driven%closed) then
      stiff(2) = 1.0_dp/(1.0_dp + driven%beta(2)*law%flexibility)
      soft(2) = law%flexibility*stiff(2)
    end if
  end subroutine shares

  !> Direction c of the separation at x, and lambda/x.
  pure subroutine direction_at(equation, x, length, direction)
    type(law_equation), intent(in) :: equation
    real(dp), intent(in) :: x
    real(dp), intent(out) :: length         !< stress
    real(dp), intent(out) :: direction(2)

    direction = equation%driving/(1.0_dp + (equation%b - equation%least)*x)
    length = sqrt(direction(1)**2 + direction(2)**2)
    direction = direction/length
  end subroutine direction_at

  !> Damage D = (1 - K/alpha) k/(K + k) at x, k the softening stiffness.
  !>
  !> 1 - K/alpha jumps to 1 where alpha is large or infinite. D does not: under opening, a bilinear law has dissipated the
  !> fraction D of its fracture energy, at any alpha. It is a function of K alone, which never grows, so D never decreases.
  pure function damage_of(law, least, x) result(damage)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: least, x
    real(dp) :: damage

    damage = damage_at_secant(law, remainder_at(least, x), x)
  end function damage_of

  !> The same for K = traction/separation, or numbers in this proportion.
  pure function damage_at_secant(law, traction, separation) result(damage)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: traction, separation
    real(dp) :: damage
    real(dp) :: k

    k = softening_stiffness(law)
    damage = min(1.0_dp, k*max(0.0_dp, separation - law%flexibility*traction)/(traction + k*separation))
  end function damage_at_secant

  !> x at a damage: the inverse of `damage_of`.
  pure function at_damage(law, least, damage) result(x)
    type(law_parameters), intent(in) :: law
    real(dp), intent(in) :: least, damage
    real(dp) :: x
    real(dp) :: k, flexible

    k = softening_stiffness(law)
    flexible = damage + k*law%flexibility
    x = 1.0_dp/least
    if (damage < 1.0_dp) x = flexible/(k*(1.0_dp - damage) + least*flexible)
  end function at_damage

  !> 1 - x min b = K x, zero at failure without rounding.
  pure function remainder_at(least, x) result(rest)
    real(dp), intent(in) :: least, x
    real(dp) :: rest

    rest = 0.0_dp
    if (x < 1.0_dp/least) rest = 1.0_dp - least*x
  end function remainder_at

  !> Softening stiffness k of the bilinear law in mode I.
  pure function softening_stiffness(law) result(k)
    type(law_parameters), intent(in) :: law
    real(dp) :: k

    k = 1.0_dp/(2.0_dp*law%toughness(2)/law%strength(2)**2 - law%flexibility)
  end function softening_stiffness

end module cohesive_local_equation
