! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A spring that ends the process, or does not end, in increment 2, in the way that JPROPS(1) says.
      include '../uel.inc'
      rhs(1,1) = u(2) - u(1)
      rhs(2,1) = -rhs(1,1)
      amatrx(1,1) = 1
      amatrx(2,2) = 1
      amatrx(1,2) = -1
      amatrx(2,1) = -1
      if (kinc /= 2 .or. jelem /= 7) return
      select case (jprops(1))
      case (1)
        k = 2000000000
        svars(k) = 1
      case (2)
        rhs(1,1) = endless(svars(1))
      case (3)
        k = jprops(2)
        svars(1) = 5/k
      case (4)
        k = 0
        do while (k >= 0)
          k = mod(k + 1, 1000)
        end do
        svars(1) = k
      case (5)
        call abort
      case (6)
        open (unit=99, file='no-such-folder/no-such-file', status='old')
      case (7)
        stop 'enough'
      case (8)
        k = 900000000
        write (7,*) 'entry', svars(k)
      case (9)
        write (7,*) 'value', given(1)
      case (10)
        write (6,*) 'value', given(2)
      case (11)
        k = jprops(2)
        write (6,*) 5/k
      case (12)
        do
          write (7,*) 'again'
        end do
      case (13)
        write (7,*) 'first of four'
        write (7,*) 'second'
        write (7,*) 'stiffness is negative'
        write (7,'(a)') '   see page 7'
        call xit
      case (14)
        write (*,*) 'no convergence of the local iteration'
        call xit
      end select
      end

      function given(way)
      include 'aba_param.inc'
      integer way
      given = 0
      if (way == 1) call xit
      if (way == 2) stop 'no value'
      end

      recursive function endless(x) result(y)
      include 'aba_param.inc'
      dimension room(1000)
      room = x + 1
      y = sqrt(endless(room(7))) + sum(room)
      end
