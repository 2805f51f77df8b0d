! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What a stabilised interface takes from the bulk on both sides: the weighted stress <sigma>.n, and beta and gamma from its
!> stiffness.
module elements_interface_bulk
  use core_kinds, only: dp
  use core_quadrature, only: gauss_rule, gauss_abscissa, outer_abscissa
  use core_status, only: status_type, ok
  use materials_spectral_norm, only: spectral_norm
  use elements_bulk_quad, only: quad_traction, quad_area, quad_face_eigenvalue
  use elements_interface_edges, only: interface_place, measure_interface
  implicit none(type, external)
  private
  public :: stabilisation_type, nitsche_parameters, stabilise, bulk_operator
  public :: sample_middle, sample_face, sample_gauss

  !> Where to take the bulk stress: where it is most accurate along the face (in its middle, or in eight-node quads on the line
  !> through two points), on the face at the xi of the point, or at the nearest Gauss point of the quad. In a quad the stress varies
  !> spuriously along xi; only the first option avoids this.
  integer, parameter :: sample_middle = 0
  integer, parameter :: sample_face = 1
  integer, parameter :: sample_gauss = 2

  !> eta of the interface in the quad below and in that above.
  real(dp), parameter :: eta_of_side(2) = [1.0_dp, -1.0_dp]

  !> Parameters of the stabilisation; a zero stands for (21) or (22), a negative
  !> beta for both from the local eigenvalue problem.
  type :: stabilisation_type
    real(dp) :: beta(2)        !< (tau, n), stress/length
    real(dp) :: gamma_bottom   !< weight of the bottom stress; that of the top is 1 - gamma_bottom
  end type stabilisation_type

