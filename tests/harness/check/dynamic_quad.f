! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A linear quad in plane stress for *DYNAMIC by the operator of Hilber, Hughes and Taylor, as the example of UEL in the User
! Subroutines Guide: PROPS Young's modulus, Poisson's ratio, thickness, density; SVARS forces of the last two increments.
! JPROPS(2) = 0 takes a lumped mass matrix, 1 a consistent one. It is right with JPROPS(1) = 0, and has a mistake with any
! other number.
      include '../uel.inc'
      dimension b(3,8),c(3,3),dn(2,4),shape(4),xj(2,2),xi(4),eta(4),
     & force(8),stiff(8,8),mass(8,8),def(8)
      double precision mass
      data xi /-1,1,1,-1/, eta /-1,-1,1,1/
      mistake = jprops(1)
      c = 0
      c(1,1) = props(1)/(1 - props(2)**2)
      c(2,2) = c(1,1)
      c(1,2) = props(2)*c(1,1)
      c(2,1) = c(1,2)
      c(3,3) = props(1)/(2 + 2*props(2))
      if (mistake == 53) c(3,3) = 2*c(3,3)
      stiff = 0
      mass = 0
      g = 1/sqrt(3d0)
      points = 4
      if (mistake == 2) then
        points = 1
        g = 0
      end if
      do k = 1, nint(points)
        do n = 1, 4
          dn(1,n) = xi(n)*(1 + eta(n)*eta(k)*g)/4
          dn(2,n) = eta(n)*(1 + xi(n)*xi(k)*g)/4
          shape(n) = (1 + xi(n)*xi(k)*g)*(1 + eta(n)*eta(k)*g)/4
        end do
        xj = matmul(dn, transpose(coords(1:2,:)))
        det = xj(1,1)*xj(2,2) - xj(1,2)*xj(2,1)
        w = det*props(3)*4/points
        if (mistake == 20) w = props(3)*4/points
        b = 0
        do n = 1, 4
          b(1,2*n-1) = (xj(2,2)*dn(1,n) - xj(1,2)*dn(2,n))/det
          b(2,2*n) = (xj(1,1)*dn(2,n) - xj(2,1)*dn(1,n))/det
          b(3,2*n-1) = b(2,2*n)
          if (mistake /= 3) b(3,2*n) = b(1,2*n-1)
        end do
        stiff = stiff + w*matmul(transpose(b), matmul(c, b))
        do m = 1, 4
          do n = 1, 4
            add = w*props(4)*shape(m)*shape(n)
            l = merge(m, n, jprops(2) == 0)
            mass(2*m-1,2*l-1) = mass(2*m-1,2*l-1) + add
            mass(2*m,2*l) = mass(2*m,2*l) + add
          end do
        end do
      end do
      def = u
      if (mistake == 50) def = du(1:8,1)
      force = matmul(stiff, def)
      if (mistake == 8) force(1) = force(1) + stiff(1,1)*u(1)
      if (mistake == 8) stiff(1,1) = 2*stiff(1,1)
      rhs(1:8,1) = 0
      amatrx = 0
      select case (lflags(3))
      case (1)
        if (lflags(1) == 11 .or. lflags(1) == 12) then
          alpha = params(1)
          if (mistake == 51) alpha = 0
          rhs(1:8,1) = -matmul(mass, a) - (1 + alpha)*force
          if (mistake /= 52) rhs(1:8,1) = rhs(1:8,1) + alpha*svars(1:8)
          amatrx = mass/(params(2)*dtime**2) + (1 + alpha)*stiff
        else
          rhs(1:8,1) = -force
          amatrx = stiff
        end if
        svars(9:16) = svars(1:8)
        svars(1:8) = force
        energy(1) = dot_product(v, matmul(mass, v))/2
        energy(2) = dot_product(u, force)/2
      case (2)
        amatrx = stiff
      case (4)
        amatrx = mass
      case (5)
        rhs(1:8,1) = -matmul(mass, a) - (1 + params(1))*force
     &    + params(1)*(svars(1:8) + svars(9:16))/2
      case (6)
        amatrx = mass
        rhs(1:8,1) = -force
        svars(1:8) = force
        energy(1) = dot_product(v, matmul(mass, v))/2
        energy(2) = dot_product(u, force)/2
      end select
      end
