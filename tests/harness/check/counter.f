! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A spring of stiffness 1 along x with a fault: a counter of its calls goes into
! the array that JPROPS(1) says: 0 none, 1 RHS, 2 AMATRX, 3 SVARS, 4 ENERGY,
! 5 PNEWDT, 7 column 2 of RHS; 6: the first call of all must be that of
! element 1.
      include '../uel.inc'
      integer :: calls = 0
      calls = calls + 1
      if (jprops(1) .eq. 6 .and. calls .eq. 1 .and. jelem .ne. 1)
     &  call xit
      c = 1d-12*calls
      rhs(1,1) = u(2) - u(1)
      rhs(2,1) = u(1) - u(2)
      if (nrhs .eq. 2) rhs(1:2,2) = 0
      amatrx = reshape((/ 1d0, -1d0, -1d0, 1d0 /), (/ 2, 2 /))
      svars(1) = svars(1) + du(2,1) - du(1,1)
      energy(2) = (u(2) - u(1))**2/2
      if (jprops(1) .eq. 1) rhs(2,1) = rhs(2,1) + c
      if (jprops(1) .eq. 2) amatrx(1,2) = amatrx(1,2) + c
      if (jprops(1) .eq. 3) svars(2) = calls
      if (jprops(1) .eq. 4) energy(2) = energy(2) + c
      if (jprops(1) .eq. 5) pnewdt = 2 + c
      if (jprops(1) .eq. 7 .and. nrhs .eq. 2) rhs(1,2) = c
      end
