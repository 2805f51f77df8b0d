! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> A continuum element next to an interface, as that element itself computes it: strains by its displacements at any place and at
!> its integration points, area or volume, and the bound of the traction on its face.
!>
!> A traction is bounded by the energy of the element only if it is made of the strains that have this energy. Quads and bricks with
!> full integration have the strain of the place, with the part of the incompatible modes, which are condensed, or with the mean
!> volume strain. All others have the polynomial through the strains at their integration points: quads and bricks with reduced
!> integration (the uniform strain of one point, or 2 x 2 (x 2) points), triangles, tetrahedra and wedges.
module elements_bulk_solid
  use core_cells, only: cell_functions, cell_point, corners_of, is_linear, is_multilinear, is_product, point_shares, points_of_cell
  use core_kinds, only: dp
  use core_rotation, only: traction_operator
  use core_small_matrix, only: add_product
  use core_status, only: status_type, ok, inside_out, not_positive_definite
  use core_strains, only: strain_matrix
  use core_symmetric, only: invert_definite
  use elements_continuum_solid, only: incompatible_modes, mean_volume, modes_of, solid_gradient, solid_points, solid_strains
  use elements_face_eigenvalue, only: face_eigenvalue
  implicit none(type, external)
  private
  public :: solid_type, has_formulation, heating_at, strains_at, solid_traction, solid_size, solid_face_eigenvalue

  !> Formulation besides those of elements_continuum_solid: reduced integration.
  integer, parameter, public :: reduced_integration = 3

  !> An elastic solid beside an interface.
  type :: solid_type
    integer :: nodes = 0
    integer :: formulation = 0
    integer :: plane = 0                     !< plane_stress or plane_strain, in the plane
    real(dp) :: stiffness(6, 6) = 0.0_dp     !< D, global axes, stress; in the plane the first three rows and columns
    real(dp) :: expansion(6) = 0.0_dp        !< thermal strain, global axes, 1/temperature; in the plane the first three
    real(dp) :: heating(8) = 0.0_dp          !< change of temperature of the corners
  end type solid_type

