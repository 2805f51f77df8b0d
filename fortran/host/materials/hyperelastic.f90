! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Hyperelasticity: stress and tangent from the deformation gradient F. With preferred directions host_anisotropic gives them.
!>
!> The strain energy per initial volume is that of Abaqus (Theory Guide, Hyperelastic material behavior): W of the stretches
!> less the change of volume J = det F, and U(J). With e the logarithms of the principal stretches, h and H the derivatives of W
!> by e, and P the projector on changes of shape, the principal Kirchhoff stresses are P h + J U' and their derivatives by e
!> P H P + J U' + J^2 U''. UHYPER gives an energy of both, with mixed derivatives. Tangents are those of the Jaumann rate of the
!> Kirchhoff stress over J, as DDSDDE of UMAT (R.W. Ogden, Non-linear elastic deformations, 1984, section 6.1).
module host_hyperelastic
  use core_small_matrix, only: determinant
  use core_symmetric, only: eigenvalues
  use host_anisotropic, only: anisotropic_stress, anisotropic_t
  use host_kinds, only: dp
  use host_point, only: point_t
  use host_uhyper, only: call_uhyper, user_potential_t
  implicit none (type, external)
  private
  public :: hyperelastic_t, add_principal, calls_user, energy_at, hyperelastic_stress, highest_order, outer, principal, &
            shape_energy, state_variables, symmetric_dyad, volume_energy, volume_of

  integer, parameter :: highest_order = 6

  type :: hyperelastic_t
    real(dp) :: polynomial(0:highest_order, 0:highest_order) = 0   !< of (I1 - 3)^i (I2 - 3)^j, without 0, 0
    real(dp) :: ogden(2, highest_order) = 0                        !< mu and alpha; mu = 0: no term
    real(dp) :: volumetric(highest_order) = 0                      !< 1/D of (J - 1)^2i
    logical :: logarithmic = .false.                               !< U = volumetric(1) ((J^2 - 1)/2 - ln J)
    type(user_potential_t), allocatable :: user                    !< of UHYPER; then nothing above counts
    type(anisotropic_t), allocatable :: anisotropic                !< then of the above the energy of the volume counts alone
  end type hyperelastic_t

  !> Difference of logarithmic stretches below which the shear modulus is its limit, with an error of the square.
  real(dp), parameter :: equal = 1e-5_dp

  !> Passes of a search that ends before.
  integer, parameter :: most_passes = 100

  !> Largest exponent: its exponential still has a square.
  real(dp), parameter :: largest = 300