contains

  !> Uses (21) and (22) where beta and gamma are not given: with the stiffness norm |D| and meas(Omega) of both sides,
  !>
  !>     gamma_1 = (meas(Omega_1)/|D_1|)/(meas(Omega_1)/|D_1| + meas(Omega_2)/|D_2|),    gamma_2 = 1 - gamma_1,
  !>     beta = 2 meas(Gamma) (|D_1| gamma_1**2/meas(Omega_1) + |D_2| gamma_2**2/meas(Omega_2)).
  pure function nitsche_parameters(given, norms, areas, length) result(used)
    type(stabilisation_type), intent(in) :: given
    real(dp), intent(in) :: norms(2)   !< |D| of bottom and top, stress
    real(dp), intent(in) :: areas(2)   !< meas(Omega) of bottom and top
    real(dp), intent(in) :: length     !< meas(Gamma)
    type(stabilisation_type) :: used
    real(dp) :: softness(2)

    used = given
    softness = areas/norms
    if (.not. given%gamma_bottom > 0.0_dp) used%gamma_bottom = softness(1)/(softness(1) + softness(2))
    where (.not. given%beta > 0.0_dp) used%beta = 2.0_dp*length &
      *(used%gamma_bottom**2/softness(1) + (1.0_dp - used%gamma_bottom)**2/softness(2))
  end function nitsche_parameters

  !> Beta and gamma of an interface that knows its two quads, the bottom one first among the nodes.
  pure subroutine stabilise(given, nodes, points, edges, coordinates, stiffness, used, status)
    type(stabilisation_type), intent(in) :: given
    integer, intent(in) :: nodes                        !< of a quad
    integer, intent(in) :: points                       !< nodes of an edge
    integer, intent(in) :: edges(points, 2)             !< nodes of the bottom and the top edge
    real(dp), intent(in) :: coordinates(2, 2*nodes)     !< original coordinates, length
    real(dp), intent(in) :: stiffness(3, 3, 2)          !< D of bottom and top, stress
    type(stabilisation_type), intent(out) :: used
    type(status_type), intent(out) :: status            !< inside_out: item 1 for the bottom quad, 2 for the top one
    type(interface_place) :: places(points)
    real(dp) :: areas(2), norms(2), frames(2, 2, points), quad(2, nodes), length
    integer :: side, k
    logical :: local

    used = given
    local = minval(given%beta) < 0.0_dp
    call measure_interface(points, coordinates(:, edges(:, 1)), coordinates(:, edges(:, 2)), gauss_rule, places, status)
    if (status%code /= ok) return
    do k = 1, points
      frames(:, :, k) = places(k)%frame
    end do
    length = sum(places%length)
    do side = 1, 2
      quad = coordinates(:, (side - 1)*nodes + 1:side*nodes)
      if (local) then
        ! lambda takes the place of |D| meas(Gamma)/meas(Omega)
        areas(side) = length
        call quad_face_eigenvalue(nodes, quad, eta_of_side(side), points, frames, places%length, stiffness(:, :, side), &
          norms(side), status)
      else
        norms(side) = spectral_norm(stiffness(:, :, side))
        call quad_area(nodes, quad, areas(side), status)
      end if
      if (status%code /= ok) then
        status%item = side
        return
      end if
    end do
    used = nitsche_parameters(given, norms, areas, length)
  end subroutine stabilise

  !> B: the matrix that takes the displacements of both quads to <sigma>.n = gamma_1 sigma_1.n + gamma_2 sigma_2.n of (18)
  !> in (tau, n) at a point of the interface.
  pure subroutine bulk_operator(sampling, place, gamma_bottom, nodes, stiffness, coordinates, matrix, status)
    integer, intent(in) :: sampling
    type(interface_place), intent(in) :: place
    real(dp), intent(in) :: gamma_bottom
    integer, intent(in) :: nodes                        !< of a quad
    real(dp), intent(in) :: stiffness(3, 3, 2)
    real(dp), intent(in) :: coordinates(2, 2*nodes)
    real(dp), intent(out) :: matrix(2, 4*nodes)
    type(status_type), intent(out) :: status            !< inside_out: item 1 for the bottom quad, 2 for the top one
    real(dp) :: weights(2), points(2, 2), shares(2), part(2, 2*nodes)
    integer :: side, i, first

    matrix = 0.0_dp
    weights = [gamma_bottom, 1.0_dp - gamma_bottom]
    do side = 1, 2
      call sample(sampling, nodes, place%s, eta_of_side(side), points, shares)
      first = 2*nodes*(side - 1)
      do i = 1, 2
        if (.not. abs(shares(i)) > 0.0_dp) cycle
        call quad_traction(nodes, coordinates(:, (side - 1)*nodes + 1:side*nodes), points(:, i), place%frame, &
          stiffness(:, :, side), part, status)
        if (status%code /= ok) then
          status%item = side
          return
        end if
        matrix(:, first + 1:first + 2*nodes) = matrix(:, first + 1:first + 2*nodes) + (weights(side)*shares(i))*part
      end do
    end do
  end subroutine bulk_operator

  !> Points (xi, eta) of a quad whose stresses, in these shares, stand for the position s on its edge: the edge itself, the nearest
  !> Gauss point, or where the stress of the edge is most accurate (Barlow 1976): the middle in a four-node quad, the line through
  !> xi = +-1/sqrt(3) in an eight-node one.
  pure subroutine sample(sampling, nodes, s, eta, points, shares)
    integer, intent(in) :: sampling, nodes
    real(dp), intent(in) :: s, eta
    real(dp), intent(out) :: points(2, 2), shares(2)

    points(1, :) = s
    points(2, :) = eta
    shares = [1.0_dp, 0.0_dp]
    select case (sampling)
    case (sample_face)
      return
    case (sample_gauss)
      if (nodes == 4) then
        points(1, :) = sign(gauss_abscissa, s)
        points(2, :) = gauss_abscissa*eta
      else
        points(1, :) = merge(sign(outer_abscissa, s), 0.0_dp, abs(s) > 0.5_dp)
        points(2, :) = outer_abscissa*eta
      end if
    case default
      if (nodes == 4) then
        points(1, :) = 0.0_dp
      else
        points(1, :) = [-gauss_abscissa, gauss_abscissa]
        shares = 0.5_dp*(1.0_dp + s*points(1, :)/gauss_abscissa**2)
      end if
    end select
  end subroutine sample

end module elements_interface_bulk
