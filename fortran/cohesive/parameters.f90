! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What every cohesive law is described by; components in the order (tau, n).
module cohesive_parameters
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: law_parameters
  public :: bilinear_law

  integer, parameter :: bilinear_law = 1

  !> Parameters of a law. The initial stiffness is alpha_i = ratio_i/flexibility, so that an infinite one has a finite
  !> description: laws are written in the flexibility.
  type :: law_parameters
    integer :: kind           !< bilinear_law
    real(dp) :: flexibility   !< 1/alpha_n, length/stress; 0 for a law that is rigid up to the onset of damage
    real(dp) :: ratio(2)      !< alpha/alpha_n; 1 where alpha is infinite
    real(dp) :: strength(2)   !< tau_max, sigma_max, stress
    real(dp) :: toughness(2)  !< G_IIc, G_Ic, energy/area
    real(dp) :: viscosity     !< relaxation time; 0 for none
  end type law_parameters

end module cohesive_parameters
