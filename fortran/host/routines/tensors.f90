! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Tensor utilities of Abaqus (User Subroutines Guide, Obtaining stress invariants ...): components are stored as
!> ndi direct ones, then nshr shear ones in the order 12, 13, 23; with lstr = 2 shear components are engineering strains.
module host_tensors
  use core_symmetric, only: eigenvalues
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_messages, only: add_message
  implicit none (type, external)
  private
  public :: to_matrix, to_components, eigen

  !> Routines that are called at integration points.
  character(len=6), parameter :: of_a_point(6) = [character(len=6) :: 'ORIENT', 'SDVINI', 'SIGINI', 'UMAT', 'USDFLD', &
                                                             'UVARM']

contains

  !> Symmetric matrix of a stored tensor.
  pure function to_matrix(s, lstr, ndi, nshr) result(matrix)
    real(dp), intent(in) :: s(*)
    integer(i4), intent(in) :: lstr, ndi, nshr
    real(dp) :: matrix(3, 3), factor
    integer, parameter :: row(3) = [1, 1, 2], column(3) = [2, 3, 3]
    integer :: k
    factor = merge(0.5_dp, 1.0_dp, lstr == 2)
    matrix = 0
    do k = 1, ndi
      matrix(k, k) = s(k)
    end do
    do k = 1, nshr
      matrix(row(k), column(k)) = factor*s(ndi + k)
      matrix(column(k), row(k)) = factor*s(ndi + k)
    end do
  end function to_matrix

  !> Stored components of a symmetric matrix.
  pure subroutine to_components(matrix, lstr, ndi, nshr, s)
    real(dp), intent(in) :: matrix(3, 3)
    integer(i4), intent(in) :: lstr, ndi, nshr
    real(dp), intent(inout) :: s(*)
    real(dp) :: shear(3)
    integer :: k
    shear = merge(2.0_dp, 1.0_dp, lstr == 2)*[matrix(1, 2), matrix(1, 3), matrix(2, 3)]
    do k = 1, ndi
      s(k) = matrix(k, k)
    end do
    s(ndi + 1:ndi + nshr) = shear(1:nshr)
  end subroutine to_components

  !> Eigenvalues and eigenvectors (rows of vectors) of a stored tensor, not sorted. Warns where they are not found.
  subroutine eigen(s, lstr, ndi, nshr, values, vectors)
    real(dp), intent(in) :: s(*)
    integer(i4), intent(in) :: lstr, ndi, nshr
    real(dp), intent(out) :: values(3), vectors(3, 3)
    logical :: good
    character(len=120) :: text
    character(len=40) :: place
    call eigenvalues(to_matrix(s, lstr, ndi, nshr), values, good, vectors)
    if (good) return
    place = ''
    if (any(current%routine == of_a_point)) write (place, '(a,i0)') ' at integration point ', current%point
    write (text, '(4a)') 'in ', trim(current%routine), trim(place), &
      ': a tensor has no principal values, since it contains NaN or infinity'
    call add_message(-1_i4, text)
  end subroutine eigen

end module host_tensors

!> sprime = R s R^T.
subroutine rotsig(s, r, sprime, lstr, ndi, nshr)
  use host_kinds, only: dp, i4
  use host_tensors, only: to_components, to_matrix
  implicit none (type, external)
  real(dp), intent(in) :: s(*), r(3, 3)
  real(dp), intent(inout) :: sprime(*)
  integer(i4), intent(in) :: lstr, ndi, nshr
  real(dp) :: rotated(3, 3)
  rotated = to_matrix(s, lstr, ndi, nshr)
  rotated = matmul(r, matmul(rotated, transpose(r)))
  call to_components(rotated, lstr, ndi, nshr, sprime)
end subroutine rotsig

!> Mean stress and Mises stress.
subroutine sinv(stress, sinv1, sinv2, ndi, nshr)
  use host_kinds, only: dp, i4
  use host_tensors, only: to_matrix
  implicit none (type, external)
  real(dp), intent(in) :: stress(*)
  real(dp), intent(out) :: sinv1, sinv2
  integer(i4), intent(in) :: ndi, nshr
  real(dp) :: deviator(3, 3)
  integer :: k
  deviator = to_matrix(stress, 1_i4, ndi, nshr)
  sinv1 = (deviator(1, 1) + deviator(2, 2) + deviator(3, 3))/3
  do k = 1, 3
    deviator(k, k) = deviator(k, k) - sinv1
  end do
  sinv2 = sqrt(1.5_dp*sum(deviator**2))
end subroutine sinv

!> Principal values, not sorted.
subroutine sprinc(s, ps, lstr, ndi, nshr)
  use host_kinds, only: dp, i4
  use host_tensors, only: eigen
  implicit none (type, external)
  real(dp), intent(in) :: s(*)
  real(dp), intent(out) :: ps(3)
  integer(i4), intent(in) :: lstr, ndi, nshr
  real(dp) :: directions(3, 3)
  call eigen(s, lstr, ndi, nshr, ps, directions)
end subroutine sprinc

!> Principal values, not sorted, and their directions: an(k, :) belongs to ps(k).
subroutine sprind(s, ps, an, lstr, ndi, nshr)
  use host_kinds, only: dp, i4
  use host_tensors, only: eigen
  implicit none (type, external)
  real(dp), intent(in) :: s(*)
  real(dp), intent(out) :: ps(3), an(3, 3)
  integer(i4), intent(in) :: lstr, ndi, nshr
  call eigen(s, lstr, ndi, nshr, ps, an)
end subroutine sprind
