! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A truss in space with large displacements (Green's strain, St. Venant and Kirchhoff): PROPS Young's modulus, area.
! SVARS: strain, stress.
      include '../../harness/uel.inc'
      dimension before(3),after(3),b(6),geometry(6,6)
      rhs(1:6,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      before = coords(1:3,2) - coords(1:3,1)
      after = before + u(4:6) - u(1:3)
      span = sqrt(sum(before**2))
      strain = (sum(after**2) - span**2)/(2*span**2)
      stress = props(1)*strain
      b = (/ -after, after /)/span**2
      volume = props(2)*span
      rhs(1:6,1) = -volume*stress*b
      geometry = 0
      do i = 1, 3
        geometry(i,i) = 1/span**2
        geometry(i+3,i+3) = 1/span**2
        geometry(i,i+3) = -1/span**2
        geometry(i+3,i) = -1/span**2
      end do
      do i = 1, 6
        amatrx(:,i) = volume*(props(1)*b*b(i) + stress*geometry(:,i))
      end do
      energy(2) = volume*stress*strain/2
      svars(1) = strain
      svars(2) = stress
      end
