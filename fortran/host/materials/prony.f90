! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Isotropic linear viscoelasticity by a Prony series (Abaqus Analysis User's Guide, Time domain viscoelasticity), small strains.
!>
!> A spring of the long-term moduli beside Maxwell elements g G, k K, tau of the instantaneous moduli G and K. The stress of each
!> is exact if strains grow linearly in an increment: R.L. Taylor, K.S. Pister, G.L. Goudreau, Int. J. for Numerical Methods in
!> Engineering 2 (1970) 45.
!>
!> History of a point: strain 11, 22, 33, 12, 13, 23 (engineering shear), strain energy, change of the viscous strain rate in the
!> increment times its length, then the stress of each Maxwell element.
module host_prony
  use host_kinds, only: dp
  implicit none (type, external)
  private
  public :: prony_t, prony_solid, prony_values

  integer, parameter :: prony_values = 8    !< of the history before the stresses

  type :: prony_t
    real(dp), allocatable :: shear(:), bulk(:), times(:)   !< g, k and tau of each Maxwell element
    real(dp) :: moduli(2) = 0                              !< instantaneous shear and bulk modulus
  end type prony_t

contains

  !> Plane strain (n = 4) and three dimensions (n = 6).
  pure subroutine prony_solid(law, elapsed, n, old, strain, stress, tangent, new)
    type(prony_t), intent(in) :: law
    real(dp), intent(in) :: elapsed            !< time in which stresses relax
    integer, intent(in) :: n
    real(dp), intent(in) :: old(:), strain(n)
    real(dp), intent(out) :: stress(n), tangent(n, n), new(:)
    real(dp) :: change(n), part(n), rate(n), moduli(2), by_strain(2), gain
    integer :: k, first, i
    new = old
    new(1:n) = strain
    moduli = law%moduli*(1 - [sum(law%shear), sum(law%bulk)])
    by_strain = moduli
    stress = stress_of(moduli, strain)
    new(7) = 0.5_dp*dot_product(stress, strain)
    change = strain - old(1:n)
    rate = 0
    do k = 1, size(law%times)
      first = prony_values + 6*(k - 1)
      moduli = law%moduli*[law%shear(k), law%bulk(k)]
      gain = growth(elapsed/law%times(k))
      part = exp(-elapsed/law%times(k))*old(first + 1:first + n) + gain*stress_of(moduli, change)
      by_strain = by_strain + gain*moduli
      stress = stress + part
      new(7) = new(7) + energy_of(moduli, part)
      rate = rate + (deviator(part) - deviator(old(first + 1:first + n)))/(2*law%moduli(1)*law%times(k))
      new(first + 1:first + n) = part
    end do
    new(8) = elapsed*sqrt((sum(rate(:3)**2) + 2*sum(rate(4:)**2))*2/3)
    tangent = 0
    do i = 1, n
      tangent(i, i) = merge(2, 1, i <= 3)*by_strain(1)
      if (i <= 3) tangent(i, :3) = tangent(i, :3) + by_strain(2) - 2*by_strain(1)/3
    end do
  end subroutine prony_solid

  !> (1 - exp(-x))/x.
  pure real(dp) function growth(x)
    real(dp), intent(in) :: x
    if (x > 1e-3_dp) then
      growth = (1 - exp(-x))/x
    else
      growth = 1 - x/2*(1 - x/3*(1 - x/4*(1 - x/5)))
    end if
  end function growth

  !> Of a strain with engineering shear; moduli: shear, bulk.
  pure function stress_of(moduli, strain) result(stress)
    real(dp), intent(in) :: moduli(2), strain(:)
    real(dp) :: stress(size(strain)), volume
    volume = sum(strain(:3))
    stress(:3) = 2*moduli(1)*(strain(:3) - volume/3) + moduli(2)*volume
    stress(4:) = moduli(1)*strain(4:)
  end function stress_of

  pure function deviator(stress) result(part)
    real(dp), intent(in) :: stress(:)
    real(dp) :: part(size(stress))
    part = stress
    part(:3) = part(:3) - sum(stress(:3))/3
  end function deviator

  !> Energy of springs under a stress; one without a modulus has none.
  pure real(dp) function energy_of(moduli, stress)
    real(dp), intent(in) :: moduli(2), stress(:)
    real(dp) :: part(size(stress))
    energy_of = 0
    part = deviator(stress)
    if (moduli(1) > 0) energy_of = (sum(part(:3)**2) + 2*sum(part(4:)**2))/(4*moduli(1))
    if (moduli(2) > 0) energy_of = energy_of + (sum(stress(:3))/3)**2/(2*moduli(2))
  end function energy_of
end module host_prony
