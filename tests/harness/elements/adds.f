! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A spring of stiffness 1 that adds to RHS and AMATRX; it sets them to zero first unless JPROPS(1) = 1.
      include '../uel.inc'
      if (jprops(1) /= 1) then
        rhs(1:2,1) = 0
        amatrx(1:2,1:2) = 0
      end if
      rhs(1,1) = rhs(1,1) + u(2) - u(1)
      rhs(2,1) = rhs(2,1) + u(1) - u(2)
      amatrx(1,1) = amatrx(1,1) + 1
      amatrx(2,2) = amatrx(2,2) + 1
      amatrx(1,2) = amatrx(1,2) - 1
      amatrx(2,1) = amatrx(2,1) - 1
      energy(2) = (u(2) - u(1))**2/2
      end
