! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A plate (Reissner and Mindlin) in the plane of 1 and 2: dofs 3, 4, 5; bending with four points, shear with one, so that it has
! modes without energy that its neighbours and the boundary prevent. PROPS Young's modulus, Poisson's ratio, thickness; a load U1
! is a pressure in direction 3.
      include '../../harness/uel.inc'
      dimension dn(4,2),dx(4,2),xj(2,2),xi(4),eta(4),shape(4),bb(3,12),bs(2,12),d(3,3),stiff(12,12)
      data xi /-1,1,1,-1/, eta /-1,-1,1,1/
      rhs(1:12,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      d = 0
      d(1,1) = props(1)*props(3)**3/(12*(1 - props(2)**2))
      d(2,2) = d(1,1)
      d(1,2) = props(2)*d(1,1)
      d(2,1) = d(1,2)
      d(3,3) = (1 - props(2))/2*d(1,1)
      stiff = 0
      do k = 1, 5
        r = 0
        s = 0
        if (k < 5) then
          r = xi(k)/sqrt(3d0)
          s = eta(k)/sqrt(3d0)
        end if
        shape = (1 + xi*r)*(1 + eta*s)/4
        dn(:,1) = xi*(1 + eta*s)/4
        dn(:,2) = eta*(1 + xi*r)/4
        xj = matmul(coords(1:2,:), dn)
        det = xj(1,1)*xj(2,2) - xj(1,2)*xj(2,1)
        dx(:,1) = (dn(:,1)*xj(2,2) - dn(:,2)*xj(2,1))/det
        dx(:,2) = (dn(:,2)*xj(1,1) - dn(:,1)*xj(1,2))/det
        if (k < 5) then
          bb = 0
          bb(1,3:12:3) = dx(:,1)
          bb(2,2:12:3) = -dx(:,2)
          bb(3,3:12:3) = dx(:,2)
          bb(3,2:12:3) = -dx(:,1)
          stiff = stiff + det*matmul(transpose(bb), matmul(d, bb))
          do i = 1, ndload
            if (jdltyp(i,1) == 1) rhs(1:12:3,1) = rhs(1:12:3,1) + det*adlmag(i,1)*shape
          end do
        else
          bs = 0
          bs(1,1:12:3) = dx(:,1)
          bs(1,3:12:3) = shape
          bs(2,1:12:3) = dx(:,2)
          bs(2,2:12:3) = -shape
          stiff = stiff + 4*det*5d0/6*props(3)*props(1)/(2*(1 + props(2)))*matmul(transpose(bs), bs)
        end if
      end do
      rhs(1:12,1) = rhs(1:12,1) - matmul(stiff, u)
      amatrx = stiff
      end
