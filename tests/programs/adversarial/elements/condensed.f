! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A quad in plane stress with four incompatible modes inside (Taylor, Beresford and Wilson), which are condensed: PROPS Young's
! modulus, Poisson's ratio, thickness. SVARS: the amplitudes of the modes.
      include '../../harness/uel.inc'
      dimension b(3,8),bi(3,4),dn(4,2),dx(4,2),dm(2,2),xj(2,2),x0(2,2),xi(4),eta(4),d(3,3),modes(4),stiff(8,8),couple(4,8),
     1 inner(4,4),inverse(4,4)
      double precision modes,inner,inverse
      data xi /-1,1,1,-1/, eta /-1,-1,1,1/
      rhs(1:8,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      d = 0
      d(1,1) = props(1)/(1 - props(2)**2)
      d(2,2) = d(1,1)
      d(1,2) = props(2)*d(1,1)
      d(2,1) = d(1,2)
      d(3,3) = props(1)/(2*(1 + props(2)))
      stiff = 0
      couple = 0
      inner = 0
      dn(:,1) = xi/4
      dn(:,2) = eta/4
      x0 = matmul(coords(1:2,:), dn)
      det0 = x0(1,1)*x0(2,2) - x0(1,2)*x0(2,1)
      do k = 1, 4
        r = xi(k)/sqrt(3d0)
        s = eta(k)/sqrt(3d0)
        dn(:,1) = xi*(1 + eta*s)/4
        dn(:,2) = eta*(1 + xi*r)/4
        xj = matmul(coords(1:2,:), dn)
        det = xj(1,1)*xj(2,2) - xj(1,2)*xj(2,1)
        volume = det*props(3)
        dx(:,1) = (dn(:,1)*xj(2,2) - dn(:,2)*xj(2,1))/det
        dx(:,2) = (dn(:,2)*xj(1,1) - dn(:,1)*xj(1,2))/det
        b = 0
        b(1,1:8:2) = dx(:,1)
        b(2,2:8:2) = dx(:,2)
        b(3,1:8:2) = dx(:,2)
        b(3,2:8:2) = dx(:,1)
        dm(1,:) = -2*r*(/ x0(2,2), -x0(1,2) /)/det
        dm(2,:) = -2*s*(/ -x0(2,1), x0(1,1) /)/det
        bi = 0
        do m = 1, 2
          bi(1,2*m-1) = dm(m,1)
          bi(2,2*m) = dm(m,2)
          bi(3,2*m-1) = dm(m,2)
          bi(3,2*m) = dm(m,1)
        end do
        stiff = stiff + volume*matmul(transpose(b), matmul(d, b))
        couple = couple + volume*matmul(transpose(bi), matmul(d, b))
        inner = inner + volume*matmul(transpose(bi), matmul(d, bi))
      end do
      call invert4(inner, inverse)
      modes = -matmul(inverse, matmul(couple, u))
      rhs(1:8,1) = -matmul(stiff, u) - matmul(transpose(couple), modes)
      amatrx = stiff - matmul(transpose(couple), matmul(inverse, couple))
      energy(2) = -dot_product(u, rhs(1:8,1))/2
      svars(1:4) = modes
      end

      subroutine invert4(a, b)
      include 'aba_param.inc'
      dimension a(4,4),b(4,4),c(4,8)
      c = 0
      c(:,1:4) = a
      do i = 1, 4
        c(i,i+4) = 1
      end do
      do i = 1, 4
        c(i,:) = c(i,:)/c(i,i)
        do j = 1, 4
          if (j /= i) c(j,:) = c(j,:) - c(j,i)*c(i,:)
        end do
      end do
      b = c(:,5:8)
      end
