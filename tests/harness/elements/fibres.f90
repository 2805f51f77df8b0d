! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! UANISOHYPER_INV with PROPS c, d, m, q, and what goes wrong (1 XIT, 2 a write outside UI1, 3 NaN in UA):
! U = c (I1 - 3 + (I2 - 3)/2) + (J - 1)**2/d + sum over n > 3 of q/2 (I_n - z_n)**2, with z_n the value at rest, 1 or ZETA,
! + m (I1 - 3 + I4 - 1) (J - 1), I4 that of the first direction. STATEV: a count of calls, arguments.
subroutine uanisohyper_inv(ainv, ua, zeta, nfibers, ninv, ui1, ui2, ui3, temp, noel, cmname, incmpflag, ihybflag, numstatev, &
                           statev, numfieldv, fieldv, fieldvinc, numprops, props)
  include 'aba_param.inc'
  character*80 cmname
  dimension ainv(ninv), ua(2), zeta(nfibers*(nfibers - 1)/2), ui1(ninv), ui2(ninv*(ninv + 1)/2), ui3(ninv*(ninv + 1)/2), &
    statev(numstatev), fieldv(numfieldv), fieldvinc(numfieldv), props(numprops)
  c = props(1)
  d = props(2)
  a = props(3)
  q = props(4)
  ua(1) = c*(ainv(1) - 3 + 0.5*(ainv(2) - 3)) + (ainv(3) - 1)**2/d + a*(ainv(1) - 4 + ainv(4))*(ainv(3) - 1)
  ui1(1) = c + a*(ainv(3) - 1)
  ui1(2) = 0.5*c
  ui1(3) = 2*(ainv(3) - 1)/d + a*(ainv(1) - 4 + ainv(4))
  ui1(4) = a*(ainv(3) - 1)
  ui2(6) = 2/d
  ui2(4) = a
  ui2(9) = a
  do k = 1, nfibers
    do i = 1, k
      rest = 1
      if (i < k) rest = zeta(i + (k - 1)*(k - 2)/2)
      do n = 4 + 2*(i - 1) + k*(k - 1), 5 + 2*(i - 1) + k*(k - 1)
        ua(1) = ua(1) + 0.5*q*(ainv(n) - rest)**2
        ui1(n) = ui1(n) + q*(ainv(n) - rest)
        ui2(n*(n + 1)/2) = ui2(n*(n + 1)/2) + q
      end do
    end do
  end do
  if (numstatev >= 12) then
    statev(1) = statev(1) + 1
    statev(2) = temp
    statev(3) = noel
    statev(4) = incmpflag
    statev(5) = ihybflag
    statev(6) = numfieldv
    statev(7) = numprops
    statev(8) = nfibers
    statev(9) = ninv
    if (numfieldv > 0) statev(10) = fieldv(1)
    if (numfieldv > 0) statev(11) = fieldvinc(1)
    if (cmname == 'TISSUE') statev(12) = 1
  end if
  if (numprops < 5) return
  if (nint(props(5)) == 1) call xit
  if (nint(props(5)) == 2) ui1(ninv + 1) = 1
  if (nint(props(5)) == 3) ua(1) = ua(1)/(ua(1)*0)
end subroutine uanisohyper_inv
