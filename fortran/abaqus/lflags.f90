! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What LFLAGS of a call ask for, and the answer of an element that has neither mass nor damping (Abaqus User Subroutines
!> Reference Guide, UEL).
module abaqus_lflags
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: large_displacements, asks_for_nothing, asks_for_tangent, give_answer

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

  !> Hands over what a call asks for; the rest stays as it is, RHS and AMATRX zero. In a linear step, LFLAGS(4) = 1, RHS is the
  !> effect of the perturbation.
  pure subroutine give_answer(lflags, du, residual, tangent, state, energies, rhs, amatrx, svars, energy)
    integer, intent(in) :: lflags(*)
    real(dp), intent(in) :: du(:), residual(:), tangent(:, :), state(:), energies(8)
    real(dp), intent(inout) :: rhs(:), amatrx(:, :), svars(:), energy(8)

    if (asks_for_tangent(lflags)) amatrx = tangent
    if (lflags(4) == 1) then
      if (lflags(3) == perturbation) rhs = -matmul(tangent, du)
      return
    end if
    if (lflags(3) /= stiffness) rhs = residual
    if (lflags(3) == normal) then
      svars = state
      energy = energies
    end if
  end subroutine give_answer

end module abaqus_lflags
