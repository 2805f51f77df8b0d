! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! Neo-Hookean solid from DFGRD1: J sigma = PROPS(1) (F F^T - 1) + PROPS(2) ln(J) 1; STATEV(1:9) = DROT, for DDSDDE the
! moduli at F = 1.
      include '../umat.inc'
      dimension b(3,3)
      b = matmul(dfgrd1, transpose(dfgrd1))
      det = dfgrd1(3,3)*(dfgrd1(1,1)*dfgrd1(2,2)
     &  - dfgrd1(1,2)*dfgrd1(2,1))
      do i = 1, 3
        stress(i) = (props(1)*(b(i,i) - 1) + props(2)*log(det))/det
      end do
      stress(4) = props(1)*b(1,2)/det
      ddsdde = 0
      ddsdde(1:3,1:3) = props(2)
      do i = 1, 3
        ddsdde(i,i) = props(2) + 2*props(1)
      end do
      ddsdde(4,4) = props(1)
      statev(1:9) = reshape(drot, (/ 9 /))
      end
