! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! Phase field of fracture (AT2) by the heat analogy: the temperature is the phase field, phi/l**2 - lap(phi) =
! 2 (1 - phi) H/(Gc l), where H is the largest elastic energy so far. Poisson's ratio is zero. PROPS: Young's modulus, l, Gc,
! and 1, or 0 where what the displacements and the phase field do to each other is left out of the tangent.
      include '../umat.inc'
      phase=temp+dtemp
      soft=(1-phase)**2
      ddsdde=0
      do i=1,ndi
        ddsdde(i,i)=props(1)
      end do
      do i=ndi+1,ntens
        ddsdde(i,i)=props(1)/2
      end do
      stress=matmul(ddsdde,stran+dstran)
      history=max(0.5d0*dot_product(stress,stran+dstran),statev(1))
      factor=2/(props(2)*props(3))
      rpl=factor*(1-phase)*history-phase/props(2)**2
      drpldt=-factor*history-1/props(2)**2
      if (history.gt.statev(1)) drplde=props(4)*factor*(1-phase)*stress
      ddsddt=-props(4)*2*(1-phase)*stress
      stress=soft*stress
      ddsdde=soft*ddsdde
      statev(1)=history
      end
