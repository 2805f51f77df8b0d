! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A quad in plane strain of an elastic-plastic solid (Mises, linear isotropic hardening): PROPS Young's modulus, Poisson's ratio,
! yield stress, hardening modulus, thickness. SVARS of each of four points: plastic strains 11, 22, 33, 12 (tensor
! components), equivalent plastic strain.
      include '../../harness/uel.inc'
      dimension b(4,8),dn(4,2),xj(2,2),xi(4),eta(4),strain(4),stress(4),plastic(4),trial(4),flow(4),d(4,4)
      data xi /-1,1,1,-1/, eta /-1,-1,1,1/
      rhs(1:8,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      shear = props(1)/(2*(1 + props(2)))
      bulk = props(1)/(3*(1 - 2*props(2)))
      dissipated = 0
      stored = 0
      do k = 1, 4
        r = xi(k)/sqrt(3d0)
        s = eta(k)/sqrt(3d0)
        dn(:,1) = xi*(1 + eta*s)/4
        dn(:,2) = eta*(1 + xi*r)/4
        xj = matmul(coords(1:2,:), dn)
        det = xj(1,1)*xj(2,2) - xj(1,2)*xj(2,1)
        volume = det*props(5)
        b = 0
        do n = 1, 4
          dx = (dn(n,1)*xj(2,2) - dn(n,2)*xj(2,1))/det
          dy = (dn(n,2)*xj(1,1) - dn(n,1)*xj(1,2))/det
          b(1,2*n-1) = dx
          b(2,2*n) = dy
          b(4,2*n-1) = dy/2
          b(4,2*n) = dx/2
        end do
        strain = matmul(b, u)
        plastic = svars(5*k-4:5*k-1)
        alpha = svars(5*k)
        dilation = sum(strain(1:3))
        trial = 2*shear*(strain - plastic)
        trial(1:3) = trial(1:3) - 2*shear*dilation/3
        size = sqrt(sum(trial(1:3)**2) + 2*trial(4)**2)
        excess = size - sqrt(2d0/3)*(props(3) + props(4)*alpha)
        step = 0
        flow = 0
        if (size > 0) flow = trial/size
        if (excess > 0) step = excess/(2*shear + 2*props(4)/3)
        stress = trial - 2*shear*step*flow
        stress(1:3) = stress(1:3) + bulk*dilation
        d = 0
        theta = 1
        thetabar = 0
        if (excess > 0) then
          theta = 1 - 2*shear*step/size
          thetabar = 1/(1 + props(4)/(3*shear)) - (1 - theta)
        end if
        d(1:3,1:3) = bulk - 2*shear*theta/3
        do i = 1, 4
          d(i,i) = d(i,i) + 2*shear*theta
        end do
        do j = 1, 4
          weight = 1
          if (j == 4) weight = 2
          d(:,j) = d(:,j) - 2*shear*thetabar*flow*flow(j)*weight
        end do
        stress(4) = 2*stress(4)
        d(4,:) = 2*d(4,:)
        rhs(1:8,1) = rhs(1:8,1) - volume*matmul(stress, b)
        amatrx = amatrx + volume*matmul(transpose(b), matmul(d, b))
        svars(5*k-4:5*k-1) = plastic + step*flow
        svars(5*k) = alpha + sqrt(2d0/3)*step
        elastic = dot_product(stress, strain - plastic - step*flow)/2
        stored = stored + volume*elastic
        dissipated = dissipated + volume*step*dot_product(stress, flow)
      end do
      energy(2) = stored
      energy(4) = energy(4) + dissipated
      end
