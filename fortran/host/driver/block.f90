! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> One pass over a block of like elements: what is called, with what, how it may fail, and where the results go.
module host_block
  use, intrinsic :: iso_c_binding, only: c_double, c_funptr, c_int32_t
  use host_context, only: initial_stresses
  use host_kinds, only: dp, i4
  implicit none (type, external)
  private
  public :: block_t, scalars_t, keeps_state, untouched
  public :: fault_none, fault_left, fault_outside, fault_unset, fault_not_finite, fault_endless, fault_distorted
  public :: guards_stop, guards_notice, guards_search, entries_notice, entries_zero

  integer(i4), parameter :: fault_none = 0        !< all went well
  integer(i4), parameter :: fault_left = 1        !< the user routine ended the analysis
  integer(i4), parameter :: fault_outside = 2     !< a write outside an array
  integer(i4), parameter :: fault_unset = 3       !< an entry was not set
  integer(i4), parameter :: fault_not_finite = 4  !< an entry is NaN or infinite
  integer(i4), parameter :: fault_endless = 5     !< a call did not return within the time limit

  integer(i4), parameter :: fault_distorted = 6   !< a built-in element has turned inside out

  integer(i4), parameter :: guards_stop = 0       !< a write outside an array ends the pass; the element is searched for
  integer(i4), parameter :: guards_notice = 1     !< it is reported after the pass
  integer(i4), parameter :: guards_search = 2     !< each element is checked for it
  integer(i4), parameter :: guards_ignore = 3     !< it is ignored

  integer(i4), parameter :: entries_stop = 0      !< an entry of RHS or AMATRX that is not set ends the pass
  integer(i4), parameter :: entries_notice = 1    !< from the first one on, and after the pass, RHS and AMATRX are zero on entry
  integer(i4), parameter :: entries_zero = 2      !< RHS and AMATRX are zero on entry

  !> PNEWDT on entry: larger than any value that a user routine would return.
  real(dp), parameter :: untouched = 1.0e36_dp

  !> Scalars and short arrays of a call, under Abaqus' names, as in calls.c. Each call gets copies: a user routine that changes
  !> them affects nothing else.
  type, bind(c) :: scalars_t
    integer(c_int32_t) :: ndofel = 0, nrhs = 0, nsvars = 0, nprops = 0, mcrd = 0, nnode = 0, jtype = 0, kstep = 0, kinc = 0, &
                          jelem = 0, ndload = 0, npredf = 0, mlvarx = 0, mdload = 1, njprop = 0, material = 0
    integer(c_int32_t) :: lflags(7) = 0
    real(c_double) :: time(2) = 0, dtime = 0, params(3) = 0, pnewdt = untouched, period = 0
  end type scalars_t

  !> One pass over a block: what is called, with what, and where the results go. Arrays belong to the caller.
  type :: block_t
    type(c_funptr) :: address
    type(scalars_t) :: scalars           !< of each call, but for the number of the element and its loads
    logical :: built_in = .false.        !< a built-in element (host_adapter), not one of the user's
    logical :: symmetric = .false.       !< assemble (A + A^T)/2
    logical :: parallel = .false.        !< several threads may call elements at the same time
    integer(i4) :: guards = guards_stop  !< one of guards_*
    integer(i4) :: entries = entries_stop  !< one of entries_*
    logical :: want_matrix = .false.     !< check and assemble AMATRX
    logical :: want_residual = .false.   !< check and assemble RHS
    logical :: keeps_state = .false.     !< keep SVARS, ENERGY and the material history that a call leaves
    logical :: moves = .false.           !< V and A are given
    integer(i4) :: tensor = 0, iteration = 0
    integer(i4), pointer, contiguous :: labels(:) => null(), jprops(:) => null()
    integer(i4), pointer, contiguous :: equations(:, :) => null()  !< (ndofel, m) unknown, from 1
    integer(i4), pointer, contiguous :: map(:, :, :) => null()     !< (ndofel, ndofel, m) position in matrix, from 1
    real(dp), pointer, contiguous :: props(:) => null()
    real(dp), pointer, contiguous :: coords(:, :) => null()        !< (mcrd*nnode, m)
    real(dp), pointer, contiguous :: u(:) => null(), du(:) => null()
    real(dp), pointer, contiguous :: v(:) => null(), a(:) => null()   !< velocity and acceleration
    ! of the m elements, or of one that stands for all
    integer(i4), pointer, contiguous :: counts(:) => null()        !< (m) distributed loads
    integer(i4), pointer, contiguous :: kinds(:, :) => null()      !< (most, m) JDLTYP
    real(dp), pointer, contiguous :: loads(:, :, :) => null()      !< (2, most, m) magnitude at the end, increment
    real(dp), pointer, contiguous :: predef(:, :) => null()        !< (2*NPREDF*nnode, m)
    real(dp), pointer, contiguous :: svars(:, :) => null(), svars_trial(:, :) => null()     !< (nsvars, m)
    real(dp), pointer, contiguous :: energy(:, :) => null(), energy_trial(:, :) => null()   !< (8, m)
    real(dp), pointer, contiguous :: history(:, :, :) => null(), history_trial(:, :, :) => null()  !< (values, npt, m)
    real(dp), pointer, contiguous :: residual(:, :) => null()  !< (n, NRHS)
    real(dp), pointer, contiguous :: matrix(:) => null()
    real(dp), pointer, contiguous :: floor(:) => null()            !< (ndofel) |RHS| above which an entry counts as a term
    real(dp), pointer, contiguous :: flux(:, :) => null()          !< (ndofel, 3) sum of |RHS|, number of terms, the largest one
    integer :: first = 1                  !< element at which the loop on one thread begins
    integer(i4) :: alone = 0              !< elements that it has called again, since several threads could not go on
    real(dp) :: pnewdt = untouched        !< smallest returned, or one that is not finite
    real(dp) :: energy_sum(8) = 0
    integer(i4) :: fault = fault_none     !< one of fault_*
    integer(i4) :: position = 0           !< element of the fault, from 1; 0 if unknown
    integer(i4) :: culprit(3) = 0         !< first element that wrote outside an array, array and entry, with guards_search
    integer(i4) :: array = 0, index = 0   !< array (number in host_workspace) and entry of the fault, or routine and point
    integer(i4) :: unset(3) = 0           !< element, array and entry after which entries_notice became entries_zero
  end type block_t

contains

  !> Calls whose SVARS and ENERGY are kept: the normal one, that for initial stresses, and that for the initial acceleration,
  !> as the example of UEL in the User Subroutines Guide needs for the forces at the start of the first increment.
  elemental logical function keeps_state(request)
    integer(i4), intent(in) :: request   !< LFLAGS(3)
    keeps_state = any(request == [1_i4, 6_i4, initial_stresses])
  end function keeps_state
end module host_block
