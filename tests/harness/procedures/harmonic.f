! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A spring PROPS(1) with a viscous damper PROPS(2) and a structural one PROPS(3), and the mass PROPS(4) at its second node,
! one unknown (dof 1) each. PROPS(5) is a force on the second node for a displacement of the first, by which the stiffness
! is not symmetric. JPROPS(1) = 1 prints each call.
      include '../uel.inc'
      if (jprops(1) .eq. 1) write (7,'(a,7i4,f8.3)') 'FLAGS', lflags(1:7), time(1)
      rhs(1,1) = props(1)*(u(2) - u(1))
      rhs(2,1) = -rhs(1,1) + props(5)*u(1)
      amatrx = 0
      if (lflags(3) .eq. 4) then
        amatrx(2,2) = props(4)
      else
        entry = props(1)
        if (lflags(3) .eq. 3) entry = props(1 + lflags(7))
        amatrx(1:2,1) = (/ entry, -entry /)
        amatrx(1:2,2) = (/ -entry, entry /)
        if (lflags(3) .ne. 3) amatrx(2,1) = amatrx(2,1) - props(5)
      end if
      end
