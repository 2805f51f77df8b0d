! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in coupled temperature-displacement elements (CPE4T, CAX4T, C3D8T, ...): a continuum element (host_solid), and heat
!> conduction with temperatures at its corners.
!>
!> The unknowns are the displacements of all nodes, then the temperatures of the corners. Values of PROPS and JPROPS: coupled in
!> built_in.toml. SVARS go on with the heat flux of each integration point of the heat, then the energies of UMATHT. The two parts
!> interact through thermal expansion, the heat terms of UMAT and HETVAL (host_coupling) and the change of shape, which the tangent
!> leaves out. The heat is that of host_conduction.
module host_coupled
  use host_adapter, only: element_t
  use host_conduction, only: body_t, conduct, is_steady
  use host_coupling, only: coupling_t
  use host_kinds, only: dp
  use host_layout, only: j_coupled_heat_family, j_coupled_heat_points, j_solid_family
  use host_shape, only: rule_of
  use host_solid, only: add_solid, describe
  use host_solid_element, only: begins, solid_t
  use host_solid_extras, only: extras_t
  implicit none (type, external)
  private
  public :: coupled

contains

  subroutine coupled(element)
    type(element_t), intent(inout) :: element
    type(solid_t) :: this
    type(extras_t) :: extras
    type(coupling_t), target :: coupling
    integer :: last
    call describe(this, element)
    associate (jprops => element%jprops, n => this%n)
      coupling%geometry => rule_of(int(jprops(j_solid_family)), int(jprops(j_coupled_heat_points)))
      coupling%field => rule_of(int(jprops(j_coupled_heat_family)), int(jprops(j_coupled_heat_points)))
      coupling%temperature => element%u(n + 1:)
      coupling%increment => element%du(n + 1:)
      coupling%heat => element%rhs(n + 1:, 1)
      coupling%tangent => element%amatrx
      extras%coupling => coupling
      last = size(element%svars) - (this%dim + 1)*coupling%field%points
      call add_solid(this, extras, element, last)
      if (.not. element%has_forces .or. begins(this)) return
      call add_conduction(this, coupling, element, last)
      element%rhs(n + 1:, 1) = -element%rhs(n + 1:, 1)
    end associate
  end subroutine coupled

  !> Add the heat that flows into the corners.
  subroutine add_conduction(this, coupling, element, last)
    type(solid_t), intent(in) :: this
    type(coupling_t), intent(in) :: coupling
    type(element_t), intent(inout) :: element
    integer, intent(in) :: last                !< of SVARS of the continuum element
    real(dp) :: now(this%dim, this%nodes)
    type(body_t) :: body
    now = this%x
    if (this%finite) now = now + this%u
    body%geometry => coupling%geometry
    body%field => coupling%field
    body%states = this%rule%points
    body%direct = this%direct
    body%depth = this%depth
    body%dtime = merge(0.0_dp, element%dtime, is_steady(element%procedure_code))
    ! they are the hidden ones behind those of the stresses
    associate (n => this%n, svars => element%svars, points => body%field%points)
      associate (flux => svars(last + 1:last + this%dim*points), energies => svars(last + this%dim*points + 1:))
        call conduct(body, this%material, now, this%x, this%fields, this%predef, coupling%temperature, coupling%increment, flux, &
                     energies, coupling%heat, coupling%tangent(n + 1:, n + 1:))
      end associate
    end associate
  end subroutine add_conduction
end module host_coupled
