! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! Consolidation (Biot) in a triangle with six nodes: displacements at all nodes, pressure (dof 11) at the corners. PROPS Young's
! modulus, Poisson's ratio, Biot's coefficient, storage, permeability. Plane strain, unit thickness; in the steps of coupled
! temperature and displacement.
      include '../../harness/uel.inc'
      dimension b(3,12),dn(6,2),dx(6,2),dl(3,2),xj(2,2),strain(3),stress(3),d(3,3),id(12),ip(3),area(3),spread(12)
      data id /1,2,4,5,7,8,10,11,12,13,14,15/, ip /3,6,9/
      rhs(1:15,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      d = 0
      factor = props(1)/((1 + props(2))*(1 - 2*props(2)))
      d(1,1) = factor*(1 - props(2))
      d(2,2) = d(1,1)
      d(1,2) = factor*props(2)
      d(2,1) = d(1,2)
      d(3,3) = props(1)/(2*(1 + props(2)))
      do k = 1, 3
        area = 1/6d0
        area(k) = 2/3d0
        r = area(2)
        s = area(3)
        t = area(1)
        dn(:,1) = (/ 1 - 4*t, 4*r - 1, 0d0, 4*(t - r), 4*s, -4*s /)
        dn(:,2) = (/ 1 - 4*t, 0d0, 4*s - 1, -4*r, 4*r, 4*(t - s) /)
        xj = matmul(coords(1:2,:), dn)
        det = xj(1,1)*xj(2,2) - xj(1,2)*xj(2,1)
        volume = det/6
        dx(:,1) = (dn(:,1)*xj(2,2) - dn(:,2)*xj(2,1))/det
        dx(:,2) = (dn(:,2)*xj(1,1) - dn(:,1)*xj(1,2))/det
        dl(:,1) = (/ -xj(2,2) + xj(2,1), xj(2,2), -xj(2,1) /)/det
        dl(:,2) = (/ -xj(1,1) + xj(1,2), -xj(1,2), xj(1,1) /)/det
        b = 0
        b(1,1:12:2) = dx(:,1)
        b(2,2:12:2) = dx(:,2)
        b(3,1:12:2) = dx(:,2)
        b(3,2:12:2) = dx(:,1)
        spread = b(1,:) + b(2,:)
        pressure = dot_product(area, u(ip))
        strain = matmul(b, u(id))
        stress = matmul(d, strain)
        rhs(id,1) = rhs(id,1) - volume*(matmul(stress, b) - props(3)*pressure*spread)
        rhs(ip,1) = rhs(ip,1) - volume*props(5)*matmul(dl, matmul(u(ip), dl))
        amatrx(id,id) = amatrx(id,id) + volume*matmul(transpose(b), matmul(d, b))
        amatrx(ip,ip) = amatrx(ip,ip) + volume*props(5)*matmul(dl, transpose(dl))
        do j = 1, 3
          amatrx(id,ip(j)) = amatrx(id,ip(j)) - volume*props(3)*spread*area(j)
        end do
        if (dtime > 0) then
          rate = (props(3)*dot_product(spread, du(id,1)) + props(4)*dot_product(area, du(ip,1)))/dtime
          rhs(ip,1) = rhs(ip,1) - volume*rate*area
          do j = 1, 3
            amatrx(ip(j),id) = amatrx(ip(j),id) + volume*props(3)/dtime*spread*area(j)
            amatrx(ip,ip(j)) = amatrx(ip,ip(j)) + volume*props(4)/dtime*area*area(j)
          end do
        end if
      end do
      end
