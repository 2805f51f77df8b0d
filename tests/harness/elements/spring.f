! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A spring between two nodes along x: stiffness PROPS(1). SVARS(1) accumulates the elongation's increments.
      include '../uel.inc'
      s = props(1)
      rhs(1,1) = s*(u(2) - u(1))
      rhs(2,1) = -rhs(1,1)
      amatrx(1,1) = s
      amatrx(2,2) = s
      amatrx(1,2) = -s
      amatrx(2,1) = -s
      svars(1) = svars(1) + du(2,1) - du(1,1)
      energy(2) = 0.5d0*s*(u(2) - u(1))**2
      end
