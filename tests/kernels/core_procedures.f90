! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Procedures of fortran/core under names that ctypes finds.
module core_procedures
  use, intrinsic :: iso_c_binding, only: c_double, c_int
  use core_root, only: advance, root_search, search_between, searching
  use core_serendipity, only: serendipity_functions
  use core_small_matrix, only: add_combination, add_product, determinant, invert
  use core_symmetric, only: eigenvalues, invert_definite, lower_factor
  implicit none(type, external)
  private
  public :: c_cube_root, c_serendipity, c_determinant, c_invert, c_eigenvalues, c_invert_definite, c_lower_factor
  public :: c_add_product, c_add_combination

contains

  !> Root of x**3 - target between 0 and 10, from 1 on.
  subroutine c_cube_root(target, x, found, steps) bind(c)
    real(c_double), value :: target
    real(c_double), intent(out) :: x
    integer(c_int), intent(out) :: found, steps
    type(root_search) :: search

    search = search_between(0.0_c_double, 10.0_c_double, 1.0_c_double, geometric=.false.)
    do while (searching(search))
      call advance(search, search%x**3 - target, 3*search%x**2)
    end do
    x = search%x
    found = merge(1, 0, search%found)
    steps = search%steps
  end subroutine c_cube_root

  subroutine c_serendipity(dim, nodes, places, parent, n, dn) bind(c)
    integer(c_int), value :: dim, nodes
    integer(c_int), intent(in) :: places(dim, nodes)
    real(c_double), intent(in) :: parent(dim)
    real(c_double), intent(out) :: n(nodes), dn(nodes, dim)

    call serendipity_functions(dim, nodes, places, parent, n, dn)
  end subroutine c_serendipity

  subroutine c_add_product(n, m, terms, a, b, matrix) bind(c)
    integer(c_int), value :: n, m, terms
    real(c_double), intent(in) :: a(n, terms), b(m, terms)
    real(c_double), intent(inout) :: matrix(n, m)

    call add_product(n, m, terms, a, b, matrix)
  end subroutine c_add_product

  subroutine c_add_combination(n, terms, a, x, vector) bind(c)
    integer(c_int), value :: n, terms
    real(c_double), intent(in) :: a(n, terms), x(terms)
    real(c_double), intent(inout) :: vector(n)

    call add_combination(n, terms, a, x, vector)
  end subroutine c_add_combination

  subroutine c_determinant(a, value) bind(c)
    real(c_double), intent(in) :: a(3, 3)
    real(c_double), intent(out) :: value

    value = determinant(a)
  end subroutine c_determinant

  subroutine c_invert(n, a, inverse, value) bind(c)
    integer(c_int), value :: n
    real(c_double), intent(in) :: a(n, n)
    real(c_double), intent(out) :: inverse(n, n), value

    call invert(n, a, inverse, value)
  end subroutine c_invert

  subroutine c_eigenvalues(n, a, values, vectors, good) bind(c)
    integer(c_int), value :: n
    real(c_double), intent(in) :: a(n, n)
    real(c_double), intent(out) :: values(n), vectors(n, n)
    integer(c_int), intent(out) :: good
    logical :: found

    call eigenvalues(a, values, found, vectors)
    good = merge(1, 0, found)
  end subroutine c_eigenvalues

  subroutine c_invert_definite(n, a, inverse, good) bind(c)
    integer(c_int), value :: n
    real(c_double), intent(in) :: a(n, n)
    real(c_double), intent(out) :: inverse(n, n)
    integer(c_int), intent(out) :: good
    logical :: found

    call invert_definite(a, inverse, found)
    good = merge(1, 0, found)
  end subroutine c_invert_definite

  subroutine c_lower_factor(n, a, good) bind(c)
    integer(c_int), value :: n
    real(c_double), intent(inout) :: a(n, n)
    integer(c_int), intent(out) :: good
    logical :: found

    call lower_factor(a, found)
    good = merge(1, 0, found)
  end subroutine c_lower_factor

end module core_procedures
