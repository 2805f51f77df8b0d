! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in piezoelectric elements (CPE4E, CAX4E, C3D8E, ...), as a procedure with the arguments of UELMAT: a continuum element
!> (host_solid) whose nodes have an electrical potential too, linear and in small displacements.
!>
!> The unknowns are the displacements of all nodes, then their potentials. With the electrical field E = -grad(potential), the
!> stress is S = C e - b^T E and the electrical displacement D = b e + d E (Abaqus Theory Guide, "Piezoelectric analysis"; b is
!> *PIEZOELECTRIC, d *DIELECTRIC). The forces of the potentials are minus charges: so the matrix is symmetric, as Abaqus
!> has it.
!>
!> PROPS go on with b, for each direction of the field its components as SVARS have them, then d by rows. SVARS hold for each
!> point E11 ... and S11 ... of host_solid, then the gradient of the potential and the electrical displacement, all in the
!> directions of *ORIENTATION where the section has one.
module host_piezoelectric
  use host_gradients, only: all_gradients
  use host_kinds, only: dp, i4
  use host_kinematics, only: components, rotated
  use host_materials, only: find_material, material_t
  use host_shape, only: is_multilinear, rule_of, rule_t
  use host_solid, only: solid_element
  use host_solid_element, only: values_of_point
  implicit none (type, external)
  private
  public :: piezoelectric_uelmat

  integer, parameter :: of_solid = 3   !< PROPS of host_solid

contains

  subroutine piezoelectric_uelmat(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                                  v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                                  lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period, materiallib)
    integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                   lflags(*), mlvarx, mdload, jprops(*), njprop, materiallib
    real(dp) :: rhs(ndofel), amatrx(ndofel, ndofel), svars(*), energy(*), props(nprops), coords(mcrd, nnode), u(ndofel), &
                du(ndofel), v(*), a(*), time(*), dtime, params(*), adlmag(*), predef(*), ddlmag(*), pnewdt, period
    real(dp) :: force(mcrd*nnode), stiffness(mcrd*nnode, mcrd*nnode), state(values_of_point(int(mcrd))*jprops(2))
    type(rule_t), pointer :: rule
    integer(i4) :: n
    n = mcrd*nnode
    rule => rule_of(int(jprops(1)), int(jprops(2)))
    ! the response is elastic: nothing of the state at the start counts
    state = 0
    call solid_element(force, stiffness, state, energy, n, 1_i4, size(state, kind=i4), props, coords, mcrd, nnode, u, u, v, a, &
                       params, dtime, predef, npredf, lflags, jprops, materiallib)
    rhs = 0
    amatrx = 0
    rhs(:n) = force
    amatrx(:n, :n) = stiffness
    if (any(lflags(3) == [3_i4, 4_i4])) return
    call add_electricity(rule, int(jprops(3)), jprops(8) /= 0, merge(props(1), 1.0_dp, mcrd == 2), coords, props(of_solid + 1:), &
                         find_material(materiallib), u(:n), u(n + 1:), state, rhs, amatrx, svars, energy(7))
  end subroutine piezoelectric_uelmat

  !> What the potentials add to the forces, the matrix and the stresses; the state that is kept, and the electrical energy.
  subroutine add_electricity(rule, direct, averaged, depth, x, constants, material, u, potential, state, rhs, amatrx, &
                             svars, energy)
    type(rule_t), intent(in) :: rule
    integer, intent(in) :: direct
    logical, intent(in) :: averaged                          !< the volume strain is the mean, as host_solid takes it
    real(dp), intent(in) :: depth, x(rule%dim, rule%nodes), potential(rule%nodes)
    real(dp), intent(in) :: constants(rule%dim, 3*rule%dim)  !< b, 4 or 6 components for each direction, then d
    type(material_t), intent(in) :: material
    real(dp), intent(in) :: u(rule%dim*rule%nodes)
    real(dp), intent(in) :: state(values_of_point(rule%dim), rule%points)
    real(dp), intent(inout) :: rhs(:), amatrx(:, :)
    real(dp), intent(inout) :: svars(values_of_point(rule%dim) + 2*rule%dim, rule%points), energy
    real(dp) :: g(rule%nodes, direct, rule%points), b(rule%dim*rule%nodes, direct + 2*rule%dim - 3, rule%points)
    real(dp) :: volume(rule%points), field(rule%dim), displaced(rule%dim), stress(2*rule%dim)
    real(dp) :: coupling(rule%dim*rule%nodes, rule%nodes)
    integer :: dim, m, n, p, place(direct + 2*rule%dim - 3)
    dim = rule%dim
    m = 2*dim
    n = dim*rule%nodes
    place = components(size(place), m)
    call all_gradients(rule, direct, size(place), averaged .and. is_multilinear(rule) .and. rule%points > 1, x, g, b, volume)
    volume = depth*volume
    energy = 0
    associate (couple => constants(:, :m), dielectric => constants(:, m + 1:))
      do p = 1, rule%points
        field = -matmul(potential, g(:, :dim, p))
        displaced = matmul(couple(:, place), matmul(u, b(:, :, p))) + matmul(dielectric, field)
        stress = matmul(field, couple)
        rhs(:n) = rhs(:n) + volume(p)*matmul(b(:, :, p), matmul(field, couple(:, place)))
        rhs(n + 1:) = rhs(n + 1:) - volume(p)*matmul(g(:, :dim, p), displaced)
        coupling = volume(p)*matmul(b(:, :, p), matmul(transpose(couple(:, place)), transpose(g(:, :dim, p))))
        amatrx(:n, n + 1:) = amatrx(:n, n + 1:) + coupling
        amatrx(n + 1:, :n) = amatrx(n + 1:, :n) + transpose(coupling)
        amatrx(n + 1:, n + 1:) = amatrx(n + 1:, n + 1:) - &
          volume(p)*matmul(g(:, :dim, p), matmul(dielectric, transpose(g(:, :dim, p))))
        if (material%turned) stress = rotated(m, stress, material%axes, 1.0_dp)
        svars(:2*m, p) = state(:, p)
        svars(m + 1:2*m, p) = svars(m + 1:2*m, p) - stress
        svars(2*m + 1:, p) = [along(-field), along(displaced)]
        energy = energy + 0.5_dp*volume(p)*dot_product(field, matmul(dielectric, field))
      end do
    end associate

  contains

    !> Components along the directions of the material.
    function along(vector) result(turned)
      real(dp), intent(in) :: vector(:)
      real(dp) :: turned(size(vector))
      turned = vector
      if (material%turned) turned = matmul(material%axes(:size(vector), :size(vector)), vector)
    end function along
  end subroutine add_electricity
end module host_piezoelectric
