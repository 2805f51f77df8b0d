! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Linear elasticity of an orthotropic material, in the plane and in space, from engineering constants.
module materials_linear_elasticity
  use core_kinds, only: dp
  use core_rotation, only: ply_axes, strain_rotation
  use core_small_matrix, only: add_product, invert
  use core_status, only: status_type, not_positive_definite
  use core_symmetric, only: eigenvalues
  implicit none(type, external)
  private
  public :: engineering_constants, plane_stiffness, solid_stiffness, plane_expansion, solid_expansion, young_modulus
  public :: plane_stress, plane_strain

  integer, parameter :: plane_stress = 0
  integer, parameter :: plane_strain = 1

  real(dp), parameter :: degree = acos(-1.0_dp)/180.0_dp

  !> Constants; nu_ij is the contraction along j under stress along i.
  type :: engineering_constants
    real(dp) :: e1, e2, e3         !< Young's moduli, stress; e3 does not matter in plane stress
    real(dp) :: nu12, nu13, nu23   !< Poisson's ratios; nu13 and nu23 do not matter in plane stress
    real(dp) :: g12                !< shear modulus, stress
    real(dp) :: angle              !< of axis 1 from the global x axis, in space from the first axis, counter-clockwise, degrees
    real(dp) :: g13 = 0.0_dp, g23 = 0.0_dp   !< shear moduli in space, stress
    real(dp) :: expansion(3) = 0.0_dp        !< thermal expansion along the axes, 1/temperature
  end type engineering_constants

