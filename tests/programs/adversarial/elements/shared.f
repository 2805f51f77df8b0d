! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! Displacements (U1: dofs 1, 2) and moisture (U2: dof 11) of the same triangles in elements of their own, numbers n and n + 100,
! solved in turns: a module keeps what one has computed for the other, and UEXTERNALDB hands it over at the end of an increment, so
! that the order of calls does not matter. Moisture swells the solid; stretching it opens its pores. PROPS of U1: Young's
! modulus, Poisson's ratio, swelling, thickness. PROPS of U2: conductivity, increase by strain, capacity, thickness.
      module exchange
      implicit none
      double precision :: given(2,100) = 0, taken(2,100) = 0
      end module

      include '../../harness/uel.inc'
      dimension dx(3,2),b(3,6),strain(3),d(3,3),eigen(3)
      rhs(1:ndofel,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      det = (coords(1,2) - coords(1,1))*(coords(2,3) - coords(2,1)) - (coords(1,3) - coords(1,1))*(coords(2,2) - coords(2,1))
      do n = 1, 3
        m1 = mod(n, 3) + 1
        m2 = mod(n + 1, 3) + 1
        dx(n,1) = (coords(2,m1) - coords(2,m2))/det
        dx(n,2) = (coords(1,m2) - coords(1,m1))/det
      end do
      volume = det/2*props(4)
      if (jtype == 1) then
        call put(jelem, 1, swelling, .false.)
        b = 0
        b(1,1:6:2) = dx(:,1)
        b(2,2:6:2) = dx(:,2)
        b(3,1:6:2) = dx(:,2)
        b(3,2:6:2) = dx(:,1)
        d = 0
        d(1,1) = props(1)/(1 - props(2)**2)
        d(2,2) = d(1,1)
        d(1,2) = props(2)*d(1,1)
        d(2,1) = d(1,2)
        d(3,3) = props(1)/(2*(1 + props(2)))
        eigen = (/ 1d0, 1d0, 0d0 /)*props(3)*swelling
        strain = matmul(b, u)
        rhs(1:6,1) = -volume*matmul(matmul(d, strain - eigen), b)
        amatrx = volume*matmul(transpose(b), matmul(d, b))
        call put(jelem, 2, strain(1) + strain(2), .true.)
      else
        call put(jelem - 100, 2, dilation, .false.)
        conductivity = props(1)*(1 + props(2)*dilation)
        rhs(1:3,1) = -volume*conductivity*matmul(dx, matmul(u, dx))
        amatrx = volume*conductivity*matmul(dx, transpose(dx))
        if (dtime > 0) then
          do n = 1, 3
            rhs(n,1) = rhs(n,1) - volume*props(3)/3*du(n,1)/dtime
            amatrx(n,n) = amatrx(n,n) + volume*props(3)/3/dtime
          end do
        end if
        call put(jelem - 100, 1, sum(u)/3, .true.)
      end if
      end

      subroutine put(number, place, value, new)
      use exchange
      include 'aba_param.inc'
      integer place
      logical new
      if (new) then
        given(place,number) = value
      else
        value = taken(place,number)
      end if
      end

      subroutine uexternaldb(lop, lrestart, time, dtime, kstep, kinc)
      use exchange
      include 'aba_param.inc'
      dimension time(2)
      if (lop == 2) taken = given
      end
