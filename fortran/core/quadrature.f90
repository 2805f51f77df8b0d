! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Points and weights of the quadrature rules; both line rules have two points of weight 1 on (-1, 1).
module core_quadrature
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: gauss_abscissa, quad_points, line_points
  public :: gauss_rule, newton_cotes_rule

  real(dp), parameter :: gauss_abscissa = 0.577350269189625764509148780501957_dp

  !> 2 x 2 Gauss points (xi, eta) in the order Abaqus numbers them in CPS4; every weight is 1.
  real(dp), parameter :: quad_points(2, 4) = gauss_abscissa*reshape( &
    [-1.0_dp, -1.0_dp, 1.0_dp, -1.0_dp, -1.0_dp, 1.0_dp, 1.0_dp, 1.0_dp], [2, 4])

  integer, parameter :: gauss_rule = 0
  integer, parameter :: newton_cotes_rule = 1

contains

  !> The two points of a line rule on (-1, 1): Gauss, or Newton-Cotes (the ends).
  pure function line_points(rule) result(points)
    integer, intent(in) :: rule
    real(dp) :: points(2)

    points = [-1.0_dp, 1.0_dp]
    if (rule == gauss_rule) points = gauss_abscissa*points
  end function line_points

end module core_quadrature
