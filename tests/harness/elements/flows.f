! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! UMATHT of the tests. PROPS: k, b, c, d. The conductivity is k (1 + b T); the energy per mass grows by c dT and d times the first gradient,
! squared and halved. STATEV holds what it is given; STATEV(20) counts the increments.
      subroutine umatht(u,dudt,dudg,flux,dfdt,dfdg,statev,temp,dtemp,dtemdx,time,dtime,predef,dpred,cmname,ntgrd,nstatv,props,
     1 nprops,coords,pnewdt,noel,npt,layer,kspt,kstep,kinc)
      include 'aba_param.inc'
      character*80 cmname
      dimension dudg(ntgrd),flux(ntgrd),dfdt(ntgrd),dfdg(ntgrd,ntgrd),statev(nstatv),dtemdx(ntgrd),time(2),predef(1),dpred(1),
     1 props(nprops),coords(3)
      if (nstatv.gt.0) then
        statev(1:19)=(/temp,dtemp,dtemdx(1),dtemdx(ntgrd),time,dtime,predef(1),dpred(1),dble(ntgrd),dble(nstatv),dble(nprops),
     1   coords(1),coords(2),1.d2*noel+npt,1.d1*layer+kspt,1.d1*kstep+kinc,u,flux(1)/)
        statev(20)=statev(20)+1
        if (cmname.ne.'M') call xit
        if (any((/dudt,dudg,dfdt/).ne.0).or.any(dfdg.ne.0)) call xit
      end if
      if (props(4).lt.0) call xit
      conductivity=props(1)*(1+props(2)*(temp+dtemp))
      u=u+props(3)*dtemp+0.5d0*props(4)*dtemdx(1)**2
      dudt=props(3)
      dudg(1)=props(4)*dtemdx(1)
      flux=-conductivity*dtemdx
      dfdt=-props(1)*props(2)*dtemdx
      do i=1,ntgrd
        dfdg(i,i)=-conductivity
      end do
      if (props(4).gt.1.d3) pnewdt=0.5d0
      end
