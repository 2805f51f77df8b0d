C     SPDX-FileCopyrightText: The uel-harness authors
C     SPDX-License-Identifier: BSD-3-Clause
C     UMAT: isotropic elasticity, PROPS E, nu, option. STATEV: arguments it was given, to be looked at. UVARM: S22 from
C     GETVRM, its place, STATEV(1) from GETVRM, and what UMAT left in COMMON.
      include '../umat.inc'
      common /shared/ seen
      e = props(1)
      p = props(2)
      if (ndi.eq.2) then
        f = e/(1-p**2)
        a = p*f
      else
        f = e*(1-p)/((1+p)*(1-2*p))
        a = p*f/(1-p)
      end if
      do i = 1, ntens
        do j = 1, ntens
          ddsdde(i,j) = 0
          if (i.le.ndi .and. j.le.ndi) ddsdde(i,j) = a
        end do
        ddsdde(i,i) = f
        if (i.gt.ndi) ddsdde(i,i) = e/(2*(1+p))
      end do
      sse = 0
      do i = 1, ntens
        do j = 1, ntens
          stress(i) = stress(i) + ddsdde(i,j)*dstran(j)
        end do
        sse = sse + stress(i)*(stran(i)+dstran(i))/2
      end do
      statev(1) = statev(1) + 1
      statev(2) = time(2)
      statev(3) = dtime
      statev(4) = coords(1)
      statev(5) = coords(2)
      statev(6) = 1000*ndi + 100*nshr + kinc
      statev(7) = celent
      if (cmname.ne.'FLEXIBLE') statev(7) = -1
      seen = 10*noel + npt
      if (props(3).eq.1 .and. dtime.gt.0.2d0) pnewdt = 0.5d0
      if (props(3).eq.2) call xit
      end

      subroutine uvarm(uvar,direct,t,time,dtime,cmname,orname,nuvarm,
     1 noel,npt,layer,kspt,kstep,kinc,ndi,nshr,coord,jmac,jmatyp,
     2 matlayo,laccfla)
      include 'aba_param.inc'
      character*80 cmname,orname
      character*3 flgray(15)
      dimension uvar(nuvarm),direct(3,3),t(3,3),time(2),array(15),
     1 jarray(15),jmac(*),jmatyp(*),coord(*)
      common /shared/ seen
      call getvrm('S',array,jarray,flgray,jrcd,jmac,jmatyp,matlayo,
     1 laccfla)
      uvar(1) = array(2)
      uvar(2) = coord(1) + 100*coord(2)
      call getvrm('SDV',array,jarray,flgray,jrcd,jmac,jmatyp,matlayo,
     1 laccfla)
      uvar(3) = array(1)
      call getvrm('TEMP',array,jarray,flgray,jrcd,jmac,jmatyp,matlayo,
     1 laccfla)
      uvar(4) = 10*noel + npt + 1000*jrcd
      uvar(5) = seen
      if (kinc.eq.2 .and. noel.eq.99) call xit
      end
