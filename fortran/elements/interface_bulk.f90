! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What a stabilised interface takes from the bulk on both sides: the weighted stress <sigma>.n, and beta and gamma from its
!> stiffness.
module elements_interface_bulk
  use core_kinds, only: dp
  use core_quadrature, only: gauss_rule, gauss_abscissa, outer_abscissa
  use core_serendipity, only: quad_places
  use core_status, only: status_type, ok
  use cohesive_shear, only: mode_of
  use materials_spectral_norm, only: spectral_norm
  use elements_bulk_solid, only: solid_traction, solid_size, solid_face_eigenvalue
  use elements_interface_faces, only: interface_place, measure_interface
  implicit none(type, external)
  private
  public :: stabilisation_type, nitsche_parameters, stabilise, bulk_operator
  public :: sample_middle, sample_face, sample_gauss

  !> Where to take the bulk stress: where it is most accurate along the face (in its middle, or in quadratic elements on the line
  !> through two points, in space bilinear through four), on the face at the point, or at the nearest Gauss point of the element. In
  !> linear elements the stress varies spuriously along the face; only the first option avoids this.
  integer, parameter :: sample_middle = 0
  integer, parameter :: sample_face = 1
  integer, parameter :: sample_gauss = 2

  !> Points of an element that stand for a place on its face, at most.
  integer, parameter :: most_samples = 4

  !> Last parent coordinate of the interface in the element below and in that above.
  real(dp), parameter :: face_of_side(2) = [1.0_dp, -1.0_dp]

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
  !> The complete form takes the bound of the traction that acts too, where that is greater than on the face itself.
  pure subroutine stabilise(given, sampling, dim, nodes, points, faces, coordinates, stiffness, used, status)
    type(stabilisation_type), intent(in) :: given
    integer, intent(in) :: sampling
    integer, intent(in) :: dim
    integer, intent(in) :: nodes                        !< of the element on a side
    integer, intent(in) :: points                       !< integration points
    integer, intent(in) :: faces(:, :)                  !< nodes of the bottom and the top face, a column each
    real(dp), intent(in) :: coordinates(dim, 2*nodes)   !< original coordinates, length
    real(dp), intent(in) :: stiffness(:, :, :)          !< D of bottom and top, stress
    type(stabilisation_type), intent(out) :: used
    type(status_type), intent(out) :: status            !< inside_out: item 1 for the bottom element, 2 for the top one
    type(interface_place) :: places(points)
    real(dp) :: samples(dim, most_samples, points), shares(most_samples, points), frames(3, 3, points), solid(dim, nodes), measure
    real(dp) :: bounds(2, 2), bound(2), joint, greatest
    integer :: side, k, i

    used = given
    call measure_interface(dim, size(faces, 1), points, coordinates(:, faces(:, 1)), coordinates(:, faces(:, 2)), gauss_rule, &
      places, status)
    if (status%code /= ok) return
    do k = 1, points
      frames(:, :, k) = places(k)%frame
    end do
    bounds = 0.0_dp
    greatest = 1.0_dp
    do side = 1, 2
      solid = coordinates(:, (side - 1)*nodes + 1:side*nodes)
      if (given%local) then
        do i = 1, merge(2, 1, given%complete .and. sampling /= sample_face)
          do k = 1, points
            call sample(merge(sample_face, sampling, i == 1), dim, nodes, places(k)%parent, face_of_side(side), samples(:, :, k), &
              shares(:, k))
          end do
          call solid_face_eigenvalue(dim, nodes, solid, points, samples, shares, frames, places%area, stiffness(:, :, side), &
            bound, joint, status)
          if (status%code /= ok) exit
          bounds(:, side) = max(bounds(:, side), bound)
          if (given%complete) greatest = max(greatest, joint)
        end do
      else
        call solid_size(dim, nodes, solid, measure, status)
        if (status%code == ok) bounds(:, side) = spectral_norm(stiffness(:, :, side))*sum(places%area)/measure
      end if
      if (status%code /= ok) then
        status%item = side
        return
      end if
    end do
    used = nitsche_parameters(given, bounds, greatest)
  end subroutine stabilise

  !> B: the matrix that takes the displacements of both elements to <sigma>.n = gamma_1 sigma_1.n + gamma_2 sigma_2.n of (18)
  !> in the components of the frame at a point of the interface.
  pure subroutine bulk_operator(sampling, dim, place, gamma_bottom, nodes, stiffness, coordinates, matrix, status)
    integer, intent(in) :: sampling
    integer, intent(in) :: dim
    type(interface_place), intent(in) :: place
    real(dp), intent(in) :: gamma_bottom(2)             !< (tau, n)
    integer, intent(in) :: nodes                        !< of the element on a side
    real(dp), intent(in) :: stiffness(:, :, :)          !< D of bottom and top, stress
    real(dp), intent(in) :: coordinates(dim, 2*nodes)
    real(dp), intent(out) :: matrix(dim, 2*dim*nodes)
    type(status_type), intent(out) :: status            !< inside_out: item 1 for the bottom element, 2 for the top one
    real(dp) :: weights(2, 2), points(dim, most_samples), shares(most_samples), part(dim, dim*nodes)
    integer :: side, i, j, first

    matrix = 0.0_dp
    weights(:, 1) = gamma_bottom
    weights(:, 2) = 1.0_dp - gamma_bottom
    do side = 1, 2
      call sample(sampling, dim, nodes, place%parent, face_of_side(side), points, shares)
      first = dim*nodes*(side - 1)
      do i = 1, most_samples
        if (.not. abs(shares(i)) > 0.0_dp) cycle
        call solid_traction(dim, nodes, coordinates(:, (side - 1)*nodes + 1:side*nodes), points(:, i), place%frame, &
          stiffness(:, :, side), part, status)
        if (status%code /= ok) then
          status%item = side
          return
        end if
        do j = 1, dim
          matrix(j, first + 1:first + dim*nodes) = matrix(j, first + 1:first + dim*nodes) &
            + (weights(mode_of(j), side)*shares(i))*part(j, :)
        end do
      end do
    end do
  end subroutine bulk_operator

  !> Points of an element whose stresses, in these shares, stand for a position on its face: the face itself, the nearest Gauss
  !> point, or where the stress of the face is most accurate (Barlow 1976): the middle in linear elements, the line through
  !> xi = +-1/sqrt(3) in the eight-node quad, the bilinear function through xi, eta = +-1/sqrt(3) in the brick of 20 nodes.
  pure subroutine sample(sampling, dim, nodes, parent, face, points, shares)
    integer, intent(in) :: sampling, dim, nodes
    real(dp), intent(in) :: parent(2)            !< of the position
    real(dp), intent(in) :: face                 !< last parent coordinate of the face
    real(dp), intent(out) :: points(dim, most_samples), shares(most_samples)
    logical :: linear
    integer :: i

    linear = nodes == 2**dim
    shares = 0.0_dp
    shares(1) = 1.0_dp
    do i = 1, dim - 1
      points(i, :) = parent(i)
    end do
    points(dim, :) = face
    select case (sampling)
    case (sample_face)
      return
    case (sample_gauss)
      if (linear) then
        points(1:dim - 1, 1) = sign(gauss_abscissa, parent(1:dim - 1))
        points(dim, 1) = gauss_abscissa*face
      else
        points(1:dim - 1, 1) = merge(sign(outer_abscissa, parent(1:dim - 1)), 0.0_dp, abs(parent(1:dim - 1)) > 0.5_dp)
        points(dim, 1) = outer_abscissa*face
      end if
    case default
      if (linear) then
        points(1:dim - 1, :) = 0.0_dp
      else
        shares(1:2**(dim - 1)) = 1.0_dp
        do i = 1, dim - 1
          points(i, :) = gauss_abscissa*quad_places(i, 1:most_samples)
          shares = shares*(0.5_dp*(1.0_dp + parent(i)*points(i, :)/gauss_abscissa**2))
        end do
      end if
    end select
  end subroutine sample

end module elements_interface_bulk
