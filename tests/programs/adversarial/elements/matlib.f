! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A quad in plane strain whose stresses come from the materials of Abaqus: PROPS thickness; SVARS strains 11, 22, 33, 12
! of each of four points.
      subroutine uelmat(rhs,amatrx,svars,energy,ndofel,nrhs,nsvars,props,nprops,coords,mcrd,nnode,u,du,v,a,jtype,time,dtime,
     1 kstep,kinc,jelem,params,ndload,jdltyp,adlmag,predef,npredf,lflags,mlvarx,ddlmag,mdload,pnewdt,jprops,njprop,period,
     2 materiallib)
      include 'aba_param.inc'
      dimension rhs(mlvarx,*),amatrx(ndofel,ndofel),props(*),svars(*),energy(8),coords(mcrd,nnode),u(ndofel),du(mlvarx,*),
     1 v(ndofel),a(ndofel),time(2),params(*),jdltyp(mdload,*),adlmag(mdload,*),ddlmag(mdload,*),predef(2,npredf,nnode),
     2 lflags(*),jprops(*)
      dimension b(4,8),dn(4,2),xj(2,2),xi(4),eta(4),old(4),change(4),stress(4),d(4,4),f(3,3),t(1),dt(1),x(3)
      data xi /-1,1,1,-1/, eta /-1,-1,1,1/
      rhs(1:8,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      f = 0
      x = 0
      t = 0
      dt = 0
      do i = 1, 3
        f(i,i) = 1
      end do
      do k = 1, 4
        r = xi(k)/sqrt(3d0)
        s = eta(k)/sqrt(3d0)
        dn(:,1) = xi*(1 + eta*s)/4
        dn(:,2) = eta*(1 + xi*r)/4
        xj = matmul(coords(1:2,:), dn)
        det = xj(1,1)*xj(2,2) - xj(1,2)*xj(2,1)
        volume = det*props(1)
        b = 0
        do n = 1, 4
          dx = (dn(n,1)*xj(2,2) - dn(n,2)*xj(2,1))/det
          dy = (dn(n,2)*xj(1,1) - dn(n,1)*xj(1,2))/det
          b(1,2*n-1) = dx
          b(2,2*n) = dy
          b(4,2*n-1) = dy
          b(4,2*n) = dx
        end do
        change = matmul(b, du(1:8,1))
        old = svars(4*k-3:4*k)
        call material_lib_mech(materiallib,stress,d,old,change,k,1.d0,volume,f,t,dt,npredf,1.d0,x)
        rhs(1:8,1) = rhs(1:8,1) - volume*matmul(stress, b)
        amatrx = amatrx + volume*matmul(transpose(b), matmul(d, b))
        svars(4*k-3:4*k) = old + change
      end do
      end
