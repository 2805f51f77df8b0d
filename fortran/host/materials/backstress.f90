! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Mises plasticity whose yield surface moves, and may grow: linear kinematic, and combined hardening with several backstresses
!> (Abaqus Analysis User's Guide, Models for metals subjected to cyclic loading), small strains, backward Euler.
!>
!> Rate of a backstress: 2/3 C (plastic strain rate) - gamma (backstress) (rate of the equivalent plastic strain). The return is one
!> equation for the increment of the equivalent plastic strain, for the direction of flow follows from it: M. Kobayashi, N. Ohno,
!> Int. J. for Numerical Methods in Engineering 53 (2002) 2217.
!>
!> History of a point: that of host_mises, then each backstress 11, 22, 33, 12, 13, 23.
module host_backstress
  use core_limit, only: exceeds
  use core_root, only: advance, root_search, search_between, searching
  use host_kinds, only: dp
  use host_mises, only: yield_stress
  implicit none (type, external)
  private
  public :: backstress_t, combined_solid

  type :: backstress_t
    real(dp), allocatable :: moduli(:)     !< C of each backstress
    real(dp), allocatable :: recovery(:)   !< gamma of each; 0: linear
    real(dp) :: growth = 0                 !< Q: the yield surface grows by Q (1 - exp(-b plastic strain)) beside its table
    real(dp) :: rate = 0                   !< b
  end type backstress_t

contains

  !> Plane strain (n = 4) and three dimensions (n = 6). If the return does not converge, the stress is the trial stress.
  subroutine combined_solid(law, young, poisson, table, n, old, strain, stress, tangent, new, solved)
    type(backstress_t), intent(in) :: law
    real(dp), intent(in) :: young, poisson
    real(dp), intent(in) :: table(:, :)     !< (k, 2) size of the yield surface, plastic strain, ascending
    integer, intent(in) :: n
    real(dp), intent(in) :: old(:)
    real(dp), intent(in) :: strain(n)
    real(dp), intent(out) :: stress(n), tangent(n, n), new(:)
    logical, intent(out) :: solved
    real(dp), parameter :: root = sqrt(1.5_dp)
    real(dp) :: shear, bulk, mean, length, x, by_strain, elastic(n), back(n, size(law%moduli)), factors(size(law%moduli)), &
                carried(n), direction(n), by_x(n), deviator(n, n), size_now, slope, flow(n)
    type(root_search) :: search
    integer :: i, j, k, first
    shear = young/(2*(1 + poisson))
    bulk = young/(3*(1 - 2*poisson))
    new = old
    elastic = strain - old(1:n)
    mean = sum(elastic(1:3))/3
    stress(1:3) = 2*shear*(elastic(1:3) - mean)
    stress(4:n) = shear*elastic(4:n)
    do k = 1, size(law%moduli)
      first = 7 + 6*(k - 1)
      back(:, k) = old(first + 1:first + n)
    end do
    deviator = 0
    do i = 1, n
      deviator(i, i) = merge(2*shear, shear, i <= 3)
      if (i <= 3) deviator(i, 1:3) = deviator(i, 1:3) - 2*shear/3
    end do
    tangent = deviator
    solved = .true.
    x = 0
    call find_flow(0.0_dp)
    if (exceeds(root*length, size_now)) then
      ! at its upper end the stress that is left is less than the backstresses and the size of the yield surface
      search = search_between(0.0_dp, root*length/(3*shear), 0.0_dp, geometric=.false.)
      do while (searching(search))
        x = search%x
        call find_flow(x)
        call advance(search, size_now + (3*shear + sum(law%moduli*factors))*x - root*length, by_strain)
      end do
      solved = search%found
      if (solved) then
        flow = root*x*direction
        stress = stress - 2*shear*flow
        new(1:3) = old(1:3) + flow(1:3)
        new(4:n) = old(4:n) + 2*flow(4:n)
        new(7) = old(7) + x
        do k = 1, size(law%moduli)
          first = 7 + 6*(k - 1)
          new(first + 1:first + n) = factors(k)*(back(:, k) + 2*law%moduli(k)*flow/3)
        end do
        do j = 1, n
          do i = 1, n
            ! x and the direction change with the strain
            tangent(i, j) = deviator(i, j) - 2*shear*root*((x/length)*(deviator(i, j) - 2*shear*direction(i)*direction(j)) &
              + (2*shear*root/by_strain)*direction(j)*(direction(i) + (x/length)*(by_x(i) - direction(i)*inner(direction, by_x))))
          end do
        end do
      end if
    end if
    stress(1:3) = stress(1:3) + 3*bulk*mean
    tangent(1:3, 1:3) = tangent(1:3, 1:3) + bulk

  contains

    !> After an increment of the equivalent plastic strain: the stress less the backstresses that are carried over, its length
    !> and direction; the size of the yield surface; and the derivative of the yield condition by x.
    subroutine find_flow(increment)
      real(dp), intent(in) :: increment
      real(dp) :: decay
      factors = 1/(1 + law%recovery*increment)
      carried = stress - matmul(back, factors)
      length = sqrt(inner(carried, carried))
      direction = 0
      if (length > 0) direction = carried/length
      by_x = matmul(back, law%recovery*factors**2)
      call yield_stress(table, old(7) + increment, size_now, slope)
      decay = exp(-law%rate*(old(7) + increment))
      size_now = size_now + law%growth*(1 - decay)
      slope = slope + law%growth*law%rate*decay
      by_strain = slope + 3*shear + sum(law%moduli*factors**2) - root*inner(direction, by_x)
    end subroutine find_flow
  end subroutine combined_solid

  !> Product of two tensors from their components without engineering shear.
  pure real(dp) function inner(a, b)
    real(dp), intent(in) :: a(:), b(:)
    inner = dot_product(a(:3), b(:3)) + 2*dot_product(a(4:), b(4:))
  end function inner
end module host_backstress
