! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A spring between two nodes along x: stiffness PROPS(1). SVARS(1) accumulates the elongation's increments.
      subroutine uel(rhs,amatrx,svars,energy,ndofel,nrhs,nsvars,props,nprops,coords,mcrd,nnode,u,du,v,a,jtype,time,dtime,kstep,
     1 kinc,jelem,params,ndload,jdltyp,adlmag,predef,npredf,lflags,mlvarx,ddlmag,mdload,pnewdt,jprops,njprop,period)
      include 'ABA_PARAM.INC'
      dimension rhs(mlvarx,*),amatrx(ndofel,ndofel),props(*),svars(*),energy(8),coords(mcrd,nnode),u(ndofel),du(mlvarx,*),
     1 v(ndofel),a(ndofel),time(2),params(*),jdltyp(mdload,*),adlmag(mdload,*),ddlmag(mdload,*),predef(2,npredf,nnode),
     2 lflags(*),jprops(*)
      s = props(1)
      rhs(1,1) = s*(u(2) - u(1))
      rhs(2,1) = -rhs(1,1)
      amatrx(1,1) = s
      amatrx(2,2) = s
      amatrx(1,2) = -s
      amatrx(2,1) = -s
      svars(1) = svars(1) + du(2,1) - du(1,1)
      energy(2) = 0.5d0*s*(u(2) - u(1))**2
      end
