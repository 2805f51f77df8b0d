! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Elastic constants that depend on temperature and field variables (*ELASTIC, DEPENDENCIES=), by tables (host_tables).
module host_dependence
  use core_symmetric, only: invert_definite
  use host_kinds, only: dp
  use host_tables, only: interpolate
  implicit none (type, external)
  private
  public :: dependence_t, elastic_matrices, compliance_of

  type :: dependence_t
    integer :: constants = 0              !< 2: Young's modulus and Poisson's ratio; 9: engineering constants
    real(dp), allocatable :: table(:, :)  !< (constants and variables, k): temperature is the first of the variables
    real(dp) :: turn(6, 6) = 0            !< stress components in global axes to those in the axes of the material
  end type dependence_t

contains

  !> Stiffness and compliance in global axes; thickness: strain 33 per stress in plane stress.
  subroutine elastic_matrices(dependence, ntens, variables, stiffness, compliance, thickness, constants, definite)
    type(dependence_t), intent(in) :: dependence
    integer, intent(in) :: ntens                      !< 1, 2, 3, 4 or 6
    real(dp), intent(in) :: variables(:)              !< temperature and fields; more than the table has are left out
    real(dp), intent(out) :: stiffness(ntens, ntens), compliance(ntens, ntens), thickness(3)
    real(dp), intent(out) :: constants(dependence%constants)
    logical, intent(out) :: definite                  !< false: they are not positive definite, and the stiffness is zero
    real(dp) :: full(6, 6), rigid(6, 6), slopes(dependence%constants)
    logical :: good
    integer :: kept(min(ntens, 3))
    integer, parameter :: plane(3) = [1, 2, 4]
    call interpolate(dependence%constants, size(dependence%table, 1) - dependence%constants, dependence%table, variables, &
                     constants, slopes)
    full = matmul(transpose(dependence%turn), matmul(compliance_of(constants), dependence%turn))
    thickness = full(3, plane)
    if (ntens <= 3) then
      kept = plane(:ntens)
      if (ntens == 2) kept(2) = 4
      compliance = full(kept, kept)
      call invert_definite(compliance, stiffness, definite)
    else
      call invert_definite(full, rigid, definite)
      stiffness = rigid(:ntens, :ntens)
      call invert_definite(stiffness, compliance, good)
    end if
  end subroutine elastic_matrices

  !> Compliance (11, 22, 33, 12, 13, 23) of E and nu, or of E1, E2, E3, nu12, nu13, nu23, G12, G13, G23.
  pure function compliance_of(constants) result(s)
    real(dp), intent(in) :: constants(:)
    real(dp) :: s(6, 6), c(9)
    integer :: k
    if (size(constants) == 2) then
      c = constants(1)
      c(4:6) = constants(2)
      c(7:9) = constants(1)/(2*(1 + constants(2)))
    else
      c = constants
    end if
    s = 0
    do k = 1, 3
      s(k, k) = 1/c(k)
      s(k + 3, k + 3) = 1/c(k + 6)
    end do
    s(1, 2) = -c(4)/c(1)
    s(1, 3) = -c(5)/c(1)
    s(2, 3) = -c(6)/c(2)
    s(2, 1) = s(1, 2)
    s(3, 1) = s(1, 3)
    s(3, 2) = s(2, 3)
  end function compliance_of
end module host_dependence
