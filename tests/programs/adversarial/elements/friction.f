! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! Friction between two edges, nodes 1, 2 below and 4, 3 above, whose limit follows from the mean pressure of the element, not
! from that of the point: PROPS normal stiffness, tangential stiffness, coefficient of friction, width. SVARS: slip of each of
! two points.
      include '../../harness/uel.inc'
      dimension jump(2,8,2),axes(2,2),gap(2,2),shape(2),mean(8),pull(8)
      double precision jump,mean
      rhs(1:8,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      axes(1,:) = coords(1:2,2) - coords(1:2,1)
      span = sqrt(sum(axes(1,:)**2))
      axes(1,:) = axes(1,:)/span
      axes(2,:) = (/ -axes(1,2), axes(1,1) /)
      jump = 0
      do k = 1, 2
        r = (2*k - 3)/sqrt(3d0)
        shape = (/ (1 - r)/2, (1 + r)/2 /)
        do i = 1, 2
          jump(i,i,k) = -shape(1)
          jump(i,i+2,k) = -shape(2)
          jump(i,i+4,k) = shape(2)
          jump(i,i+6,k) = shape(1)
        end do
        jump(:,:,k) = matmul(axes, jump(:,:,k))
        gap(:,k) = matmul(jump(:,:,k), u)
      end do
      mean = (jump(2,:,1) + jump(2,:,2))/2
      pressure = -props(1)*dot_product(mean, u)
      area = span/2*props(4)
      do k = 1, 2
        trial = props(2)*(gap(1,k) - svars(k))
        bound = props(3)*max(pressure, 0d0)
        if (abs(trial) > bound) then
          traction = sign(bound, trial)
          pull = 0
          if (pressure > 0) pull = -sign(props(3)*props(1), trial)*mean
          svars(k) = gap(1,k) - traction/props(2)
        else
          traction = trial
          pull = props(2)*jump(1,:,k)
        end if
        rhs(1:8,1) = rhs(1:8,1) - area*(traction*jump(1,:,k) + props(1)*gap(2,k)*jump(2,:,k))
        do j = 1, 8
          amatrx(:,j) = amatrx(:,j) + area*(jump(1,:,k)*pull(j) + props(1)*jump(2,:,k)*jump(2,j,k))
        end do
      end do
      end
