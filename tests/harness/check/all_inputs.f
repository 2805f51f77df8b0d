! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! An element that changes the last entry of every argument that it is given; with JPROPS(1) = 0 of what it may change.
      include '../uel.inc'
      rhs(1:ndofel,1) = 0
      amatrx = 1
      svars(nsvars) = 1
      energy(8) = 1
      pnewdt = 2
      if (jprops(1) == 0) return
      props(nprops) = -7
      coords(mcrd,nnode) = -7
      u(ndofel) = -7
      du(ndofel,1) = -7
      v(ndofel) = -7
      a(ndofel) = -7
      time(2) = -7
      params(3) = -7
      jdltyp(mdload,1) = -7
      adlmag(mdload,1) = -7
      ddlmag(mdload,1) = -7
      predef(2,npredf,nnode) = -7
      lflags(5) = -7
      jprops(njprop) = -7
      ndofel = -7
      nrhs = -7
      nsvars = -7
      nprops = -7
      mcrd = -7
      nnode = -7
      jtype = -7
      dtime = -7
      kstep = -7
      kinc = -7
      jelem = -7
      ndload = -7
      npredf = -7
      mlvarx = -7
      mdload = -7
      njprop = -7
      period = -7
      end
