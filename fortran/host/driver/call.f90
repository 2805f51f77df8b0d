! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> A call of a user element as calls.c makes it: where its arguments are, and where they come from.
module host_call
  use, intrinsic :: iso_c_binding, only: c_funloc, c_funptr, c_int32_t, c_int64_t, c_loc, c_null_ptr, c_ptr
  use host_adapter, only: decode, element_t, evaluate
  use host_block, only: block_t, entries_zero, scalars_t
  use host_kinds, only: dp, i4, i8
  use host_workspace, only: i_a, i_amatrx, i_coords, i_du, i_energy, i_predef, i_props, i_rhs, i_svars, i_u, i_v, workspace_t
  implicit none (type, external)
  private
  public :: arguments_t, lay_out_arguments, set_loads, call_routine

  !> As in calls.c: what it needs to know of a block, whose arrays have a column for each element.
  type, bind(c) :: layout_t
    type(c_funptr) :: routine
    integer(c_int32_t) :: with_material = 0   !< call with UELMAT's 37 arguments
    integer(c_int32_t) :: loaded = 0          !< distributed loads are set before the call
    integer(c_int32_t) :: moves = 0           !< V and A are given
    integer(c_int32_t) :: keeps = 0           !< SVARS and ENERGY are kept
    ! entries of an element; `another` is that of PREDEF from one element to the next, 0 if it is the same for all
    integer(c_int64_t) :: ndofel = 0, rhs = 0, svars = 0, props = 0, coords = 0, predef = 0, another = 0, jprops = 0
    integer(c_int64_t) :: on_entry = 0               !< bits of the entries of RHS and AMATRX
    type(c_ptr) :: equations
    type(c_ptr) :: from_u, from_du, from_v, from_a   !< of the system
    type(c_ptr) :: from_scalars, from_jprops, from_props, from_svars, from_energy, from_coords, from_predef
    type(c_ptr) :: to_scalars, to_svars, to_energy
    type(c_ptr) :: element                    !< of a built-in element, the only argument of its routine
    type(c_ptr) :: given(37)                  !< addresses of the arguments
  end type layout_t

  !> Entries on either side of an argument outside the workspace: a write there does no harm to this process.
  integer, parameter :: spare = 100

  !> Arguments outside the workspace, and where all of them are. Nothing moves in a pass.
  type :: arguments_t
    type(layout_t) :: layout
    type(scalars_t) :: scalars   !< for each call
    real(dp) :: before(spare) = 0
    type(scalars_t) :: given     !< to this one
    real(dp) :: behind(spare) = 0
    integer(i4), allocatable :: jprops(:), jdltyp(:)   ! with spare entries
    real(dp), allocatable :: adlmag(:), ddlmag(:)      ! likewise
    type(element_t) :: element   !< a built-in element, which has the same arrays
  end type arguments_t

  interface
    !> Call the element at a place in its block, from 0.
    subroutine call_routine(layout, place, thread, element) bind(c, name='uel_host_call')
      import :: c_int32_t, c_int64_t, layout_t
      type(layout_t), intent(in) :: layout
      integer(c_int64_t), value :: place
      integer(c_int32_t), value :: thread, element   !< thread: from 0
    end subroutine call_routine
  end interface

