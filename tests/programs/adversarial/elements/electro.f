! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! Heat of an electric current in a quad: temperature (dof 11) and potential (dof 12), which together have a conductivity that falls
! with temperature. PROPS thermal conductivity, capacity, electric conductivity, its decrease per degree, thickness. In steps
! of heat transfer; LFLAGS(3) = 4 asks for the capacity.
      include '../../harness/uel.inc'
      dimension shape(4),dn(4,2),dx(4,2),xj(2,2),xi(4),eta(4),warmth(2),field(2),it(4),ie(4),along(4)
      data xi /-1,1,1,-1/, eta /-1,-1,1,1/, it /1,3,5,7/, ie /2,4,6,8/
      rhs(1:8,1) = 0
      amatrx = 0
      if (lflags(3) == 3) return
      do k = 1, 4
        r = xi(k)/sqrt(3d0)
        s = eta(k)/sqrt(3d0)
        shape = (1 + xi*r)*(1 + eta*s)/4
        dn(:,1) = xi*(1 + eta*s)/4
        dn(:,2) = eta*(1 + xi*r)/4
        xj = matmul(coords(1:2,:), dn)
        det = xj(1,1)*xj(2,2) - xj(1,2)*xj(2,1)
        dx(:,1) = (dn(:,1)*xj(2,2) - dn(:,2)*xj(2,1))/det
        dx(:,2) = (dn(:,2)*xj(1,1) - dn(:,1)*xj(1,2))/det
        volume = det*props(5)
        if (lflags(3) == 4) then
          do j = 1, 4
            amatrx(it,it(j)) = amatrx(it,it(j)) + volume*props(2)*shape*shape(j)
          end do
          cycle
        end if
        warmth = matmul(u(it), dx)
        field = matmul(u(ie), dx)
        along = matmul(dx, field)
        temperature = dot_product(shape, u(it))
        sigma = props(3)/(1 + props(4)*temperature)
        slope = -props(4)*sigma/(1 + props(4)*temperature)
        heat = sigma*sum(field**2)
        rhs(it,1) = rhs(it,1) + volume*(heat*shape - props(1)*matmul(dx, warmth))
        rhs(ie,1) = rhs(ie,1) - volume*sigma*along
        do j = 1, 4
          amatrx(it,it(j)) = amatrx(it,it(j)) + volume*(props(1)*matmul(dx, dx(j,:)) - slope*sum(field**2)*shape*shape(j))
          amatrx(it,ie(j)) = amatrx(it,ie(j)) - 2*volume*sigma*shape*along(j)
          amatrx(ie,it(j)) = amatrx(ie,it(j)) + volume*slope*along*shape(j)
          amatrx(ie,ie(j)) = amatrx(ie,ie(j)) + volume*sigma*matmul(dx, dx(j,:))
        end do
        if (lflags(1) /= 31 .and. dtime > 0) then
          rate = dot_product(shape, du(it,1))/dtime
          rhs(it,1) = rhs(it,1) - volume*props(2)*rate*shape
          do j = 1, 4
            amatrx(it,it(j)) = amatrx(it,it(j)) + volume*props(2)/dtime*shape*shape(j)
          end do
        end if
      end do
      end
