! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Stress and tangent of the material that *UEL PROPERTY names, as UELMAT calls for them.
!> Strain and stress are in global directions, whatever *ORIENTATION says of the material.
!> The number of components follows from TENSOR= of *USER ELEMENT. Small strain: dfgrd, dvdv0, dvmat and celent are not
!> used, nor is any predefined field.
subroutine material_lib_mech(materiallib, stress, ddsdde, stran, dstran, npt, dvdv0, dvmat, dfgrd, predef, dpredef, npredf, &
                             celent, coords)
  use host_kinds, only: dp, i4
  use host_materials, only: find_material, material_t, needs_history, stress_update
  use host_messages, only: add_message
  use host_point, only: move_to, point_t
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
  type(point_t) :: point
  character(len=128) :: text
  integer :: n
  material => find_material(materiallib)
  if (.not. associated(material)) then
    call add_message(-3_i4, 'MATERIAL_LIB_MECH: the first argument is not the MATERIALLIB that was passed to UELMAT')
    call escape()
  end if
  call move_to(point, int(npt))
  if (needs_history(material) .and. .not. associated(point%history)) then
    write (text, '(a,i0,a)') 'MATERIAL_LIB_MECH: NPT = ', npt, ' is outside the points that INTEGRATION= declares'
    call add_message(-3_i4, trim(text))
    call escape()
  end if
  point%place = coords
  n = material%ntens
  call stress_update(material, point, stran(1:n) + dstran(1:n), stress(1:n), ddsdde(1:n*n))
end subroutine material_lib_mech
