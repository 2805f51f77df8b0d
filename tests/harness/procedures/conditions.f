! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A spring of stiffness 1 that adds its load of type U2 to node 2 and keeps what it was given in SVARS: NDLOAD, MDLOAD,
! JDLTYP, ADLMAG and DDLMAG of up to three loads from 3, 6 and 9 on, NPREDF in 12, PREDEF of node 2 from 13 on.
      include '../uel.inc'
      rhs(1,1) = u(2) - u(1)
      rhs(2,1) = -rhs(1,1)
      amatrx(1,1) = 1
      amatrx(2,2) = 1
      amatrx(1,2) = -1
      amatrx(2,1) = -1
      svars(1:20) = 0
      svars(1) = ndload
      svars(2) = mdload
      do k = 1, ndload
        svars(2+k) = jdltyp(k,1)
        svars(5+k) = adlmag(k,1)
        svars(8+k) = ddlmag(k,1)
        if (jdltyp(k,1) == 2) rhs(2,1) = rhs(2,1) + adlmag(k,1)
      end do
      svars(12) = npredf
      do k = 1, npredf
        svars(11+2*k) = predef(1,k,2)
        svars(12+2*k) = predef(2,k,2)
      end do
      end
