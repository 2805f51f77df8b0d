! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The continuum elements, quad U1 and brick U9: kinematics and integration here, stress and stiffness from MATERIAL_LIB_MECH.
!>
!> The brick has its strains and stresses along the axes of its ply: axis 3 normal to the surface half-way between its faces 1 and
!> 2, axis 1 at ANGLE from s, the projection of DIRECTION1 to 3 or of the global x axis on that surface (the directions of U8).
!>
!> Incompatible modes are found anew in each call, from zero: what MATERIAL_LIB_MECH makes of a strain does not depend on how the
!> strain came about within an increment, so the modes follow from the displacements alone, and SVARS need not hold them. A linear
!> material takes two passes.
module abaqus_continuum_element
  use core_kinds, only: dp
  use core_incompatible_mode_search, only: mode_search, find_modes, most_passes
  use core_rotation, only: ply_axes, strain_rotation
  use core_solid_rotation, only: solid_turn, find_turn, turn_forces, turn_stiffness
  use core_status, only: status_type, ok, inside_out
  use core_incompatible_modes, only: condense
  use core_small_matrix, only: add_combination, add_product
  use materials_linear_elasticity, only: plane_strain
  use materials_spectral_norm, only: spectral_norm
  use elements_continuum_solid, only: modes_of, solid_gradient, solid_points, solid_shape, solid_strains
  use elements_interface_faces, only: central_frame
  use elements_solid_faces, only: face_nodes, face_places, gauss_of_face, middle_place, serves
  use abaqus_bulk_exchange, only: bulk_record, store_bulk
  use abaqus_check, only: report_status
  use abaqus_report, only: fatal, warn
  use abaqus_layout, only: elements, continuum_variables, brick_variables, p_thickness, p_angle, &
    p_direction1, p_direction2, p_direction3, &
    j_plane, j_face, j_formulation, j_brick_face, v_e11, v_e22, v_e33, v_e12, v_s11, v_s22, v_s33, v_s12, &
    b_e11, b_e22, b_e33, b_e12, b_e13, b_e23, b_s11, b_s22, b_s33, b_s12, b_s13, b_s23
  use abaqus_properties, only: integer_position
  implicit none(type, external)
  private
  public :: evaluate_continuum, continuum_forces_at

  !> Marks a stress component that a material must write, or must not.
  real(dp), parameter :: untouched = -huge(1.0_dp)

  !> PNEWDT where the increment is too large, Abaqus' own factor.
  real(dp), parameter :: smaller = 0.25_dp

  integer, parameter :: directions(3) = [p_direction1, p_direction2, p_direction3]

  !> Positions of the variables of a point, in the order of the strains.
  type :: point_positions
    integer :: count, strain(6), stress(6)
  end type point_positions

  type(point_positions), parameter :: positions(2:3) = [ &
    point_positions(continuum_variables, [v_e11, v_e22, v_e12, 0, 0, 0], [v_s11, v_s22, v_s12, 0, 0, 0]), &
    point_positions(brick_variables, [b_e11, b_e22, b_e33, b_e12, b_e13, b_e23], &
      [b_s11, b_s22, b_s33, b_s12, b_s13, b_s23])]

  !> What is the same in all points and passes of a call.
  type :: element_call
    integer :: itype, jelem
    integer :: dim, nodes, strains   !< as many Gauss points as nodes
    integer :: components            !< of the stress of the material
    integer :: of_material(6)        !< the strains among them
    integer :: formulation, face
    logical :: finite                !< large rotations
    logical :: with_tangent
    integer :: npredf                !< predefined fields
  end type element_call

