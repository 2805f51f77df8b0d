! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The call of a built-in element: what UELMAT has as arguments, decoded, and what all elements answer alike.
!>
!> A built-in element is a procedure with one argument, of type element_t. On entry RHS, AMATRX and the mass are zero. The element
!> adds the internal force to RHS and the stiffness to AMATRX if has_forces, its mass if has_mass, updates SVARS and ENERGY, and
!> says by `keep_forces` where SVARS have the forces of earlier increments. `evaluate` makes of that what LFLAGS ask for. The force
!> of a temperature or a concentration is minus the flow that enters through the node, that of a potential minus the charge.
!>
!> In dynamic steps the operator of Hilber, Hughes and Taylor needs the forces of the last two increments: they are state variables,
!> as in the UEL example of the Abaqus User Subroutines Guide.
module host_adapter
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_f_procpointer, c_funptr, c_ptr
  use host_block, only: scalars_t
  use host_context, only: initial_stresses, is_dynamic, stress_matrix
  use host_kinds, only: dp, i4
  use host_materials, only: find_material, material_t
  use host_messages, only: add_message
  use host_protect, only: escape
  implicit none (type, external)
  private
  public :: element_t, decode, evaluate, keep_forces

  integer(i4), parameter :: damping = 3, mass = 4, acceleration = 6   !< LFLAGS(3)

  !> Names of UELMAT stand for its arguments.
  type :: element_t
    procedure(element_procedure), pointer, nopass :: routine => null()
    integer(i4) :: procedure_code = 0     !< LFLAGS(1)
    logical :: finite = .false.           !< large displacements, LFLAGS(2)
    integer(i4) :: request = 0            !< LFLAGS(3), or a request of the host (host_context)
    logical :: perturbation = .false.     !< LFLAGS(4)
    logical :: dynamic = .false.          !< a dynamic step
    logical :: has_forces = .false.       !< RHS and AMATRX are wanted
    logical :: has_mass = .false.         !< the mass is
    logical :: has_damping = .false.      !< AMATRX is to be the viscous damping matrix
    logical :: of_stress = .false.        !< AMATRX is to be the initial stress matrix: DU is zero, and the perturbation is `added`
    integer :: jtype = 0, nodes = 0, mcrd = 0, fields = 0
    integer :: n = 0                      !< unknowns
    real(dp) :: dtime = 0, time(2) = 0, params(3) = 0
    type(material_t), pointer :: material => null()
    logical :: lost = .false.             !< the material is no longer in the library
    integer(i4), pointer :: jelem => null(), ndload => null()
    integer(i4), pointer, contiguous :: jprops(:) => null(), jdltyp(:) => null()
    real(dp), pointer, contiguous :: props(:) => null(), adlmag(:) => null(), ddlmag(:) => null()
    real(dp), pointer, contiguous :: coords(:, :) => null()      !< (MCRD, nodes)
    real(dp), pointer, contiguous :: u(:) => null(), du(:) => null(), v(:) => null(), a(:) => null()
    real(dp), pointer, contiguous :: added(:) => null()          !< DU of the call
    real(dp), pointer, contiguous :: predef(:, :, :) => null()   !< (2, fields, nodes)
    real(dp), pointer, contiguous :: svars(:) => null(), energy(:) => null()
    real(dp), pointer, contiguous :: rhs(:, :) => null()         !< (n, NRHS)
    real(dp), pointer, contiguous :: amatrx(:, :) => null()
    real(dp), pointer, contiguous :: old(:, :) => null()         !< (n, 2) forces of the last two increments
    real(dp), allocatable :: mass(:, :)
    real(dp), allocatable :: none(:, :)                          !< in place of old where SVARS do not have them
    real(dp), allocatable :: still(:)                            !< in place of DU for the initial stress matrix
  end type element_t

  abstract interface
    subroutine element_procedure(element)
      import :: element_t
      type(element_t), intent(inout) :: element
    end subroutine element_procedure
  end interface

contains

  !> Take from the scalars of a call what is the same for all elements of a block. Then the caller sets the arrays.
  subroutine decode(element, routine, scalars)
    type(element_t), intent(inout) :: element
    type(c_funptr), intent(in) :: routine
    type(scalars_t), intent(in) :: scalars
    call c_f_procpointer(routine, element%routine)
    associate (flags => scalars%lflags)
      element%procedure_code = flags(1)
      element%finite = flags(2) /= 0
      element%request = flags(3)
      element%perturbation = flags(4) /= 0
      element%dynamic = is_dynamic(flags(1))
      element%has_forces = all(flags(3) /= [damping, mass])
      element%has_mass = element%dynamic .or. any(flags(3) == [mass, acceleration])
      element%has_damping = flags(3) == damping .and. flags(7) == 1
      element%of_stress = stress_matrix(flags(3))
    end associate
    element%n = scalars%ndofel
    element%jtype = scalars%jtype
    element%nodes = scalars%nnode
    element%mcrd = scalars%mcrd
    element%fields = scalars%npredf
    element%dtime = scalars%dtime
    element%time = scalars%time
    element%params = scalars%params
    element%material => find_material(scalars%material)
    element%lost = scalars%material > 0 .and. .not. associated(element%material)
    if (allocated(element%mass)) deallocate (element%mass, element%none, element%still)
    allocate (element%mass(element%n, element%n), element%none(element%n, 2), element%still(element%n), source=0.0_dp)
  end subroutine decode

  !> Call the element, as calls.c does for each one, and turn its force, stiffness and mass into RHS and AMATRX.
  subroutine evaluate(context) bind(c)
    type(c_ptr), value :: context   ! is the element
    type(element_t), pointer :: element
    call c_f_pointer(context, element)
    element%none = 0
    element%old => element%none
    if (element%has_mass) element%mass = 0
    if (element%lost) call report_lost()
    call element%routine(element)
    if (element%request /= damping) call respond(element)
  end subroutine evaluate

  !> Make RHS and AMATRX of internal force, stiffness and mass, keep the force where the call keeps state, and find the kinetic
  !> energy.
  subroutine respond(element)
    type(element_t), intent(inout) :: element
    real(dp) :: force(element%n)
    associate (request => element%request, rhs => element%rhs(:, 1), old => element%old)
      if (any(request == [1_i4, acceleration, initial_stresses])) then
        force = old(:, 1)
        old(:, 2) = merge(rhs, force, request == acceleration)
        old(:, 1) = rhs
      else
        force = 0.5_dp*(old(:, 1) + old(:, 2))
      end if
      if (element%dynamic .and. any(request == [1, 5])) then
        associate (alpha => element%params(1))
          rhs = -matmul(element%mass, element%a) - (1 + alpha)*rhs + alpha*force
          if (request == 1) element%amatrx = (1 + alpha)*element%amatrx + element%mass/(element%params(2)*element%dtime**2)
        end associate
      else
        rhs = -rhs
      end if
      if (any(request == [mass, acceleration])) element%amatrx = element%mass
      if (element%dynamic) element%energy(1) = 0.5_dp*dot_product(element%v, matmul(element%mass, element%v))
    end associate
  end subroutine respond

  !> Leave the pass.
  subroutine report_lost()
    call add_message(-3_i4, 'the material of these elements was that of a job that has ended')
    call escape()
  end subroutine report_lost

  !> Let SVARS from one place to the one before another hold the forces of the last two increments, if there are any.
  subroutine keep_forces(element, first, behind)
    type(element_t), intent(inout) :: element
    integer, intent(in) :: first, behind
    if (behind > first) element%old(1:element%n, 1:2) => element%svars(first:behind - 1)
  end subroutine keep_forces
end module host_adapter
