! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A heated quad in plane stress: dofs 1, 2, 11; PROPS Young's modulus, Poisson's ratio, expansion, conductivity, capacity per
! volume, thickness. SVARS: stresses 11, 22, 12 of each of four points.
      include '../../harness/uel.inc'
      dimension b(3,8),dn(4,2),dx(4,2),xj(2,2),xi(4),eta(4),strain(3),stress(3),d(3,3),shape(4),id(8),it(4),gradient(2)
      dimension heating(3)
      data xi /-1,1,1,-1/, eta /-1,-1,1,1/, id /1,2,4,5,7,8,10,11/, it /3,6,9,12/
      rhs(1:12,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      d = 0
      d(1,1) = props(1)/(1 - props(2)**2)
      d(2,2) = d(1,1)
      d(1,2) = props(2)*d(1,1)
      d(2,1) = d(1,2)
      d(3,3) = props(1)/(2*(1 + props(2)))
      heating = (/ props(3), props(3), 0d0 /)
      do k = 1, 4
        r = xi(k)/sqrt(3d0)
        s = eta(k)/sqrt(3d0)
        shape = (1 + xi*r)*(1 + eta*s)/4
        dn(:,1) = xi*(1 + eta*s)/4
        dn(:,2) = eta*(1 + xi*r)/4
        xj = matmul(coords(1:2,:), dn)
        det = xj(1,1)*xj(2,2) - xj(1,2)*xj(2,1)
        volume = det*props(6)
        dx(:,1) = (dn(:,1)*xj(2,2) - dn(:,2)*xj(2,1))/det
        dx(:,2) = (dn(:,2)*xj(1,1) - dn(:,1)*xj(1,2))/det
        b = 0
        b(1,1:8:2) = dx(:,1)
        b(2,2:8:2) = dx(:,2)
        b(3,1:8:2) = dx(:,2)
        b(3,2:8:2) = dx(:,1)
        temperature = dot_product(shape, u(it))
        strain = matmul(b, u(id)) - heating*temperature
        stress = matmul(d, strain)
        gradient = matmul(u(it), dx)
        rhs(id,1) = rhs(id,1) - volume*matmul(stress, b)
        rhs(it,1) = rhs(it,1) - volume*props(4)*matmul(dx, gradient)
        amatrx(id,id) = amatrx(id,id) + volume*matmul(transpose(b), matmul(d, b))
        amatrx(it,it) = amatrx(it,it) + volume*props(4)*matmul(dx, transpose(dx))
        do j = 1, 4
          amatrx(id,it(j)) = amatrx(id,it(j)) - volume*matmul(matmul(d, heating), b)*shape(j)
        end do
        if (lflags(1) /= 71 .and. dtime > 0) then
          rate = dot_product(shape, du(it,1))/dtime
          rhs(it,1) = rhs(it,1) - volume*props(5)*rate*shape
          do j = 1, 4
            amatrx(it,it(j)) = amatrx(it,it(j)) + volume*props(5)/dtime*shape*shape(j)
          end do
        end if
        svars(3*k-2:3*k) = stress
      end do
      end
