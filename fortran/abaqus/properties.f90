! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The properties and state variables of an element type, from the tables of abaqus_layout, which fortran/properties.toml defines:
!> how many there are, where a property stands in PROPS or JPROPS, and what a zero stands for.
module abaqus_properties
  use, intrinsic :: iso_c_binding, only: c_int
  use core_kinds, only: dp
  use abaqus_layout, only: elements, faces, reals, integers, rows_of_reals, rows_of_integers, interfaces, stabilised, &
    next_to_solids, p_betan, p_betat, j_law, j_closure
  implicit none(type, external)
  private
  public :: row_of, family_of, unknowns_of, variables_of, variables_of_points, nodes_of_face, face_nodes
  public :: real_position, integer_position, unpack, recommend, delamination_layout_version

  ! values that choose among laws and estimates; 0 stands for what the element is made for, see `recommend`
  real(dp), parameter, public :: by_eigenvalues = -1.0_dp   ! BETAN, BETAT: needs the elements on both sides
  real(dp), parameter, public :: by_equation_21 = -2.0_dp
  integer, parameter, public :: consistent_closure = 1      ! CLOSURE
  integer, parameter, public :: paper_closure = 2
  integer, parameter, public :: complete_closure = 3

contains

  !> Row of Un in `elements`, the itype of the procedures below; 0 where there is no such type.
  pure function row_of(jtype) result(itype)
    integer, intent(in) :: jtype
    integer :: itype

    do itype = 1, size(elements)
      if (elements(itype)%jtype == jtype) return
    end do
    itype = 0
  end function row_of

  !> Number of the family of a type: its column in `rows_of_reals` and `rows_of_integers`.
  pure integer function family_of(itype)
    integer, intent(in) :: itype

    family_of = 1 + trailz(elements(itype)%family)
  end function family_of

  !> Number of unknowns.
  pure function unknowns_of(itype) result(number)
    integer, intent(in) :: itype
    integer :: number

    number = elements(itype)%dimension*elements(itype)%nodes
  end function unknowns_of

  !> Number of SVARS, VARIABLES of *USER ELEMENT; 0 for row 0.
  pure function variables_of(itype) result(number)
    integer, intent(in) :: itype
    integer :: number

    number = 0
    if (itype > 0) number = variables_of_points(itype) + elements(itype)%own
  end function variables_of

  !> Number of SVARS of the points.
  pure function variables_of_points(itype) result(number)
    integer, intent(in) :: itype
    integer :: number

    number = elements(itype)%points*elements(itype)%variables
  end function variables_of_points

  !> Number of nodes of each face of an interface element.
  pure function nodes_of_face(itype) result(number)
    integer, intent(in) :: itype
    integer :: number

    number = count(faces(itype)%bottom > 0) + count(faces(itype)%bottom_middles > 0)
  end function nodes_of_face

  !> Nodes of its bottom and its top face, a column each.
  pure function face_nodes(itype) result(nodes)
    integer, intent(in) :: itype
    integer :: nodes(nodes_of_face(itype), 2)

    nodes(:, 1) = present_of(size(nodes, 1), [faces(itype)%bottom, faces(itype)%bottom_middles])
    nodes(:, 2) = present_of(size(nodes, 1), [faces(itype)%top, faces(itype)%top_middles])
  end function face_nodes

  !> The entries that are not zero, as the intrinsic pack, which allocates memory in each call.
  pure function present_of(n, entries) result(present_ones)
    integer, intent(in) :: n
    integer, intent(in) :: entries(:)
    integer :: present_ones(n)
    integer :: i, k

    k = 0
    do i = 1, size(entries)
      if (entries(i) == 0) cycle
      k = k + 1
      present_ones(k) = entries(i)
    end do
  end function present_of

  !> Position in PROPS of the property in a row of `reals`.
  pure function real_position(itype, row) result(position)
    integer, intent(in) :: itype, row
    integer :: position

    position = count(iand(reals(1:row)%families, elements(itype)%family) /= 0)
  end function real_position

  !> Position in JPROPS of the property in a row of `integers`.
  pure function integer_position(itype, row) result(position)
    integer, intent(in) :: itype, row
    integer :: position

    position = count(iand(integers(1:row)%families, elements(itype)%family) /= 0)
  end function integer_position

  !> Properties by their rows in `reals` and `integers`; 0 where the element has no such property.
  pure subroutine unpack(itype, props, jprops, values, options)
    integer, intent(in) :: itype
    real(dp), intent(in) :: props(elements(itype)%reals)
    integer, intent(in) :: jprops(elements(itype)%integers)
    real(dp), intent(out) :: values(size(reals))
    integer, intent(out) :: options(size(integers))
    integer :: position, family

    family = family_of(itype)
    values = 0.0_dp
    do position = 1, size(props)
      values(rows_of_reals(position, family)) = props(position)
    end do
    options = 0
    do position = 1, size(jprops)
      options(rows_of_integers(position, family)) = jprops(position)
    end do
  end subroutine unpack

  !> Puts what a zero stands for in its place: the bilinear law and, in a self-contained element, the complete form and beta
  !> from the local eigenvalues, in U3 and U10, which follow the paper, its closure and (21).
  pure subroutine recommend(itype, values, options)
    integer, intent(in) :: itype
    real(dp), intent(inout) :: values(size(reals))
    integer, intent(inout) :: options(size(integers))
    integer, parameter :: betas(2) = [p_betan, p_betat]
    logical :: follows_paper

    if (iand(elements(itype)%family, interfaces) /= 0 .and. options(j_law) == 0) options(j_law) = 1
    if (iand(elements(itype)%family, stabilised) == 0) return
    follows_paper = iand(elements(itype)%family, next_to_solids) /= 0
    if (options(j_closure) == 0) options(j_closure) = merge(paper_closure, complete_closure, follows_paper)
    where (.not. abs(values(betas)) > 0.0_dp) values(betas) = merge(by_equation_21, by_eigenvalues, follows_paper)
  end subroutine recommend

  !> Marks a library as holding these elements, so that a host may name their SVARS.
  function delamination_layout_version() result(version) bind(c, name='delamination_layout_version')
    integer(c_int) :: version

    version = 1_c_int
  end function delamination_layout_version

end module abaqus_properties
