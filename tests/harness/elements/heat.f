! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A material that generates heat. PROPS: Young's modulus, Poisson's ratio, a, b, c, d, and what DDSDDT, DRPLDE and DRPLDT are
! multiplied with. Component i of the stress is the elastic one + i d T**2; the heat source is a - b T + c T sum(i e_i).
      include '../umat.inc'
      temperature=temp+dtemp
      ddsdde=0
      factor=props(1)/((1+props(2))*(1-2*props(2)))
      ddsdde(1:ndi,1:ndi)=factor*props(2)
      do i=1,ndi
        ddsdde(i,i)=factor*(1-props(2))
      end do
      do i=ndi+1,ntens
        ddsdde(i,i)=0.5d0*factor*(1-2*props(2))
      end do
      if (ndi.eq.2) then
        ddsdde=0
        ddsdde(1:2,1:2)=props(1)*props(2)/(1-props(2)**2)
        ddsdde(1,1)=props(1)/(1-props(2)**2)
        ddsdde(2,2)=ddsdde(1,1)
        ddsdde(3,3)=0.5d0*props(1)/(1+props(2))
      end if
      stress=matmul(ddsdde,stran+dstran)
      rpl=props(3)-props(4)*temperature
      drpldt=-props(4)
      do i=1,ntens
        strain=stran(i)+dstran(i)
        stress(i)=stress(i)+i*props(6)*temperature**2
        ddsddt(i)=2*i*props(6)*temperature
        rpl=rpl+props(5)*temperature*i*strain
        drpldt=drpldt+props(5)*i*strain
        drplde(i)=props(5)*temperature*i
      end do
      ddsddt=props(7)*ddsddt
      drplde=props(8)*drplde
      drpldt=props(9)*drpldt
      statev(1)=temp
      statev(2)=dtemp
      end