contains

  !> Whether elements with so many nodes have a formulation.
  pure logical function has_formulation(dim, nodes, formulation)
    integer, intent(in) :: dim, nodes, formulation

    select case (formulation)
    case (incompatible_modes, mean_volume)
      has_formulation = is_multilinear(dim, nodes)
    case (reduced_integration)
      has_formulation = is_product(dim, nodes)
    case default
      has_formulation = .true.
    end select
  end function has_formulation

  !> Number of integration points.
  pure integer function points_of(dim, solid)
    integer, intent(in) :: dim
    type(solid_type), intent(in) :: solid

    points_of = points_of_cell(dim, solid%nodes, solid%formulation == reduced_integration)
  end function points_of

  !> Change of temperature that the thermal strain of a solid has at a place: the mean of its corners, or with midside nodes the
  !> linear function between them, as in Abaqus.
  pure function heating_at(dim, solid, place) result(heating)
    integer, intent(in) :: dim
    type(solid_type), intent(in) :: solid
    real(dp), intent(in) :: place(dim)      !< parent coordinates
    real(dp) :: heating
    real(dp), dimension(corners_of(dim, solid%nodes)) :: shape
    real(dp) :: slope(size(shape), dim)

    shape = 1.0_dp/size(shape)
    if (.not. is_linear(dim, solid%nodes)) call cell_functions(dim, size(shape), place, shape, slope)
    heating = dot_product(shape, solid%heating(1:size(shape)))
  end function heating_at

  !> Strains by displacements, transposed, at places and, on request, at the integration points with their areas or volumes.
  pure subroutine strains_at(dim, solid, coordinates, places, b, status, b_points, volumes)
    integer, intent(in) :: dim
    type(solid_type), intent(in) :: solid
    real(dp), intent(in) :: coordinates(dim, solid%nodes)
    real(dp), intent(in) :: places(:, :)             !< (dim, places) parent coordinates
    real(dp), intent(out) :: b(dim*solid%nodes, 3*(dim - 1), size(places, 2))
    type(status_type), intent(out) :: status         !< inside_out with the Jacobian; not_positive_definite
    real(dp), intent(out), optional :: b_points(:, :, :), volumes(:)   !< both or none
    real(dp) :: own(dim*solid%nodes, 3*(dim - 1), points_of(dim, solid)), own_volumes(points_of(dim, solid))
    real(dp) :: shares(points_of(dim, solid))
    logical :: reduced
    integer :: i, k

    b = 0.0_dp
    if (any(solid%formulation == [incompatible_modes, mean_volume])) then
      call assumed_strains(dim, dim*solid%nodes, modes_of(dim, solid%plane, solid%formulation), solid, coordinates, places, &
        present(b_points), b, own, own_volumes, status)
    else
      reduced = solid%formulation == reduced_integration
      if (present(b_points) .or. reduced .or. .not. is_product(dim, solid%nodes)) then
        call strains_at_points(dim, solid, reduced, coordinates, own, own_volumes, status)
        if (status%code /= ok) return
      end if
      do k = 1, size(places, 2)
        if (reduced .or. .not. is_product(dim, solid%nodes)) then
          shares = point_shares(dim, solid%nodes, reduced, places(:, k))
          do i = 1, size(shares)
            b(:, :, k) = b(:, :, k) + shares(i)*own(:, :, i)
          end do
        else
          call plain_strains(dim, solid%nodes, coordinates, places(:, k), b(:, :, k), status)
          if (status%code /= ok) return
        end if
      end do
    end if
    if (present(b_points)) b_points = own
    if (present(volumes)) volumes = own_volumes
  end subroutine strains_at

  !> The same with incompatible modes or the mean volume strain. The modes take the values that leave no force on them:
  !> b - b_modes inverse(K_mm) K_mu.
  pure subroutine assumed_strains(dim, m, modes, solid, coordinates, places, with_points, b, b_points, volumes, status)
    integer, intent(in) :: dim
    integer, intent(in) :: m, modes      !< unknowns of the nodes, and of the modes
    type(solid_type), intent(in) :: solid
    real(dp), intent(in) :: coordinates(dim, 2**dim), places(:, :)
    logical, intent(in) :: with_points
    real(dp), intent(out) :: b(m, 3*(dim - 1), size(places, 2))
    real(dp), intent(out) :: b_points(m, 3*(dim - 1), 2**dim)   !< only with
    real(dp), intent(out) :: volumes(2**dim)
    type(status_type), intent(out) :: status
    real(dp) :: all_places(dim, 2**dim + size(places, 2)), jacobians(2**dim + size(places, 2))
    real(dp) :: everything(m + modes, 3*(dim - 1), 2**dim + size(places, 2)), stiffness(3*(dim - 1), 3*(dim - 1))
    real(dp) :: stresses(m + modes, 3*(dim - 1), 2**dim), matrix(m + modes, modes), inverse(modes, modes), values(m, modes)
    integer :: k, points, strains
    logical :: good

    points = 2**dim
    strains = 3*(dim - 1)
    all_places(:, 1:points) = solid_points(dim)
    all_places(:, points + 1:) = places
    call solid_strains(dim, m + modes, strains, solid%formulation, coordinates, all_places, everything, jacobians, status)
    if (status%code /= ok) return
    if (.not. minval(jacobians) > 0.0_dp) then
      status = status_type(inside_out, 0, minval(jacobians), 0.0_dp)
      return
    end if
    volumes = jacobians(1:points)
    values = 0.0_dp
    if (modes > 0) then
      stiffness = solid%stiffness(1:strains, 1:strains)
      stresses = 0.0_dp
      do k = 1, points
        call add_product(m + modes, strains, strains, everything(:, :, k), volumes(k)*stiffness, stresses(:, :, k))
      end do
      matrix = 0.0_dp
      call add_product(m + modes, modes, strains*points, stresses, everything(m + 1:, :, 1:points), matrix)
      call invert_definite(matrix(m + 1:, :), inverse, good)
      if (.not. good) then
        status = status_type(not_positive_definite, 0, 0.0_dp, 0.0_dp)
        return
      end if
      call add_product(m, modes, modes, matrix(1:m, :), -inverse, values)
    end if
    do k = 1, merge(points, 0, with_points)
      b_points(:, :, k) = condensed(k)
    end do
    do k = 1, size(places, 2)
      b(:, :, k) = condensed(points + k)
    end do

  contains

    !> Strains at a place by the displacements of the nodes alone.
    pure function condensed(k)
      integer, intent(in) :: k
      real(dp) :: condensed(m, strains)

      condensed = everything(1:m, :, k)
      call add_product(m, strains, modes, values, transpose(everything(m + 1:, :, k)), condensed)
    end function condensed

  end subroutine assumed_strains

  !> Strains of the displacements at the integration points; the one point of a quad of four or a brick of eight nodes has the mean
  !> of the element.
  pure subroutine strains_at_points(dim, solid, reduced, coordinates, b, volumes, status)
    integer, intent(in) :: dim
    type(solid_type), intent(in) :: solid
    logical, intent(in) :: reduced
    real(dp), intent(in) :: coordinates(dim, solid%nodes)
    real(dp), intent(out) :: b(:, :, :), volumes(:)
    type(status_type), intent(out) :: status
    real(dp) :: parent(dim), weight, part(size(b, 1), size(b, 2))
    logical :: uniform
    integer :: k, at

    b = 0.0_dp
    volumes = 0.0_dp
    uniform = reduced .and. is_multilinear(dim, solid%nodes)
    do k = 1, points_of_cell(dim, solid%nodes, reduced .and. .not. uniform)
      call cell_point(dim, solid%nodes, reduced .and. .not. uniform, k, parent, weight)
      call plain_strains(dim, solid%nodes, coordinates, parent, part, status)
      if (status%code /= ok) return
      at = merge(1, k, uniform)
      volumes(at) = volumes(at) + weight*status%value
      if (uniform) part = (weight*status%value)*part
      b(:, :, at) = b(:, :, at) + part
    end do
    if (uniform) b = b/volumes(1)
  end subroutine strains_at_points

  !> Strains of the displacements at a place; the value of the status is the Jacobian.
  pure subroutine plain_strains(dim, nodes, coordinates, parent, b, status)
    integer, intent(in) :: dim, nodes
    real(dp), intent(in) :: coordinates(dim, nodes), parent(dim)
    real(dp), intent(out) :: b(dim*nodes, 3*(dim - 1))
    type(status_type), intent(out) :: status
    real(dp) :: gradient(dim, nodes), by_node(nodes, dim)

    call solid_gradient(dim, nodes, coordinates, parent, gradient, status)
    by_node = transpose(gradient)
    call strain_matrix(dim, dim, nodes, by_node, b)
  end subroutine plain_strains

  !> sigma.n of a solid, in the components of a frame, by its strain: (strains, components).
  pure function solid_traction(dim, solid, frame) result(matrix)
    integer, intent(in) :: dim
    type(solid_type), intent(in) :: solid
    real(dp), intent(in) :: frame(3, 3)          !< rows tau, n and zero, or s, n and t
    real(dp) :: matrix(3*(dim - 1), dim)
    real(dp) :: operator(dim, 3*(dim - 1)), stiffness(3*(dim - 1), 3*(dim - 1))

    operator = traction_operator(dim, frame)
    stiffness = solid%stiffness(1:size(matrix, 1), 1:size(matrix, 1))
    matrix = 0.0_dp
    ! D is symmetric
    call add_product(size(matrix, 1), dim, size(matrix, 1), stiffness, operator, matrix)
  end function solid_traction

  !> Area or volume.
  pure subroutine solid_size(dim, solid, coordinates, value, status)
    integer, intent(in) :: dim
    type(solid_type), intent(in) :: solid
    real(dp), intent(in) :: coordinates(dim, solid%nodes)
    real(dp), intent(out) :: value
    type(status_type), intent(out) :: status        !< inside_out with the area or a Jacobian
    real(dp) :: gradient(dim, solid%nodes), parent(dim), weight
    integer :: k

    value = 0.0_dp
    if (dim == 2 .and. solid%nodes == 4) then
      value = quad_area(coordinates(:, 1:4))
      status = status_type(merge(ok, inside_out, value > 0.0_dp), 0, value, 0.0_dp)
      return
    end if
    do k = 1, points_of_cell(dim, solid%nodes, .false.)
      call cell_point(dim, solid%nodes, .false., k, parent, weight)
      call solid_gradient(dim, solid%nodes, coordinates, parent, gradient, status)
      if (status%code /= ok) return
      value = value + weight*status%value
    end do
  end subroutine solid_size

  !> Area of a quad of four nodes; negative where they run clockwise.
  pure function quad_area(coordinates) result(area)
    real(dp), intent(in) :: coordinates(2, 4)
    real(dp) :: area
    real(dp) :: diagonal_13(2), diagonal_24(2)

    diagonal_13 = coordinates(:, 3) - coordinates(:, 1)
    diagonal_24 = coordinates(:, 4) - coordinates(:, 2)
    area = 0.5_dp*(diagonal_13(1)*diagonal_24(2) - diagonal_13(2)*diagonal_24(1))
  end function quad_area

  !> lambda of a face, see elements_face_eigenvalue. The traction of a point is that of the samples in the solid that stand for it.
  pure subroutine solid_face_eigenvalue(dim, solid, coordinates, samples, shares, frames, areas, lambda, joint, status)
    integer, intent(in) :: dim
    type(solid_type), intent(in) :: solid
    real(dp), intent(in) :: coordinates(dim, solid%nodes)
    real(dp), intent(in) :: samples(:, :)             !< (dim, samples) parent coordinates
    real(dp), intent(in) :: shares(:, :)              !< (samples, points of the face)
    real(dp), intent(in) :: frames(:, :, :)           !< of the points
    real(dp), intent(in) :: areas(:)                  !< of the face that each of them stands for
    real(dp), intent(out) :: lambda(2)                !< of shear and normal traction, stress/length
    real(dp), intent(out) :: joint                    !< of both, see there
    type(status_type), intent(out) :: status          !< inside_out with the Jacobian
    real(dp), dimension(dim*solid%nodes, 3*(dim - 1), size(samples, 2)) :: b
    real(dp), dimension(dim*solid%nodes, 3*(dim - 1), points_of(dim, solid)) :: b_points, stresses
    real(dp) :: volumes(points_of(dim, solid)), stiffness(3*(dim - 1), 3*(dim - 1))
    real(dp) :: energy(dim*solid%nodes, dim*solid%nodes), traction(dim*size(areas), dim*solid%nodes)
    integer :: i, k

    lambda = 0.0_dp
    joint = 2.0_dp
    call strains_at(dim, solid, coordinates, samples, b, status, b_points, volumes)
    if (status%code /= ok) return
    stiffness = solid%stiffness(1:size(stiffness, 1), 1:size(stiffness, 1))
    stresses = 0.0_dp
    do k = 1, size(volumes)
      call add_product(size(energy, 1), size(stiffness, 1), size(stiffness, 1), b_points(:, :, k), volumes(k)*stiffness, &
        stresses(:, :, k))
    end do
    energy = 0.0_dp
    call add_product(size(energy, 1), size(energy, 1), size(stiffness, 1)*size(volumes), stresses, b_points, energy)
    traction = 0.0_dp
    do k = 1, size(areas)
      do i = 1, size(shares, 1)
        if (.not. abs(shares(i, k)) > 0.0_dp) cycle
        traction(dim*(k - 1) + 1:dim*k, :) = traction(dim*(k - 1) + 1:dim*k, :) &
          + (sqrt(areas(k))*shares(i, k))*transpose(matmul(b(:, :, i), solid_traction(dim, solid, frames(:, :, k))))
      end do
    end do
    call face_eigenvalue(coordinates, energy, traction, 3*(dim - 1)*size(volumes) <= dim*(solid%nodes) - 3*(dim - 1), lambda, &
      joint, status)
  end subroutine solid_face_eigenvalue

end module elements_bulk_solid
