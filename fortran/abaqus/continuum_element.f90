! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The continuum quad U1: kinematics and integration here, stress and stiffness from MATERIAL_LIB_MECH.
module abaqus_continuum_element
  use core_kinds, only: dp
  use core_quadrature, only: quad_points
  use core_shape_functions, only: quad_shape, quad_gradient
  use core_status, only: status_type, inside_out
  use materials_linear_elasticity, only: plane_strain
  use materials_spectral_norm, only: spectral_norm
  use elements_quad4, only: quad4_nodes, quad4_unknowns, quad4_points, quad4_area, quad4_strain, quad4_add_force, &
    quad4_add_stiffness, face_point, face_nodes, gauss_of_face, face_places
  use abaqus_bulk_exchange, only: bulk_record, store_bulk
  use abaqus_check, only: report_status
  use abaqus_report, only: fatal
  use abaqus_layout, only: continuum_variables, integer_position, p_thickness, j_plane, j_face, &
    v_e11, v_e22, v_e33, v_e12, v_s11, v_s22, v_s33, v_s12
  implicit none(type, external)
  private
  public :: evaluate_continuum

  !> Marks a stress component that a plane stress material must not write and a plane strain material must.
  real(dp), parameter :: untouched = -huge(1.0_dp)

  !> Data of the four Gauss points once the stress is known.
  type :: gauss_state
    real(dp) :: gradient(2, quad4_nodes, quad4_points), strain(3, quad4_points), stress(3, quad4_points)
    real(dp) :: stiffness(3, 3, quad4_points), volume(quad4_points)
  end type gauss_state

