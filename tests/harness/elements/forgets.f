! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A spring of stiffness 1 that adds the force on node 1 to a local variable without a value, where another routine has left 7.
      include '../uel.inc'
      call leave()
      call forget(u,rhs)
      amatrx(1,1) = 1
      amatrx(2,2) = 1
      amatrx(1,2) = -1
      amatrx(2,1) = -1
      end

      subroutine leave()
      real*8, volatile :: junk(20)
      junk = 7
      end

      subroutine forget(u,rhs)
      real*8 u(2), rhs(2)
      real*8, volatile :: force(20)
      force(10) = force(10) + u(2) - u(1)
      rhs(1) = force(10)
      rhs(2) = u(1) - u(2)
      end
