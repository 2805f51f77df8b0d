! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> From the arrays of a UEL call to the interface kernels and back.
module abaqus_interface_elements
  use core_kinds, only: dp
  use core_status, only: status_type, ok, sentence
  use materials_linear_elasticity, only: engineering_constants, plane_stiffness
  use cohesive_parameters, only: law_parameters, bilinear_law, ppr_law
  use cohesive_ppr, only: prepare_ppr
  use elements_interface_bulk, only: stabilisation_type
  use elements_interface_kernel, only: interface_shape, integrate_interface, most_points
  use elements_interface_point, only: interface_options, interface_point
  use abaqus_layout, only: elements, reals, interface_variables, &
    p_thickness, p_alphan, p_alphat, p_sigmamax, p_taumax, p_gic, p_giic, p_viscosity, p_eta, p_power, &
    p_shapen, p_shapet, p_blend, p_betan, p_betat, p_gammabot, p_friction, p_bottom_e1, p_bottom_nu12, p_top_e1, p_top_nu12, &
    j_law, j_integration, j_tangent, j_sampling, j_eight_plane, &
    v_x, v_y, v_sepn, v_sept, v_tn, v_tt, v_damage, v_dissi, v_dissii, v_sn, v_st, v_dmax, v_dissv, v_wn, v_wt, v_dissf, &
    v_maxn, v_maxt
  use abaqus_check, only: closure_of, refuse
  use abaqus_report, only: fatal
  use abaqus_neighbours, only: stress_of_neighbours
  implicit none(type, external)
  private
  public :: evaluate_interface

  !> U2 to U6: nodes of an edge, nodes of a quad of its own, and the nodes of the bottom and the top edge, left to right.
  type(interface_shape), parameter :: shapes(2:6) = [ &
    interface_shape(2, 0, [1, 2, 0], [4, 3, 0]), &
    interface_shape(2, 0, [1, 2, 0], [4, 3, 0]), &
    interface_shape(2, 4, [4, 3, 0], [5, 6, 0]), &
    interface_shape(3, 0, [1, 2, 5], [4, 3, 6]), &
    interface_shape(3, 8, [4, 3, 7], [9, 10, 13])]

