! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! Diffusion with traps (A. McNabb, P.K. Foster, Transactions of the Metallurgical Society of AIME 227 (1963) 618); the concentration in
! the lattice is the temperature. UMAT, elastic: PROPS are Young's modulus, the density of traps n, their equilibrium constant a and
! the rate f: the trapped concentration ct, in STATEV(1), changes by f (n a c - (1 + a c) ct), from equilibrium on. UMATHT: the
! diffusivity; the energy is c.
      subroutine umat(stress,statev,ddsdde,sse,spd,scd,rpl,ddsddt,drplde,drpldt,stran,dstran,time,dtime,temp,dtemp,predef,dpred,
     1 cmname,ndi,nshr,ntens,nstatv,props,nprops,coords,drot,pnewdt,celent,dfgrd0,dfgrd1,noel,npt,layer,kspt,kstep,kinc)
      include 'aba_param.inc'
      character*80 cmname
      dimension stress(ntens),statev(nstatv),ddsdde(ntens,ntens),ddsddt(ntens),drplde(ntens),stran(ntens),dstran(ntens),time(2),
     1 predef(1),dpred(1),props(nprops),coords(3),drot(3,3),dfgrd0(3,3),dfgrd1(3,3)
      do i=1,ntens
        ddsdde(i,i)=props(1)
        stress(i)=stress(i)+props(1)*dstran(i)
      end do
      old=statev(1)
      if (kstep.eq.1.and.kinc.eq.1) old=props(2)*props(3)*temp/(1+props(3)*temp)
      step=props(4)*dtime
      slowed=1+(1+props(3)*(temp+dtemp))*step
      statev(1)=(old+props(2)*props(3)*(temp+dtemp)*step)/slowed
      rpl=-(statev(1)-old)/dtime
      drpldt=-props(3)*step*(props(2)-statev(1))/slowed/dtime
      end
      subroutine umatht(u,dudt,dudg,flux,dfdt,dfdg,statev,temp,dtemp,dtemdx,time,dtime,predef,dpred,cmname,ntgrd,nstatv,props,
     1 nprops,coords,pnewdt,noel,npt,layer,kspt,kstep,kinc)
      include 'aba_param.inc'
      character*80 cmname
      dimension dudg(ntgrd),flux(ntgrd),dfdt(ntgrd),dfdg(ntgrd,ntgrd),statev(nstatv),dtemdx(ntgrd),time(2),predef(1),dpred(1),
     1 props(nprops),coords(3)
      if (statev(1).le.0) call xit
      u=u+dtemp
      dudt=1
      flux=-props(1)*dtemdx
      do i=1,ntgrd
        dfdg(i,i)=-props(1)
      end do
      end
