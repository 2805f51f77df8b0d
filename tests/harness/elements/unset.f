! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A spring that leaves entries as they are: RHS(2) with JPROPS(1) = 1, AMATRX(1,2) with 2; with 3 it adds to RHS.
      include '../uel.inc'
      if (jprops(1) == 3) then
        rhs(1,1) = rhs(1,1) + 1
      else
        rhs(1,1) = 0
      end if
      if (jprops(1) /= 1) rhs(2,1) = 0
      amatrx(1,1) = 1
      amatrx(2,2) = 1
      if (jprops(1) /= 2) amatrx(1,2) = -1
      amatrx(2,1) = -1
      end
