! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Thermal strain of *EXPANSION (Analysis User's Guide, Thermal expansion): a(T) (T - zero) - a(T0) (T0 - zero), with the
!> temperature T0 at the start of the analysis. Coefficients are linear between the temperatures of the table, constant beyond.
module host_expansion
  use host_kinds, only: dp
  implicit none (type, external)
  private
  public :: expansion_t, free_strain, free_strain_rate

  type :: expansion_t
    real(dp), allocatable :: table(:, :)   !< (7, k) temperature, then the coefficients of 11, 22, 33, 12, 13, 23
    real(dp) :: zero = 0                   !< temperature at which there is no strain
  end type expansion_t

contains

  !> Thermal strain, shear as engineering strain.
  pure function free_strain(expansion, temperature, initial) result(strain)
    type(expansion_t), intent(in) :: expansion
    real(dp), intent(in) :: temperature, initial
    real(dp) :: strain(6), a(6, 2), now(6), start(6)
    a = coefficients(expansion, temperature)
    now = a(:, 1)*(temperature - expansion%zero)
    a = coefficients(expansion, initial)
    start = a(:, 1)*(initial - expansion%zero)
    strain = now - start
  end function free_strain

  !> Its derivative by the temperature.
  pure function free_strain_rate(expansion, temperature) result(rate)
    type(expansion_t), intent(in) :: expansion
    real(dp), intent(in) :: temperature
    real(dp) :: rate(6), a(6, 2)
    a = coefficients(expansion, temperature)
    rate = a(:, 1) + a(:, 2)*(temperature - expansion%zero)
  end function free_strain_rate

  !> Coefficients, and their derivatives by the temperature.
  pure function coefficients(expansion, temperature) result(a)
    type(expansion_t), intent(in) :: expansion
    real(dp), intent(in) :: temperature
    real(dp) :: a(6, 2)
    integer :: k, last
    last = size(expansion%table, 2)
    a = 0
    if (temperature <= expansion%table(1, 1)) then
      a(:, 1) = expansion%table(2:, 1)
    else if (temperature >= expansion%table(1, last)) then
      a(:, 1) = expansion%table(2:, last)
    else
      k = count(expansion%table(1, :) <= temperature)
      associate (low => expansion%table(:, k), high => expansion%table(:, k + 1))
        a(:, 2) = (high(2:) - low(2:))/(high(1) - low(1))
        a(:, 1) = low(2:) + a(:, 2)*(temperature - low(1))
      end associate
    end if
  end function coefficients
end module host_expansion
