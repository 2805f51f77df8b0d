! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Procedures Python calls (through f2py) outside of the element loop: for user routines of points, nodes and amplitudes, and for
!> points of contact; host/entry/elements.f90 has the others.

!> Traction-separation response of m points. A state is a cohesive_point, its components one after the other.
subroutine host_traction_separation(reals, integers, dtime, separation, before, after, tangent, brittle, fault, n, k, j, m)
  use host_kinds, only: dp, i4
  use host_traction_separation, only: cohesive_law, cohesive_point, fine, read_law, update_point
  implicit none (type, external)
  integer(i4), intent(in) :: n, k, j, m
  real(dp), intent(in) :: reals(n), dtime, separation(3, m)
  integer(i4), intent(in) :: integers(k)
  real(dp), intent(in) :: before(j, m)
  real(dp), intent(inout) :: after(j, m), tangent(3, 3, m)
  integer(i4), intent(out) :: brittle         !< the first point whose fracture energy is too small, 0 without any
  real(dp), intent(out) :: fault              !< by how much
  type(cohesive_law) :: law
  type(cohesive_point) :: old, new
  integer :: p, status
  law = read_law(reals, integers)
  brittle = 0
  do p = 1, m
    old = cohesive_point(before(1:3, p), before(4:6, p), before(7, p), before(8:10, p), before(11, p), before(12, p), &
                         before(13, p))
    call update_point(law, 1.0_dp, dtime, separation(:, p), old, new, tangent(:, :, p), status, fault)
    if (status /= fine) then
      brittle = int(p, i4)
      return
    end if
    after(:, p) = [new%separation, new%traction, new%damage, new%dissipated, new%viscous, new%largest, new%criterion]
  end do
end subroutine host_traction_separation

!> Call UVARM at all material points of a block of built-in elements.
subroutine host_uvarm_pass(address, names, axes, counts, place, clock, labels, coords, svars, history, uvar, left, element, &
                           point, mcrd, nnode, variables, points, values, nuvarm, m, each, every)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_context, only: current
  use host_kinds, only: dp, i4, i8
  use host_uvarm_pass, only: run_uvarm, uvarm_pass_t
  implicit none (type, external)
  integer(i8), intent(in) :: address
  character(len=80), intent(in) :: names(2)   !< of the material and its orientation
  integer(i4), intent(in) :: each, every      !< points and m, or 1 if all have the same directions
  real(dp), intent(in), target :: axes(3, 3, each, every)   !< rows: material directions
  integer(i4), intent(in) :: counts(5)        !< stress components, STATEV, family of the elements, 1: the history begins with a
                                              !< plastic strain, 1: material in the directions
  integer(i4), intent(in) :: place(2)         !< step, increment
  real(dp), intent(in) :: clock(3)            !< step time, total time at the start of the increment, time increment
  integer(i4), intent(in) :: mcrd, nnode, variables, points, values, nuvarm, m
  integer(i4), intent(in), target :: labels(m)
  real(dp), intent(in), target :: coords(mcrd, nnode, m), svars(variables, points, m), history(values, points, m)
  real(dp), intent(inout), target :: uvar(nuvarm, points, m)
  integer(i4), intent(out) :: left            !< 1 if the routine ended the analysis
  integer(i4), intent(out) :: element, point  !< of the last call
  type(uvarm_pass_t) :: pass
  pass%user%address = transfer(int(address, c_intptr_t), pass%user%address)
  pass%user%material = names(1)
  pass%user%orientation = names(2)
  pass%user%statev = counts(2)
  pass%user%room = counts(2)
  pass%user%plastic = counts(4) /= 0
  pass%axes => axes
  pass%local = counts(5) /= 0
  pass%tensor = counts(1)
  pass%family = counts(3)
  pass%kstep = place(1)
  pass%kinc = place(2)
  pass%time = clock(:2)
  pass%dtime = clock(3)
  pass%labels => labels
  pass%coords => coords
  pass%svars => svars
  pass%history => history
  pass%uvar => uvar
  call run_uvarm(pass, left)
  element = current%element
  point = current%point
end subroutine host_uvarm_pass

!> Call SDVINI at all points of a block.
subroutine host_sdvini_pass(address, family, labels, coords, statev, left, element, point, mcrd, nnode, nstatv, points, m)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_context, only: current
  use host_kinds, only: dp, i4, i8
  use host_sdvini, only: run_sdvini, sdvini_pass_t
  implicit none (type, external)
  integer(i8), intent(in) :: address
  integer(i4), intent(in) :: family           !< of built-in elements with integration points, else 0
  integer(i4), intent(in) :: mcrd, nnode, nstatv, points, m
  integer(i4), intent(in), target :: labels(m)
  real(dp), intent(in), target :: coords(mcrd, nnode, m)
  real(dp), intent(inout), target :: statev(nstatv, points, m)
  integer(i4), intent(out) :: left            !< 1 if the routine ended the analysis
  integer(i4), intent(out) :: element, point  !< of the last call
  type(sdvini_pass_t) :: pass
  pass%address = transfer(int(address, c_intptr_t), pass%address)
  pass%family = family
  pass%labels => labels
  pass%coords => coords
  pass%statev => statev
  call run_sdvini(pass, left)
  element = current%element
  point = current%point
end subroutine host_sdvini_pass

