! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Built-in plane continuum elements CPS3, CPS4, CPS8 and CPS8R, and CPE likewise, as a procedure with the arguments of
!> UELMAT.
!>
!> Full integration: 1 point in triangles, 2 x 2 Gauss points in quadrilaterals of four nodes, 3 x 3 in those of eight,
!> 2 x 2 where the name ends in R. NSVARS tells how many points there are. CPE4 replaces the volume strain of the
!> points by its mean over the element, as Abaqus does (Theory Guide, Solid isoparametric quadrilaterals and hexahedra:
!> selectively reduced integration), with half of the difference on each direction in the plane.
!> PROPS(1) is the thickness. SVARS hold, for each point, E11 E22 E33 E12 S11 S22 S33 S12, in the directions of
!> *ORIENTATION where the section has one, as Abaqus prints them.
module host_solid
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_materials, only: elastic_energy, find_material, material_t, stress_update, thickness_strain
  use host_messages, only: add_message
  use host_protect, only: escape
  implicit none (type, external)
  private
  public :: solid_uelmat, point_position

  integer, parameter :: per_point = 8

contains

  subroutine solid_uelmat(rhs, amatrx, svars, energy, ndofel, nrhs, nsvars, props, nprops, coords, mcrd, nnode, u, du, &
                          v, a, jtype, time, dtime, kstep, kinc, jelem, params, ndload, jdltyp, adlmag, predef, npredf, &
                          lflags, mlvarx, ddlmag, mdload, pnewdt, jprops, njprop, period, materiallib)
    integer(i4) :: ndofel, nrhs, nsvars, nprops, mcrd, nnode, jtype, kstep, kinc, jelem, ndload, jdltyp(*), npredf, &
                   lflags(*), mlvarx, mdload, jprops(*), njprop, materiallib
    real(dp) :: rhs(*), amatrx(*), svars(*), energy(*), props(*), coords(*), u(*), du(*), v(*), a(*), time(*), dtime, &
                params(*), adlmag(*), predef(*), ddlmag(*), pnewdt, period
    integer, parameter :: stiffness_wanted(3) = [1, 2, 5]
    rhs(1:ndofel*nrhs) = 0
    amatrx(1:ndofel*ndofel) = 0
    if (.not. any(lflags(3) == stiffness_wanted)) return
    call integrate(int(nnode), int(nsvars)/per_point, find_material(materiallib), props(1), coords, u, rhs, amatrx, svars, &
                   energy)
  end subroutine solid_uelmat

  !> Residual, tangent, state and energy.
  subroutine integrate(nodes, points, material, thickness, x, u, rhs, stiffness, svars, energy)
    integer, intent(in) :: nodes, points
    type(material_t), intent(in) :: material
    real(dp), intent(in) :: thickness, x(2, nodes), u(2*nodes)
    real(dp), intent(inout) :: rhs(2*nodes), stiffness(2*nodes, 2*nodes), svars(per_point, points), energy(8)
    real(dp) :: b(3, 2*nodes, points), weight(points), strain(3), stress(3), modulus(3, 3), db(3), elastic, work
    integer :: i, j, p, n
    n = 2*nodes
    do p = 1, points
      call gradients(nodes, points, p, x, b(:, :, p), weight(p))
    end do
    if (nodes == 4 .and. material%ntens == 4) call average_volume_strain(weight, b)
    elastic = 0
    work = energy(2) + energy(4)
    ! a line across the element, half of it where there are nodes in the middle of the edges
    current%length = sqrt(sum(weight))/merge(2, 1, nodes == 8)
    do p = 1, points
      current%place = point_position(nodes, points, p, x)
      weight(p) = thickness*weight(p)
      strain = 0
      do j = 1, n
        strain = strain + b(:, j, p)*u(j)
      end do
      call point_update(material, int(p, i4), weight(p), strain, svars(:, p), stress, modulus, elastic, work)
      stress = weight(p)*stress
      modulus = weight(p)*modulus
      do j = 1, n
        rhs(j) = rhs(j) - stress(1)*b(1, j, p) - stress(2)*b(2, j, p) - stress(3)*b(3, j, p)
        db = modulus(:, 1)*b(1, j, p) + modulus(:, 2)*b(2, j, p) + modulus(:, 3)*b(3, j, p)
        do i = 1, n
          stiffness(i, j) = stiffness(i, j) + b(1, i, p)*db(1) + b(2, i, p)*db(2) + b(3, i, p)*db(3)
        end do
      end do
    end do
    energy(2) = elastic
    energy(4) = work - elastic
  end subroutine integrate

  !> Stress (11, 22, 12) and in-plane tangent of a point; its state and its part of the energies.
  subroutine point_update(material, point, volume, plane_strain, state, plane_stress, modulus, elastic, work)
    type(material_t), intent(in) :: material
    integer(i4), intent(in) :: point
    real(dp), intent(in) :: volume, plane_strain(3)
    real(dp), intent(inout) :: state(per_point), elastic, work
    real(dp), intent(out) :: plane_stress(3), modulus(3, 3)
    integer :: n
    real(dp) :: strain(4), stress(4), tangent(material%ntens, material%ntens), e(3), t(3), out_of_plane(2)
    logical :: valid
    n = material%ntens
    strain(1:3) = [plane_strain(1:2), 0.0_dp]
    strain(n) = plane_strain(3)
    call stress_update(material, point, strain, stress, tangent, valid)
    plane_stress = [stress(1), stress(2), stress(n)]
    modulus(1:2, 1:2) = tangent(1:2, 1:2)
    modulus(1:2, 3) = tangent(1:2, n)
    modulus(3, 1:2) = tangent(n, 1:2)
    modulus(3, 3) = tangent(n, n)
    elastic = elastic + volume*elastic_energy(material, point, stress)
    if (n == 3) then
      out_of_plane = [thickness_strain(material, point, stress), 0.0_dp]
    else
      out_of_plane = [0.0_dp, stress(3)]
    end if
    e = plane_strain
    t = plane_stress
    if (material%turned) then
      e(3) = e(3)/2
      e = turn(material%axes, e)
      e(3) = 2*e(3)
      t = turn(material%axes, t)
    end if
    ! trapezoidal rule, exact where the response is linear
    work = work + volume*0.5_dp*((t(1) + state(5))*(e(1) - state(1)) + (t(2) + state(6))*(e(2) - state(2)) &
                                 + (t(3) + state(8))*(e(3) - state(4)))
    state = [e(1), e(2), out_of_plane(1), e(3), t(1), t(2), out_of_plane(2), t(3)]
  end subroutine point_update

  !> Components 11, 22, 12 of a symmetric tensor along the rows of axes.
  pure function turn(axes, s) result(local)
    real(dp), intent(in) :: axes(2, 2), s(3)
    real(dp) :: local(3), tensor(2, 2)
    tensor = reshape([s(1), s(3), s(3), s(2)], [2, 2])
    tensor = matmul(axes, matmul(tensor, transpose(axes)))
    local = [tensor(1, 1), tensor(2, 2), tensor(1, 2)]
  end function turn

  !> Strain matrix (11, 22, 12) of a Gauss point, points counted along x first as in Abaqus, and its area.
  subroutine gradients(nodes, points, point, x, b, area)
    integer, intent(in) :: nodes, points, point
    real(dp), intent(in) :: x(2, nodes)
    real(dp), intent(inout) :: b(3, 2*nodes), area
    real(dp), parameter :: g = 1/sqrt(3.0_dp), corner(2, 4) = reshape([-1, -1, 1, -1, 1, 1, -1, 1], [2, 4])
    real(dp) :: r, s, local(nodes, 2), jacobian(2, 2), determinant, dx, dy
    character(len=128) :: text
    integer :: k
    real(dp) :: rule_weight
    rule_weight = merge(0.5_dp, 1.0_dp, nodes == 3)
    if (nodes == 3) then
      local(:, 1) = [-1, 1, 0]
      local(:, 2) = [-1, 0, 1]
    else if (nodes == 8) then
      call serendipity(points, point, local, rule_weight)
    else
      r = merge(-g, g, mod(point, 2) == 1)
      s = merge(-g, g, point <= 2)
      local(:, 1) = 0.25_dp*corner(1, :)*(1 + corner(2, :)*s)
      local(:, 2) = 0.25_dp*corner(2, :)*(1 + corner(1, :)*r)
    end if
    jacobian = 0
    do k = 1, nodes
      jacobian(:, 1) = jacobian(:, 1) + x(:, k)*local(k, 1)
      jacobian(:, 2) = jacobian(:, 2) + x(:, k)*local(k, 2)
    end do
    determinant = jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1)
    if (.not. determinant > 0) then
      write (text, '(a,i0,a,es10.2,a)') 'the element is inside out at its integration point ', point, &
        ' (Jacobian', determinant, '); its nodes must run counter-clockwise'
      call add_message(-3_i4, trim(text))
      call escape()
    end if
    area = rule_weight*determinant
    do k = 1, nodes
      dx = (local(k, 1)*jacobian(2, 2) - local(k, 2)*jacobian(2, 1))/determinant
      dy = (local(k, 2)*jacobian(1, 1) - local(k, 1)*jacobian(1, 2))/determinant
      b(:, 2*k - 1) = [dx, 0.0_dp, dy]
      b(:, 2*k) = [0.0_dp, dy, dx]
    end do
  end subroutine gradients

  !> Derivatives of the shape functions of eight nodes by the parent coordinates in a point of 2 x 2 or 3 x 3, and its weight.
  pure subroutine serendipity(points, point, local, weight)
    integer, intent(in) :: points, point
    real(dp), intent(out) :: local(8, 2), weight
    real(dp), parameter :: node(2, 8) = reshape([-1, -1, 1, -1, 1, 1, -1, 1, 0, -1, 1, 0, 0, 1, -1, 0], [2, 8])
    real(dp), parameter :: outer = sqrt(0.6_dp), places(3) = [-outer, 0.0_dp, outer], weights(3) = [5, 8, 5]/9.0_dp
    real(dp) :: r, s, a, b
    integer :: i, j, k
    if (points == 4) then
      r = merge(-1, 1, mod(point, 2) == 1)/sqrt(3.0_dp)
      s = merge(-1, 1, point <= 2)/sqrt(3.0_dp)
      weight = 1
    else
      i = mod(point - 1, 3) + 1
      j = (point - 1)/3 + 1
      r = places(i)
      s = places(j)
      weight = weights(i)*weights(j)
    end if
    do k = 1, 4
      a = node(1, k)*r
      b = node(2, k)*s
      local(k, :) = 0.25_dp*node(:, k)*[(1 + b)*(2*a + b), (1 + a)*(a + 2*b)]
    end do
    do k = 5, 7, 2
      local(k, :) = [-r*(1 + node(2, k)*s), 0.5_dp*node(2, k)*(1 - r**2)]
      local(k + 1, :) = [0.5_dp*node(1, k + 1)*(1 - s**2), -s*(1 + node(1, k + 1)*r)]
    end do
  end subroutine serendipity

  !> Coordinates of an integration point.
  pure function point_position(nodes, points, point, x) result(place)
    integer, intent(in) :: nodes, points, point
    real(dp), intent(in) :: x(:, :)             !< (coordinates, nodes)
    real(dp) :: place(3), parent(2), n(nodes), a, b
    real(dp), parameter :: g = 1/sqrt(3.0_dp), outer = sqrt(0.6_dp), places(3) = [-outer, 0.0_dp, outer]
    real(dp), parameter :: node(2, 8) = reshape([-1, -1, 1, -1, 1, 1, -1, 1, 0, -1, 1, 0, 0, 1, -1, 0], [2, 8])
    integer :: k
    if (points == 9) then
      parent = [places(mod(point - 1, 3) + 1), places((point - 1)/3 + 1)]
    else
      parent = [merge(-g, g, mod(point, 2) == 1), merge(-g, g, point <= 2)]
    end if
    n = 1.0_dp/nodes
    if (nodes > 3) then
      do k = 1, 4
        a = node(1, k)*parent(1)
        b = node(2, k)*parent(2)
        n(k) = 0.25_dp*(1 + a)*(1 + b)*merge(a + b - 1, 1.0_dp, nodes == 8)
      end do
      do k = 5, nodes, 2
        n(k) = 0.5_dp*(1 - parent(1)**2)*(1 + node(2, k)*parent(2))
        n(k + 1) = 0.5_dp*(1 + node(1, k + 1)*parent(1))*(1 - parent(2)**2)
      end do
    end if
    place = 0
    place(:size(x, 1)) = matmul(x, n)
  end function point_position

  !> Replace the volume strain of each point by its mean over the element.
  pure subroutine average_volume_strain(area, b)
    real(dp), intent(in) :: area(4)
    real(dp), intent(inout) :: b(3, 8, 4)
    real(dp) :: mean(8), change(8)
    integer :: p
    mean = 0
    do p = 1, 4
      mean = mean + area(p)*(b(1, :, p) + b(2, :, p))
    end do
    mean = mean/sum(area)
    do p = 1, 4
      change = (mean - b(1, :, p) - b(2, :, p))/2
      b(1, :, p) = b(1, :, p) + change
      b(2, :, p) = b(2, :, p) + change
    end do
  end subroutine average_volume_strain
end module host_solid
