! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Plane stress of a law that is written for plane strain: the strain 33 without a stress 33. The caller evaluates the law:
!>
!>     search = free_thickness(guess, scale)
!>     do while (searching(search))
!>       solid_strain(search, strain), stress and tangent (11, 22, 33, 12) at it
!>       advance(search, stress(3), tangent(3, 3))
!>     end do
!>     stress and tangent of the plane by reduce
module host_thickness
  use core_root, only: root_search, search_between
  use host_kinds, only: dp
  implicit none (type, external)
  private
  public :: free_thickness, reduced_change, reduced_stress, reduced_tangent, thickness_search, solid_strain

  type :: thickness_search
    type(root_search) :: root    !< of the stress 33; its x is positive, so that it has a size to compare rounding with
    real(dp) :: shift = 0        !< x less the strain 33
  end type thickness_search

contains

  !> A search that starts at a guess, and finds the strain 33 if it is not farther from it than a positive scale.
  pure function free_thickness(guess, scale) result(search)
    real(dp), intent(in) :: guess, scale
    type(thickness_search) :: search
    search%shift = 4*scale - guess
    search%root = search_between(3*scale, 5*scale, 4*scale, geometric=.false.)
  end function free_thickness

  !> Strains 11, 22, 33, 12 with which the law is evaluated.
  pure function solid_strain(search, strain) result(solid)
    type(thickness_search), intent(in) :: search
    real(dp), intent(in) :: strain(3)
    real(dp) :: solid(4)
    solid = [strain(1:2), search%root%x - search%shift, strain(3)]
  end function solid_strain

  !> Stresses 11, 22, 12.
  pure function reduced_stress(solid) result(stress)
    real(dp), intent(in) :: solid(4)
    real(dp) :: stress(3)
    stress = solid([1, 2, 4])
  end function reduced_stress

  !> Changes of the stresses 11, 22, 12 if those of a solid change at the same strains, while no stress 33 arises.
  pure function reduced_change(change, solid) result(reduced)
    real(dp), intent(in) :: change(4), solid(4, 4)   !< solid: derivatives by the strains
    real(dp) :: reduced(3)
    reduced = change([1, 2, 4]) - solid([1, 2, 4], 3)/solid(3, 3)*change(3)
  end function reduced_change

  !> Their derivatives by the strains 11, 22, 12, while no stress 33 arises.
  pure function reduced_tangent(solid) result(tangent)
    real(dp), intent(in) :: solid(4, 4)
    real(dp) :: tangent(3, 3)
    integer, parameter :: place(3) = [1, 2, 4]
    tangent = solid(place, place) - spread(solid(place, 3), 2, 3)*spread(solid(3, place), 1, 3)/solid(3, 3)
  end function reduced_tangent
end module host_thickness
