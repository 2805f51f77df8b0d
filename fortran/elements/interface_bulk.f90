! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What a stabilised interface takes from the bulk on both sides: the weighted stress <sigma>.n, and beta and gamma from its
!> stiffness.
module elements_interface_bulk
  use core_cells, only: cell_functions, cell_point, corners_of, is_linear, node_parents, point_shares, points_of_cell
  use core_kinds, only: dp
  use core_quadrature, only: gauss_rule, gauss_abscissa
  use core_small_matrix, only: add_product
  use core_status, only: status_type, ok
  use cohesive_shear, only: mode_of
  use materials_spectral_norm, only: spectral_norm
  use elements_bulk_solid, only: solid_type, reduced_integration, heating_at, strains_at, solid_traction, solid_size, &
    solid_face_eigenvalue
  use elements_interface_faces, only: interface_place, measure_interface
  implicit none(type, external)
  private
  public :: stabilisation_type, nitsche_parameters, stabilise, bulk_operators
  public :: sample_middle, sample_face, sample_gauss

  !> Where to take the bulk stress: where it is most accurate along the face (in its middle, or in quadratic elements on the line
  !> through two points, in space bilinear through four), on the face at the point, or at the nearest integration point. In
  !> linear elements the stress varies spuriously along the face; only the first option avoids this.
  integer, parameter :: sample_middle = 0
  integer, parameter :: sample_face = 1
  integer, parameter :: sample_gauss = 2

  !> Places of an element that stand together for any position on its face, at most.
  integer, parameter :: most_samples = 4

  !> Parameters of the stabilisation, (tau, n); a zero stands for what follows from (21) and (22), with the bounds of the local
  !> eigenvalue problem or with those of the paper.
  type :: stabilisation_type
    real(dp) :: beta(2)           !< stress/length
    real(dp) :: gamma_bottom(2)   !< weight of the bottom stress; that of the top is 1 - gamma_bottom
    logical :: local              !< bounds of the local eigenvalue problem
    logical :: complete = .false. !< of the complete form
    logical :: known = .false.    !< nothing is left to compute
    logical :: given(2) = .false.      !< this beta is a value of the deck and may not change
    real(dp) :: estimate(2) = 0.0_dp   !< beta that was too small for the law and has been raised to `beta`; 0 where none was
  end type stabilisation_type

