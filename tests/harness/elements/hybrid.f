! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! neo-Hooke, W = c (I1 - 3) + (J - 1)**2/d. PROPS: c, d, and the
! formulation: 0 incremental, 1 total, 2 incompressible.
      subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl,
     1  ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp,
     2  dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props,
     3  nprops, coords, drot, pnewdt, celent, f0, f, noel, npt, layer,
     4  kspt, jstep, kinc)
      implicit none
      character*80 cmname
      integer ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt,
     1  jstep(4), kinc, i, j, k, l, m, n, first(6), second(6)
      double precision stress(*), statev(*), ddsdde(ntens, ntens), sse,
     1  spd, scd, rpl, ddsddt(*), drplde(*), drpldt, stran(*),
     2  dstran(*), time(2), dtime, temp, dtemp, predef(*), dpred(*),
     3  props(*), coords(3), drot(3, 3), pnewdt, celent, f0(3, 3),
     4  f(3, 3), b(3, 3), one(3, 3), det, volume, mean, slope, c,
     5  trace
      data first /1, 2, 3, 1, 1, 2/, second /1, 2, 3, 2, 3, 3/
      one = 0
      do i = 1, 3
        one(i, i) = 1
      end do
      det = f(1, 1)*(f(2, 2)*f(3, 3) - f(2, 3)*f(3, 2))
     1  - f(1, 2)*(f(2, 1)*f(3, 3) - f(2, 3)*f(3, 1))
     2  + f(1, 3)*(f(2, 1)*f(3, 2) - f(2, 2)*f(3, 1))
      b = matmul(f, transpose(f))/det**(2d0/3)
      trace = b(1, 1) + b(2, 2) + b(3, 3)
      c = 2*props(1)/det
      volume = det
      if (nint(props(3)) == 1) volume = stress(ntens + 1)
      mean = 0
      slope = 0
      if (nint(props(3)) < 2) then
        mean = 2/props(2)*(volume - 1)
        slope = 2/props(2)*det
      end if
      if (nint(props(3)) == 1) then
        stress(ntens + 2) = slope
        stress(ntens + 3) = 0
      else if (nint(props(3)) == 0) then
        slope = slope + mean
      end if
      do m = 1, ntens
        i = first(m)
        j = second(m)
        stress(m) = c*(b(i, j) - trace/3*one(i, j)) + mean*one(i, j)
        do n = 1, ntens
          k = first(n)
          l = second(n)
          ddsdde(m, n) = c*((one(i, k)*b(j, l) + b(i, k)*one(j, l)
     1      + one(i, l)*b(j, k) + b(i, l)*one(j, k))/2
     2      - 2d0/3*(one(i, j)*b(k, l) + b(i, j)*one(k, l))
     3      + 2d0/9*one(i, j)*one(k, l)*trace)
     4      + slope*one(i, j)*one(k, l)
        end do
      end do
      sse = (props(1)*(trace - 3) + mean*(volume - 1)/2)/det
      end
