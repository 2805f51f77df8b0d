! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What the host knows about the current call, for the utility routines that a user's file calls.
module host_context
  use host_kinds, only: dp, i4
  implicit none (type, external)
  private
  public :: added_stress, base_stress, call_context, current, initial_stresses, is_dynamic, job_name, names_cut, &
            output_directory, output_variables, rank, ranks, stress_matrix, threads, visible_t

  !> LFLAGS(3) of the host's own pass before an analysis, in which built-in elements take their stresses from SVARS.
  integer(i4), parameter :: initial_stresses = -1

  !> And of the passes for the initial stress matrix (geometric stiffness): of the stresses at U, and of those that a linear
  !> perturbation DU adds to them.
  integer(i4), parameter :: base_stress = -2, added_stress = -3

  !> And of the pass after an increment, in which elements whose points have places and directions of their own call UVARM: DU is
  !> zero, no material is called, and all that is kept is UVAR, in the history.
  integer(i4), parameter :: output_variables = -4

  !> What GETVRM returns: values of the material point for which USDFLD or UVARM runs.
  type :: visible_t
    !> Strain, then stress; of a truss E11, S11, PE11 and the equivalent plastic strain. Null while neither routine runs.
    real(dp), pointer, contiguous :: values(:) => null()
    real(dp) :: axes(3, 3) = 0           !< rows: directions of these values
    real(dp), pointer, contiguous :: history(:) => null()     !< committed history of the point
    real(dp), pointer, contiguous :: fields(:, :) => null()   !< its temperature and fields (host_point)
    integer :: first = 0                 !< position of STATEV in the history
    integer :: statev = 0                !< number of STATEV
    logical :: plastic = .false.         !< the history begins with a plastic strain, except that of a truss
  end type visible_t

  !> The call of a user routine or of an element, as far as routines without arguments for it need it: GETVRM, XIT, STDB_ABQERR,
  !> messages, and what a call that is left says of its end. The state of a material point is an argument (host_point).
  type :: call_context
    character(len=16) :: routine = ' '   !< name of the user routine that runs
    integer(i4) :: element = 0    !< element number, 0 outside an element loop
    integer(i4) :: step = 0
    integer(i4) :: increment = 0
    integer(i4) :: iteration = 0  !< 0 before the first solution, and outside an element loop
    integer(i4) :: point = 0      !< material point of the user routine, from 1
    integer(i4) :: thread = 0     !< of the call, from 0
    real(dp) :: time(2) = 0       !< step and total time at the start of the increment
    real(dp) :: dtime = 0
    integer(i4) :: flags(4) = 0   !< LFLAGS(1) to (4)
    integer(i4) :: procedure = 0  !< LFLAGS(1); 0 in the pass for the initial acceleration, in which no time passes
    integer(i4) :: tensor = 0     !< components of stress: 1, 2, 3, 4 or 6; 0 without a material
    real(dp) :: pnewdt = 0        !< smallest that a user material has returned in this call
    logical :: deformed = .false. !< the element has displacements: a smaller increment may spare it a distortion
    integer :: distorted = 0      !< point at which it is inside out, negative: over the axis; 0 for none
    real(dp), pointer, contiguous :: history(:, :) => null()        !< (values, points) committed material history
    real(dp), pointer, contiguous :: history_trial(:, :) => null()  !< (values, points) of this call
    type(visible_t) :: visible
  end type call_context

  ! each thread has its own
  type(call_context), target, save :: current
  !$omp threadprivate(current)
  integer(i4), save :: threads = 1         !< that call the elements of the job
  integer(i4), save :: ranks = 1           !< processes that run the job
  integer(i4), save :: rank = 0            !< number of this one, from 0
  character(len=4096), save :: job_name = ' '
  character(len=4096), save :: output_directory = ' '
  logical, save :: names_cut(2) = .false.   !< job name, output directory: a user routine took a part of it

contains

  !> Whether LFLAGS(1) is that of a dynamic step.
  elemental logical function is_dynamic(procedure_code)
    integer(i4), intent(in) :: procedure_code
    is_dynamic = procedure_code == 11 .or. procedure_code == 12
  end function is_dynamic

  !> Whether LFLAGS(3) asks for the initial stress matrix.
  elemental logical function stress_matrix(request)
    integer(i4), intent(in) :: request
    stress_matrix = request == base_stress .or. request == added_stress
  end function stress_matrix
end module host_context
