! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! DFLUX and FILM of the tests: 2 + x - 3 T times the magnitude of the deck; the film coefficient of the deck times 1 + T/10, sink +
! x. They print what they are given; where x is above 50 they stop.
      subroutine dflux(flux,sol,kstep,kinc,time,noel,npt,coords,jltyp,temp,press,sname)
      include 'aba_param.inc'
      dimension flux(2),time(2),coords(3)
      character*80 sname
      write(6,'(a,8es24.16,5i6,1x,a)') 'DFLUX ',flux,sol,time,coords,kstep,kinc,noel,npt,jltyp,trim(sname)
      if (temp.ne.0.or.press.ne.0) call xit
      if (coords(1).gt.50) call xit
      flux(2)=-3*flux(1)
      flux(1)=flux(1)*(2+coords(1)-3*sol)
      end

      subroutine film(h,sink,temp,kstep,kinc,time,noel,npt,coords,jltyp,field,nfield,sname,node,area)
      include 'aba_param.inc'
      dimension h(2),time(2),coords(3),field(*)
      character*80 sname
      write(6,'(a,11es24.16,7i6,1x,a)') 'FILM ',h,sink,temp,time,coords,field(1),area,kstep,kinc,noel,npt,jltyp,nfield,node,
     1 trim(sname)
      if (coords(1).gt.50) call xit
      h(2)=h(1)/10
      h(1)=h(1)*(1+temp/10)
      sink=sink+coords(1)
      end
