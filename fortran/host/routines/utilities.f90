! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Ways out of a user routine, and messages: the routines of Abaqus that a user's file calls by name. None of them may be in a
!> module, since the file uses the plain external names.

!> End the analysis; the block driver's caller gets control back (guards/protect.c).
subroutine xit()
  use host_protect, only: escape
  implicit none (type, external)
  call escape()
end subroutine xit

!> Not documented; public user elements call it as they would XIT.
subroutine xexit()
  use host_protect, only: escape
  implicit none (type, external)
  call escape()
end subroutine xexit

!> Send a message: lop 1 information, -1 warning, -2 error, -3 fatal error, which ends the analysis.
subroutine stdb_abqerr(lop, string, intv, realv, charv)
  use host_kinds, only: dp, i4
  use host_messages, only: add_message, substitute
  use host_protect, only: escape
  implicit none (type, external)
  integer(i4), intent(in) :: lop
  character(len=*), intent(in) :: string
  integer(i4), intent(in) :: intv(*)
  real(dp), intent(in) :: realv(*)
  character(len=*), intent(in) :: charv(*)
  call add_message(lop, substitute(string, intv, realv, charv))
  if (lop == -3) call escape()
end subroutine stdb_abqerr

!> Name of the job, and its length.
subroutine getjobname(jobname, lenjobname)
  use host_context, only: job_name
  use host_kinds, only: i4
  use host_messages, only: pass_name
  implicit none (type, external)
  character(len=*), intent(out) :: jobname
  integer(i4), intent(out) :: lenjobname
  call pass_name(1, 'GETJOBNAME: the name of the job', job_name, jobname, lenjobname)
end subroutine getjobname

!> Folder of the output files, and its length.
subroutine getoutdir(outdir, lenoutdir)
  use host_context, only: output_directory
  use host_kinds, only: i4
  use host_messages, only: pass_name
  implicit none (type, external)
  character(len=*), intent(out) :: outdir
  integer(i4), intent(out) :: lenoutdir
  call pass_name(2, 'GETOUTDIR: the name of the output directory', output_directory, outdir, lenoutdir)
end subroutine getoutdir

!> Number of MPI processes.
subroutine getnumcpus(numprocesses)
  use host_context, only: ranks
  use host_kinds, only: i4
  implicit none (type, external)
  integer(i4), intent(out) :: numprocesses
  numprocesses = ranks
end subroutine getnumcpus

!> Rank of this MPI process, from 0.
subroutine getrank(kprocessnum)
  use host_context, only: rank
  use host_kinds, only: i4
  implicit none (type, external)
  integer(i4), intent(out) :: kprocessnum
  kprocessnum = rank
end subroutine getrank

!> Number of threads that call the elements.
function getnumthreads() result(number)
  use host_context, only: threads
  use host_kinds, only: i4
  implicit none (type, external)
  integer(i4) :: number
  number = threads
end function getnumthreads

!> Number of the calling thread, from 0.
function get_thread_id() result(thread)
  use host_context, only: current
  use host_kinds, only: i4
  implicit none (type, external)
  integer(i4) :: thread
  thread = current%thread
end function get_thread_id

!> Value of an environment variable, and its length.
subroutine getenvvar(envvarname, envvar, lenenvvar)
  use host_kinds, only: i4
  implicit none (type, external)
  character(len=*), intent(in) :: envvarname
  character(len=*), intent(out) :: envvar
  integer(i4), intent(out) :: lenenvvar
  call get_environment_variable(trim(envvarname), envvar, lenenvvar)
end subroutine getenvvar
