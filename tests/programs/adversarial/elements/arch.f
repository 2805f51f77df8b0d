! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!
! A bar in space with large displacements and rotations, logarithmic strain, and plasticity with kinematic hardening, for arches
! that snap through: PROPS Young's modulus, area, yield stress, hardening modulus. SVARS: plastic strain, back stress.
      include '../../harness/uel.inc'
      dimension after(3),way(6)
      rhs(1:6,1) = 0
      if (nrhs == 2) rhs(1:6,2) = 0
      amatrx = 0
      if (lflags(3) == 3 .or. lflags(3) == 4) return
      after = coords(1:3,2) - coords(1:3,1) + u(4:6) - u(1:3)
      span = sqrt(sum((coords(1:3,2) - coords(1:3,1))**2))
      stretched = sqrt(sum(after**2))
      strain = log(stretched/span)
      trial = props(1)*(strain - svars(1))
      excess = abs(trial - svars(2)) - props(3)
      tangent = props(1)
      step = 0
      if (excess > 0) then
        step = sign(excess/(props(1) + props(4)), trial - svars(2))
        tangent = props(1)*props(4)/(props(1) + props(4))
      end if
      if (abs(step) > 0.05d0) pnewdt = 0.5d0
      stress = trial - props(1)*step
      force = stress*props(2)*span/stretched
      way = (/ -after, after /)/stretched
      rhs(1:6,1) = -force*way
      stiffness = (tangent*props(2)*span/stretched - 2*force)/stretched
      do i = 1, 6
        amatrx(:,i) = stiffness*way*way(i)
      end do
      do i = 1, 3
        amatrx(i,i) = amatrx(i,i) + force/stretched
        amatrx(i+3,i+3) = amatrx(i+3,i+3) + force/stretched
        amatrx(i,i+3) = amatrx(i,i+3) - force/stretched
        amatrx(i+3,i) = amatrx(i+3,i) - force/stretched
      end do
      energy(2) = props(2)*span*stress**2/(2*props(1))
      energy(4) = energy(4) + props(2)*span*step*stress
      svars(1) = svars(1) + step
      svars(2) = svars(2) + props(4)*step
      end
