! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A material point: U is the strain, -RHS the stress, AMATRX the tangent; JPROPS(1) is the number of the point.
      subroutine uelmat(rhs,amatrx,svars,energy,ndofel,nrhs,nsvars,props,nprops,coords,mcrd,nnode,u,du,v,a,jtype,time,dtime,
     1 kstep,kinc,jelem,params,ndload,jdltyp,adlmag,predef,npredf,lflags,mlvarx,ddlmag,mdload,pnewdt,jprops,njprop,period,
     2 materiallib)
      include 'ABA_PARAM.INC'
      dimension rhs(mlvarx,*),amatrx(ndofel,ndofel),props(*),svars(*),energy(8),coords(mcrd,nnode),u(ndofel),du(mlvarx,*),
     1 v(ndofel),a(ndofel),time(2),params(*),jdltyp(mdload,*),adlmag(mdload,*),ddlmag(mdload,*),predef(2,npredf,nnode),
     2 lflags(*),jprops(*)
      dimension stran(6),dstran(6),stress(6),f(3,3),t(1),dt(1),x(3)
      stran(1:ndofel) = u - du(1:ndofel,1)
      dstran(1:ndofel) = du(1:ndofel,1)
      material = materiallib
      if (jprops(2) == 1) material = -3
      call material_lib_mech(material,stress,amatrx,stran,dstran,jprops(1),1.d0,1.d0,f,t,dt,npredf,1.d0,x)
      rhs(1:ndofel,1) = -stress(1:ndofel)
      svars(1) = 0
      end
