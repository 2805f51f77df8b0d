! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A UMAT with a modulus of its own for each component, 10, 100, ...; STATEV(1:NTENS) = strains, then sizes and CELENT.
      include '../umat.inc'
      ddsdde = 0
      do k = 1, ntens
        ddsdde(k,k) = 10**k
        stress(k) = stress(k) + 10**k*dstran(k)
        statev(k) = stran(k) + dstran(k)
      end do
      statev(ntens+1) = 100*ntens + 10*ndi + nshr
      statev(ntens+2) = celent
      end
