! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! End the analysis where increment 3 ends: UVARM if the first property says so, else UEXTERNALDB.
      subroutine uvarm(uvar, direct, t, time, dtime, cmname, orname, nuvarm, noel, npt, layer, kspt, kstep, kinc, &
         ndi, nshr, coord, jmac, jmatyp, matlayo, laccfla)
      include 'aba_param.inc'
      character*80 cmname, orname
      dimension uvar(nuvarm), direct(3,3), t(3,3), time(2), coord(*), jmac(*), jmatyp(*)
      uvar(1) = time(1)
      if (kinc == 3 .and. cmname(1:5) == 'UVARM') call xit
      end

      subroutine uexternaldb(lop, lrestart, time, dtime, kstep, kinc)
      include 'aba_param.inc'
      dimension time(2)
      if (lop == 2 .and. kinc == 3) call xit
      end
