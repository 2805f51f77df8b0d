! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! HETVAL of the tests: the heat is PREDEF(1) - PREDEF(2) T. STATEV holds what it is given; STATEV(8) counts the increments.
      subroutine hetval(cmname,temp,time,dtime,statev,flux,predef,dpred)
      include 'aba_param.inc'
      character*80 cmname
      dimension temp(2),statev(*),predef(*),time(2),flux(2),dpred(*)
      if (cmname.eq.'M') then
        statev(1:7)=(/temp,time,dtime,predef(1),dpred(1)/)
        statev(8)=statev(8)+1
        if (any(flux.ne.0)) call xit
      end if
      if (cmname.eq.'STOPS') call xit
      if (cmname.eq.'BEYOND') flux(3)=1
      flux(1)=predef(1)-predef(2)*temp(1)
      flux(2)=-predef(2)
      end