contains

  !> Evaluates an element; `good` is false after a message.
  !>
  !> ENERGY(2) grows by the work of the stress, by the trapezoidal rule: the strain energy of an elastic material; for an inelastic
  !> one it includes the work of the inelastic strain, since the material does not separate the two.
  subroutine evaluate_continuum(itype, jelem, values, options, coords, u, predef, npredf, materiallib, finite, with_tangent, &
    svars, energy, pnewdt, residual, tangent, good)
    integer, intent(in) :: itype, jelem
    real(dp), intent(in) :: values(:)              !< properties by their rows in the layout
    integer, intent(in) :: options(:)
    real(dp), intent(in) :: coords(:, :), u(:)     !< coords: original ones, (2 or 3, nodes)
    integer, intent(in) :: npredf
    real(dp), intent(in) :: predef(:, :, :)        !< (2, npredf, nodes) end value and increment at the nodes
    integer, intent(in) :: materiallib(*)          !< handle of the host, passed through
    logical, intent(in) :: finite, with_tangent
    real(dp), intent(inout) :: svars(:), energy(8), pnewdt
    real(dp), intent(out) :: residual(:)
    real(dp), contiguous, intent(inout) :: tangent(:, :)   !< zero on entry, and without
    logical, intent(out) :: good
    type(element_call) :: this
    integer :: modes, places

    residual = 0.0_dp
    associate (dim => elements(itype)%dimension, plane => options(j_plane))
      this = element_call(itype, jelem, dim, elements(itype)%nodes, 3*(dim - 1), merge(3 + plane, 6, dim == 2), &
        [1, 2, merge(4, 3, dim == 2 .and. plane == plane_strain), 4, 5, 6], options(j_formulation), &
        merge(options(j_face), options(j_brick_face), dim == 2), finite, with_tangent, npredf)
      modes = modes_of(dim, plane, this%formulation)
      ! those of the face follow the Gauss points
      places = this%nodes
      if (this%face /= 0) places = places + middle_place(dim)
      ! a compiler makes more of loops whose length it knows
      if (dim == 2) then
        call integrate(this, 2, 4, 3, 8, 8 + modes, places, values(p_thickness), 0.0_dp, values(directions), coords(1:2, :), u, &
          predef, materiallib, svars, energy, pnewdt, residual, tangent, good)
      else
        call integrate(this, 3, 8, 6, 24, 24 + modes, places, 1.0_dp, values(p_angle), values(directions), coords, u, predef, &
          materiallib, svars, energy, pnewdt, residual, tangent, good)
      end if
    end associate
  end subroutine evaluate_continuum

  !> RHS of the stresses in SVARS, at the displacements to which they belong: of the start of an increment, where incompatible modes
  !> are in equilibrium; `good` is false after a message.
  subroutine continuum_forces_at(itype, jelem, values, options, coords, u, finite, svars, residual, good)
    integer, intent(in) :: itype, jelem
    real(dp), intent(in) :: values(:)              !< properties by their rows in the layout
    integer, intent(in) :: options(:)
    real(dp), intent(in) :: coords(:, :), u(:)     !< coords: original ones, (2 or 3, nodes)
    logical, intent(in) :: finite
    real(dp), intent(in) :: svars(:)
    real(dp), intent(out) :: residual(:)
    logical, intent(out) :: good

    associate (dim => elements(itype)%dimension)
      call sum_stresses(itype, jelem, dim, elements(itype)%nodes, 3*(dim - 1), &
        size(u) + modes_of(dim, options(j_plane), options(j_formulation)), options(j_formulation), finite, &
        merge(values(p_thickness), 1.0_dp, dim == 2), values(p_angle), values(directions), coords(1:dim, :), u, svars, residual, &
        good)
    end associate
  end subroutine continuum_forces_at

  !> The same with its sizes.
  subroutine sum_stresses(itype, jelem, dim, nodes, strains, n, formulation, finite, thickness, angle, direction, coordinates, &
    u, svars, residual, good)
    integer, intent(in) :: itype, jelem, dim, nodes, strains
    integer, intent(in) :: n                       !< unknowns, with those of the modes
    integer, intent(in) :: formulation
    logical, intent(in) :: finite
    real(dp), intent(in) :: thickness, angle, direction(3), coordinates(dim, nodes), u(dim*nodes), svars(:)
    real(dp), intent(out) :: residual(dim*nodes)
    logical, intent(out) :: good
    real(dp) :: b(n, strains, nodes), volume(nodes), to_ply(strains, strains), stress(strains), force(n), moved(dim*nodes)
    real(dp), parameter :: middle(3) = 0.0_dp      ! parent coordinates
    real(dp) :: gradient(dim, nodes)
    type(solid_turn) :: turn
    type(status_type) :: status
    integer :: k

    residual = 0.0_dp
    call solid_strains(dim, n, strains, formulation, coordinates, solid_points(dim), b, volume, status)
    good = status%code == ok
    if (.not. good) then
      call report_status(itype, jelem, status)
      return
    end if
    call find_ply_strains(strains, angle, direction, coordinates, to_ply, status)
    good = status%code == ok
    if (.not. good) then
      call report_status(itype, jelem, status)
      return
    end if
    force = 0.0_dp
    do k = 1, nodes
      stress = svars((k - 1)*positions(dim)%count + positions(dim)%stress(:strains))
      force = force + (thickness*volume(k))*matmul(b(:, :, k), matmul(stress, to_ply))
    end do
    residual = -force(:dim*nodes)
    if (.not. finite) return
    call solid_gradient(dim, nodes, coordinates, middle(:dim), gradient, status)
    call find_turn(dim, nodes, gradient, reshape(coordinates, [dim*nodes]), u, turn, moved, good)
    if (good) then
      residual = turn_forces(dim, nodes, turn, residual)
    else
      call report_status(itype, jelem, status_type(inside_out, 0, 0.0_dp, 0.0_dp))
    end if
  end subroutine sum_stresses

  !> The same with its sizes.
  subroutine integrate(this, dim, nodes, strains, m, n, places, thickness, angle, direction, coordinates, u, predef, materiallib, &
    svars, energy, pnewdt, residual, tangent, good)
    type(element_call), intent(in) :: this
    integer, value :: dim, nodes, strains
    integer, value :: m, n                       !< unknowns of the nodes, and with the modes
    integer, intent(in) :: places                !< Gauss points, then places on the face
    real(dp), intent(in) :: thickness
    real(dp), intent(in) :: angle, direction(3)  !< of the ply from s, degrees, and of s; zero: that of x
    real(dp), intent(in) :: coordinates(dim, nodes), u(m), predef(:, :, :)
    integer, intent(in) :: materiallib(*)
    real(dp), intent(inout) :: svars(:), energy(8), pnewdt
    real(dp), intent(inout) :: residual(m), tangent(m, m)
    logical, intent(out) :: good
    real(dp) :: parents(dim, places), b(n, strains, places), volume(places), to_ply(strains, strains), unknowns(n)
    real(dp) :: strain(strains, nodes), stress(strains, nodes), modulus(strains, strains, nodes)
    real(dp) :: force(n), matrix(n, n), inverse(n - m, n - m), nodal(m), stiffness(m, m), stresses(n, strains, nodes)
    real(dp) :: along_ply(n, strains)
    real(dp), parameter :: middle(3) = 0.0_dp    ! parent coordinates
    real(dp) :: gradient(dim, nodes)
    type(solid_turn) :: turn
    type(status_type) :: status
    integer :: k

    parents(:, :nodes) = solid_points(dim)
    if (this%face /= 0) parents(:, nodes + 1:) = face_places(dim, this%face)
    call solid_strains(dim, n, strains, this%formulation, coordinates, parents, b, volume, status)
    good = status%code == ok
    if (.not. good) then
      call report_status(this%itype, this%jelem, status)
      return
    end if
    call find_ply_strains(strains, angle, direction, coordinates, to_ply, status)
    good = status%code == ok
    if (.not. good) then
      call report_status(this%itype, this%jelem, status)
      return
    end if
    do k = 1, merge(places, 0, dim == 3)
      along_ply = 0.0_dp
      call add_product(n, strains, strains, b(:, :, k), to_ply, along_ply)
      b(:, :, k) = along_ply
    end do
    unknowns = 0.0_dp
    unknowns(:m) = u
    if (this%finite) then
      call solid_gradient(dim, nodes, coordinates, middle(:dim), gradient, status)
      call find_turn(dim, nodes, gradient, coordinates, u, turn, unknowns(:m), good)
      if (.not. good) then
        call reduce_increment(this, 'its displacements turn its middle inside out', pnewdt)
        return
      end if
    end if

    call find_stress(this, dim, nodes, strains, m, n, thickness, coordinates, u, parents(:, :nodes), predef, materiallib, &
      b(:, :, :nodes), volume(:nodes), unknowns, svars, energy(2), pnewdt, strain, stress, modulus, force, matrix, inverse, good)
    if (.not. good) return
    nodal = force(:m)
    if (this%with_tangent) then
      do k = 1, nodes
        stresses(:, :, k) = stress_matrix(n, strains, thickness*volume(k), b(:, :, k), modulus(:, :, k))
      end do
      call add_product(n, m, strains*nodes, b, stresses(:m, :, :), matrix)
    end if
    if (n > m) then
      call condense(m, inverse, force, matrix, nodal, stiffness)
    else
      stiffness = matrix
    end if
    if (this%finite) then
      residual = -turn_forces(dim, nodes, turn, nodal)
      if (this%with_tangent) tangent = turn_stiffness(dim, nodes, turn, nodal, stiffness)
    else
      residual = -nodal
      if (this%with_tangent) tangent = stiffness
    end if
    if (this%face == 0) return
    call store_for_neighbours(this, dim, nodes, strains, n, places - nodes, coordinates, u, unknowns, sum(volume(:nodes)), turn, &
      to_ply, b(:, :, nodes + 1:), strain, stress, modulus)
  end subroutine integrate

  !> Strains, stresses and stiffnesses of the Gauss points, with the modes that leave no force on them; SVARS at the end of the
  !> increment.
  subroutine find_stress(this, dim, nodes, strains, m, n, thickness, coordinates, u, parents, predef, materiallib, b, volume, &
    unknowns, svars, energy, pnewdt, strain, stress, modulus, force, matrix, inverse, good)
    type(element_call), intent(in) :: this
    integer, value :: dim, nodes, strains, m, n
    real(dp), intent(in) :: thickness, coordinates(dim, nodes), u(dim, nodes), parents(dim, nodes), predef(:, :, :)
    integer, intent(in) :: materiallib(*)
    real(dp), intent(in) :: b(n, strains, nodes), volume(nodes)
    real(dp), intent(inout) :: unknowns(n)        !< modes zero on entry
    real(dp), intent(inout) :: svars(:), energy   !< the work of the stress is added
    real(dp), intent(inout) :: pnewdt
    real(dp), intent(out) :: strain(strains, nodes), stress(strains, nodes), modulus(strains, strains, nodes)
    real(dp), intent(out) :: force(n), matrix(n, n)        !< columns of the modes alone
    real(dp), intent(out) :: inverse(n - m, n - m)         !< of the stiffness of the modes
    logical, intent(out) :: good
    real(dp) :: state(size(svars)), work, stored
    type(mode_search) :: search
    integer :: pass
    logical :: settled

    do pass = 1, most_passes
      call update_points()
      if (.not. good) return
      settled = n == m
      if (settled) exit
      call find_modes(search, force(m + 1:), matrix(m + 1:, m + 1:), stored, unknowns(m + 1:), inverse, settled, good)
      if (settled .or. .not. good) exit
    end do
    good = good .and. settled
    if (.not. good) then
      call reduce_increment(this, 'its incompatible modes are not in equilibrium', pnewdt)
      return
    end if
    svars = state
    energy = energy + work

  contains

    !> What the unknowns make of the points.
    subroutine update_points()
      real(dp) :: shape(nodes), place(dim), weight, length, by_modes(n, strains)
      integer :: a, i, k

      length = merge(sqrt(sum(volume)), sum(volume)**(1.0_dp/3.0_dp), dim == 2)
      state = svars
      work = 0.0_dp
      stored = 0.0_dp
      force = 0.0_dp
      matrix = 0.0_dp
      do k = 1, nodes
        weight = thickness*volume(k)
        shape = solid_shape(dim, parents(:, k))
        place = 0.0_dp
        do a = 1, nodes
          place = place + shape(a)*coordinates(:, a)
          if (this%finite) place = place + shape(a)*u(:, a)
        end do
        do i = 1, strains
          strain(i, k) = sum(unknowns*b(:, i, k))
        end do
        call call_material(this, k, shape, place, length, weight, predef, materiallib, strain(:, k), state, stress(:, k), &
          modulus(:, :, k), work, good)
        if (.not. good) return
        call add_combination(n, strains, b(:, :, k), weight*stress(:, k), force)
        if (n == m) cycle
        stored = stored + weight*sum(stress(:, k)**2)/max(maxval(abs(modulus(:, :, k))), tiny(1.0_dp))
        by_modes = stress_matrix(n, strains, weight, b(:, :, k), modulus(:, :, k))
        call add_product(n, n - m, strains, b(:, :, k), by_modes(m + 1:, :), matrix(:, m + 1:))
      end do
    end subroutine update_points

  end subroutine find_stress

  !> Warns, and asks for a smaller increment.
  subroutine reduce_increment(this, why, pnewdt)
    type(element_call), intent(in) :: this
    character(len=*), intent(in) :: why
    real(dp), intent(inout) :: pnewdt

    call warn(this%itype, this%jelem, why // '; a smaller increment is needed', [integer ::], [real(dp) ::])
    pnewdt = min(pnewdt, smaller)
  end subroutine reduce_increment

  !> Stress and stiffness of Gauss point k from the host; its strains and stresses in SVARS go from start to end values.
  subroutine call_material(this, k, shape, place, length, volume, predef, materiallib, strain, svars, stress, stiffness, work, good)
    type(element_call), intent(in) :: this
    integer, intent(in) :: k
    real(dp), intent(in) :: shape(:)               !< shape functions of the nodes
    real(dp), intent(in) :: place(:)               !< of the point
    real(dp), intent(in) :: length                 !< characteristic element length
    real(dp), intent(in) :: volume
    real(dp), intent(in) :: predef(:, :, :)
    integer, intent(in) :: materiallib(*)
    real(dp), intent(in) :: strain(:)              !< at the end of the increment
    real(dp), intent(inout) :: svars(:)
    real(dp), intent(out) :: stress(:), stiffness(:, :)
    real(dp), intent(inout) :: work                !< the work of the stress is added
    logical, intent(out) :: good
    real(dp), parameter :: identity(3, 3) = reshape([1.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 1.0_dp, 0.0_dp, &
      0.0_dp, 0.0_dp, 1.0_dp], [3, 3])
    ! room for what a host may write if TENSOR does not fit
    real(dp) :: start(6), change(6), found(6), matrix(36), coords(3), field(this%npredf), field_change(this%npredf)
    integer :: i, j, first, strains, at(size(strain))
    external :: material_lib_mech

    strains = size(strain)
    at = this%of_material(:strains)
    first = (k - 1)*positions(this%dim)%count
    do i = 1, this%npredf
      field_change(i) = dot_product(shape, predef(2, i, :))
      field(i) = dot_product(shape, predef(1, i, :)) - field_change(i)
    end do
    coords = 0.0_dp
    coords(:size(place)) = place
    associate (e => first + positions(this%dim)%strain(:strains), s => first + positions(this%dim)%stress(:strains), &
      n => this%components)
      start = 0.0_dp
      change = 0.0_dp
      start(at) = svars(e)
      change(at) = strain - start(at)
      found = 0.0_dp
      found(n:min(n + 1, 6)) = untouched
      matrix = 0.0_dp
      call material_lib_mech(materiallib, found, matrix, start, change, k, 1.0_dp, volume, identity, field, &
        field_change, this%npredf, length, coords)
      ! NaN counts as written
      good = .not. abs(found(n) - untouched) <= 0.0_dp
      if (good .and. n < 6) good = abs(found(n + 1) - untouched) <= 0.0_dp
      if (.not. good) then
        call refuse_tensor(this)
        return
      end if
      do j = 1, strains
        do i = 1, strains
          stiffness(i, j) = matrix(at(i) + n*(at(j) - 1))
        end do
      end do
      stress = found(at)
      work = work + 0.5_dp*volume*dot_product(svars(s) + stress, change(at))
      svars(e) = strain
      svars(s) = stress
      if (this%dim == 3) return
      svars(first + v_e33) = 0.0_dp
      svars(first + v_s33) = merge(found(3), 0.0_dp, n == 4)
    end associate
  end subroutine call_material

  !> The stress components of the material are not those that the element needs.
  subroutine refuse_tensor(this)
    type(element_call), intent(in) :: this

    if (this%dim == 2) then
      call fatal(this%itype, this%jelem, 'JPROPS(%I) PLANE = %I, but the material has a different number of stress ' // &
        'components: use TENSOR=PSTRESS with PLANE = 0 and TENSOR=PSTRAIN with PLANE = 1', &
        [integer_position(this%itype, j_plane), this%components - 3], [real(dp) ::])
    else
      call fatal(this%itype, this%jelem, 'the material has fewer than six stress components: use TENSOR=THREED', &
        [integer ::], [real(dp) ::])
    end if
  end subroutine refuse_tensor

  !> Matrix that takes strains in global axes to those in the axes of the brick's ply; the unit matrix in the plane.
  pure subroutine find_ply_strains(strains, angle, direction, coordinates, matrix, status)
    integer, intent(in) :: strains
    real(dp), intent(in) :: angle, direction(3), coordinates(:, :)
    real(dp), intent(out) :: matrix(strains, strains)
    type(status_type), intent(out) :: status    !< ok, or along_normal
    real(dp) :: frame(3, 3)
    integer :: i

    status = status_type(ok, 0, 0.0_dp, 0.0_dp)
    if (strains == 6) then
      call central_frame(4, coordinates(:, 1:4), coordinates(:, 5:8), direction, frame, status)
      matrix = strain_rotation(ply_axes(frame, angle))
      return
    end if
    matrix = 0.0_dp
    do i = 1, strains
      matrix(i, i) = 1.0_dp
    end do
  end subroutine find_ply_strains

  !> Stress of a point, times its volume, by the unknowns.
  pure function stress_matrix(n, strains, weight, b, modulus) result(matrix)
    integer, intent(in) :: n, strains
    real(dp), intent(in) :: weight                                     !< volume of the point
    real(dp), intent(in) :: b(n, strains), modulus(strains, strains)   !< modulus need not be symmetric
    real(dp) :: matrix(n, strains)

    matrix = 0.0_dp
    call add_product(n, strains, strains, b, weight*modulus, matrix)
  end function stress_matrix

  !> Stores stresses and sizes for the adjacent interface elements. The stress at a place on the face is that of the Gauss point
  !> next to it, carried there by the stiffness: exact in linear elasticity, without another call of the material. In the middle
  !> it is the mean of those of all these points.
  subroutine store_for_neighbours(this, dim, nodes, strains, n, places, coordinates, u, unknowns, measure, turn, to_ply, b, &
    strain, stress, modulus)
    type(element_call), intent(in) :: this
    integer, intent(in) :: dim, nodes, strains, n, places
    real(dp), intent(in) :: coordinates(dim, nodes), u(dim, nodes), unknowns(n)
    real(dp), intent(in) :: measure                      !< area or volume
    type(solid_turn), intent(in) :: turn
    real(dp), intent(in) :: to_ply(strains, strains)
    real(dp), intent(in) :: b(n, strains, places)        !< strains on the face by the unknowns, in the axes of the ply
    real(dp), intent(in) :: strain(strains, nodes), stress(strains, nodes), modulus(strains, strains, nodes)   !< of Gauss points
    type(bulk_record) :: record
    real(dp) :: carried(strains)
    integer :: a, i, served, points(2**(dim - 1)), corners(2**(dim - 1))

    corners = face_nodes(dim, this%face)
    points = gauss_of_face(dim, this%face)
    record%dimension = dim
    record%face = this%face
    record%coordinates(:dim, :size(corners)) = coordinates(:, corners)
    record%displacement(:dim, :size(corners)) = u(:, corners)
    record%middle(:dim) = sum(coordinates, 2)/nodes
    record%measure = measure
    do a = 1, size(points)
      associate (d => matmul(transpose(to_ply), matmul(modulus(:, :, points(a)), to_ply)))
        record%norm = record%norm + spectral_norm(d)/size(points)
      end associate
      record%gauss_stress(:, :, a) = nominal(this, turn, matmul(stress(:, points(a)), to_ply))
    end do
    do i = 1, places
      carried = 0.0_dp
      served = 0
      do a = 1, size(points)
        if (.not. serves(dim, a, i)) cycle
        carried = carried + stress(:, points(a)) &
          + matmul(modulus(:, :, points(a)), matmul(unknowns, b(:, :, i)) - strain(:, points(a)))
        served = served + 1
      end do
      record%face_stress(:, :, i) = nominal(this, turn, matmul(carried/served, to_ply))
    end do
    call store_bulk(this%jelem, record)
  end subroutine store_for_neighbours

  !> Nominal stress from the stress in global axes that turn with the element.
  pure function nominal(this, turn, stress) result(tensor)
    type(element_call), intent(in) :: this
    type(solid_turn), intent(in) :: turn
    real(dp), intent(in) :: stress(:)
    real(dp) :: tensor(3, 3)

    tensor = 0.0_dp
    tensor(1, 1) = stress(1)
    tensor(2, 2) = stress(2)
    tensor(1, 2) = stress(this%dim + 1)
    if (this%dim == 3) then
      tensor(3, 3) = stress(3)
      tensor(1, 3) = stress(5)
      tensor(2, 3) = stress(6)
    end if
    tensor(2, 1) = tensor(1, 2)
    tensor(3, 1:2) = tensor(1:2, 3)
    if (this%finite) tensor = matmul(turn%rotation, tensor)
  end function nominal

end module abaqus_continuum_element