contains

  !> Uses (21) and (22) where beta and gamma are not given: with the stiffness norm |D| and meas(Omega) of both sides,
  !>
  !>     gamma_1 = (meas(Omega_1)/|D_1|)/(meas(Omega_1)/|D_1| + meas(Omega_2)/|D_2|),    gamma_2 = 1 - gamma_1,
  !>     beta = 2 meas(Gamma) (|D_1| gamma_1**2/meas(Omega_1) + |D_2| gamma_2**2/meas(Omega_2)).
  !>
  !> The bound lambda of the local eigenvalue problem takes the place of |D| meas(Gamma)/meas(Omega), for each mode. The gamma are
  !> those for which the least beta is the smallest. The complete form needs `joint` times this beta: see fortran/README.md.
  pure function nitsche_parameters(given, bounds, joint) result(used)
    type(stabilisation_type), intent(in) :: given
    real(dp), intent(in) :: bounds(2, 2)   !< lambda, or |D| meas(Gamma)/meas(Omega): (tau, n) of bottom and top, stress/length
    real(dp), intent(in) :: joint          !< of both modes, the larger one of bottom and top
    type(stabilisation_type) :: used

    used = given
    where (.not. given%gamma_bottom > 0.0_dp) used%gamma_bottom = bounds(:, 2)/(bounds(:, 1) + bounds(:, 2))
    where (.not. given%beta > 0.0_dp) used%beta = 2.0_dp*joint &
      *(used%gamma_bottom**2*bounds(:, 1) + (1.0_dp - used%gamma_bottom)**2*bounds(:, 2))
  end function nitsche_parameters

  !> Beta and gamma of an interface that knows the elements on both sides, the bottom one first among the nodes.
  !> The complete form takes the bound of the traction that acts too, at the points where it acts, where that is greater than on the
  !> face itself by Gauss' rule.
  pure subroutine stabilise(given, sampling, rule, dim, solids, points, faces, direction, coordinates, used, status)
    type(stabilisation_type), intent(in) :: given
    integer, intent(in) :: sampling
    integer, intent(in) :: rule
    integer, intent(in) :: dim
    type(solid_type), intent(in) :: solids(2)           !< bottom and top
    integer, intent(in) :: points                       !< integration points
    integer, intent(in) :: faces(:, :)                  !< nodes of the bottom and the top face, a column each
    real(dp), intent(in) :: direction(3)                !< for s, in space; zero: none
    real(dp), intent(in) :: coordinates(:, :)           !< original coordinates, (2 or 3, nodes), length
    type(stabilisation_type), intent(out) :: used
    type(status_type), intent(out) :: status            !< inside_out: item 1 for the bottom element, 2 for the top one
    type(interface_place) :: places(points)
    real(dp) :: samples(dim, max(points, most_samples)), shares(max(points, most_samples), points), frames(3, 3, points), measure
    real(dp) :: bounds(2, 2), bound(2), joint, greatest
    integer :: samplings(2), rules(2), side, k, i, n, first, last
    logical :: another

    used = given
    samplings = [sample_face, sampling]
    rules = [gauss_rule, rule]
    another = given%local .and. given%complete .and. (sampling /= sample_face .or. rule /= gauss_rule)
    bounds = 0.0_dp
    greatest = 1.0_dp
    do i = 1, merge(2, 1, another)
      call measure_interface(dim, size(faces, 1), points, coordinates(:, faces(:, 1)), coordinates(:, faces(:, 2)), rules(i), &
        direction, places, status)
      if (status%code /= ok) return
      do k = 1, points
        frames(:, :, k) = places(k)%frame
      end do
      do side = 1, 2
        first = first_node(solids, side)
        last = first + solids(side)%nodes - 1
        if (given%local) then
          call sample(samplings(i), dim, solids(side), faces(:, side) - first + 1, places, samples, shares, n)
          call solid_face_eigenvalue(dim, solids(side), coordinates(:, first:last), samples(:, 1:n), shares(1:n, :), frames, &
            places%area, bound, joint, status)
          if (status%code == ok) then
            bounds(:, side) = max(bounds(:, side), bound)
            if (given%complete) greatest = max(greatest, joint)
          end if
        else
          call solid_size(dim, solids(side), coordinates(:, first:last), measure, status)
          if (status%code == ok) bounds(:, side) = sum(places%area)/measure &
            *spectral_norm(solids(side)%stiffness(1:3*(dim - 1), 1:3*(dim - 1)))
        end if
        if (status%code /= ok) then
          status%item = side
          return
        end if
      end do
    end do
    used = nitsche_parameters(given, bounds, greatest)
  end subroutine stabilise

  !> B of each point, transposed: <sigma>.n = gamma_1 sigma_1.n + gamma_2 sigma_2.n of (18) in the components of the frame there, by
  !> the displacements of both elements; and the traction without them, of the initial stress less that of the thermal strains.
  pure subroutine bulk_operators(sampling, dim, places, gamma_bottom, solids, faces, initial, coordinates, matrices, at_rest, &
    status)
    integer, intent(in) :: sampling
    integer, intent(in) :: dim
    type(interface_place), intent(in) :: places(:)
    real(dp), intent(in) :: gamma_bottom(2)             !< (tau, n)
    type(solid_type), intent(in) :: solids(2)           !< bottom and top
    integer, intent(in) :: faces(:, :)                  !< nodes of the bottom and the top face, a column each
    real(dp), intent(in) :: initial(3)                  !< traction of the initial stress, (s, n, t)
    real(dp), intent(in) :: coordinates(:, :)           !< original coordinates, (2 or 3, nodes), length
    real(dp), intent(out) :: matrices(:, :, :)          !< (unknowns, 2 or 3, points)
    real(dp), intent(out) :: at_rest(:, :)              !< traction without displacements, (2 or 3, points)
    type(status_type), intent(out) :: status            !< inside_out: item 1 for the bottom element, 2 for the top one
    real(dp) :: weights(2, 2)
    integer :: side, k

    weights(:, 1) = gamma_bottom
    weights(:, 2) = 1.0_dp - gamma_bottom
    do k = 1, size(places)
      at_rest(:, k) = initial(1:dim)
    end do
    do side = 1, 2
      associate (first => first_node(solids, side), nodes => solids(side)%nodes)
        call side_operators(sampling, dim, places, weights(:, side), solids(side), faces(:, side) - first + 1, &
          coordinates(:, first:first + nodes - 1), matrices(dim*(first - 1) + 1:dim*(first + nodes - 1), :, :), at_rest, status)
      end associate
      if (status%code == ok) cycle
      status%item = side
      return
    end do
  end subroutine bulk_operators

  !> The part of one side.
  pure subroutine side_operators(sampling, dim, places, weights, solid, face, coordinates, matrices, at_rest, status)
    integer, intent(in) :: sampling, dim
    type(interface_place), intent(in) :: places(:)
    real(dp), intent(in) :: weights(2)                  !< (tau, n)
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: face(:)                      !< nodes of the solid on the interface
    real(dp), intent(in) :: coordinates(dim, solid%nodes)
    real(dp), intent(out) :: matrices(:, :, :)
    real(dp), intent(inout) :: at_rest(:, :)
    type(status_type), intent(out) :: status
    real(dp) :: of_strain(dim, 3*(dim - 1)), heating
    real(dp) :: samples(dim, max(size(places), most_samples)), shares(max(size(places), most_samples), size(places))
    real(dp) :: b(dim*solid%nodes, 3*(dim - 1), max(size(places), most_samples)), tractions(dim*solid%nodes, dim, size(places))
    integer :: i, j, k, n
    logical :: expands

    expands = maxval(abs(solid%expansion)) > 0.0_dp
    call sample(sampling, dim, solid, face, places, samples, shares, n)
    call strains_at(dim, solid, coordinates, samples(:, 1:n), b(:, :, 1:n), status)
    if (status%code /= ok) return
    tractions = 0.0_dp
    do k = 1, size(places)
      of_strain = transpose(solid_traction(dim, solid, places(k)%frame))
      do j = 1, dim
        of_strain(j, :) = weights(mode_of(j))*of_strain(j, :)
      end do
      heating = 0.0_dp
      do i = 1, n
        if (.not. abs(shares(i, k)) > 0.0_dp) cycle
        call add_product(size(b, 1), dim, size(b, 2), b(:, :, i), shares(i, k)*of_strain, tractions(:, :, k))
        if (expands) heating = heating + shares(i, k)*heating_at(dim, solid, samples(:, i))
      end do
      if (expands) at_rest(:, k) = at_rest(:, k) - matmul(of_strain, heating*solid%expansion(1:size(b, 2)))
    end do
    matrices = tractions
  end subroutine side_operators

  !> First node of the element on a side.
  pure integer function first_node(solids, side)
    type(solid_type), intent(in) :: solids(2)
    integer, intent(in) :: side

    first_node = merge(1, 1 + solids(1)%nodes, side == 1)
  end function first_node

  !> Places of an element whose strains, in these shares, stand for positions on its face: the face itself, the nearest integration
  !> point, or where the stress of the face is most accurate (Barlow 1976): the middle in linear elements; in those with midside
  !> nodes the line through s = +-1/sqrt(3) of an edge, the bilinear function through xi, eta = +-1/sqrt(3) of a quadrilateral, the
  !> linear one through the three points of degree 2 of a triangle.
  pure subroutine sample(sampling, dim, solid, face, positions, places, shares, n)
    integer, intent(in) :: sampling, dim
    type(solid_type), intent(in) :: solid
    integer, intent(in) :: face(:)                           !< its nodes on the interface
    type(interface_place), intent(in) :: positions(:)        !< on the face
    real(dp), intent(out) :: places(:, :)                    !< parent coordinates of the element
    real(dp), intent(out) :: shares(:, :)                    !< of the places, for each position
    integer, intent(out) :: n                                !< number of places
    real(dp) :: of_face(dim - 1, most_samples), weight
    integer :: k, corners
    logical :: reduced

    corners = merge(2, corners_of(2, size(face)), dim == 2)
    reduced = solid%formulation == reduced_integration
    shares = 0.0_dp
    if (sampling == sample_middle) then
      n = 1
      if (.not. is_linear(dim, solid%nodes)) n = points_of_face(dim, corners)
      do k = 1, n
        if (dim == 2) then
          of_face(:, k) = merge(0.0_dp, (2*k - 3)*gauss_abscissa, n == 1)
        else if (n == 1) then
          of_face(:, k) = merge(0.0_dp, 1.0_dp/3.0_dp, corners == 4)
        else
          call cell_point(2, merge(8, 6, corners == 4), corners == 4, k, of_face(:, k), weight)
        end if
        places(:, k) = place_in_solid(dim, solid%nodes, face(1:corners), of_face(:, k))
      end do
      do k = 1, size(positions)
        shares(1:n, k) = 1.0_dp
        if (n > 1 .and. dim == 2) shares(1:2, k) = 0.5_dp*(1.0_dp + positions(k)%parent(1)*[-1.0_dp, 1.0_dp]/gauss_abscissa)
        if (n > 1 .and. dim == 3) shares(1:n, k) = point_shares(2, merge(8, 6, corners == 4), corners == 4, positions(k)%parent)
      end do
      return
    end if
    n = size(positions)
    do k = 1, n
      places(:, k) = place_in_solid(dim, solid%nodes, face(1:corners), positions(k)%parent(1:dim - 1))
      if (sampling == sample_gauss) places(:, k) = nearest_point(dim, solid%nodes, reduced, places(:, k))
      shares(k, k) = 1.0_dp
    end do
  end subroutine sample

  !> Points of a face through which the stress of an element with midside nodes is taken.
  pure integer function points_of_face(dim, corners)
    integer, intent(in) :: dim, corners

    points_of_face = merge(2, corners, dim == 2)
  end function points_of_face

  !> Parent coordinates in an element of a place on its face.
  pure function place_in_solid(dim, nodes, corners, parent) result(place)
    integer, intent(in) :: dim, nodes
    integer, intent(in) :: corners(:)           !< nodes of the face at its corners
    real(dp), intent(in) :: parent(dim - 1)     !< on the face
    real(dp) :: place(dim)
    real(dp) :: shape(size(corners)), slope(size(corners), 2), parents(dim, corners_of(dim, nodes))
    integer :: k

    if (dim == 2) then
      shape = 0.5_dp*[1.0_dp - parent(1), 1.0_dp + parent(1)]
    else
      call cell_functions(2, size(corners), parent, shape, slope)
    end if
    parents = node_parents(dim, nodes)
    place = 0.0_dp
    do k = 1, size(corners)
      place = place + shape(k)*parents(:, corners(k))
    end do
  end function place_in_solid

  !> The integration point next to a place, by parent coordinates.
  pure function nearest_point(dim, nodes, reduced, place) result(nearest)
    integer, intent(in) :: dim, nodes
    logical, intent(in) :: reduced
    real(dp), intent(in) :: place(dim)
    real(dp) :: nearest(dim)
    real(dp) :: point(dim), weight, least
    integer :: k

    least = huge(1.0_dp)
    nearest = place
    do k = 1, points_of_cell(dim, nodes, reduced)
      call cell_point(dim, nodes, reduced, k, point, weight)
      if (sum((point - place)**2) >= least) cycle
      least = sum((point - place)**2)
      nearest = point
    end do
  end function nearest_point

end module elements_interface_bulk
