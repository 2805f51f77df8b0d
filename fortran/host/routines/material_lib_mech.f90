! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Stress and tangent of the material that *UEL PROPERTY names, as UELMAT calls for them.
!> Strain and stress are in global directions, whatever *ORIENTATION says of the material.
!> The number of components follows from TENSOR= of *USER ELEMENT. Small strain: dfgrd, dvdv0, dvmat and celent are not
!> used, nor is any predefined field.
subroutine material_lib_mech(materiallib, stress, ddsdde, stran, dstran, npt, dvdv0, dvmat, dfgrd, predef, dpredef, npredf, &
                             celent, coords)
  use host_context, only: current
  use host_kinds, only: dp, i4
  use host_materials, only: find_material, material_t, stress_update
  use host_messages, only: add_message
  use host_protect, only: escape
  implicit none (type, external)
  integer(i4), intent(in) :: materiallib             !< as UELMAT got it
  real(dp), intent(out) :: stress(*)                 !< at the end of the increment
  real(dp), intent(out) :: ddsdde(*)                 !< (ntens, ntens)
  real(dp), intent(in) :: stran(*), dstran(*)        !< strain at the start, and its increment
  integer(i4), intent(in) :: npt                     !< number of the material point, from 1
  real(dp), intent(in) :: dvdv0, dvmat, dfgrd(3, 3), predef(*), dpredef(*), celent, coords(3)
  integer(i4), intent(in) :: npredf
  type(material_t), pointer :: material
  character(len=128) :: text
  logical :: valid
  integer :: n
  material => find_material(materiallib)
  if (.not. associated(material)) then
    call add_message(-3_i4, 'MATERIAL_LIB_MECH: the first argument is not the MATERIALLIB that was passed to UELMAT')
    call escape()
  end if
  n = material%ntens
  current%place = coords
  call stress_update(material, npt, stran(1:n) + dstran(1:n), stress(1:n), ddsdde(1:n*n), valid)
  if (valid) return
  write (text, '(a,i0,a)') 'MATERIAL_LIB_MECH: NPT = ', npt, ' is outside the points that INTEGRATION= declares'
  call add_message(-3_i4, trim(text))
  call escape()
end subroutine material_lib_mech
