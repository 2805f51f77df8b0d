! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A tetrahedron of a compressible neo-Hookean solid, total Lagrangian: PROPS shear modulus, Lame's first constant. A load U1 is a
! force per reference volume in direction 3. SVARS: the six components of the Cauchy stress (11, 22, 33, 12, 13, 23).
      include '../../harness/uel.inc'
      dimension dn(4,3),dx(4,3),xj(3,3),xinv(3,3),f(3,3),finv(3,3),p(3,3),cauchy(3,3),tangent(3,3,3,3)
      data dn /-1,1,0,0, -1,0,1,0, -1,0,0,1/
      rhs(1:12,1) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      xj = matmul(coords(1:3,:), dn)
      call invert(xj, xinv, det)
      dx = matmul(dn, xinv)
      volume = det/6
      f = matmul(reshape(u, (/ 3, 4 /)), dx)
      do i = 1, 3
        f(i,i) = f(i,i) + 1
      end do
      call invert(f, finv, ratio)
      if (ratio <= 0) then
        pnewdt = 0.5
        return
      end if
      p = props(1)*(f - transpose(finv)) + props(2)*log(ratio)*transpose(finv)
      do i = 1, 3
        do j = 1, 3
          do k = 1, 3
            do l = 1, 3
              tangent(i,j,k,l) = props(2)*finv(j,i)*finv(l,k) + (props(1) - props(2)*log(ratio))*finv(l,i)*finv(j,k)
              if (i == k .and. j == l) tangent(i,j,k,l) = tangent(i,j,k,l) + props(1)
            end do
          end do
        end do
      end do
      do n = 1, 4
        do i = 1, 3
          rhs(3*n-3+i,1) = -volume*dot_product(p(i,:), dx(n,:))
          do m = 1, 4
            do k = 1, 3
              sum1 = 0
              do j = 1, 3
                do l = 1, 3
                  sum1 = sum1 + dx(n,j)*tangent(i,j,k,l)*dx(m,l)
                end do
              end do
              amatrx(3*n-3+i,3*m-3+k) = volume*sum1
            end do
          end do
        end do
      end do
      do i = 1, ndload
        if (jdltyp(i,1) == 1) rhs(3:12:3,1) = rhs(3:12:3,1) + volume*adlmag(i,1)/4
      end do
      cauchy = matmul(p, transpose(f))/ratio
      svars(1:6) = (/ cauchy(1,1), cauchy(2,2), cauchy(3,3), cauchy(1,2), cauchy(1,3), cauchy(2,3) /)
      energy(2) = volume*(props(1)/2*(sum(f**2) - 3) - props(1)*log(ratio) + props(2)/2*log(ratio)**2)
      end

      subroutine invert(a, b, det)
      include 'aba_param.inc'
      dimension a(3,3),b(3,3)
      do i = 1, 3
        do j = 1, 3
          m1 = mod(j, 3) + 1
          m2 = mod(j + 1, 3) + 1
          n1 = mod(i, 3) + 1
          n2 = mod(i + 1, 3) + 1
          b(i,j) = a(m1,n1)*a(m2,n2) - a(m1,n2)*a(m2,n1)
        end do
      end do
      det = dot_product(a(1,:), b(:,1))
      b = b/det
      end
