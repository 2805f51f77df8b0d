! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A bar of a standard linear solid: PROPS modulus of the parallel spring, modulus and relaxation time of the Maxwell branch,
! area. SVARS: stress of the Maxwell branch, which is integrated for a constant rate of strain. In the plane, small displacements.
      include '../../harness/uel.inc'
      dimension direction(2),b(4)
      rhs(1:4,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      direction = coords(1:2,2) - coords(1:2,1)
      span = sqrt(sum(direction**2))
      direction = direction/span
      b = (/ -direction, direction /)/span
      strain = dot_product(b, u)
      dstrain = dot_product(b, du(1:4,1))
      decay = 1
      share = 1
      if (dtime > 0) then
        decay = exp(-dtime/props(3))
        share = (1 - decay)*props(3)/dtime
      end if
      branch = decay*svars(1) + props(2)*share*dstrain
      stress = props(1)*strain + branch
      volume = span*props(4)
      rhs(1:4,1) = -volume*stress*b
      do i = 1, 4
        amatrx(:,i) = volume*(props(1) + props(2)*share)*b*b(i)
      end do
      svars(1) = branch
      end
