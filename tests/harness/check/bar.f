! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A bar in space of unit EA and finite rotation, with the Green-Lagrange strain. It is right with JPROPS(1) = 0; with 1 it
! leaves out the displacements in direction 3.
      include '../uel.inc'
      dimension start(3),dir(3),b(6),slope(6)
      start = coords(:,2) - coords(:,1)
      dir = start + u(4:6) - u(1:3)
      if (jprops(1) == 1) dir(3) = start(3)
      span = sqrt(dot_product(start,start))
      strain = (dot_product(dir,dir)/span**2 - 1)/2
      b(1:3) = -dir/span
      b(4:6) = dir/span
      slope = (/ -1, -1, -1, 1, 1, 1 /)
      if (jprops(1) == 1) b(3:6:3) = 0
      rhs(1:6,1) = -strain*b
      do i = 1, 6
        do j = 1, 6
          amatrx(i,j) = b(i)*b(j)/span
          if (mod(i - j, 3) == 0 .and. (jprops(1) == 0 .or.
     &        mod(i, 3) /= 0))
     &      amatrx(i,j) = amatrx(i,j) + strain*slope(i)*slope(j)/span
        end do
      end do
      energy(2) = span*strain**2/2
      end
