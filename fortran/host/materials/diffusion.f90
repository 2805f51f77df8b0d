! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The diffusion of one material through another: *DIFFUSIVITY, *SOLUBILITY and *KAPPA.
!>
!> With the normalized concentration phi = c/s the flux is J = -s D (grad phi + kappa_s grad ln(theta - theta_Z) + kappa_p grad p),
!> p the equivalent pressure stress (Abaqus Theory Guide, Mass diffusion analysis); by Fick's law it is -D (grad c + s kappa_p grad
!> p), which is the same with kappa_s = phi/s ds/d ln(theta - theta_Z).
module host_diffusion
  use host_kinds, only: dp
  use host_tables, only: interpolate
  use host_thermal, only: flow_t
  implicit none (type, external)
  private
  public :: diffusion_t, driven_t, diffusive_flow, solubility_at

  !> Tables have the concentration, but that of the solubility, and the temperature behind their constants.
  type :: diffusion_t
    logical :: fick = .false.                             !< LAW=FICK
    real(dp), allocatable :: diffusivity(:, :)            !< (8, k) D11, D12, D22, D13, D23, D33, in global directions
    real(dp), allocatable :: solubility(:, :)             !< (2, k)
    real(dp), allocatable :: soret(:, :), pressure(:, :)  !< (3, k) kappa_s, kappa_p; k = 0: none
    real(dp) :: absolute_zero = 0
    real(dp) :: axes(3, 3) = 0                            !< rows: directions in which fluxes are put out
  end type diffusion_t

  !> What drives the diffusion at a point.
  type :: driven_t
    real(dp) :: normalized = 0      !< concentration
    real(dp) :: gradient(3) = 0     !< of the normalized concentration
    real(dp) :: temperature = 0
    real(dp) :: warming(3) = 0      !< gradient of the temperature
    real(dp) :: pressing(3) = 0     !< gradient of the equivalent pressure stress
  end type driven_t

  integer, parameter :: rows(6) = [1, 1, 2, 1, 2, 3], columns(6) = [1, 2, 2, 3, 3, 3]

contains

  !> Solubility and its derivative by the temperature.
  pure subroutine solubility_at(law, temperature, value, slope)
    type(diffusion_t), intent(in) :: law
    real(dp), intent(in) :: temperature
    real(dp), intent(out) :: value, slope
    real(dp) :: values(1), slopes(1)
    call interpolate(1, 1, law%solubility, [temperature], values, slopes)
    value = values(1)
    slope = slopes(1)
  end subroutine solubility_at

  !> Flux of the concentration at a point, with its derivatives by the normalized concentration (in place of the temperature of
  !> heat) and its gradient. good is false if the temperature is not above absolute zero, where it has to be.
  pure subroutine diffusive_flow(law, dim, point, flow, good)
    type(diffusion_t), intent(in) :: law
    integer, intent(in) :: dim
    type(driven_t), intent(in) :: point
    type(flow_t), intent(out) :: flow
    logical, intent(out) :: good
    real(dp) :: d(3, 3), d_slope(3, 3), s, s_slope, c, force(dim), force_slope(dim), values(6), slopes(6), factor(1), change(1)
    integer :: k
    good = .true.
    call solubility_at(law, point%temperature, s, s_slope)
    c = s*point%normalized
    call interpolate(6, 2, law%diffusivity, [c, point%temperature], values, slopes)
    do k = 1, 6
      d(rows(k), columns(k)) = values(k)
      d(columns(k), rows(k)) = values(k)
      d_slope(rows(k), columns(k)) = slopes(k)
      d_slope(columns(k), rows(k)) = slopes(k)
    end do
    ! the force on the concentration, and its derivative by the normalized one
    force = s*point%gradient(:dim)
    force_slope = 0
    if (law%fick) then
      force = force + s_slope*point%normalized*point%warming(:dim)
      force_slope = s_slope*point%warming(:dim)
    else if (size(law%soret, 2) > 0) then
      good = point%temperature > law%absolute_zero
      if (.not. good) return
      call interpolate(1, 2, law%soret, [c, point%temperature], factor, change)
      associate (along => s*point%warming(:dim)/(point%temperature - law%absolute_zero))
        force = force + factor(1)*along
        force_slope = force_slope + s*change(1)*along
      end associate
    end if
    if (size(law%pressure, 2) > 0) then
      call interpolate(1, 2, law%pressure, [c, point%temperature], factor, change)
      force = force + s*factor(1)*point%pressing(:dim)
      force_slope = force_slope + s**2*change(1)*point%pressing(:dim)
    end if
    flow%flux(:dim) = -matmul(d(:dim, :dim), force)
    flow%flux_by_temperature(:dim) = -matmul(d(:dim, :dim), force_slope) - s*matmul(d_slope(:dim, :dim), force)
    flow%flux_by_gradient(:dim, :dim) = -s*d(:dim, :dim)
  end subroutine diffusive_flow
end module host_diffusion
