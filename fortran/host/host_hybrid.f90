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
!> Other materials, which are compressible, have the mean stress of their points projected on the functions: the pressure that is
!> eliminated, for a bulk modulus that is the same in the element.
module host_hybrid
  use core_small_matrix, only: invert_general
  use host_kinds, only: dp
  use host_shape, only: rule_t
  implicit none (type, external)
  private
  public :: pressure_t, begin_pressure, mean_stress, add_compatibility, smoothing_t, begin_smoothing, keep_point, &
            keep_temperature, smooth, smooth_by_temperature, mean_stress_added, smoothing_change

  type :: pressure_t
    real(dp) :: volume = 0                         !< of the element before any displacement
    real(dp), allocatable :: functions(:, :)       !< (functions, points)
    real(dp), allocatable :: factors(:)            !< the unknowns
    real(dp), allocatable :: added(:)              !< their changes by a perturbation, for the matrix of its stress
    real(dp), allocatable :: residual(:)           !< theirs: mean differences of the changes of volume
    real(dp), allocatable :: by_displacements(:, :)   !< (unknowns of the nodes, functions) its derivatives
    real(dp), allocatable :: by_factors(:, :)      !< (functions, functions)
  end type pressure_t

  type :: smoothing_t
    real(dp), allocatable :: projection(:, :)      !< on the functions: values at all points by those of what is projected
    real(dp), allocatable :: mean(:), weight(:), strain(:)    !< of the points: mean stresses, volumes now, volume strains
    real(dp), allocatable :: change(:)             !< of the mean stresses by the projection
    real(dp), allocatable :: by_displacements(:, :), rate(:, :)   !< derivatives of volume strains and mean stresses
    real(dp), allocatable :: by_temperatures(:, :)   !< (corners, points) derivatives of the mean stresses, if they have any
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
    real(dp), dimension(functions, rule%points) :: values, weighted
    real(dp) :: inverse(functions, functions)
    logical :: good
    values = pressure_functions(rule, functions, x)
    weighted = values*spread(initial, 1, functions)
    ! regular wherever the element is not inside out
    call invert_general(matmul(weighted, transpose(values)), inverse, good)
    this%projection = matmul(transpose(values), matmul(inverse, weighted))
    allocate (this%mean(rule%points), this%weight(rule%points), this%strain(rule%points), this%change(rule%points))
    allocate (this%by_displacements(unknowns, rule%points), this%rate(unknowns, rule%points))
  end subroutine begin_smoothing

  !> Keep a point with its volume now, its mean stress, the volume strain of that, and its derivatives by the strains: in large
  !> displacements those of the mean stress times the volume.
  pure subroutine keep_point(this, point, weight, direct, finite, of_point, b)
    type(smoothing_t), intent(inout) :: this
    integer, intent(in) :: point, direct
    logical, intent(in) :: finite
    real(dp), intent(in) :: weight, of_point(:), b(:, :)
    this%weight(point) = weight
    this%mean(point) = of_point(1)
    this%strain(point) = of_point(2)
    this%by_displacements(:, point) = sum(b(:, :direct), 2)
    this%rate(:, point) = matmul(b, of_point(3:))
    if (finite) this%rate(:, point) = this%rate(:, point) - of_point(1)*this%by_displacements(:, point)
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

  !> What the projection changes of the mean stresses of all points.
  pure function smoothing_change(this) result(change)
    type(smoothing_t), intent(in) :: this
    real(dp) :: change(size(this%mean))
    change = matmul(this%projection, this%mean) - this%mean
  end function smoothing_change

  !> Add what the projection changes of the mean stresses to the forces and, but for the change of the forces of a given
  !> pressure, to the tangent.
  pure subroutine smooth(this, force, stiffness)
    type(smoothing_t), intent(inout) :: this
    real(dp), intent(inout) :: force(:), stiffness(:, :)
    real(dp) :: weighted(size(this%rate, 1), size(this%rate, 2))
    this%change = smoothing_change(this)
    weighted = this%by_displacements*spread(this%weight, 1, size(weighted, 1))
    force = force + matmul(weighted, this%change)
    stiffness = stiffness + matmul(weighted, matmul(this%projection, transpose(this%rate)) - transpose(this%rate))
  end subroutine smooth

  !> Add what the projection changes of the derivatives of the forces by the temperatures of the corners.
  pure subroutine smooth_by_temperature(this, tangent)
    type(smoothing_t), intent(in) :: this
    real(dp), intent(inout) :: tangent(:, :)     !< (displacements, corners)
    real(dp) :: weighted(size(this%rate, 1), size(this%rate, 2))
    if (.not. allocated(this%by_temperatures)) return
    weighted = this%by_displacements*spread(this%weight, 1, size(weighted, 1))
    associate (rate => transpose(this%by_temperatures))
      tangent = tangent + matmul(weighted, matmul(this%projection, rate) - rate)
    end associate
  end subroutine smooth_by_temperature
end module host_hybrid
