! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Derivatives of the foot point X of a point, its projection onto a surface, and of the normal n there.
!>
!> With the tangents tau of the surface, the clearance g, the motion W du of the point relative to X, and G du = d tau at fixed
!> natural coordinates xi, they are
!>
!>     (tau_a tau_b - g n tau_ab) dxi_b = tau_a W du + g n G_a du,    dn = -tau^a (n G_a du + n tau_ab dxi_b)
!>
!> (P. Wriggers, Computational Contact Mechanics, 2nd edition (2006), chapter 4).
module host_contact_derivatives
  use host_kinds, only: dp
  use host_contact_faces, only: rounding, foot_t, det, solve
  implicit none (type, external)
  private
  public :: differentiate

contains

  !> Derivatives of natural coordinates and normal by the unknowns.
  pure subroutine differentiate(foot, gap, along, across, natural_by, tilt)
    type(foot_t), intent(in) :: foot
    real(dp), intent(in) :: gap                              !< g
    real(dp), intent(in), contiguous :: along(:, :)                      !< (u, a) tau_a W
    real(dp), intent(in), contiguous :: across(:, :)                     !< (u, a) n G_a
    real(dp), intent(out), contiguous :: natural_by(:, :)                !< (u, a) of xi_a
    real(dp), intent(out), contiguous :: tilt(:, :)                      !< (u, a): dn = -tau_a tilt_a du
    real(dp) :: bent(2, 2), matrix(2, 2)
    integer :: a, b
    bent = 0
    do a = 1, foot%along
      do b = 1, foot%along
        bent(b, a) = dot_product(foot%normal, foot%second(:, b, a))
      end do
    end do
    matrix = foot%metric - gap*bent
    ! the projection from the centre of a circle is not unique
    if (abs(det(foot%along, matrix)) <= rounding*det(foot%along, foot%metric)) matrix = foot%metric
    call solve_all(foot%along, matrix, along + gap*across, natural_by)
    call solve_all(foot%along, foot%metric, across + matmul(natural_by, bent(:foot%along, :foot%along)), tilt)
  end subroutine differentiate

  !> Solve a system of one or two equations for many right-hand sides (u, a).
  pure subroutine solve_all(along, matrix, right, x)
    integer, intent(in) :: along
    real(dp), intent(in) :: matrix(2, 2)
    real(dp), intent(in), contiguous :: right(:, :)
    real(dp), intent(out), contiguous :: x(:, :)
    real(dp) :: inverse(2, 2)
    integer :: a
    inverse(:, 1) = solve(along, matrix, [1.0_dp, 0.0_dp])
    inverse(:, 2) = 0
    if (along == 2) inverse(:, 2) = solve(along, matrix, [0.0_dp, 1.0_dp])
    do a = 1, along
      x(:, a) = inverse(a, 1)*right(:, 1)
      if (along == 2) x(:, a) = x(:, a) + inverse(a, 2)*right(:, 2)
    end do
  end subroutine solve_all
end module host_contact_derivatives
