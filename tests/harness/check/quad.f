! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A linear quad in plane stress: PROPS Young's modulus, Poisson's ratio, thickness; SVARS three stresses of each of four
! points. It is right with JPROPS(1) = 0, and has one of the usual mistakes with any other number.
      module calls_so_far
      integer :: calls = 0
      double precision :: largest(4) = 0
      end module

      include '../uel.inc'
      dimension b(3,8),c(3,3),dn(2,4),xj(2,2),xi(4),eta(4),stress(3)
      data xi /-1,1,1,-1/, eta /-1,-1,1,1/
      mistake = jprops(1)
      do i = 1, ndofel
        rhs(i,1) = 0
        do j = 1, ndofel
          if (mistake /= 1) amatrx(i,j) = 0
        end do
      end do
      energy(2) = 0
      start = svars(1)
      if (mistake == 41) call weigh(factor, nnode)
      if (lflags(3) == 4 .and. mistake /= 37) return
      if (lflags(3) == 2 .and. mistake == 36) return
      c = 0
      c(1,1) = props(1)/(1 - props(2)**2)
      c(2,2) = c(1,1)
      c(1,2) = props(2)*c(1,1)
      c(2,1) = c(1,2)
      c(3,3) = props(1)/(2 + 2*props(2))
      points = 4
      g = 1/sqrt(3d0)
      if (mistake == 2) then
        points = 1
        g = 0
      end if
      do k = 1, nint(points)
        do n = 1, 4
          dn(1,n) = xi(n)*(1 + eta(n)*eta(k)*g)/4
          dn(2,n) = eta(n)*(1 + xi(n)*xi(k)*g)/4
        end do
        xj = matmul(dn, transpose(coords(1:2,:)))
        det = xj(1,1)*xj(2,2) - xj(1,2)*xj(2,1)
        w = det*props(3)*4/points
        if (mistake == 20) w = props(3)/4
        b = 0
        do n = 1, 4
          b(1,2*n-1) = (xj(2,2)*dn(1,n) - xj(1,2)*dn(2,n))/det
          b(2,2*n) = (xj(1,1)*dn(2,n) - xj(2,1)*dn(1,n))/det
          b(3,2*n-1) = b(2,2*n)
          if (mistake /= 3) b(3,2*n) = b(1,2*n-1)
        end do
        if (mistake == 45) b(3,:) = b(3,:)/sqrt(2d0)
        stress = matmul(c, matmul(b, u))
        if (mistake == 35) stress = stress
     &    + c(:,1)*dot_product(b(1,1:7:2), u(2:8:2))**2/2
        rhs(1:8,1) = rhs(1:8,1) - w*matmul(transpose(b), stress)
        amatrx = amatrx + w*matmul(transpose(b), matmul(c, b))
        svars(3*k-2:3*k) = stress
        half = 0.5d0
        if (mistake == 21) half = 1
        energy(2) = energy(2) + half*w*dot_product(stress, matmul(b, u))
      end do
      select case (mistake)
      case (4)   ! sign of AMATRX
        amatrx = -amatrx
      case (5)   ! a factor in AMATRX alone
        amatrx = 2*amatrx
      case (6)   ! an entry of AMATRX forgotten
        amatrx(3,3) = 0
      case (7)   ! a force that is counted twice
        rhs(1,1) = 2*rhs(1,1)
        amatrx(1,:) = 2*amatrx(1,:)
      case (8)   ! held to the ground
        rhs(1,1) = rhs(1,1) - u(1)
        amatrx(1,1) = amatrx(1,1) + 1
      case (9)   ! more SVARS than declared
        svars(nsvars+2) = 0
      case (10)  ! a property that is not declared
        if (props(4) > 0.5d0) rhs(1:8,1) = 1.5d0*rhs(1:8,1)
      case (11)  ! what is left from other calls
        call count_calls(svars)
      case (12)  ! NaN
        if (kinc == 2) rhs(2,1) = sqrt(-1 - u(2)**2)
      case (13)  ! transposed, where the matrix is not symmetric
        rhs(1,1) = 2*rhs(1,1)
        amatrx(:,1) = 2*amatrx(:,1)
      case (14)  ! no forces in direction 2 from displacements in direction 1
        amatrx(2:8:2,1:7:2) = 0
      case (15)  ! AMATRX left at zero
        amatrx = 0
      case (16)  ! a scratch variable that threads share
        call keep_number(jelem)
      case (17)  ! a rate without a look at DTIME
        rhs(1,1) = rhs(1,1) + 0*du(1,1)/dtime
      case (18)  ! the number of the increment
        rhs(1,1) = rhs(1,1) + 0*log(real(kinc))
      case (19)  ! a force at rest
        rhs(1,1) = rhs(1,1) + 1
      case (22)  ! something is added in every increment
        svars(1) = start + 1
        rhs(1:8,1) = (1 + 0.01d0*svars(1))*rhs(1:8,1)
        amatrx = (1 + 0.01d0*svars(1))*amatrx
      case (23)  ! smaller increments, whatever this one has done
        pnewdt = 0.5d0
      case (24)
        pnewdt = -1
      case (25)  ! Newton's corrections too large
        amatrx = 0.4d0*amatrx
      case (26)  ! and the residual alone is another one
        amatrx = 0.4d0*amatrx
        if (lflags(3) == 5) rhs(1,1) = 0.9d0*rhs(1,1)
      case (28)  ! no more calls than the 20 of the run
        call count_calls(svars)
        if (svars(1) > 20) call xit
      case (27)  ! a material that breaks
        if (maxval(abs(svars(1:12))) > 100) call xit
      case (33)  ! a step that is cut in the caller's variable
        dtime = dtime/2
      case (34)  ! positions that are added up in place
        coords(1,2) = coords(1,2) + u(3)
        props(2) = 0
      case (38)  ! the largest stress of all iterations, by element
        call keep_largest(svars(1), jelem, damage)
        rhs(1:8,1) = (1 - damage)*rhs(1:8,1)
        amatrx = (1 - damage)*amatrx
      case (39)  ! a state variable that is not declared
        rhs(1:8,1) = (1 + 0*svars(nsvars+1))*rhs(1:8,1)
      case (40)  ! nothing is to be done where U is zero
        if (all(u == 0)) amatrx = 0
      case (41)  ! a local variable without a value
        rhs(1:8,1) = factor*rhs(1:8,1)
      case (42)  ! an integer property that is not declared
        if (jprops(njprop+1) == 1) rhs(1:8,1) = 1.5d0*rhs(1:8,1)
      case (29)  ! a file that is not there, at U that are not those of the run
        if (abs(u(2) - u(4)) > 0.4d0) open (unit=99,
     &    file='no-such-folder/no-such-file', status='old')
      case (30)  ! iterations that do not converge
        k = 0
        do while (abs(u(2) - u(4)) > 0.4d0 .and. k >= 0)
          k = mod(k + 1, 1000)
        end do
        svars(1) = svars(1) + k
      case (31)  ! memory that is damaged
        if (kinc == 0) call abort
      case (32)  ! the first call of all
        open (unit=99, file='no-such-folder/no-such-file',
     &    status='old')
      end select
!     a linear step: no loads, and forces of what it changes
      if (lflags(4) == 1 .and. mistake /= 43) then
        rhs(1:8,1) = 0
        if (lflags(3) == 100 .and. mistake /= 44) rhs(1:8,1) =
     &    -matmul(amatrx, du(1:8,1))
      end if
      end

      subroutine count_calls(svars)
      use calls_so_far, only: calls
      double precision svars(*)
      calls = calls + 1
      svars(1) = calls
      end

      subroutine keep_largest(stress, number, damage)
      use calls_so_far, only: largest
      double precision stress,damage
      largest(number) = max(largest(number), abs(stress))
      damage = largest(number)/(largest(number) + 1000)
      end

      subroutine weigh(factor, nnode)
      double precision factor,weight(9)
      weight(1:2*nnode) = 1
      factor = weight(nnode) + 1d-9*weight(2*nnode+1)
      end

      subroutine keep_number(number)
      common /scratch/ last
      last = number
      end