contains

  !> Evaluates U1; `good` is false after a message.
  !>
  !> ENERGY(2) grows by the work of the stress, by the trapezoidal rule: the strain energy of an elastic material; for an inelastic
  !> one it includes the work of the inelastic strain, since the material does not separate the two.
  subroutine evaluate_continuum(jelem, values, options, coordinates, u, predef, npredf, materiallib, with_tangent, &
    svars, energy, residual, tangent, good)
    integer, intent(in) :: jelem
    real(dp), intent(in) :: values(:)              !< properties by their rows in the layout
    integer, intent(in) :: options(:)
    real(dp), intent(in) :: coordinates(2, quad4_nodes), u(quad4_unknowns)
    integer, intent(in) :: npredf
    real(dp), intent(in) :: predef(2, npredf, quad4_nodes)   !< end value and increment at the nodes
    integer, intent(in) :: materiallib(*)          !< handle of the host, passed through
    logical, intent(in) :: with_tangent
    real(dp), intent(inout) :: svars(:), energy(8)
    real(dp), intent(out) :: residual(quad4_unknowns)
    real(dp), intent(out) :: tangent(quad4_unknowns, quad4_unknowns)   !< zero without
    logical, intent(out) :: good
    type(gauss_state) :: state
    type(status_type) :: status
    real(dp) :: jacobian, work, area, length, shape(quad4_nodes), field(npredf), field_change(npredf)
    integer :: i, k, first

    residual = 0.0_dp
    tangent = 0.0_dp
    work = 0.0_dp
    area = quad4_area(coordinates)
    length = sqrt(max(area, 0.0_dp))
    good = .true.
    do k = 1, quad4_points
      call quad_gradient(coordinates, quad_points(:, k), state%gradient(:, :, k), jacobian)
      if (.not. jacobian > 0.0_dp) then
        good = .false.
        status = status_type(inside_out, k, jacobian, 0.0_dp)
        call report_status(1, jelem, status)
        return
      end if
      first = (k - 1)*size(continuum_variables)
      state%volume(k) = jacobian*values(p_thickness)
      state%strain(:, k) = quad4_strain(state%gradient(:, :, k), u)
      shape = quad_shape(quad_points(:, k))
      do i = 1, npredf
        field_change(i) = dot_product(shape, predef(2, i, :))
        field(i) = dot_product(shape, predef(1, i, :)) - field_change(i)
      end do
      call call_material(jelem, k, options(j_plane), matmul(coordinates, shape), length, state%volume(k), field, &
        field_change, materiallib, state%strain(:, k), svars(first + 1:first + size(continuum_variables)), state%stress(:, k), &
        state%stiffness(:, :, k), work, good)
      if (.not. good) return
      call quad4_add_force(state%gradient(:, :, k), state%volume(k), state%stress(:, k), residual)
      if (with_tangent) then
        call quad4_add_stiffness(state%gradient(:, :, k), state%volume(k), state%stiffness(:, :, k), tangent)
      end if
    end do
    energy(2) = energy(2) + work
    if (options(j_face) /= 0) call store_for_neighbours(jelem, options(j_face), coordinates, u, area, values(p_thickness), state)
  end subroutine evaluate_continuum

  !> Stress and stiffness of Gauss point k from the host; its strains and stresses in SVARS go from start to end values.
  subroutine call_material(jelem, k, plane, place, length, volume, field, field_change, materiallib, strain, variables, &
    stress, stiffness, work, good)
    integer, intent(in) :: jelem, k, plane
    real(dp), intent(in) :: place(2)               !< of the point
    real(dp), intent(in) :: length                 !< characteristic element length
    real(dp), intent(in) :: volume
    real(dp), intent(in) :: field(:)               !< predefined fields at the start of the increment
    real(dp), intent(in) :: field_change(:)
    integer, intent(in) :: materiallib(*)
    real(dp), intent(in) :: strain(3)              !< at the end of the increment
    real(dp), intent(inout) :: variables(size(continuum_variables))
    real(dp), intent(out) :: stress(3), stiffness(3, 3)
    real(dp), intent(inout) :: work                !< the work of the stress is added
    logical, intent(out) :: good
    real(dp), parameter :: identity(3, 3) = reshape([1.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 1.0_dp, 0.0_dp, &
      0.0_dp, 0.0_dp, 1.0_dp], [3, 3])
    ! components among those of the material: 11, 22, 12 in plane stress, 11, 22, 33, 12 in plane strain
    integer, parameter :: in_plane(3, 0:1) = reshape([1, 2, 3, 1, 2, 4], [3, 2])
    ! room for what a host may write if TENSOR does not match PLANE
    real(dp) :: start(6), change(6), found(6), matrix(36), old_stress(3)
    integer :: i, j, n, at(3)
    external :: material_lib_mech

    n = 3 + plane
    at = in_plane(:, plane)
    start = 0.0_dp
    change = 0.0_dp
    start(at) = variables([v_e11, v_e22, v_e12])
    change(at) = strain - start(at)
    found = 0.0_dp
    found(4) = untouched
    matrix = 0.0_dp
    call material_lib_mech(materiallib, found, matrix, start, change, k, 1.0_dp, volume, identity, field, &
      field_change, size(field), length, [place, 0.0_dp])
    good = (abs(found(4) - untouched) > 0.0_dp) .eqv. (plane == plane_strain)
    if (.not. good) then
      call fatal(1, jelem, 'JPROPS(%I) PLANE = %I, but the material has a different number of stress components: ' // &
        'use TENSOR=PSTRESS with PLANE = 0 and TENSOR=PSTRAIN with PLANE = 1', &
        [integer_position(1, j_plane), plane], [real(dp) ::])
      return
    end if

    do j = 1, 3
      do i = 1, 3
        stiffness(i, j) = matrix(at(i) + n*(at(j) - 1))
      end do
    end do
    stress = found(at)
    old_stress = variables([v_s11, v_s22, v_s12])
    work = work + 0.5_dp*volume*dot_product(old_stress + stress, change(at))
    variables([v_e11, v_e22, v_e12]) = strain
    variables([v_s11, v_s22, v_s12]) = stress
    variables(v_e33) = 0.0_dp
    variables(v_s33) = merge(found(3), 0.0_dp, plane == plane_strain)
  end subroutine call_material

  !> Stores stress, shape function derivatives and areas for the adjacent interface elements. The stress at a place on
  !> the face is that of the Gauss point next to it, carried there by the stiffness: exact in linear elasticity, without
  !> another call of the material. In the middle it is the mean of both.
  subroutine store_for_neighbours(jelem, face, coordinates, u, area, thickness, state)
    integer, intent(in) :: jelem, face
    real(dp), intent(in) :: coordinates(2, quad4_nodes), u(quad4_unknowns), area, thickness
    type(gauss_state), intent(in) :: state
    type(bulk_record) :: record
    real(dp) :: strain(3), jacobian, along(2), carried(3, 2)
    integer :: i, side, k

    record%face = face
    record%coordinates = coordinates
    record%displacement(1, :) = u(1::2)
    record%displacement(2, :) = u(2::2)
    record%area = area
    record%gauss_stress = state%stress
    record%gauss_gradient = state%gradient
    record%gauss_area = state%volume/thickness
    along = coordinates(:, face_nodes(2, face)) - coordinates(:, face_nodes(1, face))
    record%face_length = hypot(along(1), along(2))
    record%norm = 0.0_dp
    do side = 1, 2
      record%norm = record%norm + 0.5_dp*spectral_norm(state%stiffness(:, :, gauss_of_face(side, face)))
    end do
    do i = 1, size(face_places)
      call quad_gradient(coordinates, face_point(face, face_places(i)), record%face_gradient(:, :, i), jacobian)
      strain = quad4_strain(record%face_gradient(:, :, i), u)
      do side = 1, 2
        k = gauss_of_face(side, face)
        carried(:, side) = state%stress(:, k) + matmul(state%stiffness(:, :, k), strain - state%strain(:, k))
      end do
      if (face_places(i) < 0.0_dp) then
        record%face_stress(:, i) = carried(:, 1)
      else if (face_places(i) > 0.0_dp) then
        record%face_stress(:, i) = carried(:, 2)
      else
        record%face_stress(:, i) = 0.5_dp*(carried(:, 1) + carried(:, 2))
      end if
    end do
    call store_bulk(jelem, record)
  end subroutine store_for_neighbours

end module abaqus_continuum_element
