! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Spectral norm of a matrix: |D| of equations (21) and (22).
module materials_spectral_norm
  use core_kinds, only: dp
  use core_small_matrix, only: determinant
  use core_symmetric, only: eigenvalues
  implicit none(type, external)
  private
  public :: spectral_norm

contains

  !> Largest singular value.
  pure function spectral_norm(a) result(norm)
    real(dp), intent(in) :: a(:, :)
    real(dp) :: norm
    real(dp) :: squares(size(a, 1))
    logical :: good

    if (size(a, 1) == 3) then
      norm = norm_of_three(a)
      return
    end if
    call eigenvalues(matmul(transpose(a), a), squares, good)
    norm = sqrt(maxval(squares))
  end function spectral_norm

  !> Of a 3 x 3 matrix, from the largest root of the characteristic polynomial of transpose(a) a
  !> (trigonometric solution of the cubic, which gives the largest root without cancellation).
  pure function norm_of_three(a) result(norm)
    real(dp), intent(in) :: a(3, 3)
    real(dp) :: norm
    real(dp) :: b(3, 3), scale, mean, spread, cosine

    norm = 0.0_dp
    scale = maxval(abs(a))
    if (.not. scale > 0.0_dp) return
    b = matmul(transpose(a/scale), a/scale)
    mean = (b(1, 1) + b(2, 2) + b(3, 3))/3.0_dp
    b(1, 1) = b(1, 1) - mean
    b(2, 2) = b(2, 2) - mean
    b(3, 3) = b(3, 3) - mean
    spread = sqrt(sum(b**2)/6.0_dp)
    if (spread > 0.0_dp) then
      cosine = max(-1.0_dp, min(1.0_dp, 0.5_dp*determinant(b/spread)))
      mean = mean + 2.0_dp*spread*cos(acos(cosine)/3.0_dp)
    end if
    norm = scale*sqrt(mean)
  end function norm_of_three

end module materials_spectral_norm
