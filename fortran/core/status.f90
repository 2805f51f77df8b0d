! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What a pure kernel reports for invalid input, and the sentence for each code.
module core_status
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: status_type, sentence
  public :: ok, too_brittle, not_positive_definite, inside_out, zero_length, faces_apart, small_beta, too_brittle_mixed, &
    late_secant, no_root, along_normal, layer_slants, layer_twists
  public :: bridging_strength, bridging_energy, brittle_tip, brittle_bridging, brittle_mixed_line, no_table, table_gap, &
    table_separation, table_traction, falls_with_rate

  !> Outcome of a kernel; the caller knows the names of elements and properties.
  type :: status_type
    integer :: code = 0            !< ok, or one of the codes below
    integer :: item = 0            !< which mode (1 normal), quad (1 bottom, 2 top), point, share in per cent
    real(dp) :: value = 0.0_dp     !< what was found
    real(dp) :: expected = 0.0_dp  !< the bound that it violates
  end type status_type

  integer, parameter :: ok = 0
  integer, parameter :: too_brittle = 1
  integer, parameter :: not_positive_definite = 2
  integer, parameter :: inside_out = 3
  integer, parameter :: zero_length = 4
  integer, parameter :: faces_apart = 5
  integer, parameter :: small_beta = 6
  integer, parameter :: too_brittle_mixed = 7
  integer, parameter :: late_secant = 8
  integer, parameter :: no_root = 9
  integer, parameter :: along_normal = 10
  integer, parameter :: layer_slants = 11
  integer, parameter :: layer_twists = 12
  integer, parameter :: bridging_strength = 13
  integer, parameter :: bridging_energy = 14
  integer, parameter :: brittle_tip = 15
  integer, parameter :: brittle_bridging = 16
  integer, parameter :: brittle_mixed_line = 17
  integer, parameter :: no_table = 18
  integer, parameter :: table_gap = 19
  integer, parameter :: table_separation = 20
  integer, parameter :: table_traction = 21
  integer, parameter :: falls_with_rate = 22

contains

  !> Sentence for a status code, without the names and values only the caller knows.
  pure function sentence(code) result(text)
    integer, intent(in) :: code
    character(len=160) :: text

    select case (code)
    case (ok)
      text = 'no error'
    case (too_brittle)
      text = 'too brittle for its stiffness: the separation at failure ' // &
        'does not exceed that at the onset of damage'
    case (too_brittle_mixed)
      text = 'too soft for the fracture energy in mixed mode: the separation at failure ' // &
        'does not exceed that at the onset of damage'
    case (brittle_mixed_line)
      text = 'too soft for the fracture energy of one of the two lines in mixed mode: its separation at failure ' // &
        'does not exceed that at the onset of damage'
    case (bridging_strength, bridging_energy)
      text = 'with LAW 5 the bridging is a part of the total'
    case (brittle_tip)
      text = 'leaves too little for the rest of the law and its stiffness: its separation at failure ' // &
        'does not exceed that at the onset of damage'
    case (brittle_bridging)
      text = 'too small for the strength of the bridging and the stiffness: the separation at failure ' // &
        'does not exceed that at the onset of damage'
    case (no_table)
      text = 'LAW 6 requires a point of its softening'
    case (table_gap)
      text = 'the point before it is not used'
    case (table_separation)
      text = 'the separations of LAW 6 increase from point to point'
    case (table_traction)
      text = 'the tractions of LAW 6 do not increase, and do not vanish before failure'
    case (falls_with_rate)
      text = 'with the tail of this law and its stiffness, the traction would fall with the rate'
    case (late_secant)
      text = 'too small for its stiffness: the secant of the PPR law must decrease from the origin on'
    case (no_root)
      text = 'the equation of this point is not solved: NaN or too many iterations'
    case (not_positive_definite)
      text = 'the elastic constants are not positive definite'
    case (inside_out)
      text = 'is inside out or degenerate: the Jacobian is not positive, ' // &
        'number the nodes counter-clockwise'
    case (zero_length)
      text = 'the interface has no length or area, or folds back on itself'
    case (faces_apart)
      text = 'the two faces of the interface do not coincide'
    case (layer_slants)
      text = 'the faces are apart, and the top one does not lie above the bottom one, node by node'
    case (layer_twists)
      text = 'the faces are apart, and turned against each other, or too different in size: number their nodes alike'
    case (small_beta)
      text = 'too small for the consistent law: ' // &
        'it does not exceed the softening slope of the law'
    case (along_normal)
      text = 'too close to the normal of the face to give a direction in it'
    case default
      text = 'unknown status'
    end select
  end function sentence

end module core_status
