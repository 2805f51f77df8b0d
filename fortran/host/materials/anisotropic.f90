! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Hyperelasticity with preferred directions: stress and tangent from the deformation gradient F, by invariants.
!>
!> With J = det F, G = J^(-1/3) F, b = G G' and a = G A of each direction A of unit length, the invariants are those of Abaqus
!> (Materials Guide, Anisotropic hyperelastic behavior), in the order of AINV:
!>
!>     tr b,  (tr(b)^2 - tr(b^2))/2,  J,  and for each pair of directions 1 1, 1 2, 2 2, 1 3 ...  a1 . a2,  a1 . b a2
!>
!> By a rate of deformation d they change by T : d', where d' has no trace: that defines a tensor T for each of them but J. The
!> Kirchhoff stress is the deviator of the sum of U,i T_i, and J U,J in all directions. Its Jaumann rate follows from those of a
!> and b, d'a and d'b + bd'; tangents are that rate over J, as DDSDDE of UMAT.
!>
!> HOLZAPFEL (T.C. Gasser, R.W. Ogden, G.A. Holzapfel, Journal of the Royal Society Interface 3 (2006) 15): constants C10, k1, k2
!> and kappa; the energy of the volume is that of host_hyperelastic.
module host_anisotropic
  use host_kinds, only: dp
  use host_point, only: point_t
  use host_uanisohyper, only: call_uanisohyper, user_invariants_t
  implicit none (type, external)
  private
  public :: anisotropic_t, anisotropic_stress

  type :: anisotropic_t
    real(dp), allocatable :: directions(:, :)         !< (3, directions) in the axes of the material at the start
    real(dp) :: holzapfel(4) = 0
    type(user_invariants_t), allocatable :: user      !< of UANISOHYPER_INV; then HOLZAPFEL does not count
  end type anisotropic_t

  !> Largest exponent: its exponential still has a square.
  real(dp), parameter :: largest = 300

  real(dp), parameter :: unit(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])

