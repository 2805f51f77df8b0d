! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! User routines that print each of their arguments on entry, by its name; what they return keeps the values of the deck. STATEV and
! SVARS take 10 KSTEP + KINC where the routine has them. UEL is a spring of stiffness PROPS(1) with a mass, or a conductor; with
! NRHS = 2 the load of type U2 acts on its node 2.
      subroutine uel(rhs,amatrx,svars,energy,ndofel,nrhs,nsvars,props,nprops,coords,mcrd,nnode,u,du,v,a,jtype,time,dtime,kstep,
     1 kinc,jelem,params,ndload,jdltyp,adlmag,predef,npredf,lflags,mlvarx,ddlmag,mdload,pnewdt,jprops,njprop,period)
      include 'aba_param.inc'
      dimension rhs(mlvarx,*),amatrx(ndofel,ndofel),props(*),svars(*),energy(8),coords(mcrd,nnode),u(ndofel),du(mlvarx,*),
     1 v(ndofel),a(ndofel),time(2),params(3),jdltyp(mdload,*),adlmag(mdload,*),ddlmag(mdload,*),predef(2,npredf,nnode),
     2 lflags(*),jprops(*)
      call begins('UEL',kstep,kinc,jelem,lflags(3))
      call told('SVARS',svars,nsvars)
      call told('ENERGY',energy,8)
      call counted('NRHS',nrhs)
      call told('PROPS',props,nprops)
      call told('COORDS',coords,mcrd*nnode)
      call told('U',u,ndofel)
      call told('DU',du,mlvarx*nrhs)
      call told('V',v,ndofel)
      call told('A',a,ndofel)
      call counted('JTYPE',jtype)
      call told('TIME',time,2)
      call told('DTIME',(/dtime/),1)
      call told('PARAMS',params,3)
      call told('JDLTYP',dble(jdltyp(1:ndload,1)),ndload)
      call told('ADLMAG',adlmag,ndload)
      call told('DDLMAG',ddlmag,ndload)
      call told('PREDEF',predef,2*npredf*nnode)
      call told('LFLAGS',dble(lflags(1:7)),7)
      call counted('MLVARX',mlvarx)
      call counted('MDLOAD',mdload)
      call told('PNEWDT',(/pnewdt/),1)
      call told('JPROPS',dble(jprops(1:njprop)),njprop)
      call told('PERIOD',(/period/),1)
      rhs(1:ndofel,1:nrhs)=0
      amatrx=0
      do i=1,ndofel
        if (lflags(3).eq.4.or.lflags(3).eq.6) then
          amatrx(i,i)=1
        else
          amatrx(i,i)=props(1)
          amatrx(3-i,i)=-props(1)
          if (lflags(1).eq.11.or.lflags(1).eq.12) amatrx(i,i)=props(1)+1/(params(2)*dtime**2)
          rhs(i,1)=-props(1)*(u(i)-u(3-i))-a(i)
          if (lflags(4).eq.1) rhs(i,1)=-props(1)*(du(i,1)-du(3-i,1))
        end if
      end do
      if (nrhs.eq.2) then
        rhs(2,1)=rhs(2,1)+adlmag(1,1)
        rhs(2,2)=ddlmag(1,1)
      end if
      svars(1)=10*kstep+kinc
      energy(2)=svars(1)
      end

      subroutine usdfld(field,statev,pnewdt,direct,t,celent,time,dtime,cmname,orname,nfield,nstatv,noel,npt,layer,kspt,kstep,kinc,
     1 ndi,nshr,coord,jmac,jmatyp,matlayo,laccfla)
      include 'aba_param.inc'
      character*80 cmname,orname
      dimension field(nfield),statev(nstatv),direct(3,3),t(3,3),time(2),coord(3),jmac(*),jmatyp(*)
      call begins('USDFLD',kstep,kinc,noel,npt)
      call told('FIELD',field,nfield)
      call told('STATEV',statev,nstatv)
      call told('PNEWDT',(/pnewdt/),1)
      call told('DIRECT',direct,9)
      call told('T',t,9)
      call told('CELENT',(/celent/),1)
      call told('TIME',time,2)
      call told('DTIME',(/dtime/),1)
      call named('CMNAME',cmname)
      call named('ORNAME',orname)
      call counted('LAYER',layer)
      call counted('KSPT',kspt)
      call counted('NDI',ndi)
      call counted('NSHR',nshr)
      call told('COORD',coord,3)
      statev(1)=10*kstep+kinc
      end

      subroutine uvarm(uvar,direct,t,time,dtime,cmname,orname,nuvarm,noel,npt,layer,kspt,kstep,kinc,ndi,nshr,coord,jmac,jmatyp,
     1 matlayo,laccfla)
      include 'aba_param.inc'
      character*80 cmname,orname
      dimension uvar(nuvarm),direct(3,3),t(3,3),time(2),coord(3),jmac(*),jmatyp(*)
      call begins('UVARM',kstep,kinc,noel,npt)
      call told('DIRECT',direct,9)
      call told('T',t,9)
      call told('TIME',time,2)
      call told('DTIME',(/dtime/),1)
      call named('CMNAME',cmname)
      call named('ORNAME',orname)
      call counted('NUVARM',nuvarm)
      call counted('LAYER',layer)
      call counted('KSPT',kspt)
      call counted('NDI',ndi)
      call counted('NSHR',nshr)
      call told('COORD',coord,3)
      uvar=0
      end

      subroutine uhyper(bi1,bi2,aj,u,ui1,ui2,ui3,temp,noel,cmname,incmpflag,numstatev,statev,numfieldv,fieldv,fieldvinc,numprops,
     1 props)
      include 'aba_param.inc'
      character*80 cmname
      dimension u(2),ui1(3),ui2(6),ui3(6),statev(numstatev),fieldv(numfieldv),fieldvinc(numfieldv),props(numprops)
      call begins('UHYPER',0,0,noel,0)
      call told('BI1',(/bi1/),1)
      call told('BI2',(/bi2/),1)
      call told('AJ',(/aj/),1)
      call told('TEMP',(/temp/),1)
      call named('CMNAME',cmname)
      call counted('INCMPFLAG',incmpflag)
      call told('STATEV',statev,numstatev)
      call told('FIELDV',fieldv,numfieldv)
      call told('FIELDVINC',fieldvinc,numfieldv)
      call told('PROPS',props,numprops)
      statev(1)=statev(1)+1
      u(1)=props(1)*(bi1-3)+(aj-1)**2/props(2)
      ui1(1)=props(1)
      ui1(3)=2*(aj-1)/props(2)
      ui2(3)=2/props(2)
      end

      subroutine uanisohyper_inv(ainv,ua,zeta,nfibers,ninv,ui1,ui2,ui3,temp,noel,cmname,incmpflag,ihybflag,numstatev,statev,
     1 numfieldv,fieldv,fieldvinc,numprops,props)
      include 'aba_param.inc'
      character*80 cmname
      dimension ainv(ninv),ua(2),zeta(nfibers*(nfibers-1)/2),ui1(ninv),ui2(ninv*(ninv+1)/2),ui3(ninv*(ninv+1)/2),
     1 statev(numstatev),fieldv(numfieldv),fieldvinc(numfieldv),props(numprops)
      call begins('UANISOHYPER_INV',0,0,noel,0)
      call told('AINV',ainv,ninv)
      call told('ZETA',zeta,nfibers*(nfibers-1)/2)
      call counted('NFIBERS',nfibers)
      call told('TEMP',(/temp/),1)
      call named('CMNAME',cmname)
      call counted('INCMPFLAG',incmpflag)
      call counted('IHYBFLAG',ihybflag)
      call told('STATEV',statev,numstatev)
      call told('FIELDV',fieldv,numfieldv)
      call told('FIELDVINC',fieldvinc,numfieldv)
      call told('PROPS',props,numprops)
      statev(1)=statev(1)+1
      ua(1)=props(1)*(ainv(1)-3)+(ainv(3)-1)**2/props(2)
      ui1(1)=props(1)
      ui1(3)=2*(ainv(3)-1)/props(2)
      ui2(6)=2/props(2)
      end

      subroutine dload(f,kstep,kinc,time,noel,npt,layer,kspt,coords,jltyp,sname)
      include 'aba_param.inc'
      character*80 sname
      dimension time(2),coords(3)
      call begins('DLOAD',kstep,kinc,noel,npt)
      call told('F',(/f/),1)
      call told('TIME',time,2)
      call counted('LAYER',layer)
      call counted('KSPT',kspt)
      call told('COORDS',coords,3)
      call counted('JLTYP',jltyp)
      call named('SNAME',sname)
      end

      subroutine disp(u,kstep,kinc,time,node,noel,jdof,coords)
      include 'aba_param.inc'
      dimension u(3),time(3),coords(3)
      call begins('DISP',kstep,kinc,noel,node)
      call told('U',u,3)
      call told('TIME',time,3)
      call counted('JDOF',jdof)
      call told('COORDS',coords,3)
      end

      subroutine uamp(ampname,time,ampvalueold,dt,nprops,props,nsvars,svars,lflagsinfo,nsensor,sensorvalues,sensornames,
     1 jsensorlookuptable,ampvaluenew,lflagsdefine,ampderivative,ampsecderivative,ampincintegral,ampdoubleintegral)
      include 'aba_param.inc'
      character*80 ampname,sensornames(nsensor)
      dimension time(2),props(nprops),svars(nsvars),lflagsinfo(4),sensorvalues(nsensor),jsensorlookuptable(*),lflagsdefine(*)
      call begins('UAMP',lflagsinfo(4),lflagsinfo(2),0,0)
      call named('AMPNAME',ampname)
      call told('TIME',time,2)
      call told('AMPVALUEOLD',(/ampvalueold/),1)
      call told('DT',(/dt/),1)
      call told('PROPS',props,nprops)
      call told('SVARS',svars,nsvars)
      call told('LFLAGSINFO',dble(lflagsinfo),4)
      call told('SENSORVALUES',sensorvalues,nsensor)
      if (nsensor.gt.0) call named('SENSORNAMES',sensornames(1))
      svars(1)=time(2)
      ampvaluenew=time(2)
      end

      subroutine utemp(temp,nsecpt,kstep,kinc,time,node,coords)
      include 'aba_param.inc'
      dimension temp(nsecpt),time(2),coords(3)
      call begins('UTEMP',kstep,kinc,0,node)
      call told('TEMP',temp,nsecpt)
      call counted('NSECPT',nsecpt)
      call told('TIME',time,2)
      call told('COORDS',coords,3)
      end

      subroutine ufield(field,kfield,nsecpt,kstep,kinc,time,node,coords,temp,dtemp,nfield)
      include 'aba_param.inc'
      dimension field(nsecpt,nfield),time(2),coords(3),temp(nsecpt),dtemp(nsecpt)
      call begins('UFIELD',kstep,kinc,0,node)
      call told('FIELD',field,nsecpt*nfield)
      call counted('KFIELD',kfield)
      call counted('NSECPT',nsecpt)
      call counted('NFIELD',nfield)
      call told('TIME',time,2)
      call told('COORDS',coords,3)
      call told('TEMP',temp,nsecpt)
      call told('DTEMP',dtemp,nsecpt)
      end

      subroutine sdvini(statev,coords,nstatv,ncrds,noel,npt,layer,kspt)
      include 'aba_param.inc'
      dimension statev(nstatv),coords(ncrds)
      call begins('SDVINI',0,0,noel,npt)
      call told('STATEV',statev,nstatv)
      call told('COORDS',coords,ncrds)
      call counted('LAYER',layer)
      call counted('KSPT',kspt)
      end

      subroutine uexternaldb(lop,lrestart,time,dtime,kstep,kinc)
      include 'aba_param.inc'
      dimension time(2)
      call begins('UEXTERNALDB',kstep,kinc,0,0)
      call counted('LOP',lop)
      call counted('LRESTART',lrestart)
      call told('TIME',time,2)
      call told('DTIME',(/dtime/),1)
      end

      subroutine begins(routine,kstep,kinc,noel,npt)
      character*(*) routine
      write(6,'(3a,4i9)') 'CALL ',routine,' ',kstep,kinc,noel,npt
      end

      subroutine told(name,values,n)
      include 'aba_param.inc'
      character*(*) name
      dimension values(n)
      write(6,'(3a,99es24.16)') 'TOLD ',name,' ',values
      end

      subroutine counted(name,n)
      include 'aba_param.inc'
      character*(*) name
      write(6,'(3a,i9)') 'TOLD ',name,' ',n
      end

      subroutine named(name,text)
      character*(*) name,text
      write(6,'(5a)') 'NAMED ',name,' <',text,'>'
      end
