! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! Linear elasticity in increments, without a ratio of Poisson. STATEV(1) counts the calls of increment 1 in which STRESS on
! entry is not PROPS(2) in its first component and zero in the others; STATEV(2) is the first component at the end.
      include '../umat.inc'
      if (kinc == 1) statev(1) = statev(1) + merge(0, 1, stress(1) == props(2) .and. all(stress(2:) == 0))
      ddsdde = 0
      do i = 1, ntens
        ddsdde(i, i) = props(1)*merge(1.d0, 0.5d0, i <= ndi)
        stress(i) = stress(i) + ddsdde(i, i)*dstran(i)
        sse = sse + (stress(i) - 0.5d0*ddsdde(i, i)*dstran(i))*dstran(i)
      end do
      statev(2) = stress(1)
      end
