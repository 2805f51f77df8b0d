! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A UMAT of modulus 1000 that keeps its temperatures and field variables in STATEV(1:4), and the first strain in STATEV(5).
      include '../umat.inc'
      DDSDDE = 0
      DO K = 1, NTENS
        DDSDDE(K,K) = 1000
      END DO
      STRESS = 1000*(STRAN + DSTRAN)
      STATEV(1:4) = (/TEMP, DTEMP, PREDEF(1), DPRED(1)/)
      STATEV(5) = STRAN(1) + DSTRAN(1)
      END
