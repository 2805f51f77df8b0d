! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A quad in plane strain of a solid that is elastic and viscous (Kelvin): PROPS Young's modulus, Poisson's ratio, viscosity,
! thickness. The points of integration are computed in the first call and kept. ENERGY(5) is what viscosity has dissipated.
      include '../../harness/uel.inc'
      dimension b(3,8),dn(4,2),dx(4,2),xj(2,2),xi(4),eta(4),strain(3),rate(3),d(3,3),spot(2,4)
      logical ready
      save ready,spot
      data xi /-1,1,1,-1/, eta /-1,-1,1,1/, ready /.false./
      rhs(1:8,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      if (.not. ready) then
        do k = 1, 4
          spot(1,k) = xi(k)/sqrt(3d0)
          spot(2,k) = eta(k)/sqrt(3d0)
        end do
        ready = .true.
      end if
      d = 0
      factor = props(1)/((1 + props(2))*(1 - 2*props(2)))
      d(1,1) = factor*(1 - props(2))
      d(2,2) = d(1,1)
      d(1,2) = factor*props(2)
      d(2,1) = d(1,2)
      d(3,3) = props(1)/(2*(1 + props(2)))
      stored = 0
      lost = 0
      dissipated = 0
      slow = 0
      if (dtime > 0) slow = props(3)/dtime
      do k = 1, 4
        r = spot(1,k)
        s = spot(2,k)
        dn(:,1) = xi*(1 + eta*s)/4
        dn(:,2) = eta*(1 + xi*r)/4
        xj = matmul(coords(1:2,:), dn)
        det = xj(1,1)*xj(2,2) - xj(1,2)*xj(2,1)
        volume = det*props(4)
        dx(:,1) = (dn(:,1)*xj(2,2) - dn(:,2)*xj(2,1))/det
        dx(:,2) = (dn(:,2)*xj(1,1) - dn(:,1)*xj(1,2))/det
        b = 0
        b(1,1:8:2) = dx(:,1)
        b(2,2:8:2) = dx(:,2)
        b(3,1:8:2) = dx(:,2)
        b(3,2:8:2) = dx(:,1)
        strain = matmul(b, u)
        rate = matmul(b, du(1:8,1))
        rhs(1:8,1) = rhs(1:8,1) - volume*matmul(matmul(d, strain) + slow*rate, b)
        amatrx = amatrx + volume*matmul(transpose(b), matmul(d, b) + slow*b)
        stored = stored + volume*dot_product(strain, matmul(d, strain))/2
        dissipated = dissipated + volume*slow*sum(rate**2)
      end do
      energy(2) = stored
      energy(5) = energy(5) + dissipated
      end
