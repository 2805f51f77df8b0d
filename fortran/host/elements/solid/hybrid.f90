! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The pressure of hybrid elements: an unknown of its own, constant or linear in the element.
!>
!> The work of a mean stress s on the difference of two changes of volume, that of the displacements J and that of the material
!> J(s), is added to the energy W of the changes of shape and U of those of volume (J.C. Simo, R.L. Taylor, K.S. Pister, Computer
!> Methods in Applied Mechanics and Engineering 51 (1985) 177; Abaqus Theory Guide, Hybrid incompressible solid element
!> formulation):
!>
!>     integral of W + s (J - J(s)) + U(J(s)) over the initial volume V,    U'(J(s)) = s
!>
!> It is stationary where forces are in equilibrium and, with each function of the pressure as weight, the mean of J - J(s) is
!> zero. Incompressible materials have J(s) = 1. Unknowns are the factors of the functions times V, so that their residuals are
!> strains: mean differences of J. In small displacements J - 1 is the volume strain.
!>
!> Other materials, which are compressible, have a pressure that is eliminated. With the stiffness D and the bulk modulus
!> K = I:D:I/9 of a point, the mean stress s = I:D:e/3 of its strain e, and a change t of its volume strain,
!>
!>     integral of W(e + t I/3) - p t over the volume
!>
!> is stationary where K t = p - s, so that p is the mean stress, and where p is s projected on the functions with the weight 1/K.
!> The stress is D:e + (p - s) D:I/(3K), which for isotropic materials replaces the mean stress and for anisotropic ones also
!> changes the shape that goes with it: forces are the derivatives of one energy, and their matrix is symmetric. Constant strains
!> need no change of volume. UMAT and UHYPER have p for the mean stress alone, with equal weights (Abaqus Analysis User's Guide,
!> User-defined mechanical material behavior: hybrid elements replace the pressure stress).
module host_hybrid
  use core_small_matrix, only: invert_general
  use host_kinds, only: dp
  use host_shape, only: rule_t
  implicit none (type, external)
  private
  public :: pressure_t, begin_pressure, mean_stress, add_compatibility, mean_response_t, smoothing_t, begin_smoothing, keep_point, &
            keep_temperature, smooth, smooth_by_temperature, mean_stress_added, smoothing_change

  type :: pressure_t
    real(dp) :: volume = 0                         !< of the element before any displacement
    real(dp), allocatable :: functions(:, :)       !< (functions, points)
    real(dp), allocatable :: factors(:)            !< the unknowns
    real(dp), allocatable :: added(:)              !< their changes by a perturbation, for the initial stress matrix
    real(dp), allocatable :: residual(:)           !< theirs: mean differences of the changes of volume
    real(dp), allocatable :: by_displacements(:, :)   !< (unknowns of the nodes, functions) its derivatives
    real(dp), allocatable :: by_factors(:, :)      !< (functions, functions)
  end type pressure_t

  !> A point whose pressure is eliminated; components are those of the strains of the element, in global directions.
  type :: mean_response_t
    real(dp) :: stress = 0             !< s
    real(dp) :: compressibility = 0    !< 1/K; 0 where the elastic energy does not follow from the stress
    real(dp) :: by_strains(6) = 0      !< derivatives of s
    real(dp) :: unit(6) = 0            !< stress by a unit of p - s: D:I/(3K)
    real(dp) :: unit_state(6) = 0      !< the same as SVARS hold it
    real(dp) :: work = 0               !< of a unit of p - s that has grown in the increment, per volume
  end type mean_response_t

  type :: smoothing_t
    real(dp), allocatable :: functions(:, :)       !< (functions, points)
    real(dp), allocatable :: initial(:), weight(:)   !< (points) volumes before any displacement, and now
    type(mean_response_t), allocatable :: mean(:)  !< (points)
    real(dp), allocatable :: change(:)             !< (points) p - s
    real(dp), allocatable :: force(:, :), rate(:, :)   !< (unknowns, points) forces by a unit of p - s; derivatives of s
    real(dp), allocatable :: by_temperatures(:, :)   !< (corners, points) derivatives of s, if it has any
  end type smoothing_t