contains

  !> Evaluates U2 to U6; `good` is false after a message. SVARS and ENERGY come back with their end values:
  !> ENERGY(2) is T.g/2, ENERGY(4) what damage and friction have dissipated, ENERGY(5) what the viscous overstress has.
  subroutine evaluate_interface(jtype, jelem, props, jprops, coords, u, dtime, with_tangent, svars, energy, residual, &
    tangent, good)
    integer, intent(in) :: jtype, jelem
    real(dp), intent(in) :: props(*)
    integer, intent(in) :: jprops(*)
    real(dp), intent(in) :: coords(:, :)           !< (2 or 3, nodes)
    real(dp), intent(in) :: u(:)
    real(dp), intent(in) :: dtime
    logical, intent(in) :: with_tangent            !< else it is zero
    real(dp), intent(inout) :: svars(*), energy(8)
    real(dp), intent(out) :: residual(:), tangent(:, :)
    logical, intent(out) :: good
    type(law_parameters) :: law
    type(interface_options) :: options
    type(stabilisation_type) :: stabilisation
    type(interface_point) :: old(most_points), new(most_points)
    type(status_type) :: status
    real(dp) :: energies(3), stress(3, 2), stiffness(3, 3, 2), xy(2, size(coords, 2))
    integer :: points

    call prepare_law(jtype, props, jprops, law, status)
    good = status%code == ok
    if (.not. good) then
      call refuse(jtype, jelem, status)
      return
    end if
    options = interface_options(jprops(j_integration), 0, closure_of(jtype, jprops) == 1, &
      merge(1.0_dp, props(p_blend), jprops(j_tangent) == 1))
    if (jtype /= 2 .and. jtype /= 5) then
      options%sampling = jprops(j_sampling)
      stabilisation = stabilisation_type([props(p_betat), props(p_betan)], props(p_gammabot))
    end if
    xy = coords(1:2, :)
    points = shapes(jtype)%points
    old(1:points) = points_from(svars, points)
    associate (shape => shapes(jtype), thickness => props(p_thickness))
      select case (jtype)
      case (2, 5)
        call integrate_interface(shape, law, options, thickness, xy, u, dtime, with_tangent, old, new, residual, tangent, &
          energies, status)
      case (3)
        call stress_of_neighbours(jelem, jprops, options, xy, reshape(u, [2, 4]), stabilisation, stress, good)
        if (.not. good) return
        call integrate_interface(shape, law, options, thickness, xy, u, dtime, with_tangent, old, new, residual, tangent, &
          energies, status, stabilisation, neighbours=stress)
      case default
        call elasticity_of_quads(jtype, jelem, props, jprops(j_eight_plane), stiffness, good)
        if (.not. good) return
        call integrate_interface(shape, law, options, thickness, xy, u, dtime, with_tangent, old, new, residual, tangent, &
          energies, status, stabilisation, stiffness)
      end select
    end associate
    good = status%code == ok
    if (good) then
      call write_state(new(1:points), svars)
      energy = 0.0_dp
      energy([2, 4, 5]) = energies
    else
      call refuse(jtype, jelem, status)
    end if
  end subroutine evaluate_interface

  !> The cohesive law; an initial stiffness of 0 stands for an infinite one.
  pure subroutine prepare_law(jtype, props, jprops, law, status)
    integer, intent(in) :: jtype
    real(dp), intent(in) :: props(*)
    integer, intent(in) :: jprops(*)
    type(law_parameters), intent(out) :: law
    type(status_type), intent(out) :: status

    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    law%kind = jprops(j_law)
    law%flexibility = 0.0_dp
    law%ratio = 1.0_dp
    if (props(p_alphan) > 0.0_dp) then
      law%flexibility = 1.0_dp/props(p_alphan)
      law%ratio = [props(p_alphat)/props(p_alphan), 1.0_dp]
    end if
    law%strength = [props(p_taumax), props(p_sigmamax)]
    law%toughness = [props(p_giic), props(p_gic)]
    law%viscosity = props(p_viscosity)
    if (jtype /= 2 .and. jtype /= 5) law%friction = props(p_friction)
    if (law%kind == bilinear_law) return
    if (law%kind == ppr_law) then
      if (props(p_shapet) > 0.0_dp) law%shape(1) = props(p_shapet)
      if (props(p_shapen) > 0.0_dp) law%shape(2) = props(p_shapen)
      call prepare_ppr(law, status)
      return
    end if
    law%eta = props(p_eta)
    if (props(p_power) > 0.0_dp) law%power = props(p_power)
  end subroutine prepare_law

  !> Stiffness of the bottom and the top quad of U4 and U6.
  subroutine elasticity_of_quads(jtype, jelem, props, plane, stiffness, good)
    integer, intent(in) :: jtype, jelem
    real(dp), intent(in) :: props(*)
    integer, intent(in) :: plane
    real(dp), intent(out) :: stiffness(3, 3, 2)
    logical, intent(out) :: good
    integer, parameter :: first(2) = [p_bottom_e1, p_top_e1]
    integer, parameter :: ratio(2) = [p_bottom_nu12, p_top_nu12]
    type(engineering_constants) :: material
    type(status_type) :: status
    integer :: side

    do side = 1, 2
      associate (c => props(first(side):first(side) + 7))
        material = engineering_constants(c(1), c(2), c(3), c(4), c(5), c(6), c(7), c(8))
      end associate
      call plane_stiffness(material, plane, stiffness(:, :, side), status)
      good = status%code == ok
      if (.not. good) then
        call fatal(jtype, jelem, 'PROPS(%I) ' // trim(reals(ratio(side))%name) // ' = %R and its neighbours: ' // &
          trim(sentence(status%code)) // '; %R is expected to be positive', &
          [ratio(side)], [props(ratio(side)), status%value])
        return
      end if
    end do
  end subroutine elasticity_of_quads

  !> Committed state of n points.
  pure function points_from(svars, n) result(points)
    real(dp), intent(in) :: svars(*)
    integer, intent(in) :: n
    type(interface_point) :: points(n)
    integer :: k, first

    do k = 1, n
      first = (k - 1)*size(interface_variables)
      points(k)%history%separation = [svars(first + v_wt), svars(first + v_wn)]
      points(k)%traction = [svars(first + v_tt), svars(first + v_tn)]
      points(k)%history%damage = svars(first + v_damage)
      points(k)%history%damage_max = svars(first + v_dmax)
      points(k)%history%dissipated = [svars(first + v_dissii), svars(first + v_dissi)]
      points(k)%history%viscous = svars(first + v_dissv)
      points(k)%history%rubbed = svars(first + v_dissf)
      points(k)%history%largest = [svars(first + v_maxt), svars(first + v_maxn)]
    end do
  end function points_from

  !> Writes the state of the points to SVARS.
  pure subroutine write_state(points, svars)
    type(interface_point), intent(in) :: points(:)
    real(dp), intent(inout) :: svars(*)
    integer :: k, first

    do k = 1, size(points)
      first = (k - 1)*size(interface_variables)
      svars(first + v_x) = points(k)%position(1)
      svars(first + v_y) = points(k)%position(2)
      svars(first + v_sepn) = points(k)%jump(2)
      svars(first + v_sept) = points(k)%jump(1)
      svars(first + v_tn) = points(k)%traction(2)
      svars(first + v_tt) = points(k)%traction(1)
      svars(first + v_damage) = points(k)%history%damage
      svars(first + v_dissi) = points(k)%history%dissipated(2)
      svars(first + v_dissii) = points(k)%history%dissipated(1)
      svars(first + v_sn) = points(k)%stabilisation(2)
      svars(first + v_st) = points(k)%stabilisation(1)
      svars(first + v_dmax) = points(k)%history%damage_max
      svars(first + v_dissv) = points(k)%history%viscous
      svars(first + v_dissf) = points(k)%history%rubbed
      svars(first + v_maxn) = points(k)%history%largest(2)
      svars(first + v_maxt) = points(k)%history%largest(1)
      svars(first + v_wn) = points(k)%history%separation(2)
      svars(first + v_wt) = points(k)%history%separation(1)
    end do
  end subroutine write_state

end module abaqus_interface_elements
