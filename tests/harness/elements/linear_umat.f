! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! Linear: PROPS has DDSDDE, column by column.
      subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl,
     1  ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp,
     2  dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props,
     3  nprops, coords, drot, pnewdt, celent, f0, f, noel, npt, layer,
     4  kspt, jstep, kinc)
      implicit none
      character*80 cmname
      integer ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt,
     1  jstep(4), kinc, j
      double precision stress(ntens), statev(*), ddsdde(ntens, ntens),
     1  sse, spd, scd, rpl, ddsddt(*), drplde(*), drpldt, stran(ntens),
     2  dstran(ntens), time(2), dtime, temp, dtemp, predef(*), dpred(*),
     3  props(6, 6), coords(3), drot(3, 3), pnewdt, celent, f0(3, 3),
     4  f(3, 3)
      ddsdde = props(:ntens, :ntens)
      stress = 0
      do j = 1, ntens
        stress = stress + ddsdde(:, j)*(stran(j) + dstran(j))
      end do
      end