contains

  !> Stiffness that takes (e11, e22, 2 e12) to (s11, s22, s12), in global axes.
  pure subroutine plane_stiffness(material, plane, stiffness, status)
    type(engineering_constants), intent(in) :: material
    integer, intent(in) :: plane                 !< plane_stress or plane_strain
    real(dp), intent(out) :: stiffness(3, 3)     !< stress
    type(status_type), intent(out) :: status     !< not_positive_definite: value is what should be positive
    real(dp) :: c11, c12, c22, det

    stiffness = 0.0_dp
    if (plane == plane_strain .and. .not. material%e3 > 0.0_dp) then
      status = status_type(not_positive_definite, 0, material%e3, 0.0_dp)
      return
    end if
    c11 = 1.0_dp/material%e1
    c22 = 1.0_dp/material%e2
    c12 = -material%nu12/material%e1
    ! no strain along 3: the compliance is the Schur complement of its entry, positive definite if and only if all is
    if (plane == plane_strain) then
      c11 = c11 - material%nu13**2*material%e3/material%e1**2
      c22 = c22 - material%nu23**2*material%e3/material%e2**2
      c12 = c12 - material%nu13*material%nu23*material%e3/(material%e1*material%e2)
    end if
    det = c11*c22 - c12**2
    if (.not. (c11 > 0.0_dp .and. c22 > 0.0_dp .and. det > 0.0_dp)) then
      status = status_type(not_positive_definite, 0, min(c11*material%e1, c22*material%e2, &
        det*material%e1*material%e2), 0.0_dp)
      return
    end if
    stiffness(1, 1) = c22/det
    stiffness(2, 2) = c11/det
    stiffness(1, 2) = -c12/det
    stiffness(2, 1) = stiffness(1, 2)
    stiffness(3, 3) = material%g12
    if (abs(material%angle) > 0.0_dp) call rotate(material%angle, stiffness)
  end subroutine plane_stiffness

  !> Rotates a plane stiffness from material axes, at an angle (degrees) to the global ones, to global axes.
  pure subroutine rotate(angle, stiffness)
    real(dp), intent(in) :: angle
    real(dp), intent(inout) :: stiffness(3, 3)
    real(dp) :: c, s, to_local(3, 3)

    c = cos(angle*degree)
    s = sin(angle*degree)
    ! strains, with engineering shear, in material axes from those in global axes
    to_local(1, :) = [c*c, s*s, c*s]
    to_local(2, :) = [s*s, c*c, -c*s]
    to_local(3, :) = [-2.0_dp*c*s, 2.0_dp*c*s, c*c - s*s]
    stiffness = matmul(transpose(to_local), matmul(stiffness, to_local))
  end subroutine rotate

  !> Stiffness that takes (e11, e22, e33, 2 e12, 2 e13, 2 e23) to (s11, s22, s33, s12, s13, s23), in global axes.
  pure subroutine solid_stiffness(material, frame, stiffness, status)
    type(engineering_constants), intent(in) :: material
    real(dp), intent(in) :: frame(3, 3)          !< rows s, n and t: the angle is from s to t, and n is the material axis 3
    real(dp), intent(out) :: stiffness(6, 6)     !< stress
    type(status_type), intent(out) :: status     !< not_positive_definite: value is what should be positive
    real(dp) :: compliance(3, 3), inverse(3, 3), values(3), to_local(6, 6), to_global(6, 6), local(6, 6), determinant
    logical :: good

    stiffness = 0.0_dp
    if (.not. material%e3 > 0.0_dp) then
      status = status_type(not_positive_definite, 0, material%e3, 0.0_dp)
      return
    end if
    compliance(1, :) = [1.0_dp, -material%nu12, -material%nu13]/material%e1
    compliance(2, :) = [-material%nu12/material%e1, 1.0_dp/material%e2, -material%nu23/material%e2]
    compliance(3, :) = [-material%nu13/material%e1, -material%nu23/material%e2, 1.0_dp/material%e3]
    if (.not. minval(leading_minors(material)) > 0.0_dp) then
      call eigenvalues(unit_diagonal(compliance), values, good)
      status = status_type(not_positive_definite, 0, minval(values), 0.0_dp)
      return
    end if
    call invert(3, compliance, inverse, determinant)
    to_local = strain_rotation(ply_axes(frame, material%angle))
    local(1:3, :) = matmul(inverse, to_local(1:3, :))
    local(4, :) = material%g12*to_local(4, :)
    local(5, :) = material%g13*to_local(5, :)
    local(6, :) = material%g23*to_local(6, :)
    to_global = transpose(to_local)
    call add_product(6, 6, 6, to_global, transpose(local), stiffness)
  end subroutine solid_stiffness

  !> Strain (e11, e22, 2 e12) of a body that is free in the plane and one degree warmer, in global axes. In plane strain the
  !> expansion along 3, which is prevented, adds what the stress along 3 makes of it.
  pure function plane_expansion(material, plane) result(strain)
    type(engineering_constants), intent(in) :: material
    integer, intent(in) :: plane                 !< plane_stress or plane_strain
    real(dp) :: strain(3)
    real(dp) :: along, across, c, s

    along = material%expansion(1)
    across = material%expansion(2)
    if (plane == plane_strain) then
      along = along + material%nu13*material%e3/material%e1*material%expansion(3)
      across = across + material%nu23*material%e3/material%e2*material%expansion(3)
    end if
    c = cos(material%angle*degree)
    s = sin(material%angle*degree)
    strain = [c*c*along + s*s*across, s*s*along + c*c*across, 2.0_dp*c*s*(along - across)]
  end function plane_expansion

  !> Strain (e11, e22, e33, 2 e12, 2 e13, 2 e23) of a free body that is one degree warmer, in global axes.
  pure function solid_expansion(material, frame) result(strain)
    type(engineering_constants), intent(in) :: material
    real(dp), intent(in) :: frame(3, 3)          !< as in `solid_stiffness`
    real(dp) :: strain(6)
    real(dp) :: axes(3, 3), tensor(3, 3)
    integer :: i, j

    axes = ply_axes(frame, material%angle)
    do j = 1, 3
      do i = 1, 3
        tensor(i, j) = sum(material%expansion*axes(:, i)*axes(:, j))
      end do
    end do
    strain = [tensor(1, 1), tensor(2, 2), tensor(3, 3), 2.0_dp*tensor(1, 2), 2.0_dp*tensor(1, 3), 2.0_dp*tensor(2, 3)]
  end function solid_expansion

  !> Young's modulus along a direction in the plane of axes 1 and 2.
  pure function young_modulus(material, direction) result(modulus)
    type(engineering_constants), intent(in) :: material
    real(dp), intent(in) :: direction(2)   !< along the axis from which the angle counts, and across it; not zero
    real(dp) :: modulus
    real(dp) :: c, s, along, across

    c = cos(material%angle*degree)
    s = sin(material%angle*degree)
    along = (c*direction(1) + s*direction(2))**2/sum(direction**2)
    across = 1.0_dp - along
    modulus = 1.0_dp/(along**2/material%e1 + across**2/material%e2 &
      + along*across*(1.0_dp/material%g12 - 2.0_dp*material%nu12/material%e1))
  end function young_modulus

  !> Leading minors of the compliance of the direct strains, with its rows and columns scaled so that its diagonal is 1: all are
  !> positive if and only if it is positive definite.
  pure function leading_minors(material) result(minors)
    type(engineering_constants), intent(in) :: material
    real(dp) :: minors(2)
    real(dp) :: squares(3)

    associate (m => material)
      squares = [m%nu12**2*m%e2/m%e1, m%nu13**2*m%e3/m%e1, m%nu23**2*m%e3/m%e2]
      minors(1) = 1.0_dp - squares(1)
      minors(2) = 1.0_dp - sum(squares) - 2.0_dp*m%nu12*m%nu13*m%nu23*m%e3/m%e1
    end associate
  end function leading_minors

  !> A symmetric matrix with its rows and columns scaled so that its diagonal is 1.
  pure function unit_diagonal(matrix) result(scaled)
    real(dp), intent(in) :: matrix(3, 3)
    real(dp) :: scaled(3, 3)
    integer :: i, j

    do j = 1, 3
      do i = 1, 3
        scaled(i, j) = matrix(i, j)/sqrt(matrix(i, i)*matrix(j, j))
      end do
    end do
  end function unit_diagonal

end module materials_linear_elasticity
