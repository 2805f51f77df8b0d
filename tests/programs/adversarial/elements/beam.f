! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! An Euler-Bernoulli beam in the plane, dofs 1, 2 and 6, small rotations: PROPS Young's modulus, area, second moment of area,
! mass per length; a load U1 is a force per length in the local direction 2. Static steps, and modes (LFLAGS(3) = 2, 4).
      include '../../harness/uel.inc'
      dimension turn(6,6),local(6,6),mass(6,6)
      double precision local,mass
      rhs(1:6,1) = 0
      amatrx = 0
      if (lflags(3) == 3) return
      span = sqrt(sum((coords(1:2,2) - coords(1:2,1))**2))
      c = (coords(1,2) - coords(1,1))/span
      s = (coords(2,2) - coords(2,1))/span
      turn = 0
      do n = 0, 3, 3
        turn(n+1,n+1) = c
        turn(n+1,n+2) = s
        turn(n+2,n+1) = -s
        turn(n+2,n+2) = c
        turn(n+3,n+3) = 1
      end do
      local = 0
      ea = props(1)*props(2)/span
      ei = props(1)*props(3)/span
      local(1,1) = ea
      local(1,4) = -ea
      local(2,2) = 12*ei/span**2
      local(2,3) = 6*ei/span
      local(2,5) = -12*ei/span**2
      local(2,6) = 6*ei/span
      local(3,3) = 4*ei
      local(3,5) = -6*ei/span
      local(3,6) = 2*ei
      local(4,4) = ea
      local(5,5) = 12*ei/span**2
      local(5,6) = -6*ei/span
      local(6,6) = 4*ei
      mass = 0
      amount = props(4)*span
      mass(1,1) = amount/3
      mass(1,4) = amount/6
      mass(4,4) = amount/3
      mass(2,2) = 156*amount/420
      mass(2,3) = 22*span*amount/420
      mass(2,5) = 54*amount/420
      mass(2,6) = -13*span*amount/420
      mass(3,3) = 4*span**2*amount/420
      mass(3,5) = 13*span*amount/420
      mass(3,6) = -3*span**2*amount/420
      mass(5,5) = 156*amount/420
      mass(5,6) = -22*span*amount/420
      mass(6,6) = 4*span**2*amount/420
      do i = 1, 6
        do j = 1, i - 1
          local(i,j) = local(j,i)
          mass(i,j) = mass(j,i)
        end do
      end do
      if (lflags(3) == 4) then
        amatrx = matmul(transpose(turn), matmul(mass, turn))
        return
      end if
      amatrx = matmul(transpose(turn), matmul(local, turn))
      rhs(1:6,1) = -matmul(amatrx, u)
      energy(2) = -dot_product(u, rhs(1:6,1))/2
      do i = 1, ndload
        if (jdltyp(i,1) == 1) then
          rhs(1:6,1) = rhs(1:6,1) + adlmag(i,1)*span*matmul(transpose(turn),
     1     (/ 0d0, 0.5d0, span/12, 0d0, 0.5d0, -span/12 /))
        end if
      end do
      end
