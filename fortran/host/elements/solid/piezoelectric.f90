! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in piezoelectric elements (CPE4E, CAX4E, C3D8E, ...): a continuum element (host_solid) whose nodes have an electrical
!> potential too, linear and in small displacements.
!>
!> The unknowns are the displacements of all nodes, then their potentials. With the electrical field E = -grad(potential), the
!> stress is S = C e - b^T E and the electrical displacement D = b e + d E (Abaqus Theory Guide, "Piezoelectric analysis"; b is
!> *PIEZOELECTRIC, d *DIELECTRIC). The forces of the potentials are minus charges: so the matrix is symmetric, as Abaqus
!> has it.
!>
!> Values of PROPS and JPROPS: piezoelectric in built_in.toml. SVARS hold for each point E11 ... and S11 ... of host_solid, then
!> the gradient of the potential and the electrical displacement, all in the directions of *ORIENTATION where the section has one.
module host_piezoelectric
  use host_adapter, only: element_t
  use host_kinds, only: dp
  use host_kinematics, only: components, rotated
  use host_layout, only: j_solid_points, p_piezoelectric_constants
  use host_solid, only: add_solid, describe, kinematics_of
  use host_solid_element, only: solid_t, values_of_point
  use host_solid_extras, only: extras_t
  use host_solid_kinematics, only: kinematics_t
  implicit none (type, external)
  private
  public :: piezoelectric

contains

  subroutine piezoelectric(element)
    type(element_t), intent(inout) :: element
    real(dp), target :: state(values_of_point(element%mcrd)*element%jprops(j_solid_points))
    type(solid_t) :: this
    type(extras_t) :: extras
    call describe(this, element)
    ! the response is elastic: nothing of the state at the start counts
    state = 0
    this%state(1:values_of_point(this%dim), 1:this%rule%points) => state
    call add_solid(this, extras, element, size(state))
    if (.not. element%has_forces) return
    call add_electricity(this, kinematics_of(this), element%props(p_piezoelectric_constants:), element%u(this%n + 1:), &
                         element%rhs(:, 1), element%amatrx, element%svars, element%energy(7))
  end subroutine piezoelectric

  !> What the potentials add to the forces, the matrix and the stresses; the state that is kept, and the electrical energy.
  subroutine add_electricity(this, kinematics, constants, potential, force, stiffness, svars, energy)
    type(solid_t), intent(in) :: this
    class(kinematics_t), intent(in) :: kinematics
    real(dp), intent(in) :: constants(this%dim, 3*this%dim)  !< b, 4 or 6 components for each direction, then d
    real(dp), intent(in) :: potential(this%nodes)
    real(dp), intent(inout) :: force(:), stiffness(:, :)
    real(dp), intent(inout) :: svars(values_of_point(this%dim) + 2*this%dim, this%rule%points), energy
    real(dp) :: volume, field(this%dim), displaced(this%dim), stress(2*this%dim), coupling(this%n, this%nodes), u(this%n)
    integer :: m, n, p, place(this%strains)
    m = 2*this%dim
    n = this%n
    u = reshape(this%u, [n])
    place = components(this%strains, m)
    energy = 0
    associate (couple => constants(:, :m), dielectric => constants(:, m + 1:), material => this%material)
      do p = 1, this%rule%points
        volume = kinematics%volume(p)*this%depth
        associate (g => kinematics%g(:, :this%dim, p), b => kinematics%b(:, :, p))
          field = -matmul(potential, g)
          displaced = matmul(couple(:, place), matmul(u, b)) + matmul(dielectric, field)
          stress = matmul(field, couple)
          force(:n) = force(:n) - volume*matmul(b, matmul(field, couple(:, place)))
          force(n + 1:) = force(n + 1:) + volume*matmul(g, displaced)
          coupling = volume*matmul(b, matmul(transpose(couple(:, place)), transpose(g)))
          stiffness(:n, n + 1:) = stiffness(:n, n + 1:) + coupling
          stiffness(n + 1:, :n) = stiffness(n + 1:, :n) + transpose(coupling)
          stiffness(n + 1:, n + 1:) = stiffness(n + 1:, n + 1:) - volume*matmul(g, matmul(dielectric, transpose(g)))
        end associate
        if (material%turned) stress = rotated(m, stress, material%axes, 1.0_dp)
        svars(:2*m, p) = this%state(:, p)
        svars(m + 1:2*m, p) = svars(m + 1:2*m, p) - stress
        svars(2*m + 1:, p) = [along(-field), along(displaced)]
        energy = energy + 0.5_dp*volume*dot_product(field, matmul(dielectric, field))
      end do
    end associate

  contains

    !> Components along the directions of the material.
    function along(vector) result(turned)
      real(dp), intent(in) :: vector(:)
      real(dp) :: turned(size(vector))
      turned = vector
      if (this%material%turned) turned = matmul(this%material%axes(:size(vector), :size(vector)), vector)
    end function along
  end subroutine add_electricity
end module host_piezoelectric
