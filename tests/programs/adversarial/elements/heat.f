! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! Conduction in a quad: PROPS conductivity, capacity per volume, thickness; a load U1 heats the volume. SVARS keep the flux at
! the four points. Steady (LFLAGS(1) = 31) and transient by backward differences.
      include '../../harness/uel.inc'
      dimension shape(4),dn(4,2),dx(4,2),xj(2,2),xi(4),eta(4),flux(2),gradient(2)
      data xi /-1,1,1,-1/, eta /-1,-1,1,1/
      rhs(1:4,1) = 0
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
        volume = det*props(3)
        if (lflags(3) == 4) then
          do i = 1, 4
            amatrx(i,i) = amatrx(i,i) + volume*props(2)*shape(i)
          end do
          cycle
        end if
        gradient = matmul(u, dx)
        flux = -props(1)*gradient
        rhs(1:4,1) = rhs(1:4,1) + volume*matmul(dx, flux)
        amatrx = amatrx + volume*props(1)*matmul(dx, transpose(dx))
        if (lflags(1) /= 31 .and. dtime > 0) then
          rate = dot_product(shape, du(1:4,1))/dtime
          rhs(1:4,1) = rhs(1:4,1) - volume*props(2)*rate*shape
          do j = 1, 4
            amatrx(:,j) = amatrx(:,j) + volume*props(2)/dtime*shape*shape(j)
          end do
        end if
        do i = 1, ndload
          if (jdltyp(i,1) == 1) rhs(1:4,1) = rhs(1:4,1) + volume*adlmag(i,1)*shape
        end do
        svars(2*k-1:2*k) = flux
      end do
      end
