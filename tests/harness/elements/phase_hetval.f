! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! The phase field of phase.f with its source in HETVAL, which gets STATEV as UMAT leaves it; PROPS are those of phase.f.
      include '../umat.inc'
      soft=(1-temp-dtemp)**2
      ddsdde=0
      do i=1,ndi
        ddsdde(i,i)=props(1)
      end do
      do i=ndi+1,ntens
        ddsdde(i,i)=props(1)/2
      end do
      stress=matmul(ddsdde,stran+dstran)
      statev(1)=max(0.5d0*dot_product(stress,stran+dstran),statev(1))
      statev(2)=props(2)
      statev(3)=props(3)
      stress=soft*stress
      ddsdde=soft*ddsdde
      end

      subroutine hetval(cmname,temp,time,dtime,statev,flux,predef,dpred)
      include 'aba_param.inc'
      character*80 cmname
      dimension temp(2),statev(*),predef(*),time(2),flux(2),dpred(*)
      factor=2*statev(1)/(statev(2)*statev(3))
      flux(1)=factor*(1-temp(1))-temp(1)/statev(2)**2
      flux(2)=-factor-1/statev(2)**2
      end
