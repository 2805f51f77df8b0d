! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> What UMAT and HETVAL add to a coupled temperature-displacement element: the heat (RPL, FLUX) that they generate at the points,
!> and the derivatives DRPLDT, DRPLDE, DDSDDT and FLUX(2) for the tangent (User Subroutines Guide, UMAT, HETVAL).
!>
!> The temperature of a point is that between the corners, in elements with middle nodes too (Analysis User's Guide,
!> Coupled temperature-displacement elements). Thermal strain is that of the mean of the corners in elements with straight edges,
!> as the manual says; it leaves open whether UMAT is given this mean too: here every point has its own temperature.
!>
!> And what temperatures that are given make at a point of any element: its temperature, and its thermal strain.
module host_coupling
  use host_expansion, only: expansion_t, free_strain, free_strain_rate
  use host_kinds, only: dp
  use host_kinematics, only: gradients
  use host_point, only: heat_t, point_t, prepare_fields
  use host_shape, only: is_quadratic, rule_t
  implicit none (type, external)
  private
  public :: coupling_t, interpolate_fields, find_shape, set_temperature, add_heat_source, add_thermal_strain, thermal_strain, &
            shares

  !> Corners of an element: their temperatures, and their part of its equations. The arrays belong to the caller.
  type :: coupling_t
    real(dp), pointer :: temperature(:) => null()   !< at the end of the increment
    real(dp), pointer :: increment(:) => null()
    real(dp), pointer :: heat(:) => null()          !< that flows into the corners
    !> Tangent of all unknowns, temperatures behind the displacements; the part of the displacements alone stays.
    real(dp), pointer :: tangent(:, :) => null()
    !> Points of the integrals over temperatures, of the shape and of the temperatures.
    type(rule_t), pointer :: geometry => null(), field => null()
    real(dp) :: shape(8) = 0                        !< of the temperatures, in the point of find_shape
  end type coupling_t

