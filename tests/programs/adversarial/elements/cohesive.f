! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A cohesive layer of zero thickness in space between two faces, nodes 1 to 4 below and 5 to 8 above them: PROPS stiffness,
! strength, separation at failure. All separations have the same weight, closing is elastic. SVARS: largest separation of each of
! four points. ENERGY: stored, dissipated. Asks for smaller increments where damage grows by more than 0.3.
      include '../../harness/uel.inc'
      dimension jump(3,24),axes(3,3),gap(3),open(3),traction(3),d(3,3),shape(4),dn(4,2),tangent(3,2),xi(4),eta(4)
      double precision jump
      data xi /-1,1,1,-1/, eta /-1,-1,1,1/
      rhs(1:24,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      onset = props(2)/props(1)
      stored = 0
      dissipated = 0
      do k = 1, 4
        r = xi(k)/sqrt(3d0)
        s = eta(k)/sqrt(3d0)
        shape = (1 + xi*r)*(1 + eta*s)/4
        dn(:,1) = xi*(1 + eta*s)/4
        dn(:,2) = eta*(1 + xi*r)/4
        tangent = matmul(coords(1:3,1:4), dn)
        axes(3,:) = (/ tangent(2,1)*tangent(3,2) - tangent(3,1)*tangent(2,2), tangent(3,1)*tangent(1,2)
     1   - tangent(1,1)*tangent(3,2), tangent(1,1)*tangent(2,2) - tangent(2,1)*tangent(1,2) /)
        area = sqrt(sum(axes(3,:)**2))
        axes(3,:) = axes(3,:)/area
        axes(1,:) = tangent(:,1)/sqrt(sum(tangent(:,1)**2))
        axes(2,:) = (/ axes(3,2)*axes(1,3) - axes(3,3)*axes(1,2), axes(3,3)*axes(1,1) - axes(3,1)*axes(1,3),
     1   axes(3,1)*axes(1,2) - axes(3,2)*axes(1,1) /)
        jump = 0
        do n = 1, 4
          do i = 1, 3
            jump(i,3*n-3+i) = -shape(n)
            jump(i,3*n+9+i) = shape(n)
          end do
        end do
        jump = matmul(axes, jump)
        gap = matmul(jump, u)
        open = (/ gap(1), gap(2), max(gap(3), 0d0) /)
        size = sqrt(sum(open**2))
        before = max(svars(k), onset)
        peak = max(before, size)
        damage = min(props(3)*(peak - onset)/(peak*(props(3) - onset)), 1d0)
        first = min(props(3)*(before - onset)/(before*(props(3) - onset)), 1d0)
        if (damage - first > 0.3d0) pnewdt = 0.5d0
        traction = (1 - damage)*props(1)*gap
        if (gap(3) < 0) traction(3) = props(1)*gap(3)
        d = 0
        do i = 1, 3
          d(i,i) = (1 - damage)*props(1)
        end do
        if (gap(3) < 0) d(3,3) = props(1)
        if (size > before .and. size < props(3)) then
          slope = props(3)*onset/(peak**2*(props(3) - onset))
          do j = 1, 3
            d(:,j) = d(:,j) - props(1)*slope*open*open(j)/size
          end do
        end if
        rhs(1:24,1) = rhs(1:24,1) - area*matmul(traction, jump)
        amatrx = amatrx + area*matmul(transpose(jump), matmul(d, jump))
        stored = stored + area*dot_product(traction, gap)/2
        dissipated = dissipated + area*props(2)*props(3)/2*(min(peak, props(3)) - min(before, props(3)))/(props(3) - onset)
        svars(k) = peak
      end do
      energy(2) = stored
      energy(4) = energy(4) + dissipated
      end