contains

  !> 1, and of linear pressures the coordinates before any displacement, from the middle of the nodes, over the largest one.
  pure function pressure_functions(rule, count, x) result(functions)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: count                     !< 1, or one more than the dimension
    real(dp), intent(in) :: x(rule%dim, rule%nodes)
    real(dp) :: functions(count, rule%points), from_middle(rule%dim, rule%nodes)
    functions(1, :) = 1
    if (count == 1) return
    from_middle = x - spread(sum(x, 2)/rule%nodes, 2, rule%nodes)
    functions(2:, :) = matmul(from_middle, rule%n)/maxval(abs(from_middle))
  end function pressure_functions

  !> Begin the sums over the points, with the unknowns in factors; initial: volumes of its points before any displacement.
  pure subroutine begin_pressure(this, rule, x, initial)
    type(pressure_t), intent(inout) :: this
    type(rule_t), intent(in) :: rule
    real(dp), intent(in) :: x(rule%dim, rule%nodes), initial(rule%points)
    integer :: n
    n = size(this%factors)
    this%functions = pressure_functions(rule, n, x)
    this%volume = sum(initial)
    allocate (this%residual(n), this%by_displacements(rule%dim*rule%nodes, n), this%by_factors(n, n), source=0.0_dp)
  end subroutine begin_pressure

  !> Mean stress of a point.
  pure real(dp) function mean_stress(this, point)
    type(pressure_t), intent(in) :: this
    integer, intent(in) :: point
    mean_stress = dot_product(this%functions(:, point), this%factors)/this%volume
  end function mean_stress

  !> Its change by a perturbation.
  pure real(dp) function mean_stress_added(this, point)
    type(pressure_t), intent(in) :: this
    integer, intent(in) :: point
    mean_stress_added = dot_product(this%functions(:, point), this%added)/this%volume
  end function mean_stress_added

  !> Add a point with the change of its volume by the displacements, its derivatives, and the derivative of the change of volume
  !> of the material by the mean stress, times the initial volume of the point.
  pure subroutine add_compatibility(this, point, difference, by_displacements, by_mean_stress)
    type(pressure_t), intent(inout) :: this
    integer, intent(in) :: point
    real(dp), intent(in) :: difference               !< of the volumes by the displacements and of the material
    real(dp), intent(in) :: by_displacements(:), by_mean_stress
    integer :: i
    do i = 1, size(this%factors)
      associate (weight => this%functions(i, point)/this%volume)
        this%residual(i) = this%residual(i) + weight*difference
        this%by_displacements(:, i) = this%by_displacements(:, i) + weight*by_displacements
        this%by_factors(:, i) = this%by_factors(:, i) - weight*by_mean_stress/this%volume*this%functions(:, point)
      end associate
    end do
  end subroutine add_compatibility

  !> Begin an element with a pressure that is eliminated; initial: volumes of its points before any displacement.
  pure subroutine begin_smoothing(this, rule, functions, x, initial, unknowns)
    type(smoothing_t), intent(out) :: this
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: functions, unknowns       !< unknowns: of the element
    real(dp), intent(in) :: x(rule%dim, rule%nodes), initial(rule%points)
    this%functions = pressure_functions(rule, functions, x)
    this%initial = initial
    allocate (this%mean(rule%points), this%weight(rule%points))
    allocate (this%force(unknowns, rule%points), this%rate(unknowns, rule%points))
  end subroutine begin_smoothing

  !> Keep a point with its volume now and its strains by the unknowns. In large displacements derivatives are those of the mean
  !> stress times the volume.
  pure subroutine keep_point(this, point, weight, direct, finite, mean, b)
    type(smoothing_t), intent(inout) :: this
    integer, intent(in) :: point, direct
    logical, intent(in) :: finite
    real(dp), intent(in) :: weight, b(:, :)
    type(mean_response_t), intent(in) :: mean
    integer :: m
    m = size(b, 2)
    this%weight(point) = weight
    this%mean(point) = mean
    this%force(:, point) = weight*matmul(b, mean%unit(:m))
    this%rate(:, point) = matmul(b, mean%by_strains(:m))
    if (finite) this%rate(:, point) = this%rate(:, point) - mean%stress*sum(b(:, :direct), 2)
  end subroutine keep_point

  !> Keep how the mean stress of a point changes with its temperature, which is that of the corners by their shape functions.
  pure subroutine keep_temperature(this, point, mean_by_temperatures)
    type(smoothing_t), intent(inout) :: this
    integer, intent(in) :: point
    real(dp), intent(in) :: mean_by_temperatures(:)   !< (corners)
    if (.not. allocated(this%by_temperatures)) then
      allocate (this%by_temperatures(size(mean_by_temperatures), size(this%mean)), source=0.0_dp)
    end if
    this%by_temperatures(:, point) = mean_by_temperatures
  end subroutine keep_temperature

  !> Values of the pressure at all points by the mean stresses there.
  pure function projection_of(this) result(projection)
    type(smoothing_t), intent(in) :: this
    real(dp) :: projection(size(this%mean), size(this%mean))
    real(dp) :: weighted(size(this%functions, 1), size(this%mean)), inverse(size(this%functions, 1), size(this%functions, 1))
    logical :: good
    weighted = this%functions*spread(this%initial, 1, size(weighted, 1))
    if (all(this%mean%compressibility > 0)) then
      ! relative to the largest, so that no unit matters
      weighted = weighted*spread(this%mean%compressibility/maxval(this%mean%compressibility), 1, size(weighted, 1))
    end if
    ! regular wherever the element is not inside out
    call invert_general(matmul(weighted, transpose(this%functions)), inverse, good)
    projection = matmul(transpose(this%functions), matmul(inverse, weighted))
  end function projection_of

  !> Difference of the pressure and the mean stress of the strain, at all points.
  pure function smoothing_change(this) result(change)
    type(smoothing_t), intent(in) :: this
    real(dp) :: change(size(this%mean))
    change = matmul(projection_of(this), this%mean%stress) - this%mean%stress
  end function smoothing_change

  !> Add what the pressure changes of the forces and, but for the change of the forces of a given pressure, of the tangent.
  pure subroutine smooth(this, force, stiffness)
    type(smoothing_t), intent(inout) :: this
    real(dp), intent(inout) :: force(:), stiffness(:, :)
    this%change = smoothing_change(this)
    force = force + matmul(this%force, this%change)
    stiffness = stiffness + matmul(this%force, matmul(projection_of(this), transpose(this%rate)) - transpose(this%rate))
  end subroutine smooth

  !> Add what the pressure changes of the derivatives of the forces by the temperatures of the corners.
  pure subroutine smooth_by_temperature(this, tangent)
    type(smoothing_t), intent(in) :: this
    real(dp), intent(inout) :: tangent(:, :)     !< (displacements, corners)
    if (.not. allocated(this%by_temperatures)) return
    associate (rate => transpose(this%by_temperatures))
      tangent = tangent + matmul(this%force, matmul(projection_of(this), rate) - rate)
    end associate
  end subroutine smooth_by_temperature
end module host_hybrid
