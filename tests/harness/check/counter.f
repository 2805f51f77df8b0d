! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A spring of stiffness 1 along x with a fault: a counter in a module goes into
! the array that JPROPS(1) says: 0 none, 1 RHS, 2 AMATRX, 3 SVARS, 4 ENERGY,
! 5 PNEWDT, 7 column 2 of RHS; 6: the first call of all must be that of
! element 1.
      module counter
      integer :: calls = 0
      end module

      subroutine uel(rhs,amatrx,svars,energy,ndofel,nrhs,nsvars,
     &  props,nprops,coords,mcrd,nnode,u,du,v,a,jtype,time,dtime,
     &  kstep,kinc,jelem,params,ndload,jdltyp,adlmag,predef,npredf,
     &  lflags,mlvarx,ddlmag,mdload,pnewdt,jprops,njprop,period)
      use counter, only: calls
      include 'aba_param.inc'
      dimension rhs(mlvarx,*),amatrx(ndofel,ndofel),props(*),
     &  svars(*),energy(8),coords(mcrd,nnode),u(ndofel),
     &  du(mlvarx,*),v(ndofel),a(ndofel),time(2),params(*),
     &  jdltyp(mdload,*),adlmag(mdload,*),ddlmag(mdload,*),
     &  predef(2,npredf,nnode),lflags(*),jprops(*)
      calls = calls + 1
      if (jprops(1) .eq. 6 .and. calls .eq. 1 .and. jelem .ne. 1)
     &  call xit
      c = 1d-12*calls
      rhs(1,1) = u(2) - u(1)
      rhs(2,1) = u(1) - u(2)
      if (nrhs .eq. 2) rhs(1:2,2) = 0
      amatrx = reshape((/ 1d0, -1d0, -1d0, 1d0 /), (/ 2, 2 /))
      svars(1) = svars(1) + du(2,1) - du(1,1)
      energy(2) = (u(2) - u(1))**2/2
      if (jprops(1) .eq. 1) rhs(2,1) = rhs(2,1) + c
      if (jprops(1) .eq. 2) amatrx(1,2) = amatrx(1,2) + c
      if (jprops(1) .eq. 3) svars(2) = calls
      if (jprops(1) .eq. 4) energy(2) = energy(2) + c
      if (jprops(1) .eq. 5) pnewdt = 2 + c
      if (jprops(1) .eq. 7 .and. nrhs .eq. 2) rhs(1,2) = c
      end
