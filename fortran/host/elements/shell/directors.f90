! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Large rotations of shells of eight nodes whose strains are small: the directors turn with the nodes.
!>
!> Of the shell x(r,s) + z v(r,s) of host_shell_strains the nodes move by u, and the directors become d = exp(rotation vector) v.
!> The strains are those of Green and Lagrange, less what is quadratic in z (J.C. Simo, D.D. Fox, Computer Methods in Applied
!> Mechanics and Engineering 72 (1989) 267):
!>
!>     e = sym(y,a . y,b - x,a . x,b)/2,    k = sym(y,a . d,b - x,a . v,b),    shear = y,a . d - x,a . v,    y = x + u
!>
!> A rotation of all changes none of them, nor the drilling strain, (y,1 . Q e2 - y,2 . Q e1)/2 with the mean Q of the rotations of
!> the nodes. Their work gives the forces of the nodes, and their moments about the global axes, as host_corotation has them. The
!> derivative by the unknowns is that by a complex step.
module host_shell_directors
  use host_corotation, only: rotation_of
  use host_kinds, only: dp
  use host_polar, only: cross, step
  use host_shell_strains, only: shell_point
  implicit none (type, external)
  private
  public :: shell_stress, mean_directors, director_strains, director_stiffness

  !> Stresses of an element, and what they change by with the strains.
  type :: shell_stress
    real(dp), allocatable :: force(:, :)        !< (8, points) forces and moments per length along the axes of the points
    real(dp), allocatable :: modulus(:, :, :)   !< (8, 8, points)
    real(dp), allocatable :: drill(:)           !< (points of full integration)
    real(dp) :: drilling = 0                    !< stiffness
  end type shell_stress

  !> Where the nodes are.
  type :: place_t
    complex(dp), allocatable :: x(:, :)             !< (3, nodes)
    complex(dp), allocatable :: rotation(:, :, :)   !< (3, 3, nodes)
    complex(dp), allocatable :: director(:, :)      !< (3, nodes)
  end type place_t

