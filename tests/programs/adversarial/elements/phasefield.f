! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A phase field of brittle fracture (AT2) in plane strain, solved together with the displacements: dofs 1, 2, and 3 for the
! phase. PROPS: Young's modulus, Poisson's ratio, fracture energy, length, thickness. SVARS: the largest energy density so far
! at each of four points.
      include '../../harness/uel.inc'
      dimension b(3,8),dn(4,2),dx(4,2),xj(2,2),xi(4),eta(4),stress(3),d(3,3),shape(4),id(8),ip(4),gradient(2)
      data xi /-1,1,1,-1/, eta /-1,-1,1,1/, id /1,2,4,5,7,8,10,11/, ip /3,6,9,12/
      rhs(1:12,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      d = 0
      factor = props(1)/((1 + props(2))*(1 - 2*props(2)))
      d(1,1) = factor*(1 - props(2))
      d(2,2) = d(1,1)
      d(1,2) = factor*props(2)
      d(2,1) = d(1,2)
      d(3,3) = props(1)/(2*(1 + props(2)))
      do k = 1, 4
        r = xi(k)/sqrt(3d0)
        s = eta(k)/sqrt(3d0)
        shape = (1 + xi*r)*(1 + eta*s)/4
        dn(:,1) = xi*(1 + eta*s)/4
        dn(:,2) = eta*(1 + xi*r)/4
        xj = matmul(coords(1:2,:), dn)
        det = xj(1,1)*xj(2,2) - xj(1,2)*xj(2,1)
        volume = det*props(5)
        dx(:,1) = (dn(:,1)*xj(2,2) - dn(:,2)*xj(2,1))/det
        dx(:,2) = (dn(:,2)*xj(1,1) - dn(:,1)*xj(1,2))/det
        b = 0
        b(1,1:8:2) = dx(:,1)
        b(2,2:8:2) = dx(:,2)
        b(3,1:8:2) = dx(:,2)
        b(3,2:8:2) = dx(:,1)
        phase = dot_product(shape, u(ip))
        gradient = matmul(u(ip), dx)
        stress = matmul(d, matmul(b, u(id)))
        density = dot_product(stress, matmul(b, u(id)))/2
        history = max(svars(k), density)
        g = (1 - phase)**2 + 1d-7
        rhs(id,1) = rhs(id,1) - volume*g*matmul(stress, b)
        rhs(ip,1) = rhs(ip,1) - volume*((props(3)/props(4)*phase - 2*(1 - phase)*history)*shape
     1   + props(3)*props(4)*matmul(dx, gradient))
        amatrx(id,id) = amatrx(id,id) + volume*g*matmul(transpose(b), matmul(d, b))
        amatrx(ip,ip) = amatrx(ip,ip) + volume*props(3)*props(4)*matmul(dx, transpose(dx))
        do j = 1, 4
          amatrx(ip,ip(j)) = amatrx(ip,ip(j)) + volume*(props(3)/props(4) + 2*history)*shape*shape(j)
          amatrx(id,ip(j)) = amatrx(id,ip(j)) - volume*2*(1 - phase)*matmul(stress, b)*shape(j)
          if (density > svars(k)) amatrx(ip(j),id) = amatrx(ip(j),id) - volume*2*(1 - phase)*matmul(stress, b)*shape(j)
        end do
        svars(k) = history
      end do
      end
