! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A spring of stiffness SVARS(1) between two nodes, and a UMAT of modulus STATEV(1); SDVINI sets both from the place.
      include '../uel.inc'
      AMATRX = -SVARS(1)
      AMATRX(1,1) = SVARS(1)
      AMATRX(2,2) = SVARS(1)
      RHS(1:2,1) = -MATMUL(AMATRX, U)
      END
      include '../umat.inc'
      DDSDDE = 0
      DO K = 1, NTENS
        DDSDDE(K,K) = STATEV(1)
      END DO
      STRESS = STATEV(1)*(STRAN + DSTRAN)
      END
      SUBROUTINE SDVINI(STATEV,COORDS,NSTATV,NCRDS,NOEL,NPT,LAYER,KSPT)
      INCLUDE 'ABA_PARAM.INC'
      DIMENSION STATEV(NSTATV),COORDS(NCRDS)
      STATEV(1) = 100*COORDS(1)
      IF (NSTATV .GT. 1) STATEV(2) = 10*NOEL + NPT
      IF (NOEL .EQ. 66 .OR. (NOEL .EQ. 67 .AND. NPT .EQ. 3)) CALL XIT
      END
