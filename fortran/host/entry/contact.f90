! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Procedures Python calls (through f2py) for the points of contact. Nodes and faces are counted from 0.
!>
!> A surface has faces with shapes (terms, nodes), the coefficients of the monomials of host/contact/faces.f90 in the shape
!> functions. Coordinates are those of all nodes.

!> Monomials at natural coordinates, with derivatives.
subroutine host_contact_monomials(natural, values, first, second, along, terms, m)
  use host_kinds, only: dp, i4
  use host_contact_faces, only: monomials
  implicit none (type, external)
  integer(i4), intent(in) :: along, terms, m
  real(dp), intent(in) :: natural(along, m)
  real(dp), intent(inout) :: values(terms, m), first(along, terms, m), second(along, along, terms, m)
  real(dp) :: by(terms, along), by_both(terms, along, along)
  integer :: i, a, b
  do i = 1, m
    call monomials(int(along), int(terms), natural(:, i), values(:, i), by, by_both)
    do a = 1, along
      first(a, :, i) = by(:, a)
      do b = 1, along
        second(b, a, :, i) = by_both(:, b, a)
      end do
    end do
  end do
end subroutine host_contact_monomials

!> Largest distances of the nodes of faces from their centroids.
subroutine host_contact_sizes(nodes, coordinates, sizes, k, m, d, n)
  use host_kinds, only: dp, i4, i8
  use host_contact_faces, only: size_of
  implicit none (type, external)
  integer(i4), intent(in) :: k, m, d, n
  integer(i8), intent(in) :: nodes(k, m)
  real(dp), intent(in) :: coordinates(d, n)
  real(dp), intent(out) :: sizes(m)
  real(dp) :: corners(d, k)
  integer :: i
  do i = 1, m
    corners = coordinates(:, nodes(:, i) + 1)
    sizes(i) = size_of(corners)
  end do
end subroutine host_contact_sizes

!> Normals and metrics of tangents.
subroutine host_contact_frames(tangents, normals, metrics, d, along, m)
  use host_kinds, only: dp, i4
  use host_contact_faces, only: find_frame, foot_t
  implicit none (type, external)
  integer(i4), intent(in) :: d, along, m
  real(dp), intent(in) :: tangents(d, along, m)
  real(dp), intent(inout) :: normals(d, m), metrics(along, along, m)
  type(foot_t) :: foot
  integer :: i
  foot%along = along
  foot%tangents = 0
  do i = 1, m
    foot%tangents(:d, :along) = tangents(:, :, i)
    call find_frame(int(d), foot)
    normals(:, i) = foot%normal(:d)
    metrics(:, :, i) = foot%metric(:along, :along)
  end do
end subroutine host_contact_frames

!> Points of faces: coordinates, tangents and their derivatives.
subroutine host_contact_feet(shapes, nodes, coordinates, face, natural, at, tangents, second, terms, k, faces, d, n, along, m)
  use host_kinds, only: dp, i4, i8
  use host_contact_faces, only: evaluate, foot_t, polynomial_of
  implicit none (type, external)
  integer(i4), intent(in) :: terms, k, faces, d, n, along, m
  real(dp), intent(in) :: shapes(terms, k, faces), coordinates(d, n), natural(along, m)
  integer(i8), intent(in) :: nodes(k, faces), face(m)
  real(dp), intent(inout) :: at(d, m), tangents(d, along, m), second(d, along, along, m)
  type(foot_t) :: foot
  integer :: i
  do i = 1, m
    associate (p => face(i) + 1)
      foot = evaluate(polynomial_of(shapes(:, :, p), nodes(:, p), coordinates), int(d), natural(:, i))
    end associate
    at(:, i) = foot%at(:d)
    tangents(:, :, i) = foot%tangents(:d, :along)
    second(:, :, :, i) = foot%second(:d, :along, :along)
  end do
end subroutine host_contact_feet