contains

  !> Cauchy stress, tangent, and the strain energy of the point. u: energy of the volume and its derivatives by J; those of the
  !> user's law take its place, unless the mean stress is given. good is false if the energy is too large for numbers.
  subroutine anisotropic_stress(law, n, point, j, statev, u, stress, tangent, good)
    type(anisotropic_t), intent(in) :: law
    integer, intent(in) :: n                      !< 4 or 6
    type(point_t), intent(inout) :: point
    real(dp), intent(in) :: j                     !< determinant of F, above zero
    real(dp), intent(inout) :: statev(:)          !< of UANISOHYPER_INV
    real(dp), intent(inout) :: u(0:2)
    real(dp), intent(out) :: stress(n)            !< 11, 22, 33, 12, 13, 23 or the first four of them
    real(dp), intent(out) :: tangent(n, n)
    logical, intent(out) :: good
    real(dp) :: g(3, 3), b(3, 3), total(3, 3), d(3, 3), change(3, 3), trace, w
    real(dp) :: a(3, size(law%directions, 2)), cosines(size(a, 2)*(size(a, 2) - 1)/2)
    real(dp) :: invariants(3 + size(a, 2)*(size(a, 2) + 1)), t(3, 3, size(invariants)), first(size(invariants))
    real(dp) :: second(size(invariants), size(invariants)), mixed(size(invariants)), rates(size(invariants))
    integer :: c, k
    stress = 0
    tangent = 0
    point%energy = 0
    good = .true.
    g = point%deformation(:, :, 2)/j**(1.0_dp/3)
    b = matmul(g, transpose(g))
    a = matmul(g, matmul(point%turn, law%directions))
    call find_invariants(j, a, b, law%directions, invariants, t, cosines)
    if (allocated(law%user)) then
      call call_uanisohyper(law%user, point, invariants, cosines, statev, w, first, second)
    else
      call holzapfel(law%holzapfel, size(a, 2), invariants, w, first, second, good)
      if (.not. good) return
    end if
    mixed = 0
    if (allocated(law%user) .and. .not. point%hybrid) then
      u = [0.0_dp, first(3), second(3, 3)]
      mixed = second(:, 3)
      mixed(3) = 0
    end if
    first(3) = 0
    second(:, 3) = 0
    second(3, :) = 0
    point%energy = (w + u(0))/j
    total = 0
    do k = 1, size(first)
      total = total + first(k)*t(:, :, k)
    end do
    stress = components(n, deviator(total)/j + u(1)*unit)
    do c = 1, n
      d = strain_direction(c)
      trace = d(1, 1) + d(2, 2) + d(3, 3)
      d = deviator(d)
      do k = 1, size(first)
        rates(k) = sum(t(:, :, k)*d)
      end do
      change = matmul(d, total) + matmul(total, d) + first(2)*4*(sum(b*d)*b - matmul(b, matmul(d, b)))
      call add_squares(a, b, d, first, change)
      do k = 1, size(first)
        change = change + (dot_product(second(:, k), rates) + mixed(k)*j*trace)*t(:, :, k)
      end do
      tangent(:, c) = components(n, deviator(change)/j + ((u(1) + j*u(2))*trace + dot_product(mixed, rates))*unit)
    end do
  end subroutine anisotropic_stress

  !> Invariants, what they change by (T, zero for J), and the products A1 . A2 of unlike directions.
  pure subroutine find_invariants(j, a, b, directions, invariants, t, cosines)
    real(dp), intent(in) :: j, a(:, :), b(3, 3), directions(:, :)
    real(dp), intent(out) :: invariants(:), t(:, :, :), cosines(:)
    real(dp) :: square(3, 3), p(3), q(3)
    integer :: i, k, place
    square = matmul(b, b)
    invariants(1) = b(1, 1) + b(2, 2) + b(3, 3)
    invariants(2) = 0.5_dp*(invariants(1)**2 - square(1, 1) - square(2, 2) - square(3, 3))
    invariants(3) = j
    t(:, :, 1) = 2*b
    t(:, :, 2) = 2*(invariants(1)*b - square)
    t(:, :, 3) = 0
    place = 0
    do k = 1, size(a, 2)
      do i = 1, k
        p = matmul(b, a(:, i))
        q = matmul(b, a(:, k))
        associate (at => place_of(i, k))
          invariants(at) = dot_product(a(:, i), a(:, k))
          invariants(at + 1) = dot_product(a(:, i), q)
          t(:, :, at) = both(a(:, i), a(:, k))
          t(:, :, at + 1) = both(a(:, i), q) + both(p, a(:, k))
        end associate
        if (i == k) cycle
        place = place + 1
        cosines(place) = dot_product(directions(:, i), directions(:, k))
      end do
    end do
  end subroutine find_invariants

  !> Add what the rates of a . b a have because b is in them.
  pure subroutine add_squares(a, b, d, first, change)
    real(dp), intent(in) :: a(:, :), b(3, 3), d(3, 3), first(:)
    real(dp), intent(inout) :: change(3, 3)
    integer :: i, k
    do k = 1, size(a, 2)
      do i = 1, k
        associate (slope => first(place_of(i, k) + 1))
          change = change + 2*slope*(both(a(:, i), matmul(b, matmul(d, a(:, k)))) + both(matmul(b, matmul(d, a(:, i))), a(:, k)))
        end associate
      end do
    end do
  end subroutine add_squares

  !> Energy of the change of shape and its derivatives.
  pure subroutine holzapfel(constants, fibres, invariants, w, first, second, good)
    real(dp), intent(in) :: constants(4), invariants(:)
    integer, intent(in) :: fibres
    real(dp), intent(out) :: w, first(:), second(:, :)
    logical, intent(out) :: good
    real(dp) :: strain, slope, curvature, weights(2)
    integer :: i, k, at(2)
    associate (c10 => constants(1), k1 => constants(2), k2 => constants(3), kappa => constants(4))
      good = .true.
      w = c10*(invariants(1) - 3)
      first = 0
      second = 0
      first(1) = c10
      weights = [kappa, 1 - 3*kappa]
      do k = 1, fibres
        at = [1, place_of(k, k)]
        strain = dot_product(weights, invariants(at) - [3, 1])
        ! fibres take no pressure
        if (.not. strain > 0) cycle
        good = good .and. k2*strain**2 < largest
        if (.not. good) return
        if (k2 > 0) then
          slope = k1*strain*exp(k2*strain**2)
          curvature = k1*(1 + 2*k2*strain**2)*exp(k2*strain**2)
          w = w + k1/(2*k2)*(exp(k2*strain**2) - 1)
        else
          slope = k1*strain
          curvature = k1
          w = w + 0.5_dp*k1*strain**2
        end if
        first(at) = first(at) + slope*weights
        do i = 1, 2
          second(at, at(i)) = second(at, at(i)) + curvature*weights*weights(i)
        end do
      end do
    end associate
  end subroutine holzapfel

  !> Place of a1 . a2 among the invariants, i <= k.
  pure integer function place_of(i, k)
    integer, intent(in) :: i, k
    place_of = 4 + 2*(i - 1) + k*(k - 1)
  end function place_of

  !> Sum of the dyads of two vectors, in both orders.
  pure function both(p, q) result(matrix)
    real(dp), intent(in) :: p(3), q(3)
    real(dp) :: matrix(3, 3)
    matrix = spread(p, 2, 3)*spread(q, 1, 3)
    matrix = matrix + transpose(matrix)
  end function both

  pure function deviator(matrix) result(found)
    real(dp), intent(in) :: matrix(3, 3)
    real(dp) :: found(3, 3)
    found = matrix - (matrix(1, 1) + matrix(2, 2) + matrix(3, 3))/3*unit
  end function deviator

  pure function components(n, matrix) result(found)
    integer, intent(in) :: n
    real(dp), intent(in) :: matrix(3, 3)
    real(dp) :: found(n), all(6)
    all = [matrix(1, 1), matrix(2, 2), matrix(3, 3), matrix(1, 2), matrix(1, 3), matrix(2, 3)]
    found = all(:n)
  end function components

  !> Tensor of a component of strain that is one, shear as engineering strain.
  pure function strain_direction(component) result(matrix)
    integer, intent(in) :: component
    real(dp) :: matrix(3, 3)
    integer, parameter :: row(6) = [1, 2, 3, 1, 1, 2], column(6) = [1, 2, 3, 2, 3, 3]
    matrix = 0
    matrix(row(component), column(component)) = 0.5_dp
    matrix = matrix + transpose(matrix)
  end function strain_direction
end module host_anisotropic
