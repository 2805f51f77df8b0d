! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A beam along x of unit EA and EI, whose rotation is dof 3, where Abaqus has a displacement. With JPROPS(1) = 0
! the rotation does nothing, and a rotation of the displacements is resisted.
      include '../uel.inc'
      dimension bend(4,4)
      span = coords(1,2) - coords(1,1)
      bend(:,1) = (/ 12d0, 6*span, -12d0, 6*span /)
      bend(:,2) = (/ 6*span, 4*span**2, -6*span, 2*span**2 /)
      bend(:,3) = -bend(:,1)
      bend(:,4) = (/ 6*span, 2*span**2, -6*span, 4*span**2 /)
      if (jprops(1) == 0) bend(2:4:2,:) = 0
      if (jprops(1) == 0) bend(:,2:4:2) = 0
      amatrx = 0
      amatrx(1,1) = 1/span
      amatrx(4,4) = 1/span
      amatrx(1,4) = -1/span
      amatrx(4,1) = -1/span
      amatrx((/2, 3, 5, 6/),(/2, 3, 5, 6/)) = bend/span**3
      rhs(1:6,1) = -matmul(amatrx, u)
      end
