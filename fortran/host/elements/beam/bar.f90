! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> A force along the line between two nodes, of trusses and SPRINGA.
module host_bar
  use host_context, only: added_stress, stress_matrix
  use host_kinds, only: dp, i4
  use host_messages, only: add_message
  use host_protect, only: escape
  implicit none (type, external)
  private
  public :: bar_t, bar_of, bar_forces, initial_length

  type :: bar_t
    logical :: finite = .false.    !< large displacements
    real(dp) :: along(3) = 0       !< unit vector of the line, which turns with it in large displacements
    real(dp) :: length = 0         !< before any displacement
    real(dp) :: now = 0            !< the same, or that now in large displacements
    real(dp) :: elongation = 0
  end type bar_t

contains

  pure real(dp) function initial_length(dim, x)
    integer, intent(in) :: dim
    real(dp), intent(in) :: x(dim, 2)
    initial_length = norm2(x(:, 2) - x(:, 1))
  end function initial_length

  !> Leaves the pass if both nodes are in one place.
  function bar_of(dim, finite, x, u) result(bar)
    integer, intent(in) :: dim
    logical, intent(in) :: finite
    real(dp), intent(in) :: x(dim, 2), u(dim, 2)
    type(bar_t) :: bar
    bar%finite = finite
    bar%length = initial_length(dim, x)
    if (.not. bar%length > 0) then
      call add_message(-3_i4, 'both nodes are at the same position')
      call escape()
    end if
    bar%along(:dim) = (x(:, 2) - x(:, 1))/bar%length
    bar%now = bar%length
    if (finite) then
      bar%along(:dim) = x(:, 2) + u(:, 2) - x(:, 1) - u(:, 1)
      bar%now = norm2(bar%along)
      bar%along = bar%along/bar%now
      bar%elongation = bar%now - bar%length
    else
      bar%elongation = dot_product(bar%along(:dim), u(:, 2) - u(:, 1))
    end if
  end function bar_of

  !> Forces and stiffness of a pull, and of its derivative by the elongation; if the request (LFLAGS(3)) is the initial stress
  !> matrix, only the change of the forces as the line turns.
  pure subroutine bar_forces(dim, bar, request, pull, slope, du, force, stiffness)
    integer, intent(in) :: dim
    type(bar_t), intent(in) :: bar
    integer(i4), intent(in) :: request
    real(dp), intent(in) :: pull, slope, du(dim, 2)
    real(dp), intent(inout) :: force(dim, 2), stiffness(dim, 2, dim, 2)
    real(dp) :: acting, block(dim, dim), square(dim, dim)
    integer :: i
    associate (along => bar%along(:dim))
      acting = pull
      if (request == added_stress) acting = slope*dot_product(along, du(:, 2) - du(:, 1))
      square = spread(along, 2, dim)*spread(along, 1, dim)
      block = slope*square
      if (stress_matrix(request)) block = 0
      if (bar%finite .or. stress_matrix(request)) then
        ! the force turns with the line
        block = block - acting/bar%now*square
        do i = 1, dim
          block(i, i) = block(i, i) + acting/bar%now
        end do
      end if
      force(:, 1) = -acting*along
      force(:, 2) = acting*along
    end associate
    stiffness(:, 1, :, 1) = block
    stiffness(:, 2, :, 2) = block
    stiffness(:, 1, :, 2) = -block
    stiffness(:, 2, :, 1) = -block
  end subroutine bar_forces
end module host_bar
