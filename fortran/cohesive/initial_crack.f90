! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Points of an initial crack: they have failed before the analysis begins, and carry contact and friction alone.
!>
!> A point that has failed never bonds again, so that the state of failure may be imposed at the start of every increment: nothing
!> needs to know which one is the first. What such a point would have dissipated belongs to no increment of the analysis; its
!> energies begin at zero, and since a failed point has nothing left to dissipate by damage, they stay there.
module cohesive_initial_crack
  use core_kinds, only: dp
  use cohesive_parameters, only: law_parameters
  use cohesive_state, only: point_history
  implicit none(type, external)
  private
  public :: open_crack

contains

  !> Puts the history of a point at the end of its law.
  elemental subroutine open_crack(law, history)
    type(law_parameters), intent(in) :: law
    type(point_history), intent(inout) :: history

    history%damage = 1.0_dp
    history%damage_max = 1.0_dp
    history%spent = 1.0_dp
    ! zero but for the PPR law, whose history these are: with one of them at its end neither component has a traction
    history%largest = max(history%largest, law%final)
  end subroutine open_crack

end module cohesive_initial_crack
