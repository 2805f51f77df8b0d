! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! A linear elastic material, nu = 0, that writes outside its arrays. PROPS: Young's modulus, the array (1 STATEV, 2 STRESS,
! 3 DDSDDE), and the first and the last entry.
      include '../umat.inc'
      ddsdde=0
      do i=1,ndi
        ddsdde(i,i)=props(1)
      end do
      do i=ndi+1,ntens
        ddsdde(i,i)=props(1)/2
      end do
      stress=matmul(ddsdde,stran+dstran)
      do i=nint(props(3)),nint(props(4))
        select case (nint(props(2)))
        case (1)
          call spoil(statev,i)
        case (2)
          call spoil(stress,i)
        case default
          call spoil(ddsdde,i)
        end select
      end do
      end

      subroutine spoil(array,entry)
      real*8 array(*)
      integer entry
      array(entry)=7
      end
