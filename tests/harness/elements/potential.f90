! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! UHYPER: U = c (I1 - 3) + b (I2 - 3) + (J - 1)**2/d + (m (I1 - 3) + k (I2 - 3)) (J - 1), PROPS c, b, d, m, k and what goes wrong:
! 1 XIT, 2 a write outside UI1, 3 NaN in U. STATEV: a count of calls, arguments.
subroutine uhyper(bi1, bi2, aj, u, ui1, ui2, ui3, temp, noel, cmname, incmpflag, numstatev, statev, numfieldv, fieldv, &
                  fieldvinc, numprops, props)
  include 'aba_param.inc'
  character*80 cmname
  dimension u(2), ui1(3), ui2(6), ui3(6), statev(*), fieldv(*), fieldvinc(*), props(*)
  c = props(1)
  b = props(2)
  d = props(3)
  a = props(4)
  e = props(5)
  u(1) = c*(bi1 - 3) + b*(bi2 - 3) + (aj - 1)**2/d + (a*(bi1 - 3) + e*(bi2 - 3))*(aj - 1)
  ui1(1) = c + a*(aj - 1)
  ui1(2) = b + e*(aj - 1)
  ui1(3) = 2*(aj - 1)/d + a*(bi1 - 3) + e*(bi2 - 3)
  ui2(3) = 2/d
  ui2(5) = a
  ui2(6) = e
  if (numstatev >= 9) then
    statev(1) = statev(1) + 1
    statev(2) = temp
    statev(3) = noel
    statev(4) = incmpflag
    statev(5) = numfieldv
    statev(6) = numprops
    if (numfieldv > 0) statev(7) = fieldv(1)
    if (numfieldv > 0) statev(8) = fieldvinc(1)
    if (cmname == 'RUBBER') statev(9) = 1
  end if
  if (numprops < 6) return
  if (nint(props(6)) == 1) call xit
  if (nint(props(6)) == 2) ui1(4) = 1
  if (nint(props(6)) == 3) u(1) = u(1)/(u(1)*0)
end subroutine uhyper
