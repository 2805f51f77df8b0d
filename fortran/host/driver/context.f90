! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What the host knows about the current call, for the utility routines that a user's file calls.
module host_context
  use host_kinds, only: dp, i4
  implicit none (type, external)
  private
  public :: added_stress, base_stress, call_context, current, fields_at_end, heat_t, initial_stresses, job_name, names_cut, &
            output_directory, output_variables, rank, ranks, stress_matrix, threads

  !> LFLAGS(3) of the host's own pass before an analysis, in which built-in elements take their stresses from SVARS.
  integer(i4), parameter :: initial_stresses = -1

  !> And of those for the matrix of a stress: that of U, and that which the displacements DU add to it.
  integer(i4), parameter :: base_stress = -2, added_stress = -3

  !> And of that after an increment, in which elements whose points have places and directions of their own call UVARM: DU is zero,
  !> no material is called, and all that is kept is UVAR, in the history.
  integer(i4), parameter :: output_variables = -4

  !> The heat terms of UMAT at the end of the increment, and of UHARD the last one; directions of the stresses, engineering shear
  !> strains.
  type :: heat_t
    real(dp) :: source = 0                   !< RPL, heat generated per volume and time
    real(dp) :: source_by_temperature = 0    !< DRPLDT
    real(dp) :: source_by_strain(6) = 0      !< DRPLDE
    real(dp) :: stress_by_temperature(6) = 0 !< DDSDDT
  end type heat_t

  type :: call_context
    character(len=16) :: routine = ' '   !< name of the user routine that runs
    integer(i4) :: element = 0    !< element number, 0 outside an element loop
    integer(i4) :: step = 0
    integer(i4) :: increment = 0
    integer(i4) :: iteration = 0  !< 0 before the first solution, and outside an element loop
    integer(i4) :: point = 0      !< material point, from 1
    integer(i4) :: npt = 0        !< of shells: integration point, 0 elsewhere; the material point is a section point
    integer(i4) :: layer = 1      !< and
    integer(i4) :: kspt = 1       !< section point of the layer
    integer(i4) :: thread = 0     !< of the call, from 0
    real(dp) :: time(2) = 0       !< step and total time at the start of the increment
    real(dp) :: dtime = 0
    integer(i4) :: flags(4) = 0   !< LFLAGS(1) to (4)
    integer(i4) :: procedure = 0  !< LFLAGS(1); 0 in the pass for the initial acceleration, in which no time passes
    real(dp) :: place(3) = 0      !< coordinates of the material point
    real(dp), allocatable :: fields(:, :)   !< (fields, 2) temperature and fields of the point: at the start, increments
    real(dp) :: length = 0        !< characteristic length of the element
    real(dp) :: pnewdt = 0        !< smallest that a user material has returned in this call
    integer(i4) :: tensor = 0     !< components of stress: 1, 2, 3, 4 or 6; 0 without a material
    type(heat_t) :: heat          !< of the last call of UMAT or UHARD
    logical :: deformed = .false. !< the element is deformed
    integer :: distorted = 0      !< point at which it is inside out, negative: over the axis; 0 for none
    logical :: finite = .false.   !< large displacements: the next two are those of the point
    real(dp) :: rotation(3, 3) = 0         !< of the increment
    real(dp) :: deformation(3, 3, 2) = 0   !< deformation gradients at its start and end
    real(dp) :: turn(3, 3) = 0    !< from the directions of the material at the start of the job to those of these gradients
    real(dp) :: energy = 0        !< strain energy per volume now of a hyperelastic point
    real(dp) :: dissipated = 0    !< energy per volume now that its networks dissipate in the increment
    logical :: hybrid = .false.   !< the mean stress of the point is given: the next one
    real(dp) :: mean_stress = 0
    real(dp), pointer, contiguous :: history(:, :) => null()        !< (values, npt) committed material history
    real(dp), pointer, contiguous :: history_trial(:, :) => null()  !< (values, npt) of this call
    !> Strain, then stress of the point, for GETVRM; of a truss E11, S11, PE11 and the equivalent plastic strain.
    real(dp), pointer, contiguous :: values(:) => null()
    real(dp) :: axes(3, 3) = 0    !< rows: directions of those values
    integer :: column = 0         !< of the point in the history, for GETVRM
    integer :: first = 0          !< place of its STATEV there
    integer :: statev = 0         !< and their number
    logical :: plastic = .false.  !< it has a plastic strain, with which its history begins, but that of a truss
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

  !> Whether LFLAGS(3) asks for the matrix of a stress.
  elemental logical function stress_matrix(request)
    integer(i4), intent(in) :: request
    stress_matrix = request == base_stress .or. request == added_stress
  end function stress_matrix

  !> Temperature and fields of the point at the end of the increment, and their increments; zero and none without any.
  subroutine fields_at_end(temperature, its_change, fields, their_changes)
    real(dp), intent(out) :: temperature, its_change
    real(dp), allocatable, intent(out) :: fields(:), their_changes(:)
    temperature = 0
    its_change = 0
    if (allocated(current%fields)) then
      temperature = sum(current%fields(1, :))
      its_change = current%fields(1, 2)
      fields = sum(current%fields(2:, :), 2)
      their_changes = current%fields(2:, 2)
    else
      allocate (fields(0), their_changes(0))
    end if
  end subroutine fields_at_end
end module host_context