contains

  !> Room for the arguments outside the workspace, and the layout of all of them.
  subroutine lay_out_arguments(block, work, arguments)
    type(block_t), intent(in) :: block
    type(workspace_t), intent(in), target :: work
    type(arguments_t), intent(inout), target :: arguments
    integer :: last
    if (allocated(arguments%jprops)) deallocate (arguments%jprops, arguments%jdltyp, arguments%adlmag, arguments%ddlmag)
    allocate (arguments%jprops(1 - spare:size(block%jprops) + spare), source=0_i4)
    ! two columns
    last = 2*max(1, size(block%kinds, 1)) + spare
    allocate (arguments%jdltyp(1 - spare:last), source=0_i4)
    allocate (arguments%adlmag(1 - spare:last), arguments%ddlmag(1 - spare:last), source=0.0_dp)
    arguments%scalars = block%scalars
    if (block%built_in) call lay_out_element(block, work, arguments)
    associate (layout => arguments%layout, given => arguments%given)
      layout%routine = block%address
      layout%element = c_null_ptr
      if (block%built_in) then
        layout%routine = c_funloc(evaluate)
        layout%element = c_loc(arguments%element)
      end if
      layout%with_material = merge(1, 0, block%scalars%material > 0)
      layout%loaded = merge(1, 0, any(block%counts > 0))
      layout%moves = merge(1, 0, block%moves)
      layout%keeps = merge(1, 0, block%keeps_state)
      layout%ndofel = block%scalars%ndofel
      layout%rhs = work%length(i_rhs)
      layout%svars = work%length(i_svars)
      layout%props = work%length(i_props)
      layout%coords = work%length(i_coords)
      layout%predef = work%length(i_predef)
      layout%another = merge(layout%predef, 0_c_int64_t, size(block%predef, 2) > 1)
      layout%jprops = size(block%jprops)
      layout%on_entry = merge(0_i8, work%unset, block%entries == entries_zero .or. block%built_in)
      layout%equations = c_loc(block%equations)
      layout%from_u = c_loc(block%u)
      layout%from_du = c_loc(block%du)
      layout%from_v = c_loc(block%v)
      layout%from_a = c_loc(block%a)
      layout%from_scalars = c_loc(arguments%scalars)
      layout%from_jprops = c_loc(block%jprops)
      layout%from_props = c_loc(block%props)
      layout%from_svars = c_loc(block%svars)
      layout%from_energy = c_loc(block%energy)
      layout%from_coords = c_loc(block%coords)
      layout%from_predef = c_loc(block%predef)
      layout%to_scalars = c_loc(given)
      layout%to_svars = c_loc(block%svars_trial)
      layout%to_energy = c_loc(block%energy_trial)
      ! in the order of UELMAT
      layout%given = &
        [at(i_rhs), at(i_amatrx), at(i_svars), at(i_energy), c_loc(given%ndofel), c_loc(given%nrhs), c_loc(given%nsvars), &
         at(i_props), c_loc(given%nprops), at(i_coords), c_loc(given%mcrd), c_loc(given%nnode), at(i_u), at(i_du), at(i_v), &
         at(i_a), c_loc(given%jtype), c_loc(given%time), c_loc(given%dtime), c_loc(given%kstep), c_loc(given%kinc), &
         c_loc(given%jelem), c_loc(given%params), c_loc(given%ndload), c_loc(arguments%jdltyp(1)), c_loc(arguments%adlmag(1)), &
         at(i_predef), c_loc(given%npredf), c_loc(given%lflags), c_loc(given%mlvarx), c_loc(arguments%ddlmag(1)), &
         c_loc(given%mdload), c_loc(given%pnewdt), c_loc(arguments%jprops(1)), c_loc(given%njprop), c_loc(given%period), &
         c_loc(given%material)]
    end associate
  contains
    !> Address of an array in the workspace.
    type(c_ptr) function at(array)
      integer, intent(in) :: array
      at = c_loc(work%memory(work%start(array)))
    end function at
  end subroutine lay_out_arguments

  !> A built-in element with the arrays of the call.
  subroutine lay_out_element(block, work, arguments)
    type(block_t), intent(in) :: block
    type(workspace_t), intent(in), target :: work
    type(arguments_t), intent(inout), target :: arguments
    call decode(arguments%element, block%address, block%scalars)
    associate (element => arguments%element, of => block%scalars)
      element%jelem => arguments%given%jelem
      element%ndload => arguments%given%ndload
      element%jprops => arguments%jprops(1:size(block%jprops))
      element%jdltyp => arguments%jdltyp(1:size(block%kinds, 1))
      element%adlmag => arguments%adlmag(1:size(block%kinds, 1))
      element%ddlmag => arguments%ddlmag(1:size(block%kinds, 1))
      element%rhs(1:of%ndofel, 1:of%nrhs) => array(i_rhs)
      element%amatrx(1:of%ndofel, 1:of%ndofel) => array(i_amatrx)
      element%svars => array(i_svars)
      element%energy => array(i_energy)
      element%props => array(i_props)
      element%coords(1:of%mcrd, 1:of%nnode) => array(i_coords)
      element%u => array(i_u)
      element%added => array(i_du)
      element%added => element%added(:of%ndofel)
      element%du => element%added
      if (element%of_stress) element%du => element%still
      element%v => array(i_v)
      element%a => array(i_a)
      element%predef(1:2, 1:of%npredf, 1:of%nnode) => array(i_predef)
    end associate
  contains
    !> An array in the workspace.
    function array(number)
      integer, intent(in) :: number
      real(dp), pointer, contiguous :: array(:)
      array => work%memory(work%start(number):work%start(number) + work%length(number) - 1)
    end function array
  end subroutine lay_out_element

  !> Distributed loads of an element. Their second column, of the other load case with NRHS = 2, is zero.
  subroutine set_loads(block, row, arguments)
    type(block_t), intent(in) :: block
    integer, intent(in) :: row   !< of the element in the distributed loads
    type(arguments_t), intent(inout) :: arguments
    integer(i4) :: n
    n = block%counts(row)
    arguments%scalars%ndload = n
    arguments%scalars%mdload = max(n, 1_i4)
    arguments%jdltyp = 0
    arguments%adlmag = 0
    arguments%ddlmag = 0
    arguments%jdltyp(1:n) = block%kinds(:n, row)
    arguments%adlmag(1:n) = block%loads(1, :n, row)
    arguments%ddlmag(1:n) = block%loads(2, :n, row)
  end subroutine set_loads
end module host_call
