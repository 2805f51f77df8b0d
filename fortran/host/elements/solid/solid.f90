! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in continuum elements (CPS, CPE, CAX, C3D) as a procedure with the arguments of UELMAT. harness/uel/model/element_types.py
!> lists the types.
!>
!> An element is composed of kinematics (host_solid_kinematics), the update of its points (host_solid_point) and additions
!> (host_solid_extras), in the loop of host_solid_integration.
!>
!> JPROPS: family of the element (host_shape), integration points, direct strains (host_kinematics), enhanced hourglass
!> control, integration points of the mass. CPE4, CAX4 and C3D8 replace the volume strain of the points by its mean over the
!> element, as Abaqus does. CPS4R, CPE4R, CAX4R and C3D8R have the uniform strain and hourglass control (host_hourglass):
!> enhanced where JPROPS(4) is not zero, else with the stiffness parameter PROPS(3). JPROPS(4) is 1 if the material knows its
!> moduli, 2 if they are those of its first tangent. JPROPS(6) is the number of incompatible modes (host_incompatible), JPROPS(7)
!> that of the functions of the pressure of hybrid elements (host_hybrid): if the element has more unknowns than its nodes have
!> displacements, the others are its pressure. PROPS(1) is the thickness, of axisymmetric elements the angle 2 pi; PROPS(2) is
!> the density.
!>
!> Large displacements: Cauchy stress, rotated and updated increment by increment with the strain and the rotation at the middle of
!> the increment (Jaumann rate; Hughes and Winget). The tangent leaves out the change of the volume and of the middle of the
!> increment. Incompatible modes are part of the deformation gradient (host_incompatible).
!>
!> Generalised plane strain (host_planes): the planes come with the call, three unknowns of theirs behind those of the nodes.
!>
!> Hyperelastic materials take their stress from the deformation gradient, divided by the stretch of *EXPANSION, the same in all
!> directions (Analysis User's Guide, Hyperelastic behavior of rubberlike materials). Forces are derivatives of the energy, the
!> tangent those of the forces (host_mean_volume); where the volume strain is the mean, the points share the change of the volume.
!>
!> The matrix of a stress (host_context) is what the tangent in large displacements has of it, also where displacements are small.
!>
!> With layers JPROPS(1) is a family with the points of all layers (host_shape), and material, NPT, LAYER and KSPT of each point
!> follow; MATERIALLIB is the material of the first layer. Then all materials are in the directions of the points.
!>
!> The last of the predefined fields is the initial temperature; thermal strain is that of *EXPANSION since then.
!>
!> SVARS hold, for each point, E11 E22 E33 E12 S11 S22 S33 S12, in space with 13 and 23 after 12, in the directions of
!> *ORIENTATION where the section has one, as Abaqus prints them; in dynamic analyses then the forces of the last two
!> increments; then the directions of each point, if the material is in them (host_axes); last the incompatible modes, or the
!> moduli of the first tangent.
module host_solid
  use, intrinsic :: iso_c_binding, only: c_f_pointer, c_loc
  use host_axes, only: values_of_axes
  use host_condensed_modes, only: integrate_with_modes
  use host_context, only: stress_matrix
  use host_coupling, only: coupling_t
  use host_enhanced_kinematics, only: enhanced_t
  use host_hybrid, only: pressure_t
  use host_inertia, only: is_dynamic, mass_matrix, respond
  use host_kinds, only: dp, i4
  use host_kinematics, only: components
  use host_materials, only: find_material, needs_deformation
  use host_mean_dilatation, only: mean_dilatation_t
  use host_planes, only: between_planes_t, planes, planes_t
  use host_shape, only: is_multilinear, rule_of
  use host_solid_element, only: begins, solid_t, values_of_point
  use host_solid_extras, only: extras_t
  use host_solid_integration, only: integrate
  use host_solid_kinematics, only: kinematics_t
  use host_standard_kinematics, only: standard_t
  use host_uniform_kinematics, only: uniform_t
  implicit none (type, external)
  private
  public :: solid_uelmat, solid_element

  integer, parameter :: head = 7    !< values of JPROPS before those of layers

  ! kinematics of the elements of this thread, one after the other
  type(standard_t), target, save :: standard
  type(mean_dilatation_t), target, save :: mean_dilatation
  type(uniform_t), target, save :: uniform
  type(between_planes_t), target, save :: between
  type(enhanced_t), target, save :: enhanced
  !$omp threadprivate(standard, mean_dilatation, uniform, between, enhanced)

contains

  subroutine solid_uelmat(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                          v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                          lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period, materiallib)
    integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                   lflags(*), mlvarx, mdload, jprops(*), njprop, materiallib
    real(dp) :: rhs(*), amatrx(*), svars(*), energy(*), props(*), coords(*), u(*), du(*), v(*), a(*), time(*), dtime, &
                params(*), adlmag(*), predef(*), ddlmag(*), pnewdt, period
    if (njprop > head) then
      call solid_element(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, coords, mcrd, nnode, u, du, v, a, params, dtime, &
                         predef, npredf, lflags, jprops, materiallib, layers=reshape(jprops(head + 1:njprop), [4, int(jprops(2))]))
    else
      call solid_element(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, coords, mcrd, nnode, u, du, v, a, params, dtime, &
                         predef, npredf, lflags, jprops, materiallib)
    end if
  end subroutine solid_uelmat

  !> The same without the unused arguments; coupling: if the element also has temperatures; layers: material, NPT, LAYER and KSPT
  !> of each point, if there are any; bounds: if the element is between two planes.
  subroutine solid_element(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, coords, mcrd, nnode, u, du, v, a, params, &
                           dtime, predef, npredf, lflags, jprops, materiallib, coupling, layers, bounds)
    integer(i4) :: ndofel, nrhs, nsvars, mcrd, nnode, npredf, lflags(*), jprops(*), materiallib
    real(dp) :: rhs(*), amatrx(*), energy(*), props(*), v(*), a(*), params(*), dtime
    real(dp), target :: svars(*), coords(*), u(*), du(*), predef(*)
    type(coupling_t), intent(inout), optional, target :: coupling
    integer(i4), intent(in), optional, target, contiguous :: layers(:, :)
    type(planes_t), intent(in), optional :: bounds
    type(solid_t) :: element
    type(extras_t) :: extras
    class(kinematics_t), pointer :: kinematics
    real(dp), target :: change(ndofel)
    real(dp) :: mass(ndofel, ndofel), old(ndofel, 2), at_nodes(mcrd*nnode, mcrd*nnode)
    integer :: first, last, modes, n, behind
    modes = jprops(6)
    n = ndofel
    call describe(element, jprops, lflags, props(1), materiallib)
    ! no time passes where the matrix of a stress is asked for: DU is a perturbation
    change = du(:n)
    if (stress_matrix(lflags(3))) change = 0
    call set_motion(element, coords, u, change, int(npredf), predef)
    element%added => du(:n)
    element%hybrid = n > element%n .and. .not. (present(coupling) .or. present(bounds))
    if (present(layers)) element%layers => layers
    first = element%rule%points*values_of_point(element%dim) + 1
    last = first + 2*n - 1
    element%state(1:values_of_point(element%dim), 1:element%rule%points) => svars(1:first - 1)
    behind = nsvars - modes + 1
    if (jprops(4) == 2) then
      behind = behind - 2
      call c_f_pointer(c_loc(svars(behind)), extras%hourglass%moduli, [2])
    end if
    if (element%material%local) then
      behind = behind - values_of_axes*element%rule%points
      call c_f_pointer(c_loc(svars(behind)), element%axes, [3, 3, 2, element%rule%points])
    end if
    old = 0
    if (behind > last) old = reshape(svars(first:last), [n, 2])
    if (any(lflags(3) == [4, 6]) .or. is_dynamic(lflags(1))) then
      call mass_matrix(rule_of(int(jprops(1)), int(jprops(5))), jprops(3) > element%dim, props(2)*element%depth, coords, &
                       at_nodes)
      mass = 0
      mass(:element%n, :element%n) = at_nodes
    end if
    rhs(1:n*nrhs) = 0
    amatrx(1:n*n) = 0
    if (lflags(3) /= 3 .and. lflags(3) /= 4) then
      extras%hourglass%parameter = props(3)
      extras%hourglass%enhanced = jprops(4) /= 0
      if (present(coupling)) extras%coupling => coupling
      call set_pressure(element, int(jprops(7)))
      if (present(bounds)) call set_planes(element, bounds, u(element%n + 1:n), change(element%n + 1:))
      kinematics => kinematics_of(element, present(bounds))
      if (modes > 0) then
        call integrate_with_modes(element, enhanced, svars(nsvars - modes + 1:nsvars), rhs, amatrx, energy)
      else if (element%hybrid) then
        call integrate_with_pressure(element, kinematics, extras, n, u, du, rhs, amatrx, energy)
      else
        call integrate(element, kinematics, extras, rhs, amatrx, energy)
      end if
    end if
    call respond(n, lflags, params, dtime, v, a, mass, old, rhs, amatrx, energy(1))
    if (behind > last) svars(first:last) = reshape(old, [2*n])
  end subroutine solid_element

  !> What an element is, and what is asked of it.
  subroutine describe(this, jprops, lflags, thickness, materiallib)
    type(solid_t), intent(inout) :: this
    integer(i4), intent(in) :: jprops(*), lflags(3), materiallib
    real(dp), intent(in) :: thickness
    this%rule => rule_of(int(jprops(1)), int(jprops(2)))
    this%material => find_material(materiallib)
    this%dim = this%rule%dim
    this%nodes = this%rule%nodes
    this%n = this%dim*this%nodes
    this%direct = jprops(3)
    this%flat = this%direct
    call set_strains(this, this%direct + 2*this%dim - 3)
    this%depth = merge(thickness, 1.0_dp, this%dim == 2)
    this%finite = lflags(2) /= 0
    this%request = lflags(3)
  end subroutine describe

  !> Its strains among the components of SVARS and of the material.
  pure subroutine set_strains(this, strains)
    type(solid_t), intent(inout) :: this
    integer, intent(in) :: strains
    this%strains = strains
    this%of_state(:strains) = components(strains, 2*this%dim)
    this%of_material(:strains) = components(strains, this%material%ntens)
  end subroutine set_strains

  !> Its motion and its predefined fields.
  subroutine set_motion(this, x, u, du, fields, predef)
    type(solid_t), intent(inout) :: this
    real(dp), intent(in), target :: x(*), u(*), du(*), predef(*)
    integer, intent(in) :: fields
    this%x(1:this%dim, 1:this%nodes) => x(1:this%n)
    this%u(1:this%dim, 1:this%nodes) => u(1:this%n)
    this%du(1:this%dim, 1:this%nodes) => du(1:this%n)
    this%fields = fields
    this%predef(1:2, 1:fields, 1:this%nodes) => predef(1:2*fields*this%nodes)
  end subroutine set_motion

  !> Whether the mean stress is projected on so many functions of the pressure, and what depends on that.
  subroutine set_pressure(this, functions)
    type(solid_t), intent(inout) :: this
    integer, intent(in) :: functions
    this%functions = merge(0, functions, this%hybrid)
    this%smoothed = this%functions > 0 .and. this%rule%points > 1 .and. .not. begins(this)
    this%deforms = needs_deformation(this%material) .or. this%material%local .or. this%smoothed .or. this%hybrid
  end subroutine set_pressure

  !> Put the element between two planes, with the unknowns of their reference node at the end of the increment and their changes.
  subroutine set_planes(this, bounds, w, dw)
    type(solid_t), intent(inout) :: this
    type(planes_t), intent(in) :: bounds
    real(dp), intent(in) :: w(planes), dw(planes)
    this%direct = 3
    this%flat = 2
    call set_strains(this, 4)
    between%bounds = bounds
    between%bounds%w = w
    between%bounds%dw = dw
    between%others = planes
  end subroutine set_planes

  !> Kinematics of an element without incompatible modes.
  function kinematics_of(element, between_planes) result(kinematics)
    type(solid_t), intent(in) :: element
    logical, intent(in) :: between_planes
    class(kinematics_t), pointer :: kinematics
    logical :: averaged
    ! full integration of elements with straight edges locks if the volume is preserved, but not in plane stress
    averaged = element%rule%points > 1 .and. is_multilinear(element%rule) .and. element%material%ntens /= 3
    averaged = averaged .and. .not. (element%hybrid .or. element%rule%reduced .or. element%functions > 0)
    if (between_planes) then
      between%averaged = averaged
      kinematics => between
    else if (element%rule%reduced) then
      kinematics => uniform
    else if (averaged) then
      kinematics => mean_dilatation
    else
      kinematics => standard
    end if
  end function kinematics_of

  !> As integrate, with a pressure (host_hybrid), whose unknowns come after those of the nodes.
  subroutine integrate_with_pressure(this, kinematics, extras, n, u, added, force, stiffness, energy)
    type(solid_t), intent(inout) :: this
    class(kinematics_t), intent(inout) :: kinematics
    type(extras_t), intent(inout) :: extras
    integer, intent(in) :: n                     !< all unknowns
    real(dp), intent(in) :: u(n), added(n)       !< added: the perturbation
    real(dp), intent(inout) :: force(n), stiffness(n, n), energy(8)
    real(dp) :: by_nodes(this%n, this%n)
    type(pressure_t), target :: pressure
    integer :: m
    m = this%n
    by_nodes = 0
    pressure%factors = u(m + 1:)
    pressure%added = added(m + 1:)
    extras%pressure => pressure
    call integrate(this, kinematics, extras, force(:m), by_nodes, energy)
    force(m + 1:) = pressure%residual
    stiffness(:m, :m) = by_nodes
    if (stress_matrix(this%request)) return
    stiffness(:m, m + 1:) = pressure%by_displacements
    stiffness(m + 1:, :m) = transpose(pressure%by_displacements)
    stiffness(m + 1:, m + 1:) = pressure%by_factors
  end subroutine integrate_with_pressure
end module host_solid
