! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A UMAT that keeps what it gets: STRESS, STRAN, DSTRAN, each NTENS, then DROT, DFGRD0, DFGRD1. PROPS: the stiffness
! (NTENS, NTENS).
      include '../umat.inc'
      statev(1:ntens) = stress
      statev(ntens+1:2*ntens) = stran
      statev(2*ntens+1:3*ntens) = dstran
      n = 3*ntens
      statev(n+1:n+9) = reshape(drot, (/ 9 /))
      statev(n+10:n+18) = reshape(dfgrd0, (/ 9 /))
      statev(n+19:n+27) = reshape(dfgrd1, (/ 9 /))
      ddsdde = reshape(props(1:ntens**2), (/ ntens, ntens /))
      stress = stress + matmul(ddsdde, dstran)
      end
