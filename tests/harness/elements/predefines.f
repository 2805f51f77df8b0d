! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! UTEMP and UFIELD of the tests: the value of the deck + x + 10 times the total time; that + 100 times the temperature. They print
! what they are given; where the deck says 666 they stop.
      subroutine utemp(temp,nsecpt,kstep,kinc,time,node,coords)
      include 'aba_param.inc'
      dimension temp(nsecpt),time(2),coords(3)
      write(6,'(a,6es24.16,4i6)') 'UTEMP ',temp,time,coords,nsecpt,kstep,kinc,node
      if (temp(1).eq.666) call xit
      temp(1)=temp(1)+coords(1)+10*time(2)
      end

      subroutine ufield(field,kfield,nsecpt,kstep,kinc,time,node,coords,temp,dtemp,nfield)
      include 'aba_param.inc'
      dimension field(nsecpt,nfield),time(2),coords(3),temp(nsecpt),dtemp(nsecpt)
      write(6,'(a,8es24.16,6i6)') 'UFIELD',field,time,coords,temp,dtemp,kfield,nsecpt,kstep,kinc,node,nfield
      if (field(1,1).eq.666) call xit
      field(1,1)=field(1,1)+coords(1)+10*time(2)+100*temp(1)
      end
