! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A rod between two nodes with one temperature each (dof 11): conductance PROPS(1), heat capacity PROPS(2) at each node,
! backward Euler. The conductance grows by PROPS(3) per degree of the mean temperature. JPROPS(1) = 1 prints each call.
      include '../uel.inc'
      if (jprops(1) .eq. 1) write (7,'(a,7i4,3es24.16)') 'UEL',
     &  lflags(1:5), kstep, kinc, u(1:2), dtime
      g = props(1) + props(3)*(u(1) + u(2))/2
      q = g*(u(2) - u(1))
      rhs(1,1) = q
      rhs(2,1) = -q
      h = props(3)*(u(2) - u(1))/2
      amatrx = reshape((/ g - h, h - g, -g - h, h + g /), (/ 2, 2 /))
      if (lflags(1) .eq. 31 .or. lflags(1) .eq. 71) return
      if (dtime .le. 0) return
      do i = 1, 2
        rhs(i,1) = rhs(i,1) - props(2)*du(i,1)/dtime
        amatrx(i,i) = amatrx(i,i) + props(2)/dtime
      end do
      end
