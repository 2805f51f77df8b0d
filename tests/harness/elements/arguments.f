! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! Tells what it is given: SVARS hold scalars, COORDS, U and DU, PREDEF; RHS is 1, 2, ... and AMATRX(i,j) is 10 i + j.
      include '../uel.inc'
      do j = 1, ndofel
        rhs(j,1) = j
        do i = 1, ndofel
          amatrx(i,j) = 10*i + j
        end do
      end do
      svars(1) = ndofel
      svars(2) = nrhs
      svars(3) = nsvars
      svars(4) = nprops
      svars(5) = mcrd
      svars(6) = nnode
      svars(7) = jtype
      svars(8) = time(1)
      svars(9) = time(2)
      svars(10) = dtime
      svars(11) = kstep
      svars(12) = kinc
      svars(13) = jelem
      svars(14) = ndload
      svars(15) = npredf
      svars(16) = mlvarx
      svars(17) = pnewdt
      svars(18) = njprop
      svars(19) = period
      svars(20:24) = lflags(1:5)
      svars(25) = props(nprops)
      svars(26) = jprops(njprop)
      svars(27) = sum(abs(v)) + sum(abs(a)) + sum(abs(predef))
      k = 30
      do j = 1, nnode
        do i = 1, mcrd
          svars(k+1) = coords(i,j)
          k = k + 1
        end do
      end do
      svars(k+1:k+ndofel) = u
      svars(k+ndofel+1:k+2*ndofel) = du(1:ndofel,1)
      end