contains

  !> Temperature and field variables of a point; of the latter as many as the material has, at least.
  subroutine interpolate_fields(rule, p, fields, predef, least, point)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: p, fields, least       !< p: integration point
    real(dp), intent(in) :: predef(2, fields, rule%nodes)
    type(point_t), intent(inout) :: point
    integer :: k
    call prepare_fields(point, max(fields - 1, least + 1))
    do k = 1, fields - 1
      point%fields(k, 2) = dot_product(predef(2, k, :), rule%n(:, p))
      point%fields(k, 1) = dot_product(predef(1, k, :), rule%n(:, p)) - point%fields(k, 2)
    end do
  end subroutine interpolate_fields

  !> Thermal strain at the start and at the end of the increment, and its derivative by the temperature there.
  function thermal_strain(rule, point, fields, expansion, predef, interpolated, rate, coupling) result(strain)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: point, fields
    type(expansion_t), intent(in) :: expansion
    real(dp), intent(in) :: predef(2, fields, rule%nodes)
    logical, intent(in) :: interpolated   !< as in `shares`
    real(dp), intent(out) :: rate(6)
    type(coupling_t), intent(in), optional :: coupling
    real(dp) :: strain(6, 2), initial, last, before
    associate (share => shares(rule, point, interpolated, coupling))
      initial = dot_product(predef(1, fields, :size(share)), share)
      if (present(coupling)) then
        last = dot_product(coupling%temperature, share)
        before = last - dot_product(coupling%increment, share)
      else
        last = dot_product(predef(1, 1, :), share)
        before = last - dot_product(predef(2, 1, :), share)
      end if
    end associate
    strain(:, 1) = free_strain(expansion, before, initial)
    strain(:, 2) = free_strain(expansion, last, initial)
    rate = free_strain_rate(expansion, last)
  end function thermal_strain

  !> Shares of the temperatures of nodes, or of corners with a coupling, in that of thermal strain: the mean in elements with
  !> straight edges, unless they have incompatible modes or are beams (interpolated); else those of interpolation.
  function shares(rule, point, interpolated, coupling)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: point
    logical, intent(in) :: interpolated
    type(coupling_t), intent(in), optional :: coupling
    real(dp), allocatable :: shares(:)
    if (.not. (is_quadratic(rule) .or. interpolated)) then
      allocate (shares(rule%nodes), source=1.0_dp/rule%nodes)
    else if (present(coupling)) then
      shares = coupling%shape(:size(coupling%temperature))
    else
      shares = rule%n(:, point)
    end if
  end function shares

  !> Find the shape of the temperatures in a point. The only point of an element stands for all of it, and has the mean.
  subroutine find_shape(coupling, direct, points, point, x)
    type(coupling_t), intent(inout) :: coupling
    integer, intent(in) :: direct, points, point   !< points: of the stresses
    real(dp), intent(in) :: x(:, :)             !< (dimension, nodes) of the present shape
    real(dp) :: g(size(x, 2), direct), volume, total
    integer :: corners, p
    corners = size(coupling%temperature)
    if (coupling%field%points == points) then
      coupling%shape(:corners) = coupling%field%n(:, point)
    else
      total = 0
      coupling%shape = 0
      do p = 1, coupling%field%points
        call gradients(coupling%geometry, direct, p, x, g, volume)
        coupling%shape(:corners) = coupling%shape(:corners) + volume*coupling%field%n(:, p)
        total = total + volume
      end do
      coupling%shape = coupling%shape/total
    end if
  end subroutine find_shape

  !> Give UMAT the temperature of a point, at the start of the increment and its change.
  subroutine set_temperature(coupling, point)
    type(coupling_t), intent(in) :: coupling
    type(point_t), intent(inout) :: point
    integer :: corners
    corners = size(coupling%temperature)
    point%fields(1, 2) = dot_product(coupling%increment, coupling%shape(:corners))
    point%fields(1, 1) = dot_product(coupling%temperature, coupling%shape(:corners)) - point%fields(1, 2)
  end subroutine set_temperature

  !> Add what thermal strain does to the tangent: the mechanical strain of a point falls by `rate` with its temperature, in which
  !> the corners have these shares.
  subroutine add_thermal_strain(coupling, volume, b, heat, stress_by_temperature, rate, shares)
    type(coupling_t), intent(inout) :: coupling
    type(heat_t), intent(in) :: heat          !< terms of UMAT
    real(dp), intent(in) :: volume
    real(dp), intent(in) :: b(:, :)           !< (displacements, strains)
    real(dp), intent(in) :: stress_by_temperature(:), shares(:)
    real(dp), intent(in) :: rate(:)           !< of all strains of UMAT
    real(dp) :: force(size(b, 1)), source
    integer :: j, n
    n = size(b, 1)
    force = matmul(b, stress_by_temperature)
    source = dot_product(heat%source_by_strain(:size(rate)), rate)
    associate (shape => coupling%shape(:size(shares)), k => coupling%tangent)
      do j = 1, size(shares)
        k(:n, n + j) = k(:n, n + j) + volume*shares(j)*force
        k(n + 1:, n + j) = k(n + 1:, n + j) + volume*shares(j)*source*shape
      end do
    end associate
  end subroutine add_thermal_strain

  !> Add the heat source of a point, as UMAT and HETVAL left it.
  subroutine add_heat_source(coupling, volume, b, heat, component)
    type(coupling_t), intent(inout) :: coupling
    type(heat_t), intent(in) :: heat
    real(dp), intent(in) :: volume
    real(dp), intent(in) :: b(:, :)           !< (displacements, strains)
    integer, intent(in) :: component(:)       !< of the stresses of UMAT, that of each strain
    integer :: i, j, n, corners
    n = size(b, 1)
    corners = size(coupling%heat)
    associate (shape => coupling%shape, k => coupling%tangent)
      coupling%heat = coupling%heat + volume*heat%source*shape(:corners)
      do j = 1, corners
        do i = 1, corners
          k(n + i, n + j) = k(n + i, n + j) - volume*heat%source_by_temperature*shape(i)*shape(j)
        end do
        do i = 1, n
          k(n + j, i) = k(n + j, i) - volume*shape(j)*dot_product(b(i, :), heat%source_by_strain(component))
          k(i, n + j) = k(i, n + j) + volume*shape(j)*dot_product(b(i, :), heat%stress_by_temperature(component))
        end do
      end do
    end associate
  end subroutine add_heat_source
end module host_coupling
