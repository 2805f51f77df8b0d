! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A quad with eight nodes and reduced integration (2 x 2) in plane strain: it has one mode without energy that does not pass to
! its neighbours. PROPS Young's modulus, Poisson's ratio, thickness. SVARS: strains of each of four points.
      include '../../harness/uel.inc'
      dimension b(3,16),dn(8,2),dx(8,2),xj(2,2),xi(8),eta(8),strain(3),d(3,3)
      data xi /-1,1,1,-1,0,1,0,-1/, eta /-1,-1,1,1,-1,0,1,0/
      rhs(1:16,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      d = 0
      factor = props(1)/((1 + props(2))*(1 - 2*props(2)))
      d(1,1) = factor*(1 - props(2))
      d(2,2) = d(1,1)
      d(1,2) = factor*props(2)
      d(2,1) = d(1,2)
      d(3,3) = props(1)/(2*(1 + props(2)))
      energy(2) = 0
      do k = 1, 4
        r = xi(k)/sqrt(3d0)
        s = eta(k)/sqrt(3d0)
        do n = 1, 8
          if (n <= 4) then
            dn(n,1) = xi(n)*(1 + eta(n)*s)*(2*xi(n)*r + eta(n)*s)/4
            dn(n,2) = eta(n)*(1 + xi(n)*r)*(2*eta(n)*s + xi(n)*r)/4
          else if (xi(n) == 0) then
            dn(n,1) = -r*(1 + eta(n)*s)
            dn(n,2) = eta(n)*(1 - r**2)/2
          else
            dn(n,1) = xi(n)*(1 - s**2)/2
            dn(n,2) = -s*(1 + xi(n)*r)
          end if
        end do
        xj = matmul(coords(1:2,:), dn)
        det = xj(1,1)*xj(2,2) - xj(1,2)*xj(2,1)
        volume = det*props(3)
        dx(:,1) = (dn(:,1)*xj(2,2) - dn(:,2)*xj(2,1))/det
        dx(:,2) = (dn(:,2)*xj(1,1) - dn(:,1)*xj(1,2))/det
        b = 0
        b(1,1:16:2) = dx(:,1)
        b(2,2:16:2) = dx(:,2)
        b(3,1:16:2) = dx(:,2)
        b(3,2:16:2) = dx(:,1)
        strain = matmul(b, u)
        rhs(1:16,1) = rhs(1:16,1) - volume*matmul(matmul(d, strain), b)
        amatrx = amatrx + volume*matmul(transpose(b), matmul(d, b))
        energy(2) = energy(2) + volume*dot_product(strain, matmul(d, strain))/2
        svars(3*k-2:3*k) = strain
      end do
      end