!> Call SIGINI at all points of a block.
subroutine host_sigini_pass(address, element_type, family, labels, coords, sigma, left, element, point, mcrd, nnode, ntens, &
                            points, m)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_context, only: current
  use host_kinds, only: dp, i4, i8
  use host_sigini, only: run_sigini, sigini_pass_t
  implicit none (type, external)
  integer(i8), intent(in) :: address
  character(len=80), intent(in) :: element_type
  integer(i4), intent(in) :: family           !< of the elements
  integer(i4), intent(in) :: mcrd, nnode, ntens, points, m
  integer(i4), intent(in), target :: labels(m)
  real(dp), intent(in), target :: coords(mcrd, nnode, m)
  real(dp), intent(inout), target :: sigma(ntens, points, m)
  integer(i4), intent(out) :: left            !< 1 if the routine ended the analysis
  integer(i4), intent(out) :: element, point  !< of the last call
  type(sigini_pass_t) :: pass
  pass%address = transfer(int(address, c_intptr_t), pass%address)
  pass%element_type = element_type
  pass%family = family
  pass%labels => labels
  pass%coords => coords
  pass%sigma => sigma
  call run_sigini(pass, left)
  element = current%element
  point = current%point
end subroutine host_sigini_pass

!> Call ORIENT at all points of a block.
subroutine host_orient_pass(address, name, family, labels, nodes, coords, t, left, element, point, mcrd, nnode, points, m)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_context, only: current
  use host_kinds, only: dp, i4, i8
  use host_orient, only: orient_pass_t, run_orient
  implicit none (type, external)
  integer(i8), intent(in) :: address
  character(len=80), intent(in) :: name       !< of the orientation
  integer(i4), intent(in) :: family
  integer(i4), intent(in) :: mcrd, nnode, points, m
  integer(i4), intent(in), target :: labels(m), nodes(nnode, m)
  real(dp), intent(in), target :: coords(mcrd, nnode, m)
  real(dp), intent(inout), target :: t(3, 3, points, m)
  integer(i4), intent(out) :: left            !< 1 if the routine ended the analysis
  integer(i4), intent(out) :: element, point  !< of the last call
  type(orient_pass_t) :: pass
  pass%address = transfer(int(address, c_intptr_t), pass%address)
  pass%name = name
  pass%family = family
  pass%labels => labels
  pass%nodes => nodes
  pass%coords => coords
  pass%t => t
  call run_orient(pass, left)
  element = current%element
  point = current%point
end subroutine host_orient_pass

!> Call DISP (1), DLOAD (2), UTEMP (3) or UFIELD (4) at all places.
subroutine host_value_pass(routine, address, place, time, places, coords, temperatures, values, left, last, rows, n)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_kinds, only: dp, i4, i8
  use host_values, only: run_values, value_pass_t
  implicit none (type, external)
  integer(i4), intent(in) :: routine
  integer(i8), intent(in) :: address
  integer(i4), intent(in) :: place(2)         !< step, increment
  real(dp), intent(in) :: time(3)             !< step and total time at the end of the increment, time increment
  integer(i4), intent(in) :: rows, n
  integer(i4), intent(in), target :: places(rows, n)   !< as value_pass_t has them
  real(dp), intent(in), target :: coords(3, n), temperatures(2, n)
  real(dp), intent(inout), target :: values(n)
  integer(i4), intent(out) :: left            !< 1 if the routine ended the analysis
  integer(i4), intent(out) :: last            !< place of the last call
  type(value_pass_t) :: pass
  pass%routine = routine
  pass%address = transfer(int(address, c_intptr_t), pass%address)
  pass%kstep = place(1)
  pass%kinc = place(2)
  pass%time = time(:2)
  pass%dtime = time(3)
  pass%places => places
  pass%coords => coords
  pass%temperatures => temperatures
  pass%values => values
  call run_values(pass, left)
  last = pass%last
end subroutine host_value_pass

!> Call UAMP for an amplitude.
subroutine host_uamp_call(address, name, clock, props, svars, info, sensors, names, counts, given, value, define, left, nprop, &
                          nsvar, nsensor)
  use, intrinsic :: iso_c_binding, only: c_intptr_t
  use host_kinds, only: dp, i4, i8
  use host_uamp, only: run_uamp, uamp_call_t
  implicit none (type, external)
  integer(i8), intent(in) :: address
  character(len=80), intent(in) :: name
  real(dp), intent(in) :: clock(4)            !< step and total time at the end of the increment, its length, the old value
  integer(i4), intent(in) :: nprop, nsvar, nsensor
  real(dp), intent(in), target :: props(nprop), sensors(nsensor)
  real(dp), intent(inout), target :: svars(nsvar)
  integer(i4), intent(in) :: info(5)          !< lFlagsInfo, increment
  character(len=80), intent(in), target :: names(nsensor)
  integer(i4), intent(in) :: counts(3)        !< nProps, nSvars, nSensor: the arrays may be longer
  real(dp), intent(in) :: given               !< value on entry
  real(dp), intent(out) :: value
  integer(i4), intent(out) :: define(6)       !< lFlagsDefine
  integer(i4), intent(out) :: left            !< 1 if the routine ended the analysis
  type(uamp_call_t) :: arguments
  arguments%address = transfer(int(address, c_intptr_t), arguments%address)
  arguments%name = name
  arguments%time = clock(:2)
  arguments%dtime = clock(3)
  arguments%old = clock(4)
  arguments%info = info(:4)
  arguments%value = given
  arguments%nprops = counts(1)
  arguments%nsvars = counts(2)
  arguments%nsensor = counts(3)
  arguments%props => props
  arguments%svars => svars
  arguments%sensors => sensors
  arguments%names => names
  call run_uamp(arguments, info(5), left)
  value = arguments%value
  define = arguments%define
end subroutine host_uamp_call