contains

  !> Whether UHYPER or UANISOHYPER_INV give its energy.
  pure logical function calls_user(law)
    type(hyperelastic_t), intent(in) :: law
    calls_user = allocated(law%user)
    if (allocated(law%anisotropic)) calls_user = allocated(law%anisotropic%user)
  end function calls_user

  !> Number of STATEV.
  pure integer function state_variables(law)
    type(hyperelastic_t), intent(in) :: law
    state_variables = 0
    if (allocated(law%user)) state_variables = law%user%statev
    if (allocated(law%anisotropic)) then
      if (allocated(law%anisotropic%user)) state_variables = law%anisotropic%user%statev
    end if
  end function state_variables

  !> Cauchy stress, tangent, and the strain energy of the point. good is false if the stretches have no stress. Hybrid elements give
  !> the mean stress, and take the tangent at that mean stress.
  subroutine hyperelastic_stress(law, n, point, statev, stress, tangent, good)
    type(hyperelastic_t), intent(in) :: law
    integer, intent(in) :: n                      !< 4 or 6
    type(point_t), intent(inout) :: point
    real(dp), intent(inout) :: statev(:)          !< of UHYPER or UANISOHYPER_INV
    real(dp), intent(out) :: stress(n)            !< 11, 22, 33, 12, 13, 23 or the first four of them
    real(dp), intent(out) :: tangent(n, n)
    logical, intent(out) :: good
    real(dp) :: e(3), directions(3, 3), j, w, h(3), hh(3, 3), kirchhoff(3), slope(3, 3), u(0:2), mixed(3)
    stress = 0
    tangent = 0
    point%energy = 0
    if (allocated(law%anisotropic)) then
      j = determinant(point%deformation(:, :, 2))
      good = j > 0
      if (.not. good) return
      if (point%hybrid) then
        u = [energy_at(law, point%mean_stress), point%mean_stress, 0.0_dp]
      else
        u = volume_energy(law, j)
      end if
      call anisotropic_stress(law%anisotropic, n, point, j, statev, u, stress, tangent, good)
      return
    end if
    call principal(law, point%deformation(:, :, 2), e, directions, j, good)
    if (.not. good) return
    mixed = 0
    if (allocated(law%user)) then
      call user_energy(law%user, point, e - sum(e)/3, j, statev, w, h, hh, u, mixed)
    else
      call shape_energy(law, e - sum(e)/3, w, h, hh)
      u = volume_energy(law, j)
    end if
    if (point%hybrid) then
      u = [energy_at(law, point%mean_stress), point%mean_stress, 0.0_dp]
      mixed = 0
    end if
    point%energy = (w + u(0))/j
    kirchhoff = h - sum(h)/3 + j*u(1)
    mixed = j*(mixed - sum(mixed)/3)
    ! P H P, of the symmetric H
    slope = hh - spread(sum(hh, 1), 1, 3)/3 - spread(sum(hh, 2), 2, 3)/3 + sum(hh)/9 + j*u(1) + j**2*u(2) &
            + spread(mixed, 1, 3) + spread(mixed, 2, 3)
    call add_principal(n, j, e, directions, kirchhoff, slope, stress, tangent)
  end subroutine hyperelastic_stress

  !> Add the Cauchy stress and the tangent by principal Kirchhoff stresses and their derivatives by the logarithmic stretches.
  pure subroutine add_principal(n, j, e, directions, kirchhoff, slope, stress, tangent)
    integer, intent(in) :: n                      !< 4 or 6
    real(dp), intent(in) :: j, e(3), directions(3, 3)   !< directions: rows
    real(dp), intent(in) :: kirchhoff(3), slope(3, 3)
    real(dp), intent(inout) :: stress(n), tangent(n, n)
    real(dp) :: dyad(6, 3), between(6), modulus
    integer :: a, b
    do a = 1, 3
      dyad(:, a) = symmetric_dyad(directions(a, :), directions(a, :))
      stress = stress + kirchhoff(a)/j*dyad(:n, a)
    end do
    do b = 1, 3
      do a = 1, 3
        tangent = tangent + slope(a, b)/j*outer(dyad(:n, a), dyad(:n, b))
      end do
      do a = 1, b - 1
        between = 2*symmetric_dyad(directions(a, :), directions(b, :))
        if (abs(e(a) - e(b)) > equal) then
          modulus = (kirchhoff(a) - kirchhoff(b))/(2*tanh(e(a) - e(b)))
        else
          modulus = (slope(a, a) + slope(b, b) - slope(a, b) - slope(b, a))/4
        end if
        tangent = tangent + modulus/j*outer(between(:n), between(:n))
      end do
    end do
  end subroutine add_principal

  !> Logarithms of the principal stretches, their directions (rows) now, and the change of volume; good: the energy has a value.
  pure subroutine principal(law, f, e, directions, j, good)
    type(hyperelastic_t), intent(in) :: law
    real(dp), intent(in) :: f(3, 3)
    real(dp), intent(out) :: e(3), directions(3, 3), j
    logical, intent(out) :: good
    real(dp) :: squares(3)
    e = 0
    j = determinant(f)
    call eigenvalues(matmul(f, transpose(f)), squares, good, directions)
    good = good .and. j > 0 .and. all(squares > 0)
    if (.not. good) return
    e = 0.5_dp*log(squares)
    ! I1 and I2 to the highest power, and the powers of Ogden
    good = maxval(abs(e))*max(2.0_dp*highest_order, maxval(abs(law%ogden(2, :)))) < largest
  end subroutine principal

  !> W, and its derivatives by the logarithmic stretches e, whose sum is zero.
  pure subroutine shape_energy(law, e, w, h, hh)
    type(hyperelastic_t), intent(in) :: law
    real(dp), intent(in) :: e(3)
    real(dp), intent(out) :: w, h(3), hh(3, 3)
    real(dp) :: x(3), first, second, by(0:2, 0:2)
    real(dp) :: term(3)
    integer :: i, j, k
    x = exp(2*e)
    first = sum(x) - 3
    second = sum(1/x) - 3
    ! derivatives of the polynomial by its invariants
    by = 0
    do j = 0, highest_order
      do i = 0, highest_order - j
        associate (c => law%polynomial(i, j), p => powers(first, i), q => powers(second, j))
          by = by + c*outer(p, q)
        end associate
      end do
    end do
    w = by(0, 0)
    call by_stretches(x, [by(1, 0), by(0, 1)], [by(2, 0), by(1, 1), by(0, 2)], h, hh)
    do i = 1, highest_order
      associate (mu => law%ogden(1, i), alpha => law%ogden(2, i))
        if (.not. abs(mu) > 0) cycle
        term = 2*mu*exp(alpha*e)
        w = w + (sum(term) - 6*mu)/alpha**2
        h = h + term/alpha
        do k = 1, 3
          hh(k, k) = hh(k, k) + term(k)
        end do
      end associate
    end do
  end subroutine shape_energy

  !> The energy of UHYPER, all of it in w, with its derivatives by the logarithmic stretches e, whose sum is zero, and by J.
  subroutine user_energy(potential, point, e, j, statev, w, h, hh, u, mixed)
    type(user_potential_t), intent(in) :: potential
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: e(3), j
    real(dp), intent(inout) :: statev(:)
    real(dp), intent(out) :: w, h(3), hh(3, 3), u(0:2)
    real(dp), intent(out) :: mixed(3)             !< derivatives of h by J
    real(dp) :: x(3), first(3), second(3, 3)
    x = exp(2*e)
    call call_uhyper(potential, point, sum(x), sum(1/x), j, statev, w, first, second)
    call by_stretches(x, first(:2), [second(1, 1), second(1, 2), second(2, 2)], h, hh)
    u = [0.0_dp, first(3), second(3, 3)]
    mixed = second(1, 3)*2*x - second(2, 3)*2/x
  end subroutine user_energy

  !> Derivatives by the logarithmic stretches from those by I1 and I2 (the second ones by I1 twice, by both, by I2 twice).
  pure subroutine by_stretches(x, first, second, h, hh)
    real(dp), intent(in) :: x(3)                  !< squares of the stretches
    real(dp), intent(in) :: first(2), second(3)
    real(dp), intent(out) :: h(3), hh(3, 3)
    real(dp) :: i1(3), i2(3)
    integer :: k
    i1 = 2*x
    i2 = -2/x
    h = first(1)*i1 + first(2)*i2
    hh = second(1)*outer(i1, i1) + second(2)*(outer(i1, i2) + outer(i2, i1)) + second(3)*outer(i2, i2)
    do k = 1, 3
      hh(k, k) = hh(k, k) + 4*(first(1)*x(k) + first(2)/x(k))
    end do
  end subroutine by_stretches

  !> x**n and its first two derivatives.
  pure function powers(x, n) result(values)
    real(dp), intent(in) :: x
    integer, intent(in) :: n
    real(dp) :: values(3)
    values = 0
    values(1) = x**n
    if (n > 0) values(2) = n*x**(n - 1)
    if (n > 1) values(3) = n*(n - 1)*x**(n - 2)
  end function powers

  !> U and its first two derivatives by J.
  pure function volume_energy(law, j) result(u)
    type(hyperelastic_t), intent(in) :: law
    real(dp), intent(in) :: j
    real(dp) :: u(0:2)
    integer :: i
    if (law%logarithmic) then
      u = law%volumetric(1)*[(j**2 - 1)/2 - log(j), j - 1/j, 1 + 1/j**2]
      return
    end if
    u = 0
    do i = 1, highest_order
      u = u + law%volumetric(i)*powers(j - 1, 2*i)
    end do
  end function volume_energy

  !> The change of volume J at which U' is a mean stress, and its derivative by that.
  pure function volume_of(law, mean_stress) result(volume)
    type(hyperelastic_t), intent(in) :: law
    real(dp), intent(in) :: mean_stress
    real(dp) :: volume(2), u(0:2), change
    integer :: pass
    volume = [1, 0]
    if (.not. law%volumetric(1) > 0) return
    if (law%logarithmic) then
      change = mean_stress/law%volumetric(1)
      volume(1) = (change + sqrt(change**2 + 4))/2
    else
      ! U' is odd about J = 1, and steeper than its line there: from that line Newton's method has no way to overshoot
      volume(1) = 1 + mean_stress/(2*law%volumetric(1))
      do pass = 1, most_passes
        u = volume_energy(law, volume(1))
        change = (mean_stress - u(1))/u(2)
        volume(1) = volume(1) + change
        if (abs(change) <= spacing(max(abs(volume(1)), 1.0_dp))) exit
      end do
    end if
    u = volume_energy(law, volume(1))
    volume(2) = 1/u(2)
  end function volume_of

  !> U at a mean stress.
  pure real(dp) function energy_at(law, mean_stress)
    type(hyperelastic_t), intent(in) :: law
    real(dp), intent(in) :: mean_stress
    real(dp) :: volume(2), u(0:2)
    energy_at = 0
    if (.not. law%volumetric(1) > 0) return
    volume = volume_of(law, mean_stress)
    u = volume_energy(law, volume(1))
    energy_at = u(0)
  end function energy_at

  !> Components 11, 22, 33, 12, 13, 23 of the symmetric part of the dyad of two vectors.
  pure function symmetric_dyad(a, b) result(dyad)
    real(dp), intent(in) :: a(3), b(3)
    real(dp) :: dyad(6)
    dyad(:3) = a*b
    dyad(4:) = 0.5_dp*[a(1)*b(2) + a(2)*b(1), a(1)*b(3) + a(3)*b(1), a(2)*b(3) + a(3)*b(2)]
  end function symmetric_dyad

  pure function outer(a, b) result(matrix)
    real(dp), intent(in) :: a(:), b(:)
    real(dp) :: matrix(size(a), size(b))
    matrix = spread(a, 2, size(b))*spread(b, 1, size(a))
  end function outer
end module host_hyperelastic
