! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> UMAT at a material point, with the arguments of Abaqus (User Subroutines Guide, UMAT).
!>
!> The history of a point holds strain and stress (six places each), the energies SSE, SPD, SCD, then STATEV. In small
!> displacements DFGRD0, DFGRD1 and DROT are the identity; in large ones STRAN and STRESS come turned by DROT.
!>
!> HYBRID FORMULATION of *USER MATERIAL, in hybrid elements: TOTAL extends STRESS by the change of volume, which is that of
!> DFGRD1, and two derivatives of the volumetric energy, which are in DDSDDE too; there DDSDDE has no share of the mean stress.
!> Of INCOMPRESSIBLE materials only the deviatoric part of STRESS counts, and the element adds its mean stress.
module host_umat
  use, intrinsic :: iso_c_binding, only: c_f_procpointer, c_funptr
  use core_small_matrix, only: determinant
  use host_context, only: current
  use host_guarded, only: guarded_t, lay_out_guarded, warn_of_no_numbers, warn_of_writes
  use host_kinds, only: dp, i4
  use host_kinematics, only: rotated
  use host_point, only: heat_t, npt_of, point_t
  implicit none (type, external)
  private
  public :: user_material_t, total, incompressible, call_umat, direct_components, head, outputs, strain_energy, stress_place

  !> Values of the history before STATEV, and among them the places of STRESS and SSE.
  integer, parameter :: head = 15, stress_place = 7, strain_energy = 13

  !> Formulations in hybrid elements; incremental is 0.
  integer, parameter :: total = 1, incompressible = 2

  !> Arrays that UMAT writes to.
  integer, parameter :: outputs = 5
  character(len=6), parameter :: names(outputs) = [character(len=6) :: 'STRESS', 'DDSDDE', 'DDSDDT', 'DRPLDE', 'STATEV']
  character(len=13), parameter :: sizes(outputs) = [character(len=13) :: &
    'NTENS', 'NTENS x NTENS', 'NTENS', 'NTENS', '*DEPVAR']
  type(guarded_t), save, target :: work   ! each thread has its own
  !$omp threadprivate(work)

  type :: user_material_t
    type(c_funptr) :: umat
    character(len=80) :: name = ' '
    integer :: hybrid = 0                       !< its formulation, of an element that is
    integer :: statev = 0                       !< number of STATEV
    integer :: room = 0                         !< values at the end of the history of which STATEV are the first
    real(dp), allocatable :: constants(:)
    logical, pointer :: reported(:) => null()   !< (outputs) a write outside the array is
    logical, pointer :: spoilt(:) => null()     !< (outputs) NaN in the array is
  end type user_material_t

  abstract interface
    subroutine umat_procedure(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, &
                              temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, &
                              pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
      import :: dp, i4
      real(dp) :: stress(*), statev(*), ddsdde(*), sse, spd, scd, rpl, ddsddt(*), drplde(*), drpldt, stran(*), dstran(*), &
                  time(*), dtime, temp, dtemp, predef(*), dpred(*), props(*), coords(*), drot(*), pnewdt, celent, &
                  dfgrd0(*), dfgrd1(*)
      character(len=80) :: cmname
      integer(i4) :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, jstep(*), kinc
    end subroutine umat_procedure
  end interface

contains

  !> Number of direct components among ntens.
  pure integer(i4) function direct_components(ntens)
    integer, intent(in) :: ntens
    integer(i4), parameter :: direct(0:6) = [0, 1, 1, 2, 3, 3, 3]
    direct_components = direct(ntens)
  end function direct_components

  !> Number of field variables besides temperature.
  pure integer function field_variables(point)
    type(point_t), intent(in) :: point
    field_variables = 0
    if (associated(point%fields)) field_variables = size(point%fields, 1) - 1
  end function field_variables

  !> Stress and tangent at the end of the increment, and the heat terms of the point; its trial history, in which STATEV holds the
  !> start values, is that of the end.
  subroutine call_umat(material, ntens, point, strain, stress, tangent)
    type(user_material_t), intent(in) :: material
    integer, intent(in) :: ntens
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: strain(ntens)                !< total, at the end of the increment
    real(dp), intent(out) :: stress(ntens), tangent(ntens, ntens)
    procedure(umat_procedure), pointer :: umat
    real(dp) :: stran(ntens), dstran(ntens), time(2), dtime, constants(size(material%constants))
    real(dp) :: rpl, drpldt, temp, dtemp, coords(3), drot(3, 3), dfgrd0(3, 3), dfgrd1(3, 3), celent, pnewdt
    real(dp) :: predef(max(field_variables(point), 1)), dpred(max(field_variables(point), 1))
    real(dp), parameter :: identity(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])
    integer(i4) :: ndi, nshr, components, nstatv, nprops, noel, npt, layer, kspt, jstep(4), kinc
    character(len=80) :: cmname
    character(len=len(current%routine)) :: routine
    integer :: extra, first
    call c_f_procpointer(material%umat, umat)
    first = size(point%history) - material%room + 1
    stran = point%history(:ntens)
    stress = point%history(stress_place:stress_place + ntens - 1)
    extra = merge(3, 0, material%hybrid == total)
    call lay_out_guarded(work, [ntens + extra, ntens**2, ntens, ntens, material%statev])
    drot = identity
    dfgrd0 = identity
    dfgrd1 = identity
    if (point%finite) then
      drot = point%rotation
      dfgrd0 = point%deformation(:, :, 1)
      dfgrd1 = point%deformation(:, :, 2)
      stran = rotated(ntens, stran, drot, 2.0_dp)
      stress = rotated(ntens, stress, drot, 1.0_dp)
    end if
    dstran = strain - stran
    time = current%time
    dtime = current%dtime
    rpl = 0
    drpldt = 0
    temp = 0
    dtemp = 0
    predef = 0
    dpred = 0
    if (associated(point%fields)) then
      temp = point%fields(1, 1)
      dtemp = point%fields(1, 2)
      predef(:field_variables(point)) = point%fields(2:, 1)
      dpred(:field_variables(point)) = point%fields(2:, 2)
    end if
    coords = point%place
    celent = point%length
    pnewdt = current%pnewdt
    constants = material%constants
    components = int(ntens, i4)
    ndi = direct_components(ntens)
    nshr = components - ndi
    nstatv = int(material%statev, i4)
    nprops = size(constants, kind=i4)
    noel = current%element
    npt = npt_of(point)
    layer = point%layer
    kspt = point%kspt
    ! procedure type, NLGEOM, linear perturbation
    jstep = [current%step, current%flags([1, 2, 4])]
    kinc = current%increment
    cmname = material%name
    routine = current%routine
    current%routine = 'UMAT'
    current%point = npt
    associate (x => work%memory, s => work%start, new => point%history_trial)
      x(s(1):s(1) + ntens - 1) = stress
      if (extra > 0) x(s(1) + ntens:s(1) + ntens + 2) = [determinant(dfgrd1), 0.0_dp, 0.0_dp]
      x(s(2):s(2) + ntens**2 - 1) = 0
      x(s(3):s(3) + ntens - 1) = 0
      x(s(4):s(4) + ntens - 1) = 0
      x(s(5):s(5) + nstatv - 1) = new(first:first + nstatv - 1)
      call umat(x(s(1)), x(s(5)), x(s(2)), new(13), new(14), new(15), rpl, x(s(3)), x(s(4)), drpldt, stran, dstran, time, dtime, &
                temp, dtemp, predef, dpred, cmname, ndi, nshr, components, nstatv, constants, nprops, coords, drot, pnewdt, &
                celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
      call warn_of_writes(work, names, sizes, current%point, material%reported)
      call warn_of_no_numbers(work, names, current%point, material%spoilt)
      stress = x(s(1):s(1) + ntens - 1)
      tangent = reshape(x(s(2):s(2) + ntens**2 - 1), [ntens, ntens])
      point%heat = heat_t(source=rpl, source_by_temperature=drpldt)
      point%heat%stress_by_temperature(:ntens) = x(s(3):s(3) + ntens - 1)
      point%heat%source_by_strain(:ntens) = x(s(4):s(4) + ntens - 1)
      new(first:first + material%statev - 1) = x(s(5):s(5) + material%statev - 1)
      new(:ntens) = strain
      new(stress_place:stress_place + ntens - 1) = stress
    end associate
    current%routine = routine
    current%pnewdt = min(current%pnewdt, pnewdt)
  end subroutine call_umat
end module host_umat
