! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! Springs along x for tests of procedures; d = U(2) - U(1), node by node one unknown (dof 1).
!   U1  f = PROPS(1) d + PROPS(2) d**3, elastic energy in ENERGY(2)
!   U2  as U1, with PNEWDT = PROPS(4) where |DU(2) - DU(1)| > PROPS(3)
!   U3  f = PROPS(1) sign(d) sqrt(|d|): Newton's method jumps from d to -d
!   U4  f = PROPS(1) d with PROPS(2) times its stiffness in AMATRX: the error goes by 1 - 1/PROPS(2) in an iteration
!   U5  as U1, NaN where d > PROPS(3)
!   U6  damage: stiffness PROPS(1) up to d = PROPS(2), then down to no force at PROPS(3); the largest d in SVARS(1)
!   U7  shallow truss, f = PROPS(1) d (d - PROPS(2)) (d - 2 PROPS(2)): snaps through
!   U8  as U1, and says of a load PROPS(3) on its second node in column 2 of RHS
! JPROPS(1) = 1 prints each call to the message file, as UEXTERNALDB always does; 2 leaves column 2 of RHS alone.
      include '../uel.inc'
      if (jprops(1) .eq. 1) write (7,'(a,7i4,9es24.16)') 'UEL',
     &  lflags(1:5), kstep, kinc, u(1:2), du(1:2,1), time(1:2),
     &  dtime, svars(1), period
      d = u(2) - u(1)
      if (jprops(1) .ne. 2) rhs(1:2,1:nrhs) = 0
      if (jtype .le. 2 .or. jtype .eq. 5 .or. jtype .eq. 8) then
        f = props(1)*d + props(2)*d**3
        s = props(1) + 3*props(2)*d**2
        if (lflags(3) .eq. 1) energy(2) = props(1)*d**2/2
     &    + props(2)*d**4/4
      else if (jtype .eq. 3) then
        f = props(1)*sign(sqrt(abs(d)), d)
        s = props(1)/(2*sqrt(max(abs(d), 1d-12)))
      else if (jtype .eq. 4) then
        f = props(1)*d
        s = props(2)*props(1)
      else if (jtype .eq. 7) then
        h = props(2)
        f = props(1)*d*(d - h)*(d - 2*h)
        s = props(1)*(3*d**2 - 6*h*d + 2*h**2)
      else
        q = max(svars(1), props(2))
        if (d .gt. q) q = min(d, props(3))
        h = props(1)*props(2)/(props(3) - props(2))
        s = h*(props(3) - q)/q
        f = s*d
        if (lflags(3) .eq. 1) energy(2) = f*d/2
        if (d .gt. max(svars(1), props(2))) s = -h
        if (d .gt. props(3)) s = 0
        svars(1) = max(svars(1), q)
      end if
      if (jtype .eq. 2) then
        if (abs(du(2,1) - du(1,1)) .gt. props(3)) pnewdt = props(4)
      end if
      if (jtype .eq. 5) then
        if (d .gt. props(3)) f = sqrt(props(3) - d)
      end if
      if (jtype .ne. 6) svars(1) = d
      rhs(1,1) = f
      rhs(2,1) = -f
      if (jtype .eq. 8 .and. nrhs .eq. 2) rhs(2,2) = props(3)
      amatrx = reshape((/ s, -s, -s, s /), (/ 2, 2 /))
      end

      subroutine uexternaldb(lop,lrestart,time,dtime,kstep,kinc)
      include 'aba_param.inc'
      dimension time(2)
      write (7,'(a,3i4,3es24.16)') 'DB', lop, kstep, kinc, time, dtime
      end
