! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Search for the nearest face of a contact surface, with bounds that avoid most projections.
module host_contact_search
  use host_kinds, only: dp, i8
  use host_contact_faces, only: rounding, foot_t, size_of, polynomial_of, evaluate, inside, project
  implicit none (type, external)
  private
  public :: surface_t, hit_t, new_surface, find_nearest, walk

  real(dp), parameter :: far = huge(1.0_dp)
  !> Rounding error of angles.
  real(dp), parameter :: rounded = 1e-6_dp

  !> Current faces of a surface: for each its polynomial, half of its size, its bounding box, the cone of its normals, and its
  !> ends as in `Pieces` of harness/uel/model/contact.py.
  type :: surface_t
    integer :: dimension
    real(dp) :: facing                 !< largest cosine between the normals of a point and of its face
    real(dp), allocatable :: polynomials(:, :, :), sizes(:), box_low(:, :), box_high(:, :), axes(:, :), angles(:)
    real(dp), allocatable :: low(:, :), high(:, :), total(:), reach_low(:, :), reach_high(:, :), reach_total(:)
  end type surface_t

  !> A face that a point may touch.
  type :: hit_t
    integer(i8) :: face                !< from 0
    real(dp) :: natural(2), within(2)  !< of the projection onto the extended face, and clipped to the face
    real(dp) :: distance               !< from the face; `far` if its normal does not face the point
    logical :: above                   !< the projection is in the reach of the face
  end type hit_t

