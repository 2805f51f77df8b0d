! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The table of built-in elements.
module host_built_in
  use, intrinsic :: iso_c_binding, only: c_associated, c_funloc, c_funptr, c_null_funptr
  use host_beam, only: timoshenko_beam
  use host_cohesive, only: cohesive
  use host_conduction, only: heat_transfer
  use host_continuum_shell, only: continuum_shell
  use host_coupled, only: coupled_uelmat
  use host_discrete, only: discrete
  use host_generalised, only: generalised_uelmat
  use host_heat_loads, only: heat_load
  use host_mass_diffusion, only: mass_diffusion
  use host_membrane, only: membrane
  use host_piezoelectric, only: piezoelectric_uelmat
  use host_shell, only: shell
  use host_solid, only: solid_uelmat
  use host_truss, only: truss
  implicit none (type, external)
  private
  public :: address_of, find_built_in

  type :: row_t
    character(len=16) :: name
    type(c_funptr) :: address
    logical :: one_argument = .true.   !< its routine has one argument (host_adapter), not those of UEL or UELMAT
  end type row_t

contains

  !> All of them. A name is what harness/uel/usersub/_binding.py asks for.
  function table() result(rows)
    type(row_t), allocatable :: rows(:)
    rows = [row_t('solid', c_funloc(solid_uelmat), .false.), &
            row_t('coupled', c_funloc(coupled_uelmat), .false.), &
            row_t('cohesive', c_funloc(cohesive)), &
            row_t('discrete', c_funloc(discrete)), &
            row_t('heat', c_funloc(heat_transfer)), &
            row_t('heat load', c_funloc(heat_load)), &
            row_t('shell', c_funloc(shell)), &
            row_t('beam', c_funloc(timoshenko_beam)), &
            row_t('piezoelectric', c_funloc(piezoelectric_uelmat), .false.), &
            row_t('truss', c_funloc(truss)), &
            row_t('generalised', c_funloc(generalised_uelmat), .false.), &
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

  !> Whether an address is that of a built-in element, and whether its routine has one argument.
  subroutine find_built_in(address, built_in, one_argument)
    type(c_funptr), intent(in) :: address
    logical, intent(out) :: built_in, one_argument
    type(row_t), allocatable :: rows(:)
    integer :: k
    built_in = .false.
    one_argument = .false.
    rows = table()
    do k = 1, size(rows)
      if (.not. c_associated(rows(k)%address, address)) cycle
      built_in = .true.
      one_argument = rows(k)%one_argument
    end do
  end subroutine find_built_in
end module host_built_in
