! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A beam in space with dofs 1 to 6, lumped mass with different rotational inertia about its axes, and damping in proportion to
! the stiffness: PROPS Young's modulus, shear modulus, area, second moments 2 and 3, torsion constant, density, damping. Static
! steps and dynamic ones (SVARS: forces of this increment and of the one before), modes and harmonic responses.
      include '../../harness/uel.inc'
      dimension stiff(12,12),local(12,12),heavy(12,12),turn(12,12),axes(3,3),force(12)
      double precision local,inertia
      rhs(1:12,1) = 0
      amatrx = 0
      axes(1,:) = coords(1:3,2) - coords(1:3,1)
      span = sqrt(sum(axes(1,:)**2))
      axes(1,:) = axes(1,:)/span
      axes(3,:) = (/ -axes(1,2), axes(1,1), 0d0 /)
      axes(3,:) = axes(3,:)/sqrt(sum(axes(3,:)**2))
      axes(2,:) = (/ axes(3,2)*axes(1,3) - axes(3,3)*axes(1,2), axes(3,3)*axes(1,1) - axes(3,1)*axes(1,3),
     1 axes(3,1)*axes(1,2) - axes(3,2)*axes(1,1) /)
      turn = 0
      do n = 0, 9, 3
        turn(n+1:n+3,n+1:n+3) = axes
      end do
      local = 0
      call pair(local, 1, 7, props(1)*props(3)/span)
      call pair(local, 4, 10, props(2)*props(6)/span)
      call bending(local, 2, 6, 8, 12, props(1)*props(5), span, 1d0)
      call bending(local, 3, 5, 9, 11, props(1)*props(4), span, -1d0)
      stiff = matmul(transpose(turn), matmul(local, turn))
      heavy = 0
      weight = props(7)*props(3)*span/2
      inertia = weight*(props(4) + props(5))/props(3)
      do n = 0, 6, 6
        do i = 1, 3
          heavy(n+i,n+i) = weight
        end do
        heavy(n+4,n+4) = inertia
        heavy(n+5,n+5) = inertia/2 + weight*span**2/50
        heavy(n+6,n+6) = inertia/2 + weight*span**2/50
      end do
      heavy = matmul(transpose(turn), matmul(heavy, turn))
      force = matmul(stiff, u)
      if (lflags(1) == 11 .or. lflags(1) == 12) force = force + props(8)*matmul(stiff, v)
      if (lflags(3) == 1 .and. lflags(1) <= 2) then
        rhs(1:12,1) = -force
        amatrx = stiff
        svars(1:12) = force
        energy(2) = dot_product(u, force)/2
      else if (lflags(3) == 1) then
        alpha = params(1)
        rhs(1:12,1) = -matmul(heavy, a) - (1 + alpha)*force + alpha*svars(1:12)
        amatrx = heavy/(params(2)*dtime**2) + (1 + alpha)*(1 + props(8)*params(3)/(params(2)*dtime))*stiff
        svars(13:24) = svars(1:12)
        svars(1:12) = force
        energy(1) = dot_product(v, matmul(heavy, v))/2
        energy(2) = dot_product(u, matmul(stiff, u))/2
      else if (lflags(3) == 2) then
        amatrx = stiff
      else if (lflags(3) == 3) then
        if (lflags(7) == 1) amatrx = props(8)*stiff
      else if (lflags(3) == 5 .and. lflags(1) <= 2) then
        rhs(1:12,1) = -force
      else if (lflags(3) == 5) then
        rhs(1:12,1) = -matmul(heavy, a) - (1 + params(1))*force + params(1)*(svars(1:12) + svars(13:24))/2
      else
        amatrx = heavy
        if (lflags(3) == 6) then
          rhs(1:12,1) = -force
          svars(1:12) = force
          energy(2) = dot_product(u, matmul(stiff, u))/2
        end if
      end if
      end

      subroutine pair(a, i, j, value)
      include 'aba_param.inc'
      dimension a(12,12)
      a(i,i) = a(i,i) + value
      a(j,j) = a(j,j) + value
      a(i,j) = a(i,j) - value
      a(j,i) = a(j,i) - value
      end

      subroutine bending(a, i, j, k, l, ei, span, way)
      include 'aba_param.inc'
      dimension a(12,12),rows(4)
      integer rows
      dimension small(4,4)
      rows = (/ i, j, k, l /)
      small(1,:) = (/ 12d0, 6*span*way, -12d0, 6*span*way /)
      small(2,:) = (/ 6*span*way, 4*span**2, -6*span*way, 2*span**2 /)
      small(3,:) = -small(1,:)
      small(4,:) = (/ 6*span*way, 2*span**2, -6*span*way, 4*span**2 /)
      a(rows,rows) = a(rows,rows) + ei/span**3*small
      end
