! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A spring PROPS(1) with the mass PROPS(2) at each of its two nodes, one unknown (dof 1) each, for dynamic steps: the
! operator of Hilber, Hughes and Taylor with the forces of the last two increments in SVARS(1:4), and static steps.
! PROPS(3) is a cubic stiffness. JPROPS(1) = 1 prints each call.
      include '../uel.inc'
      dimension force(2), stiff(2,2)
      if (jprops(1) .eq. 1) write (7,'(a,7i4,9es24.16)') 'UEL',
     &  lflags(1:5), kstep, kinc, u(2), du(2,1), v(2), a(2), time(1),
     &  dtime, params(1:3)
      d = u(2) - u(1)
      f = props(1)*d + props(3)*d**3
      s = props(1) + 3*props(3)*d**2
      force = (/ -f, f /)
      stiff = reshape((/ s, -s, -s, s /), (/ 2, 2 /))
      amatrx = 0
      if (lflags(3) .eq. 1 .and. lflags(1) .le. 2) then
        rhs(1:2,1) = -force
        amatrx = stiff
        svars(1:2) = force
        energy(2) = props(1)*d**2/2 + props(3)*d**4/4
      else if (lflags(3) .eq. 1) then
        rhs(1:2,1) = -props(2)*a(1:2) - (1 + params(1))*force
     &    + params(1)*svars(1:2)
        amatrx = (1 + params(1))*stiff
        do i = 1, 2
          amatrx(i,i) = amatrx(i,i) + props(2)/(params(2)*dtime**2)
        end do
        svars(3:4) = svars(1:2)
        svars(1:2) = force
        energy(1) = props(2)*sum(v(1:2)**2)/2
        energy(2) = props(1)*d**2/2 + props(3)*d**4/4
      else if (lflags(3) .eq. 4) then
        amatrx(1,1) = props(2)
        amatrx(2,2) = props(2)
      else if (lflags(3) .eq. 5) then
        rhs(1:2,1) = -props(2)*a(1:2) - (1 + params(1))*force
     &    + params(1)*(svars(1:2) + svars(3:4))/2
      else if (lflags(3) .eq. 6) then
        rhs(1:2,1) = -force
        amatrx(1,1) = props(2)
        amatrx(2,2) = props(2)
        svars(1:2) = force
        energy(1) = props(2)*sum(v(1:2)**2)/2
        energy(2) = props(1)*d**2/2 + props(3)*d**4/4
      end if
      end