contains

  !> Prepare a surface, but for its ends.
  pure subroutine new_surface(surface, shapes, nodes, coordinates)
    type(surface_t), intent(inout) :: surface       !< with the ends of its faces
    real(dp), intent(in), contiguous :: shapes(:, :, :)   !< (terms, nodes, faces) coefficients of the shape functions
    integer(i8), intent(in), contiguous :: nodes(:, :)   !< from 0
    real(dp), intent(in), contiguous :: coordinates(:, :)
    real(dp) :: corners(size(coordinates, 1), size(nodes, 1))
    integer :: p, count, terms
    terms = size(shapes, 1)
    count = size(nodes, 2)
    surface%dimension = size(coordinates, 1)
    allocate (surface%polynomials(3, terms, count), surface%sizes(count), surface%angles(count))
    allocate (surface%box_low(3, count), surface%box_high(3, count), surface%axes(3, count))
    do p = 1, count
      surface%polynomials(:, :, p) = polynomial_of(shapes(:, :, p), nodes(:, p), coordinates)
      corners = coordinates(:, nodes(:, p) + 1)
      call bound(surface, p, corners)
    end do
  end subroutine new_surface

  !> Size, box and cone of a face.
  pure subroutine bound(surface, p, corners)
    type(surface_t), intent(inout) :: surface
    integer, intent(in) :: p
    real(dp), intent(in), contiguous :: corners(:, :)
    type(foot_t) :: foot
    real(dp) :: box(3, 2), normals(3, 4), natural(size(surface%low, 1)), least
    integer :: k, terms, along, ends
    terms = size(surface%polynomials, 2)
    along = size(surface%low, 1)
    box = 0
    box(:size(corners, 1), 1) = minval(corners, dim=2)
    box(:size(corners, 1), 2) = maxval(corners, dim=2)
    surface%sizes(p) = size_of(corners)
    surface%box_low(:, p) = box(:, 1) - beyond(terms)*(box(:, 2) - box(:, 1))
    surface%box_high(:, p) = box(:, 2) + beyond(terms)*(box(:, 2) - box(:, 1))
    ends = 2**along
    do k = 1, ends
      natural(1) = merge(surface%high(1, p), surface%low(1, p), btest(k, 0))
      if (along == 2) natural(2) = merge(surface%high(2, p), surface%low(2, p), btest(k, 1))
      foot = evaluate(surface%polynomials(:, :, p), surface%dimension, natural)
      normals(:, k) = foot%normal
    end do
    surface%axes(:, p) = sum(normals(:, :ends), dim=2)
    surface%axes(:, p) = surface%axes(:, p)/max(sqrt(sum(surface%axes(:, p)**2)), rounding)
    least = minval(matmul(surface%axes(:, p), normals(:, :ends)))
    surface%angles(p) = far
    ! normals of curved faces may be outside the cone of the corners
    if (least > rounding .and. terms <= 4) surface%angles(p) = acos(min(max(least, -1.0_dp), 1.0_dp))
  end subroutine bound

  !> Largest distance of a face from the bounding box of its nodes, over the box size: the largest sum of negative shape functions,
  !> -1/8 on a quadratic line and 4 times -1/4 at the centre of a quadratic quadrilateral.
  pure function beyond(terms) result(share)
    integer, intent(in) :: terms
    real(dp) :: share
    select case (terms)
    case (3)
      share = 0.125_dp
    case (4)
      share = 0
    case default
      share = 1
    end select
  end function beyond

  !> Find the nearest one of some faces, the first of equally near ones.
  !>
  !> The face with the nearest box is tried first, others only if their boxes are not farther than this face.
  pure function find_nearest(surface, point, outward, candidates) result(hit)
    type(surface_t), intent(in) :: surface
    real(dp), intent(in) :: point(3)
    real(dp), intent(in) :: outward(3)           !< normal that the face must face; zero: any face
    integer(i8), intent(in), contiguous :: candidates(:)   !< from 0
    type(hit_t) :: hit
    type(hit_t) :: hits(size(candidates))
    real(dp) :: least(size(candidates)), margin(size(candidates)), nearest
    integer :: c, first
    do c = 1, size(candidates)
      associate (p => candidates(c) + 1)
        least(c) = sqrt(sum(max(surface%box_low(:, p) - point, point - surface%box_high(:, p), 0.0_dp)**2))
        margin(c) = rounding*surface%sizes(p)
        hits(c)%distance = far
      end associate
    end do
    do
      first = minloc(least, dim=1)
      if (least(first) >= far) exit
      if (.not. looks_away(surface, candidates(first) + 1, outward)) exit
      least(first) = far
    end do
    hits(first) = reach(surface, candidates(first), point, outward)
    nearest = hits(first)%distance
    do c = 1, size(candidates)
      if (any(candidates(:c - 1) == candidates(c)) .or. candidates(c) == candidates(first)) cycle
      ! twice the margin, for rounding; if no candidate faces the point: the first one
      if (.not. (c == 1 .and. hits(first)%distance >= far)) then
        if (least(c) >= far .or. least(c) > hits(first)%distance + 2*margin(c)) cycle
        if (looks_away(surface, candidates(c) + 1, outward)) cycle
      end if
      hits(c) = reach(surface, candidates(c), point, outward)
      nearest = min(nearest, hits(c)%distance)
    end do
    ! at coordinates that are NaN
    hit = hits(first)
    do c = 1, size(candidates)
      if (.not. hits(c)%distance <= nearest + margin(c)) cycle
      hit = hits(c)
      exit
    end do
  end function find_nearest

  !> No normal of the face faces the point.
  pure function looks_away(surface, p, outward) result(away)
    type(surface_t), intent(in) :: surface
    integer(i8), intent(in) :: p                 !< from 1
    real(dp), intent(in) :: outward(3)
    logical :: away
    real(dp) :: cosine
    away = any(abs(outward) > 0) .and. surface%angles(p) < far
    if (away) then
      cosine = dot_product(surface%axes(:, p), outward)
      away = acos(min(max(cosine, -1.0_dp), 1.0_dp)) + surface%angles(p) < acos(surface%facing) - rounded
    end if
  end function looks_away

  !> Projection onto a face.
  pure function reach(surface, face, point, outward) result(hit)
    type(surface_t), intent(in) :: surface
    integer(i8), intent(in) :: face              !< from 0
    real(dp), intent(in) :: point(3), outward(3)
    type(hit_t) :: hit
    type(foot_t) :: foot
    integer :: a
    a = size(surface%low, 1)
    hit%face = face
    hit%natural = 0
    hit%within = 0
    associate (p => face + 1)
      hit%natural(:a) = project(surface%polynomials(:, :, p), surface%low(:, p), surface%high(:, p), point)
      hit%within(:a) = inside(hit%natural(:a), surface%low(:, p), surface%high(:, p), surface%total(p))
      foot = evaluate(surface%polynomials(:, :, p), surface%dimension, hit%within(:a))
      hit%distance = sqrt(sum((point - foot%at)**2))
      if (any(abs(outward) > 0) .and. dot_product(foot%normal, outward) > surface%facing) hit%distance = far
      hit%above = all(hit%natural(:a) >= surface%reach_low(:, p) - rounding) .and. &
        all(hit%natural(:a) <= surface%reach_high(:, p) + rounding) .and. &
        sum(hit%natural(:a)) <= surface%reach_total(p) + rounding .and. hit%distance < far
    end associate
  end function reach

  !> Go from a face to the nearest of its neighbours until it is itself the nearest.
  pure function walk(surface, point, outward, start, ring, most) result(hit)
    type(surface_t), intent(in) :: surface
    real(dp), intent(in) :: point(3), outward(3)
    integer(i8), intent(in) :: start             !< from 0
    integer(i8), intent(in), contiguous :: ring(:, :)   !< neighbours of each face
    integer, intent(in) :: most                  !< faces that are passed
    type(hit_t) :: hit
    integer(i8) :: last
    integer :: step
    last = start
    do step = 1, most
      hit = find_nearest(surface, point, outward, [last, ring(:, last + 1)])
      if (hit%face == last) exit
      last = hit%face
    end do
  end function walk
end module host_contact_search
