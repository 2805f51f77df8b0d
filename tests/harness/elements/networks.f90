! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! UCREEPNETWORK: increment a q**n exp(b . x) times that of time, x what else a law may depend on, PROPS a, n, b(6) and what goes
! wrong: 1 XIT, 2 a write outside OUTPUTDATA, 3 NaN in it. STATEV: a count of calls
! for the end of the increment and, if there are 40, arguments in their order.
subroutine ucreepnetwork(outputdata, statev, noutput, nstatv, networkid, coords, temp, dtemp, nfield, predef, dpred, nprops, &
                         props, i_array, niarray, r_array, nrarray, c_array, ncarray)
  include 'aba_param.inc'
  dimension outputdata(*), statev(*), coords(*), predef(*), dpred(*), props(*), i_array(*), r_array(*)
  character*80 c_array(*)
  dimension x(6)
  x = [r_array(5), r_array(7) - 3, r_array(8) - 3, r_array(9) - 3, r_array(10) - 1, r_array(11)]
  q = r_array(6)
  grown = r_array(4)*props(1)*q**props(2)*exp(dot_product(props(3:8), x))
  outputdata(1) = grown
  outputdata(2) = grown*props(3)
  outputdata(3) = r_array(4)*props(1)*props(2)*q**(props(2) - 1)*exp(dot_product(props(3:8), x))
  outputdata(4:8) = grown*props(4:8)
  if (nstatv > 0 .and. i_array(7) == 1) statev(1) = statev(1) + 1
  if (nstatv >= 40) then
    statev(2:9) = [noutput, nstatv, networkid, nfield, nprops, niarray, nrarray, ncarray]
    statev(10:11) = [temp, dtemp]
    statev(12:14) = coords(1:3)
    if (nfield > 0) statev(15:16) = [predef(1), dpred(1)]
    statev(17:23) = i_array(1:7)
    statev(24:34) = r_array(1:11)
    if (c_array(1) == 'RUBBER') statev(35) = 1
  end if
  if (nprops < 9) return
  if (nint(props(9)) == 1) call xit
  if (nint(props(9)) == 2) outputdata(9) = 1
  if (nint(props(9)) == 3) outputdata(1) = outputdata(1)/(outputdata(1)*0)
end subroutine ucreepnetwork

! UTRSNETWORK: shift at both ends from PROPS. STATEV, if there are 64: arguments in 41 to 64.
subroutine utrsnetwork(outputdata, statev, noutput, nstatv, networkid, coords, temp, dtemp, nfield, predef, dpred, nprops, &
                       props, i_array, niarray, r_array, nrarray, c_array, ncarray)
  include 'aba_param.inc'
  dimension outputdata(*), statev(*), coords(*), predef(*), dpred(*), props(*), i_array(*), r_array(*)
  character*80 c_array(*)
  outputdata(1) = props(1)
  outputdata(2) = props(2)
  if (nstatv < 64) return
  statev(41:44) = [noutput, networkid, nfield, nprops]
  statev(45:47) = [niarray, nrarray, ncarray]
  statev(48:49) = [temp, dtemp]
  statev(50:52) = coords(1:3)
  if (nfield > 0) statev(53:54) = [predef(1), dpred(1)]
  statev(55:60) = i_array(1:6)
  statev(61:64) = r_array(1:4)
end subroutine utrsnetwork
