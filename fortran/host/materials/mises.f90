! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Isotropic Mises plasticity with tabulated hardening, small strains, backward Euler.
!>
!> J.C. Simo, T.J.R. Hughes, Computational Inelasticity, Springer 1998: boxes 3.1, 3.2 (solid) and 3.3 (plane stress; with fewer
!> stresses, beams).
!> History of a point: plastic strain 11, 22, 33, 12, 13, 23 (engineering shear), equivalent plastic strain.
module host_mises
  use core_limit, only: exceeds
  use core_root, only: advance, root_search, search_between, searching
  use host_kinds, only: dp
  implicit none (type, external)
  private
  public :: mises_solid, mises_plane_stress, mises_beam, mises_uniaxial, yield_stress, trial_mises, returned_solid

contains

  !> Yield stress and its slope at an equivalent plastic strain; constant beyond the table.
  pure subroutine yield_stress(table, plastic, stress, slope)
    real(dp), intent(in) :: table(:, :)     !< (k, 2) yield stress, plastic strain, ascending
    real(dp), intent(in) :: plastic
    real(dp), intent(out) :: stress, slope
    integer :: i, k
    k = size(table, 1)
    stress = table(k, 1)
    slope = 0
    do i = 1, k - 1
      if (plastic >= table(i + 1, 2)) cycle
      slope = (table(i + 1, 1) - table(i, 1))/(table(i + 1, 2) - table(i, 2))
      stress = table(i, 1) + slope*(plastic - table(i, 2))
      return
    end do
  end subroutine yield_stress

  !> Plane strain (n = 4) and three dimensions (n = 6).
  pure subroutine mises_solid(young, poisson, table, n, old, strain, stress, tangent, new)
    real(dp), intent(in) :: young, poisson, table(:, :), old(7)
    integer, intent(in) :: n
    real(dp), intent(in) :: strain(n)
    real(dp), intent(out) :: stress(n), tangent(n, n), new(7)
    real(dp) :: q, flow, slope, multiplier
    q = trial_mises(young, poisson, n, old, strain)
    call yield_stress(table, old(7), flow, slope)
    multiplier = 0
    if (exceeds(q, flow)) call radial_return(table, old(7), q, 3*young/(2*(1 + poisson)), multiplier, slope)
    call returned_solid(young, poisson, n, old, strain, multiplier, slope, stress, tangent, new)
  end subroutine mises_solid

  !> Mises stress without any plastic strain in the increment.
  pure function trial_mises(young, poisson, n, old, strain) result(q)
    real(dp), intent(in) :: young, poisson, old(7)
    integer, intent(in) :: n
    real(dp), intent(in) :: strain(n)
    real(dp) :: q, deviator(n)
    deviator = trial_deviator(young, poisson, n, strain - old(1:n))
    q = sqrt(1.5_dp*(sum(deviator(1:3)**2) + 2*sum(deviator(4:n)**2)))
  end function trial_mises

  pure function trial_deviator(young, poisson, n, elastic) result(deviator)
    real(dp), intent(in) :: young, poisson
    integer, intent(in) :: n
    real(dp), intent(in) :: elastic(n)
    real(dp) :: deviator(n), shear
    shear = young/(2*(1 + poisson))
    deviator(1:3) = 2*shear*(elastic(1:3) - sum(elastic(1:3))/3)
    deviator(4:n) = shear*elastic(4:n)
  end function trial_deviator

  !> Stress and tangent in plane strain (n = 4) and three dimensions (n = 6) after an increment of the equivalent plastic strain
  !> (zero: elastic), at the end of which the yield stress has this slope.
  pure subroutine returned_solid(young, poisson, n, old, strain, multiplier, slope, stress, tangent, new)
    real(dp), intent(in) :: young, poisson, old(7), multiplier, slope
    integer, intent(in) :: n
    real(dp), intent(in) :: strain(n)
    real(dp), intent(out) :: stress(n), tangent(n, n), new(7)
    real(dp) :: shear, bulk, mean, q, theta, theta_bar, normal(n)
    integer :: i, j
    shear = young/(2*(1 + poisson))
    bulk = young/(3*(1 - 2*poisson))
    new = old
    mean = sum(strain(1:3) - old(1:3))/3
    stress = trial_deviator(young, poisson, n, strain - old(1:n))
    theta = 1
    theta_bar = 0
    normal = 0
    if (multiplier > 0) then
      q = trial_mises(young, poisson, n, old, strain)
      normal = stress/(q*sqrt(2.0_dp/3.0_dp))      ! of unit length
      theta = 1 - 3*shear*multiplier/q
      theta_bar = 1/(1 + slope/(3*shear)) - (1 - theta)
      stress = theta*stress
      new(1:3) = old(1:3) + sqrt(1.5_dp)*multiplier*normal(1:3)
      new(4:n) = old(4:n) + 2*sqrt(1.5_dp)*multiplier*normal(4:n)
      new(7) = old(7) + multiplier
    end if
    stress(1:3) = stress(1:3) + 3*bulk*mean
    do j = 1, n
      do i = 1, n
        tangent(i, j) = -2*shear*theta_bar*normal(i)*normal(j)
        if (i == j) tangent(i, j) = tangent(i, j) + merge(2*shear*theta, shear*theta, i <= 3)
        if (i <= 3 .and. j <= 3) tangent(i, j) = tangent(i, j) + bulk - 2*shear*theta/3
      end do
    end do
  end subroutine returned_solid

  !> Increment x of equivalent plastic strain: q - stiffness x - yield(plastic + x) = 0, exact on each line of the table.
  pure subroutine radial_return(table, plastic, q, stiffness, x, slope)
    real(dp), intent(in) :: table(:, :), plastic, q, stiffness
    real(dp), intent(out) :: x, slope
    real(dp) :: at_zero
    integer :: i, k
    k = size(table, 1)
    do i = 1, k - 1
      if (q - stiffness*(table(i + 1, 2) - plastic) > table(i + 1, 1) .or. table(i + 1, 2) <= plastic) cycle
      slope = (table(i + 1, 1) - table(i, 1))/(table(i + 1, 2) - table(i, 2))
      at_zero = table(i, 1) + slope*(plastic - table(i, 2))
      x = (q - at_zero)/(stiffness + slope)
      return
    end do
    slope = 0
    x = (q - table(k, 1))/stiffness
  end subroutine radial_return

  !> Plane stress: the return stays in the plane. If it does not converge, the response is elastic.
  pure subroutine mises_plane_stress(young, poisson, table, old, strain, stress, tangent, new, solved)
    real(dp), intent(in) :: young, poisson, table(:, :), old(7), strain(3)
    real(dp), intent(out) :: stress(3), tangent(3, 3), new(7)
    logical, intent(out) :: solved
    real(dp) :: shear, flow, slope, multiplier, trial(3), q, algorithmic(3, 3), flow_vector(3)
    shear = young/(2*(1 + poisson))
    new = old
    algorithmic = plane_modulus(young, poisson, shear, 0.0_dp)
    trial = matmul(algorithmic, strain - old([1, 2, 4]))
    stress = trial
    tangent = algorithmic
    q = sqrt(1.5_dp*dot_product(trial, projected(trial)))
    call yield_stress(table, old(7), flow, slope)
    solved = .true.
    if (.not. exceeds(q, flow)) return
    ! the return shrinks both parts of the squared Mises stress, each with its own rate
    call find_multiplier([(trial(1) + trial(2))**2/4, 0.75_dp*(trial(2) - trial(1))**2 + 3*trial(3)**2], &
                         [young/(3*(1 - poisson)), 2*shear], table, old(7), multiplier, q, slope, solved)
    if (.not. solved) return
    algorithmic = plane_modulus(young, poisson, shear, multiplier)
    stress = matmul(algorithmic, strain - old([1, 2, 4]))
    flow_vector = projected(stress)
    tangent = consistent(3, algorithmic, stress, flow_vector, multiplier, slope)
    new([1, 2, 4]) = old([1, 2, 4]) + multiplier*flow_vector
    new(3) = old(3) - multiplier*(flow_vector(1) + flow_vector(2))
    new(7) = old(7) + 2*multiplier*q/3
  end subroutine mises_plane_stress

  !> A normal stress and a shear stress with it (n = 2), or the normal stress alone (n = 1); all others are zero. If the return does
  !> not converge, the response is elastic.
  pure subroutine mises_beam(young, poisson, table, n, old, strain, stress, tangent, new, solved)
    real(dp), intent(in) :: young, poisson, table(:, :), old(7)
    integer, intent(in) :: n
    real(dp), intent(in) :: strain(n)
    real(dp), intent(out) :: stress(n), tangent(n, n), new(7)
    logical, intent(out) :: solved
    real(dp) :: moduli(2), rates(2), algorithmic(2, 2), flow_vector(2), flow, slope, multiplier, q
    solved = .true.
    new = old
    if (n == 1) then
      call mises_uniaxial(young, table, strain(1), new(1), new(7), stress(1), tangent(1, 1))
      new(2:3) = old(2:3) - (new(1) - old(1))/2
      return
    end if
    moduli = [young, young/(2*(1 + poisson))]
    rates = [2*moduli(1)/3, 2*moduli(2)]
    stress = moduli*(strain - old([1, 4]))
    tangent = diagonal(moduli)
    q = sqrt(stress(1)**2 + 3*stress(2)**2)
    call yield_stress(table, old(7), flow, slope)
    if (.not. exceeds(q, flow)) return
    call find_multiplier([stress(1)**2, 3*stress(2)**2], rates, table, old(7), multiplier, q, slope, solved)
    if (.not. solved) return
    algorithmic = diagonal(moduli/(1 + rates*multiplier))
    stress = matmul(algorithmic, strain - old([1, 4]))
    flow_vector = [2*stress(1)/3, 2*stress(2)]
    tangent = consistent(2, algorithmic, stress, flow_vector, multiplier, slope)
    new([1, 4]) = old([1, 4]) + multiplier*flow_vector
    new(2:3) = old(2:3) - multiplier*flow_vector(1)/2
    new(7) = old(7) + 2*multiplier*q/3
  end subroutine mises_beam

  !> One stress alone; its plastic strain and the equivalent plastic strain go from the start of the increment to its end.
  pure subroutine mises_uniaxial(young, table, strain, plastic, equivalent, stress, modulus)
    real(dp), intent(in) :: young, table(:, :), strain
    real(dp), intent(inout) :: plastic, equivalent
    real(dp), intent(out) :: stress, modulus
    real(dp) :: flow, hardening, increment
    stress = young*(strain - plastic)
    modulus = young
    call yield_stress(table, equivalent, flow, hardening)
    if (.not. exceeds(abs(stress), flow)) return
    call radial_return(table, equivalent, abs(stress), young, increment, hardening)
    plastic = plastic + sign(increment, stress)
    equivalent = equivalent + increment
    stress = young*(strain - plastic)
    modulus = young*hardening/(young + hardening)
  end subroutine mises_uniaxial

  !> Tangent of a return with some stresses zero (Simo and Hughes, box 3.3, without kinematic hardening).
  pure function consistent(n, algorithmic, stress, flow_vector, multiplier, slope) result(tangent)
    integer, intent(in) :: n
    real(dp), intent(in) :: algorithmic(n, n), stress(n), flow_vector(n), multiplier, slope
    real(dp) :: tangent(n, n), direction(n), beta
    direction = matmul(algorithmic, flow_vector)
    beta = 2*slope*dot_product(stress, flow_vector)/(3 - 2*slope*multiplier)
    tangent = algorithmic - spread(direction, 2, n)*spread(direction, 1, n)/(dot_product(flow_vector, direction) + beta)
  end function consistent

  pure function diagonal(values) result(matrix)
    real(dp), intent(in) :: values(2)
    real(dp) :: matrix(2, 2)
    matrix = 0
    matrix(1, 1) = values(1)
    matrix(2, 2) = values(2)
  end function diagonal

  !> Multiplier of the return: yield(plastic + 2/3 multiplier q) - q(multiplier) = 0. q falls at least as fast as with the smaller
  !> of its two rates, and is below the smallest yield stress from the upper end of the bracket on.
  pure subroutine find_multiplier(squares, rates, table, plastic, multiplier, q, slope, solved)
    real(dp), intent(in) :: squares(2)     !< parts of the squared Mises stress without any plastic strain in the increment
    real(dp), intent(in) :: rates(2)       !< of their shrinking
    real(dp), intent(in) :: table(:, :), plastic
    real(dp), intent(out) :: multiplier, q, slope
    logical, intent(out) :: solved
    type(root_search) :: search
    real(dp) :: rate, flow
    call returned(squares, rates, table, plastic, 0.0_dp, q, rate, flow, slope)
    search = search_between(0.0_dp, q/minval(table(:, 1))/minval(rates), 0.0_dp, geometric=.false.)
    do while (searching(search))
      call returned(squares, rates, table, plastic, search%x, q, rate, flow, slope)
      call advance(search, flow - q, slope*2*(q + search%x*rate)/3 - rate)
    end do
    multiplier = search%x
    solved = search%found
    call returned(squares, rates, table, plastic, multiplier, q, rate, flow, slope)
  end subroutine find_multiplier

  !> Mises stress q after a return by this multiplier, its derivative, and the yield stress with its slope.
  pure subroutine returned(squares, rates, table, plastic, multiplier, q, rate, flow, slope)
    real(dp), intent(in) :: squares(2), rates(2), table(:, :), plastic, multiplier
    real(dp), intent(out) :: q, rate, flow, slope
    real(dp) :: a, b
    a = squares(1)/(1 + rates(1)*multiplier)**2
    b = squares(2)/(1 + rates(2)*multiplier)**2
    q = sqrt(a + b)
    rate = -(a*rates(1)/(1 + rates(1)*multiplier) + b*rates(2)/(1 + rates(2)*multiplier))/q
    call yield_stress(table, plastic + 2*multiplier*q/3, flow, slope)
  end subroutine returned

  !> (C^-1 + multiplier P)^-1 of plane stress elasticity.
  pure function plane_modulus(young, poisson, shear, multiplier) result(modulus)
    real(dp), intent(in) :: young, poisson, shear, multiplier
    real(dp) :: modulus(3, 3), sum_part, difference
    ! both matrices have the eigenvectors (1, 1, 0), (1, -1, 0) and (0, 0, 1)
    sum_part = 1/((1 - poisson)/young + multiplier/3)
    difference = 1/(1/(2*shear) + multiplier)
    modulus = 0
    modulus(1, 1) = (sum_part + difference)/2
    modulus(2, 2) = modulus(1, 1)
    modulus(1, 2) = (sum_part - difference)/2
    modulus(2, 1) = modulus(1, 2)
    modulus(3, 3) = 1/(1/shear + 2*multiplier)
  end function plane_modulus

  !> P s, the deviator of a plane stress as a strain (engineering shear).
  pure function projected(s) result(p)
    real(dp), intent(in) :: s(3)
    real(dp) :: p(3)
    p = [(2*s(1) - s(2))/3, (2*s(2) - s(1))/3, 2*s(3)]
  end function projected
end module host_mises
