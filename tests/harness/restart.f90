! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A material whose stiffness falls with the largest strain so far, STATEV(1); and UEXTERNALDB, which writes its arguments
! to .msg, and kills the process before the step and increment that the variable KILL_BEFORE names.
      subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, &
         temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, &
         dfgrd0, dfgrd1, noel, npt, layer, kspt, jstep, kinc)
      include 'aba_param.inc'
      character*80 cmname
      dimension stress(ntens), statev(nstatv), ddsdde(ntens,ntens), ddsddt(ntens), drplde(ntens), stran(ntens), &
         dstran(ntens), time(2), predef(*), dpred(*), props(nprops), coords(3), drot(3,3), dfgrd0(3,3), dfgrd1(3,3), &
         jstep(4)
      ddsdde = 0
      statev(1) = max(statev(1), maxval(abs(stran + dstran)))
      do i = 1, ntens
        ddsdde(i,i) = props(1)/(1 + props(2)*statev(1))
        if (i > ndi) ddsdde(i,i) = ddsdde(i,i)/2
      end do
      stress = stress + matmul(ddsdde, dstran)
      end

      subroutine uexternaldb(lop, lrestart, time, dtime, kstep, kinc)
      use, intrinsic :: iso_c_binding, only: c_int
      include 'aba_param.inc'
      dimension time(2)
      character(len=8) :: word = ' '
      character(len=20) :: place, wanted
      interface
        integer(c_int) function getpid() bind(c)
          import c_int
        end function
        integer(c_int) function kill(process, number) bind(c)
          import c_int
          integer(c_int), value :: process, number
        end function
      end interface
      call stdb_abqerr(1, 'LOP %I LRESTART %I STEP %I INC %I TIME %R %R', (/ lop, lrestart, kstep, kinc /), time, word)
      call get_environment_variable('KILL_BEFORE', wanted)
      write (place, '(i0,1x,i0)') kstep, kinc
      if (lop == 1 .and. place == wanted) i = kill(getpid(), 9_c_int)
      end
