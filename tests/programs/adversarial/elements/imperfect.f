! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A triangle in plane stress whose stiffness scatters from element to element: a random number that follows from the number of the
! element, the same in every call. PROPS Young's modulus, Poisson's ratio, thickness, scatter. Loads U1 and U2 are forces per
! volume in directions 1 and 2, U3NU is one in direction 2 that grows with x; its magnitude is PROPS(5) per length and unit of time.
      include '../../harness/uel.inc'
      dimension dx(3,2),b(3,6),d(3,3),stress(3)
      rhs(1:6,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      chance = sin(12.9898d0*jelem)*43758.5453d0
      chance = chance - floor(chance)
      e = props(1)*(1 + props(4)*(2*chance - 1))
      det = (coords(1,2) - coords(1,1))*(coords(2,3) - coords(2,1)) - (coords(1,3) - coords(1,1))*(coords(2,2) - coords(2,1))
      do n = 1, 3
        m1 = mod(n, 3) + 1
        m2 = mod(n + 1, 3) + 1
        dx(n,1) = (coords(2,m1) - coords(2,m2))/det
        dx(n,2) = (coords(1,m2) - coords(1,m1))/det
      end do
      volume = det/2*props(3)
      b = 0
      b(1,1:6:2) = dx(:,1)
      b(2,2:6:2) = dx(:,2)
      b(3,1:6:2) = dx(:,2)
      b(3,2:6:2) = dx(:,1)
      d = 0
      d(1,1) = e/(1 - props(2)**2)
      d(2,2) = d(1,1)
      d(1,2) = props(2)*d(1,1)
      d(2,1) = d(1,2)
      d(3,3) = e/(2*(1 + props(2)))
      stress = matmul(d, matmul(b, u))
      rhs(1:6,1) = -volume*matmul(stress, b)
      amatrx = volume*matmul(transpose(b), matmul(d, b))
      do i = 1, ndload
        if (jdltyp(i,1) == 1) rhs(1:6:2,1) = rhs(1:6:2,1) + volume*adlmag(i,1)/3
        if (jdltyp(i,1) == 2) rhs(2:6:2,1) = rhs(2:6:2,1) + volume*adlmag(i,1)/3
        if (jdltyp(i,1) == -3) rhs(2:6:2,1) = rhs(2:6:2,1) + volume*props(5)*time(1)*sum(coords(1,:))/9
      end do
      svars(1:3) = stress
      end
