! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
! DFLUX of mass diffusion: TEMP + 2 PRESS - 3 SOL times the magnitude of the deck. DISP prescribes the number of the dof.
      subroutine dflux(flux,sol,kstep,kinc,time,noel,npt,coords,jltyp,temp,press,sname)
      include 'aba_param.inc'
      dimension flux(2),time(2),coords(3)
      character*80 sname
      flux(2)=-3*flux(1)
      flux(1)=flux(1)*(temp+2*press-3*sol)
      end

      subroutine disp(u,kstep,kinc,time,node,noel,jdof,coords)
      include 'aba_param.inc'
      dimension u(3),time(3),coords(3)
      u(1)=jdof
      end
