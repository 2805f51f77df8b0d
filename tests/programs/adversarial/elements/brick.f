! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A brick with eight nodes, small strains, and mass: PROPS Young's modulus, Poisson's ratio, density. Static steps and dynamic
! ones by the operator of Hilber, Hughes and Taylor, with the internal forces of the last two increments in SVARS(1:48).
! The mass is lumped.
      include '../../harness/uel.inc'
      dimension b(6,24),d(6,6),stiff(24,24),force(24),mass(24),xi(8),eta(8),zeta(8)
      double precision mass
      data xi /-1,1,1,-1,-1,1,1,-1/, eta /-1,-1,1,1,-1,-1,1,1/, zeta /-1,-1,-1,-1,1,1,1,1/
      rhs(1:24,1) = 0
      amatrx = 0
      if (lflags(3) == 3) return
      d = 0
      shear = props(1)/(2*(1 + props(2)))
      d(1:3,1:3) = props(1)*props(2)/((1 + props(2))*(1 - 2*props(2)))
      do i = 1, 3
        d(i,i) = d(i,i) + 2*shear
        d(i+3,i+3) = shear
      end do
      stiff = 0
      mass = 0
      do k = 1, 8
        call strains(coords, mcrd, xi, eta, zeta, xi(k)/sqrt(3d0), eta(k)/sqrt(3d0), zeta(k)/sqrt(3d0), b, volume)
        stiff = stiff + volume*matmul(transpose(b), matmul(d, b))
        mass = mass + volume*props(3)/8
      end do
      force = matmul(stiff, u)
      if (lflags(3) == 1 .and. lflags(1) <= 2) then
        rhs(1:24,1) = -force
        amatrx = stiff
        svars(1:24) = force
        energy(2) = dot_product(u, force)/2
      else if (lflags(3) == 1) then
        rhs(1:24,1) = -mass*a - (1 + params(1))*force + params(1)*svars(1:24)
        amatrx = (1 + params(1))*stiff
        do i = 1, 24
          amatrx(i,i) = amatrx(i,i) + mass(i)/(params(2)*dtime**2)
        end do
        svars(25:48) = svars(1:24)
        svars(1:24) = force
        energy(1) = sum(mass*v**2)/2
        energy(2) = dot_product(u, force)/2
      else if (lflags(3) == 2) then
        amatrx = stiff
      else if (lflags(3) == 5) then
        if (lflags(1) <= 2) then
          rhs(1:24,1) = -force
        else
          rhs(1:24,1) = -mass*a - (1 + params(1))*force + params(1)*(svars(1:24) + svars(25:48))/2
        end if
      else
        do i = 1, 24
          amatrx(i,i) = mass(i)
        end do
        if (lflags(3) == 6) then
          rhs(1:24,1) = -force
          svars(1:24) = force
          energy(1) = sum(mass*v**2)/2
          energy(2) = dot_product(u, force)/2
        end if
      end if
      end

      subroutine strains(coords, mcrd, xi, eta, zeta, r, s, t, b, volume)
      include 'aba_param.inc'
      dimension coords(mcrd,8),xi(8),eta(8),zeta(8),b(6,24),dn(8,3),dx(8,3),xj(3,3),xinv(3,3)
      dn(:,1) = xi*(1 + eta*s)*(1 + zeta*t)/8
      dn(:,2) = eta*(1 + xi*r)*(1 + zeta*t)/8
      dn(:,3) = zeta*(1 + xi*r)*(1 + eta*s)/8
      xj = matmul(coords(1:3,:), dn)
      volume = xj(1,1)*(xj(2,2)*xj(3,3) - xj(2,3)*xj(3,2)) - xj(1,2)*(xj(2,1)*xj(3,3) - xj(2,3)*xj(3,1))
     1 + xj(1,3)*(xj(2,1)*xj(3,2) - xj(2,2)*xj(3,1))
      do i = 1, 3
        do j = 1, 3
          m1 = mod(j, 3) + 1
          m2 = mod(j + 1, 3) + 1
          n1 = mod(i, 3) + 1
          n2 = mod(i + 1, 3) + 1
          xinv(i,j) = (xj(m1,n1)*xj(m2,n2) - xj(m1,n2)*xj(m2,n1))/volume
        end do
      end do
      dx = matmul(dn, xinv)
      b = 0
      do n = 1, 8
        do i = 1, 3
          b(i,3*n-3+i) = dx(n,i)
        end do
        b(4,3*n-2) = dx(n,2)
        b(4,3*n-1) = dx(n,1)
        b(5,3*n-2) = dx(n,3)
        b(5,3*n) = dx(n,1)
        b(6,3*n-1) = dx(n,3)
        b(6,3*n) = dx(n,2)
      end do
      end
