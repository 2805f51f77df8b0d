! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What LFLAGS of a call ask for, and the answer of an element that has neither mass nor damping (Abaqus User Subroutines
!> Reference Guide, UEL).
module abaqus_lflags
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: large_displacements, is_linear_step, asks_for_nothing, asks_for_tangent, weight_of_start, values_are_kept, give_answer

  ! LFLAGS(1): *DYNAMIC with automatic and with fixed increments
  integer, parameter :: dynamic(2) = [11, 12]

  ! LFLAGS(3)
  integer, parameter :: normal = 1              ! RHS and AMATRX; the only request whose SVARS and ENERGY are kept
  integer, parameter :: stiffness = 2
  integer, parameter :: damping = 3
  integer, parameter :: mass = 4
  integer, parameter :: residual_alone = 5
  integer, parameter :: mass_and_residual = 6
  integer, parameter :: perturbation = 100      ! RHS of a linear step whose DU is known

contains

  !> LFLAGS(2): NLGEOM is on.
  pure logical function large_displacements(lflags)
    integer, intent(in) :: lflags(*)

    large_displacements = lflags(2) /= 0
  end function large_displacements

  !> LFLAGS(4): the step is a linear perturbation.
  pure logical function is_linear_step(lflags)
    integer, intent(in) :: lflags(*)

    is_linear_step = lflags(4) == 1
  end function is_linear_step

  !> True for mass and damping alone: those matrices stay zero.
  pure logical function asks_for_nothing(lflags)
    integer, intent(in) :: lflags(*)

    asks_for_nothing = lflags(3) == damping .or. lflags(3) == mass
  end function asks_for_nothing

  !> False for the residual alone, and with the mass.
  pure logical function asks_for_tangent(lflags)
    integer, intent(in) :: lflags(*)

    asks_for_tangent = lflags(3) /= residual_alone .and. lflags(3) /= mass_and_residual
  end function asks_for_tangent

  !> -alpha of the operator of Hilber, Hughes and Taylor where RHS is to be (1 + alpha) G - alpha G_start, with the static residual
  !> G at the end and at the start of the increment; else 0.
  !>
  !> For the residual at half an increment, Abaqus asks for the mean of G at the starts of this increment and of the one before. The
  !> latter is not in SVARS, and that of this increment stands for it: their difference counts alpha/2, 2.5 per cent by default, in
  !> what chooses the next increment.
  pure real(dp) function weight_of_start(lflags, params)
    integer, intent(in) :: lflags(*)
    real(dp), intent(in) :: params(*)   !< alpha, beta and gamma in *DYNAMIC

    weight_of_start = 0.0_dp
    if (.not. any(lflags(1) == dynamic) .or. is_linear_step(lflags)) return
    if (lflags(3) == normal .or. lflags(3) == residual_alone) weight_of_start = -params(1)
  end function weight_of_start

  !> SVARS, ENERGY and PNEWDT of the call count.
  pure logical function values_are_kept(lflags)
    integer, intent(in) :: lflags(*)

    values_are_kept = lflags(3) == normal .and. .not. is_linear_step(lflags)
  end function values_are_kept

  !> Hands over what a call asks for beside AMATRX; the rest stays as it is, RHS zero. In a linear step, LFLAGS(4) = 1, RHS is the
  !> effect of the perturbation.
  pure subroutine give_answer(lflags, du, amatrx, residual, state, energies, rhs, svars, energy)
    integer, intent(in) :: lflags(*)
    real(dp), intent(in) :: du(:), amatrx(:, :), residual(:), state(:), energies(8)
    real(dp), intent(inout) :: rhs(:), svars(:), energy(8)

    if (is_linear_step(lflags)) then
      if (lflags(3) == perturbation) rhs = -matmul(amatrx, du)
      return
    end if
    if (lflags(3) /= stiffness) rhs = residual
    if (lflags(3) == normal) then
      svars = state
      energy = energies
    end if
  end subroutine give_answer

end module abaqus_lflags
