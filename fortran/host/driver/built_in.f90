! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The table of built-in elements.
module host_built_in
  use, intrinsic :: iso_c_binding, only: c_associated, c_funloc, c_funptr, c_null_funptr
  use host_beam, only: timoshenko_beam
  use host_cohesive, only: cohesive
  use host_conduction, only: heat_transfer
  use host_continuum_shell, only: continuum_shell
  use host_coupled, only: coupled
  use host_discrete, only: discrete
  use host_heat_loads, only: heat_load
  use host_mass_diffusion, only: mass_diffusion
  use host_membrane, only: membrane
  use host_piezoelectric, only: piezoelectric
  use host_shell, only: shell
  use host_solid, only: generalised, solid
  use host_truss, only: truss
  implicit none (type, external)
  private
  public :: address_of, is_built_in

  type :: row_t
    character(len=16) :: name
    type(c_funptr) :: address
  end type row_t

contains

  !> All of them. A name is what harness/uel/usersub/_binding.py asks for.
  function table() result(rows)
    type(row_t), allocatable :: rows(:)
    rows = [row_t('solid', c_funloc(solid)), &
            row_t('coupled', c_funloc(coupled)), &
            row_t('cohesive', c_funloc(cohesive)), &
            row_t('discrete', c_funloc(discrete)), &
            row_t('heat', c_funloc(heat_transfer)), &
            row_t('heat load', c_funloc(heat_load)), &
            row_t('shell', c_funloc(shell)), &
            row_t('beam', c_funloc(timoshenko_beam)), &
            row_t('piezoelectric', c_funloc(piezoelectric)), &
            row_t('truss', c_funloc(truss)), &
            row_t('generalised', c_funloc(generalised)), &
            row_t('membrane', c_funloc(membrane)), &
            row_t('mass diffusion', c_funloc(mass_diffusion)), &
            row_t('continuum shell', c_funloc(continuum_shell))]
  end function table

  !> Address of a built-in element's routine by its name, null if there is none.
  type(c_funptr) function address_of(name)
    character(len=*), intent(in) :: name
    type(row_t), allocatable :: rows(:)
    integer :: k
    address_of = c_null_funptr
    rows = table()
    do k = 1, size(rows)
      if (rows(k)%name == name) address_of = rows(k)%address
    end do
  end function address_of

  !> Whether an address is that of a built-in element.
  logical function is_built_in(address)
    type(c_funptr), intent(in) :: address
    type(row_t), allocatable :: rows(:)
    integer :: k
    rows = table()
    is_built_in = any([(c_associated(rows(k)%address, address), k=1, size(rows))])
  end function is_built_in
end module host_built_in