!> Nearest faces of points: from those among some faces, if there are any, or from the last ones, on to neighbours.
subroutine host_contact_search(shapes, nodes, coordinates, low, high, total, reach_low, reach_high, reach_total, ring, facing, &
                               points, outward, before, near, most, face, natural, within, distance, above, &
                               terms, k, faces, d, n, along, r, m, c)
  use host_kinds, only: dp, i4, i8
  use host_contact_search, only: find_nearest, hit_t, new_surface, surface_t, walk
  implicit none (type, external)
  integer(i4), intent(in) :: terms, k, faces, d, n, along, r, m, c
  real(dp), intent(in) :: shapes(terms, k, faces), coordinates(d, n)
  integer(i8), intent(in) :: nodes(k, faces)
  real(dp), intent(in) :: low(along, faces), high(along, faces), total(faces)              !< ends of the natural coordinates
  real(dp), intent(in) :: reach_low(along, faces), reach_high(along, faces), reach_total(faces)
  integer(i8), intent(in) :: ring(r, faces)          !< neighbours of each face
  real(dp), intent(in) :: facing                     !< largest cosine between the normals of a point and of its face
  real(dp), intent(in) :: points(d, m), outward(d, m)   !< outward zero: any face
  integer(i8), intent(in) :: before(m), near(c, m)
  integer(i4), intent(in) :: most                    !< faces that a point passes; 0: one of `near`
  integer(i8), intent(inout) :: face(m)
  real(dp), intent(inout) :: natural(along, m), within(along, m)   !< of the projection, and clipped to the face
  real(dp), intent(inout) :: distance(m)
  integer(i4), intent(inout) :: above(m)             !< 1: the point is above the face, or close to its ends
  type(surface_t) :: surface
  type(hit_t) :: hit
  real(dp) :: point(3), direction(3)
  integer :: i
  surface%facing = facing
  allocate (surface%low, source=low)
  allocate (surface%high, source=high)
  allocate (surface%total, source=total)
  allocate (surface%reach_low, source=reach_low)
  allocate (surface%reach_high, source=reach_high)
  allocate (surface%reach_total, source=reach_total)
  call new_surface(surface, shapes, nodes, coordinates)
  point = 0
  direction = 0
  do i = 1, m
    point(:d) = points(:, i)
    direction(:d) = outward(:, i)
    hit%face = before(i)
    if (c > 0) hit = find_nearest(surface, point, direction, [before(i), near(:, i)])
    if (most > 0) hit = walk(surface, point, direction, hit%face, ring, int(most))
    face(i) = hit%face
    natural(:, i) = hit%natural(:along)
    within(:, i) = hit%within(:along)
    distance(i) = hit%distance
    above(i) = merge(1_i4, 0_i4, hit%above)
  end do
end subroutine host_contact_search

!> Derivatives of foot points, see host/contact/derivatives.f90.
subroutine host_contact_derivatives(tangents, second, gap, along, across, natural_by, tilt, d, a, u, m)
  use host_kinds, only: dp, i4
  use host_contact_derivatives, only: differentiate
  use host_contact_faces, only: find_frame, foot_t
  implicit none (type, external)
  integer(i4), intent(in) :: d, a, u, m
  real(dp), intent(in) :: tangents(d, a, m), second(d, a, a, m), gap(m), along(u, a, m), across(u, a, m)
  real(dp), intent(inout) :: natural_by(u, a, m), tilt(u, a, m)
  type(foot_t) :: foot
  integer :: i
  foot%along = a
  foot%tangents = 0
  foot%second = 0
  do i = 1, m
    foot%tangents(:d, :a) = tangents(:, :, i)
    foot%second(:d, :a, :a) = second(:, :, :, i)
    call find_frame(int(d), foot)
    call differentiate(foot, gap(i), along(:, :, i), across(:, :, i), natural_by(:, :, i), tilt(:, :, i))
  end do
end subroutine host_contact_derivatives

!> Add the matrices sum over r of left_r right_r of points to the values of a sparse matrix.
subroutine host_contact_products(left, rows, right, columns, indptr, indices, values, u, v, r, m, n1, nnz)
  use host_kinds, only: dp, i4
  use host_contact_assembly, only: add_row, find_runs
  implicit none (type, external)
  integer(i4), intent(in) :: u, v, r, m, n1, nnz
  real(dp), intent(in) :: left(u, r, m), right(v, r, m)
  integer(i4), intent(in) :: rows(u, m), columns(v, m)   !< unknowns, from 0
  integer(i4), intent(in) :: indptr(n1), indices(nnz)   !< pattern, from 0
  real(dp), intent(inout) :: values(nnz)
  real(dp) :: row(v)
  integer(i4) :: offset(v)
  integer :: i, j, k, runs, first(v), last(v)
  offset = 1
  do k = 1, m
    call find_runs(columns(:, k), runs, first, last)
    do i = 1, u
      row = 0
      do j = 1, r
        if (abs(left(i, j, k)) > 0) row = row + left(i, j, k)*right(:, j, k)
      end do
      call add_row(row, rows(i, k), columns(:, k), first(:runs), last(:runs), offset, indptr, indices, values)
    end do
  end do
end subroutine host_contact_products

