! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A spring that leaves entries as they are: RHS(2) with JPROPS(1) = 1, AMATRX(1,2) with 2; with 3 it adds to RHS.
      subroutine uel(rhs,amatrx,svars,energy,ndofel,nrhs,nsvars,props,nprops,coords,mcrd,nnode,u,du,v,a,jtype,time,dtime,kstep,
     1 kinc,jelem,params,ndload,jdltyp,adlmag,predef,npredf,lflags,mlvarx,ddlmag,mdload,pnewdt,jprops,njprop,period)
      include 'ABA_PARAM.INC'
      dimension rhs(mlvarx,*),amatrx(ndofel,ndofel),props(*),svars(*),energy(8),coords(mcrd,nnode),u(ndofel),du(mlvarx,*),
     1 v(ndofel),a(ndofel),time(2),params(*),jdltyp(mdload,*),adlmag(mdload,*),ddlmag(mdload,*),predef(2,npredf,nnode),
     2 lflags(*),jprops(*)
      if (jprops(1) == 3) then
        rhs(1,1) = rhs(1,1) + 1
      else
        rhs(1,1) = 0
      end if
      if (jprops(1) /= 1) rhs(2,1) = 0
      amatrx(1,1) = 1
      amatrx(2,2) = 1
      if (jprops(1) /= 2) amatrx(1,2) = -1
      amatrx(2,1) = -1
      end
