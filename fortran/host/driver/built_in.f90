! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The routines of built-in elements.
module host_built_in
  use, intrinsic :: iso_c_binding, only: c_associated, c_funloc, c_funptr
  use host_beam, only: beam_uel, beam_uelmat
  use host_cohesive, only: cohesive_uel
  use host_conduction, only: heat_uelmat
  use host_continuum_shell, only: continuum_shell_uelmat
  use host_coupled, only: coupled_uelmat
  use host_discrete, only: discrete_uel
  use host_generalised, only: generalised_uelmat
  use host_heat_loads, only: heat_load_uel
  use host_mass_diffusion, only: mass_diffusion_uelmat
  use host_membrane, only: membrane_uelmat
  use host_piezoelectric, only: piezoelectric_uelmat
  use host_shell, only: shell_uelmat
  use host_solid, only: solid_uelmat
  use host_truss, only: truss_uelmat
  implicit none (type, external)
  private
  public :: built_in_elements, is_built_in

contains

  !> Addresses of built-in elements: 1 continuum, 2 coupled temperature-displacement, 3 cohesive, 4 springs and masses, 5 heat
  !> transfer, 6 heat that enters, 7 shells, 8 beams, 9 piezoelectric, 10 trusses, 11 generalised plane strain, 12 beams whose
  !> material is integrated over the section, 13 membranes, 14 mass diffusion, 15 continuum shells.
  function built_in_elements() result(addresses)
    type(c_funptr) :: addresses(15)
    addresses = [c_funloc(solid_uelmat), c_funloc(coupled_uelmat), c_funloc(cohesive_uel), c_funloc(discrete_uel), &
                 c_funloc(heat_uelmat), c_funloc(heat_load_uel), c_funloc(shell_uelmat), c_funloc(beam_uel), &
                 c_funloc(piezoelectric_uelmat), c_funloc(truss_uelmat), c_funloc(generalised_uelmat), c_funloc(beam_uelmat), &
                 c_funloc(membrane_uelmat), c_funloc(mass_diffusion_uelmat), c_funloc(continuum_shell_uelmat)]
  end function built_in_elements

  !> True for the address of a built-in element.
  function is_built_in(address) result(found)
    type(c_funptr), intent(in) :: address
    logical :: found
    type(c_funptr) :: addresses(15)
    integer :: k
    addresses = built_in_elements()
    found = .false.
    do k = 1, size(addresses)
      found = found .or. c_associated(addresses(k), address)
    end do
  end function is_built_in
end module host_built_in