!> Add to the points their means over samples: gradients of the clearance, and shares of the nodes in a force.
subroutine host_contact_means(shapes, loads, nodes, coordinates, own, face, natural, sample, point, weight, &
                              place, positions, gradients, shares, &
                              terms, k, faces, d, n, l, q, along, pairs, places, kl, width, m)
  use host_kinds, only: dp, i4, i8
  use host_contact_samples, only: new_sample, sample_t
  implicit none (type, external)
  integer(i4), intent(in) :: terms, k, faces, d, n, l, q, along, pairs, places, kl, width, m
  real(dp), intent(in) :: shapes(terms, k, faces), loads(terms, k, faces), coordinates(d, n)
  integer(i8), intent(in) :: nodes(k, faces)
  real(dp), intent(in) :: own(l, q)                  !< shape functions of the nodes of the secondary surface
  integer(i8), intent(in) :: face(q)
  real(dp), intent(in) :: natural(along, q)
  integer(i8), intent(in) :: sample(pairs), point(pairs)   !< samples ascend
  real(dp), intent(in) :: weight(pairs)
  integer(i8), intent(in) :: place(pairs)            !< column of `positions`, from 0
  integer(i8), intent(in) :: positions(kl, places)   !< of the nodes of the sample among those of the point
  real(dp), intent(inout) :: gradients(d, width, m), shares(width, m)
  type(sample_t) :: at
  integer(i8) :: last
  integer :: i, j
  last = -1
  do i = 1, pairs
    if (sample(i) /= last) then
      last = sample(i)
      associate (p => face(last + 1) + 1)
        at = new_sample(own(:, last + 1), shapes(:, :, p), loads(:, :, p), nodes(:, p), coordinates, natural(:, last + 1))
      end associate
    end if
    do j = 1, kl
      associate (node => positions(j, place(i) + 1) + 1, to => point(i) + 1)
        gradients(:, node, to) = gradients(:, node, to) + weight(i)*at%motion(j, 0)*at%foot%normal(:d)
        shares(node, to) = shares(node, to) + weight(i)*at%load(j, 0)
      end associate
    end do
  end do
end subroutine host_contact_means

!> Add the derivatives of the nodal forces of samples to the values of a sparse matrix, those of the samples with the same nodes
!> at once.
subroutine host_contact_samples_stiffness(shapes, loads, nodes, coordinates, own, face, natural, gap, normal_force, friction, &
                                          first, equations, indptr, indices, values, &
                                          terms, k, faces, d, n, l, q, along, g1, u, g, n1, nnz)
  use host_kinds, only: dp, i4, i8
  use host_contact_assembly, only: add_row, find_runs
  use host_contact_samples, only: add_stiffness, new_sample
  implicit none (type, external)
  integer(i4), intent(in) :: terms, k, faces, d, n, l, q, along, g1, u, g, n1, nnz
  real(dp), intent(in) :: shapes(terms, k, faces), loads(terms, k, faces), coordinates(d, n)
  integer(i8), intent(in) :: nodes(k, faces)
  real(dp), intent(in) :: own(l, q)                  !< shape functions of the nodes of the secondary surface
  integer(i8), intent(in) :: face(q)
  real(dp), intent(in) :: natural(along, q), gap(q)
  real(dp), intent(in) :: normal_force(q), friction(d, q)
  integer(i8), intent(in) :: first(g1)               !< sample of each group
  integer(i4), intent(in) :: equations(u, g)         !< unknowns of the nodes of a group, those of the secondary surface first
  integer(i4), intent(in) :: indptr(n1), indices(nnz)
  real(dp), intent(inout) :: values(nnz)
  real(dp) :: matrix(u, u)
  integer(i4) :: offset(u)
  integer(i8) :: i
  integer :: j, e, runs, start(u), last(u)
  offset = 1
  do j = 1, g
    matrix = 0
    do i = first(j) + 1, first(j + 1)
      if (abs(normal_force(i)) <= 0 .and. all(abs(friction(:, i)) <= 0)) cycle
      associate (p => face(i) + 1)
        call add_stiffness(new_sample(own(:, i), shapes(:, :, p), loads(:, :, p), nodes(:, p), coordinates, natural(:, i)), &
                           int(d), int(u), gap(i), normal_force(i), friction(:, i), matrix)
      end associate
    end do
    call find_runs(equations(:, j), runs, start, last)
    do e = 1, u
      call add_row(matrix(:, e), equations(e, j), equations(:, j), start(:runs), last(:runs), offset, indptr, indices, values)
    end do
  end do
end subroutine host_contact_samples_stiffness
