! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A cohesive interface of zero thickness between two edges, nodes 1, 2 below and 4, 3 above: PROPS stiffness, strength, separation
! at failure, width. Both separations have the same weight, closing is elastic. SVARS of each of two points: largest
! separation so far, damage.
      include '../../harness/uel.inc'
      dimension jump(2,8),axes(2,2),gap(2),traction(2),d(2,2),shape(2)
      double precision jump
      rhs(1:8,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      axes(1,:) = coords(1:2,2) - coords(1:2,1)
      span = sqrt(sum(axes(1,:)**2))
      axes(1,:) = axes(1,:)/span
      axes(2,:) = (/ -axes(1,2), axes(1,1) /)
      onset = props(2)/props(1)
      energy(2) = 0
      do k = 1, 2
        r = (2*k - 3)/sqrt(3d0)
        shape = (/ (1 - r)/2, (1 + r)/2 /)
        jump = 0
        do i = 1, 2
          jump(i,i) = -shape(1)
          jump(i,i+2) = -shape(2)
          jump(i,i+4) = shape(2)
          jump(i,i+6) = shape(1)
        end do
        jump = matmul(axes, jump)
        gap = matmul(jump, u)
        opening = max(gap(2), 0d0)
        size = sqrt(gap(1)**2 + opening**2)
        peak = max(svars(2*k-1), size, onset)
        damage = min(props(3)*(peak - onset)/(peak*(props(3) - onset)), 1d0)
        traction = (1 - damage)*props(1)*gap
        if (gap(2) < 0) traction(2) = props(1)*gap(2)
        d = 0
        d(1,1) = (1 - damage)*props(1)
        d(2,2) = traction(2)/merge(gap(2), 1d0, gap(2) /= 0)
        if (gap(2) == 0) d(2,2) = d(1,1)
        if (size >= peak .and. size < props(3)) then
          slope = props(3)*onset/(peak**2*(props(3) - onset))
          d(1,1) = d(1,1) - props(1)*slope*gap(1)*gap(1)/size
          d(2,2) = d(2,2) - props(1)*slope*opening*opening/size
          d(1,2) = -props(1)*slope*gap(1)*opening/size
          d(2,1) = d(1,2)
        end if
        area = span/2*props(4)
        rhs(1:8,1) = rhs(1:8,1) - area*matmul(traction, jump)
        amatrx = amatrx + area*matmul(transpose(jump), matmul(d, jump))
        svars(2*k-1) = peak
        svars(2*k) = damage
      end do
      end
