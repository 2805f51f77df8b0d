! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! Beam of Euler and Bernoulli along axis 1 in the plane: dofs 1, 2, 6 at two nodes; PROPS EA, EI.
      include '../uel.inc'
      real*8 k(6,6)
      s = coords(1,2) - coords(1,1)
      b = props(2)/s**3
      k = 0
      k(1,[1,4]) = [1, -1]*props(1)/s
      k(4,[1,4]) = -k(1,[1,4])
      k(2,[2,3,5,6]) = b*[12.d0, 6*s, -12.d0, 6*s]
      k(3,[2,3,5,6]) = b*[6*s, 4*s**2, -6*s, 2*s**2]
      k(5,:) = -k(2,:)
      k(6,[2,3,5,6]) = b*[6*s, 2*s**2, -6*s, 4*s**2]
      amatrx = k
      rhs(1:6,1) = -matmul(k,u)
      end