contains

  pure function place_of(nodes, x, v, u) result(at)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(3, nodes), v(3, nodes)
    complex(dp), intent(in) :: u(6, nodes)
    type(place_t) :: at
    integer :: k
    allocate (at%rotation(3, 3, nodes), at%director(3, nodes))
    at%x = x + u(:3, :)
    do k = 1, nodes
      at%rotation(:, :, k) = rotation_of(u(4:, k))
      at%director(:, k) = matmul(at%rotation(:, :, k), v(:, k))
    end do
  end function place_of

  !> Directors at points.
  pure function mean_directors(nodes, x, v, points, u) result(mean)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(3, nodes), v(3, nodes), u(6, nodes)
    type(shell_point), intent(in) :: points(:)
    real(dp) :: mean(3, size(points))
    type(place_t) :: at
    integer :: p
    at = place_of(nodes, x, v, cmplx(u, kind=dp))
    do p = 1, size(points)
      mean(:, p) = matmul(real(at%director, dp), points(p)%n(:nodes))
    end do
  end function mean_directors

  !> Strains, curvatures and shear strains along the axes of points, or the drilling strain, by displacements and rotation vectors.
  !> Their derivatives are in the imaginary parts.
  pure subroutine director_strains(nodes, x, v, points, full, u, strains, drill)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(3, nodes), v(3, nodes)
    type(shell_point), intent(in) :: points(:), full(:)
    complex(dp), intent(in) :: u(6, nodes)
    complex(dp), intent(out) :: strains(8, size(points)), drill(size(full))
    type(place_t) :: at, start
    integer :: p
    complex(dp) :: none(6, nodes)
    none = 0
    at = place_of(nodes, x, v, u)
    start = place_of(nodes, x, v, none)
    do p = 1, size(points)
      strains(:, p) = products(nodes, points(p), at) - products(nodes, points(p), start)
    end do
    do p = 1, size(full)
      drill(p) = drilling_of(nodes, full(p), at)
    end do
  end subroutine director_strains

  !> Products of tangents and directors at a point whose changes are the strains.
  pure function products(nodes, point, at) result(found)
    integer, intent(in) :: nodes
    type(shell_point), intent(in) :: point
    type(place_t), intent(in) :: at
    complex(dp) :: found(8), a(3, 2), d(3, 2), mean(3)
    a = matmul(at%x, point%gradient(:nodes, :))
    d = matmul(at%director, point%gradient(:nodes, :))
    mean = matmul(at%director, point%n(:nodes))
    found(:3) = [0.5_dp*sum(a(:, 1)**2), 0.5_dp*sum(a(:, 2)**2), sum(a(:, 1)*a(:, 2))]
    found(4:6) = [sum(a(:, 1)*d(:, 1)), sum(a(:, 2)*d(:, 2)), sum(a(:, 1)*d(:, 2)) + sum(a(:, 2)*d(:, 1))]
    found(7:) = [sum(a(:, 1)*mean), sum(a(:, 2)*mean)]
  end function products

  !> What the mean rotation of the nodes has made of the first two axes of a point.
  pure function turned_axes(nodes, point, at) result(axes)
    integer, intent(in) :: nodes
    type(shell_point), intent(in) :: point
    type(place_t), intent(in) :: at
    complex(dp) :: axes(3, 2)
    integer :: k
    axes = 0
    do k = 1, nodes
      axes = axes + point%n(k)*matmul(at%rotation(:, :, k), transpose(point%frame(:2, :)))
    end do
  end function turned_axes

  pure complex(dp) function drilling_of(nodes, point, at)
    integer, intent(in) :: nodes
    type(shell_point), intent(in) :: point
    type(place_t), intent(in) :: at
    complex(dp) :: a(3, 2), axes(3, 2)
    a = matmul(at%x, point%gradient(:nodes, :))
    axes = turned_axes(nodes, point, at)
    drilling_of = 0.5_dp*(sum(a(:, 1)*axes(:, 2)) - sum(a(:, 2)*axes(:, 1)))
  end function drilling_of

  !> Forces and moments of the nodes, and their derivatives by displacements and rotation vectors.
  pure subroutine director_stiffness(nodes, x, v, points, full, u, stress, force, stiffness)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(3, nodes), v(3, nodes), u(6, nodes)
    type(shell_point), intent(in) :: points(:), full(:)
    type(shell_stress), intent(in) :: stress
    real(dp), intent(out) :: force(6*nodes), stiffness(6*nodes, 6*nodes)
    complex(dp) :: moved(6, nodes), pushed(6, nodes)
    integer :: i, k
    do k = 1, nodes
      do i = 1, 6
        moved = u
        moved(i, k) = moved(i, k) + cmplx(0.0_dp, step, dp)
        pushed = forces_of(nodes, x, v, points, full, moved, stress)
        stiffness(:, 6*(k - 1) + i) = reshape(aimag(pushed), [6*nodes])/step
      end do
    end do
    ! the last step has not changed the real part
    force = reshape(real(pushed, dp), [6*nodes])
  end subroutine director_stiffness

  !> Forces and moments of the nodes, with their change by that of the displacements.
  pure function forces_of(nodes, x, v, points, full, u, stress) result(force)
    integer, intent(in) :: nodes
    real(dp), intent(in) :: x(3, nodes), v(3, nodes)
    type(shell_point), intent(in) :: points(:), full(:)
    complex(dp), intent(in) :: u(6, nodes)
    type(shell_stress), intent(in) :: stress
    complex(dp) :: force(6, nodes), strains(8, size(points)), drill(size(full)), on_director(3, nodes)
    complex(dp) :: s(8), a(3, 2), d(3, 2), mean(3), membrane(2, 2), moment(2, 2), by_tangent(3, 2), by_slope(3, 2), turning
    type(place_t) :: at
    integer :: k, p
    call director_strains(nodes, x, v, points, full, u, strains, drill)
    at = place_of(nodes, x, v, u)
    force = 0
    on_director = 0
    do p = 1, size(points)
      associate (g => points(p)%gradient(:nodes, :), n => points(p)%n(:nodes), weight => points(p)%weight)
        s = weight*cmplx(stress%force(:, p), matmul(stress%modulus(:, :, p), aimag(strains(:, p))), dp)
        a = matmul(at%x, g)
        d = matmul(at%director, g)
        mean = matmul(at%director, n)
        membrane = reshape(s([1, 3, 3, 2]), [2, 2])
        moment = reshape(s([4, 6, 6, 5]), [2, 2])
        by_tangent = matmul(a, membrane) + matmul(d, moment) + spread(mean, 2, 2)*spread(s(7:), 1, 3)
        by_slope = matmul(a, moment)
        force(:3, :) = force(:3, :) + matmul(by_tangent, transpose(g))
        on_director = on_director + matmul(by_slope, transpose(g)) + spread(matmul(a, s(7:)), 2, nodes)*spread(n, 1, 3)
      end associate
    end do
    do k = 1, nodes
      force(4:, k) = cross(at%director(:, k), on_director(:, k))
    end do
    do p = 1, size(full)
      associate (g => full(p)%gradient(:nodes, :), n => full(p)%n(:nodes))
        turning = 0.5_dp*full(p)%weight*cmplx(stress%drill(p), stress%drilling*aimag(drill(p)), dp)
        a = matmul(at%x, g)
        d = turned_axes(nodes, full(p), at)
        do k = 1, nodes
          force(:3, k) = force(:3, k) + turning*(g(k, 1)*d(:, 2) - g(k, 2)*d(:, 1))
          associate (axes => matmul(at%rotation(:, :, k), transpose(full(p)%frame(:2, :))))
            force(4:, k) = force(4:, k) + turning*n(k)*(cross(axes(:, 2), a(:, 1)) - cross(axes(:, 1), a(:, 2)))
          end associate
        end do
      end associate
    end do
  end function forces_of
end module host_shell_directors
