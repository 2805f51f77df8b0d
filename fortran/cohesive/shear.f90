! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> From the two shears of a surface to the one of the laws, and back.
!>
!> Vectors of a point have the components (s, n, t): a shear, the opening, the other shear. In the plane the third one is zero, and
!> the first two are the paper's (tau, n). Every law is a function of the shear resultant |tau| and of n; with the direction e of
!> the shear, a traction law (T_tau, T_n) of a vector p is T = T_tau e + T_n n, and
!>
!>     dT/dp = dT_tau/d|p_tau| e e^T + (T_tau/|p_tau|) (1 - e e^T) + dT_tau/dp_n e n^T + dT_n/d|p_tau| n e^T + dT_n/dp_n n n^T.
module cohesive_shear
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: mode_of, shears, resultant, shear_direction, vector_tangent

  !> Mode of each component among (tau, n).
  integer, parameter :: mode_of(3) = [1, 2, 1]

  !> The two shears among the components.
  integer, parameter :: shears(2) = [1, 3]

contains

  !> (|tau|, n) of a vector.
  pure function resultant(vector) result(pair)
    real(dp), intent(in) :: vector(3)
    real(dp) :: pair(2)

    pair(1) = abs(vector(1))
    if (abs(vector(3)) > 0.0_dp) pair(1) = hypot(vector(1), vector(3))
    pair(2) = vector(2)
  end function resultant

  !> Direction e of the shear of a vector; s where there is none.
  pure function shear_direction(vector) result(direction)
    real(dp), intent(in) :: vector(3)
    real(dp) :: direction(2)

    direction = [sign(1.0_dp, vector(1)), 0.0_dp]
    if (abs(vector(3)) > 0.0_dp) direction = vector(shears)/hypot(vector(1), vector(3))
  end function shear_direction

  !> dT/dp from the derivatives of (T_tau, T_n) by (|p_tau|, p_n).
  pure function vector_tangent(direction, share, pair) result(tangent)
    real(dp), intent(in) :: direction(2)    !< e
    real(dp), intent(in) :: share           !< T_tau/|p_tau|, or its limit
    real(dp), intent(in) :: pair(2, 2)
    real(dp) :: tangent(3, 3)
    real(dp) :: excess

    excess = pair(1, 1) - share
    tangent(1, 1) = share + excess*direction(1)**2
    tangent(3, 3) = share + excess*direction(2)**2
    tangent(1, 3) = excess*direction(1)*direction(2)
    tangent(3, 1) = tangent(1, 3)
    tangent(shears, 2) = pair(1, 2)*direction
    tangent(2, shears) = pair(2, 1)*direction
    tangent(2, 2) = pair(2, 2)
    ! without rounding in the plane
    if (.not. abs(direction(2)) > 0.0_dp) tangent(1, 1) = pair(1, 1)
  end function vector_tangent

end module cohesive_shear
