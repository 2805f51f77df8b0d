! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A bar that corrodes: its section shrinks with time, also where nothing moves. PROPS: Young's modulus, area, time in which the
! area falls by a factor of e. In the plane, small displacements. ENERGY(2) is what the section of that time stores.
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
      volume = span*props(2)*exp(-time(2)/props(3))
      stress = props(1)*strain
      rhs(1:4,1) = -volume*stress*b
      do i = 1, 4
        amatrx(:,i) = volume*props(1)*b*b(i)
      end do
      energy(2) = volume*stress*strain/2
      svars(1) = stress
      end
