! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A spring that misbehaves in element 102, in the way that JPROPS(1) says.
      include '../uel.inc'
      dimension intv(2),realv(1)
      character*8 charv(1)
      rhs(1,1) = u(2) - u(1)
      rhs(2,1) = -rhs(1,1)
      amatrx(1,1) = 1
      amatrx(2,2) = 1
      amatrx(1,2) = -1
      amatrx(2,1) = -1
      svars(1) = kinc
      if (jelem /= 102) return
      intv(1) = jelem
      intv(2) = kinc
      realv(1) = 0.125d0
      charv(1) = 'MODE_I'
      select case (jprops(1))
      case (1)
        svars(nsvars+3) = 1
      case (2)
        do i = 1, 9
          amatrx(i,1) = 1
        end do
      case (3)
        rhs(0,1) = 1
      case (4)
        energy(9) = 1
      case (5)
        rhs(2,1) = sqrt(-abs(u(2)) - 1)
      case (6)
        amatrx(2,1) = huge(u(1))*10
      case (7)
        call xit
      case (8)
        call stdb_abqerr(-3,'element %I in increment %I: %R is too much for %S',intv,realv,charv)
      case (9)
        call stdb_abqerr(1,'a note',intv,realv,charv)
        call stdb_abqerr(-1,'a warning, 100%',intv,realv,charv)
        call stdb_abqerr(-2,'an error of %R',intv,realv,charv)
      case (10)
        stop 'no more'
      case (11)
        stop 7
      case (12)
        pnewdt = 0.25d0
      case (13)
        call getvrn('S',realv,charv,intv,idum,jdum,kdum,ldum)
      case (14)
        props(1) = -1
        coords(1,1) = -1
        u(1) = -1
        lflags(3) = -1
        time(1) = -1
      case (15)
        call inner(5)
      end select
      end

      recursive subroutine inner(n)
      if (n == 0) call xit
      call inner(n - 1)
      end
