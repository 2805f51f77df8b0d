! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Heat that enters through faces, into volumes and at nodes: fluxes, by the deck or by DFLUX, films, by the deck or by FILM (User
!> Subroutines Guide, DFLUX, FILM), and radiation (Analysis User's Guide, Thermal loads). In mass diffusion solute enters as heat
!> does.
!>
!> JTYPE: 1 a face, 2 a volume, 3 a node. Values of PROPS and JPROPS: built_in.toml. Loads of the call: of kind 1 the flux or the
!> temperature of the sink or the surroundings, of kind 2 the film coefficient or the emissivity. The unknowns are the temperatures
!> or concentrations, in quadratic coupled elements those of the corners.
!>
!> Faces of linear elements have their points at the corners, as in Abaqus (Analysis User's Guide, Solid elements), each with the
!> integral of its function as weight, so that a uniform flux makes a linear temperature on any mesh; the others, and volumes,
!> have Gauss points. All is in the shape before any displacement.
module host_heat_loads
  use, intrinsic :: iso_c_binding, only: c_f_procpointer, c_funptr
  use core_rotation, only: cross
  use core_small_matrix, only: determinant
  use host_adapter, only: element_t
  use host_context, only: current
  use host_guarded, only: guarded_t, lay_out_guarded, warn_of_no_numbers, warn_of_writes
  use host_kinds, only: dp, i4
  use host_layout, only: j_heat_load_axisymmetric, j_heat_load_diffusive, j_heat_load_family, j_heat_load_field, j_heat_load_load, &
                         j_heat_load_points, p_heat_load_depth
  use host_shape, only: radius_of, rule_of, rule_t
  implicit none (type, external)
  private
  public :: define_heat_load, heat_load, heat_load_t

  integer(i4), parameter :: volume = 2, node = 3   !< JTYPE

  integer(i4), parameter :: film = 1, radiation = 2   !< law; 0: a flux

  !> A load of one type on one surface.
  type :: heat_load_t
    integer(i4) :: law = 0
    real(dp) :: absolute_zero = 0
    real(dp) :: stefan_boltzmann = 0
    logical :: by_user = .false.                !< DFLUX or FILM is called
    type(c_funptr) :: address
    character(len=80) :: surface = ' '          !< SNAME
    integer(i4) :: jltyp = 0
    logical, pointer :: reported(:) => null()   !< a write outside FLUX or H is
    logical, pointer :: spoilt(:) => null()
  end type heat_load_t

  type(heat_load_t), allocatable, save :: loads(:)
  type(guarded_t), save, target :: work   ! each thread has its own
  !$omp threadprivate(work)

  abstract interface
    subroutine dflux_procedure(flux, sol, kstep, kinc, time, noel, npt, coords, jltyp, temp, press, sname)
      import :: dp, i4
      real(dp) :: flux(*), sol, time(*), coords(*), temp, press
      integer(i4) :: kstep, kinc, noel, npt, jltyp
      character(len=80) :: sname
    end subroutine dflux_procedure

    subroutine film_procedure(h, sink, temp, kstep, kinc, time, noel, npt, coords, jltyp, field, nfield, sname, node, area)
      import :: dp, i4
      real(dp) :: h(*), sink, temp, time(*), coords(*), field(*), area
      integer(i4) :: kstep, kinc, noel, npt, jltyp, nfield, node
      character(len=80) :: sname
    end subroutine film_procedure
  end interface

contains

  !> Add a load; returns its number.
  function define_heat_load(load) result(number)
    type(heat_load_t), intent(in) :: load
    integer(i4) :: number
    if (.not. allocated(loads)) allocate (loads(0))
    loads = [loads, load]
    number = size(loads, kind=i4)
  end function define_heat_load

  subroutine heat_load(element)
    type(element_t), intent(inout) :: element
    type(rule_t), pointer :: shape, field
    logical :: corners, axisymmetric, diffusive
    integer :: p, points
    real(dp) :: n(element%nodes), of_field(element%n), weight, depth, given(2), driving(2), heat, slope
    if (.not. element%has_forces .or. element%ndload == 0) return
    given = 0
    do p = 1, element%ndload
      given(element%jdltyp(p)) = element%adlmag(p)
    end do
    points = 1
    corners = .false.
    associate (jprops => element%jprops, jtype => element%jtype, x => element%coords, fields => element%fields, &
               predef => element%predef)
      axisymmetric = jprops(j_heat_load_axisymmetric) /= 0
      diffusive = jprops(j_heat_load_diffusive) /= 0
      depth = element%props(p_heat_load_depth)
      if (jtype /= node) then
        shape => rule_of(int(jprops(j_heat_load_family)), int(jprops(j_heat_load_points)))
        field => rule_of(int(jprops(j_heat_load_field)), int(jprops(j_heat_load_points)))
        corners = jtype /= volume .and. shape%nodes == shape%corners
        points = merge(shape%nodes, shape%points, corners)
      end if
      do p = 1, points
        if (jtype == node .or. corners) then
          n = 0
          n(p) = 1
          of_field = n(:element%n)
          weight = depth
          if (corners) weight = weight*corner_area(shape, p, axisymmetric, x)
        else
          n = shape%n(:, p)
          of_field = field%n(:, p)
          weight = depth*shape%weight(p)*area(matmul(x, shape%dn(:, :, p)))*radius_of(shape, p, axisymmetric, x)
        end if
        driving = 0
        if (diffusive) driving(1) = dot_product(predef(1, 1, :), n)
        if (diffusive .and. fields > 2) driving(2) = dot_product(predef(1, fields - 1, :), n)
        call heat_at(loads(jprops(j_heat_load_load)), int(p, i4), merge(element%jelem, 0_i4, jtype == node), matmul(x, n), &
                     dot_product(element%u, of_field), element%time, weight, given, matmul(predef(1, 2:fields - 1, :), n), &
                     driving, heat, slope)
        element%rhs(:, 1) = element%rhs(:, 1) - weight*heat*of_field
        element%amatrx = element%amatrx - weight*slope*spread(of_field, 2, element%n)*spread(of_field, 1, element%n)
      end do
    end associate
  end subroutine heat_load

  !> Area, length or volume per parent one.
  pure real(dp) function area(along)
    real(dp), intent(in) :: along(:, :)
    if (size(along, 2) == size(along, 1)) then
      area = determinant(along)
    else if (size(along, 2) == 1) then
      area = norm2(along(:, 1))
    else
      area = norm2(cross(along(:, 1), along(:, 2)))
    end if
  end function area

  !> Part of the area, or about an axis of the area times the radius, that belongs to a corner: the integral of its function.
  pure real(dp) function corner_area(shape, corner, axisymmetric, x)
    type(rule_t), intent(in) :: shape
    integer, intent(in) :: corner
    logical, intent(in) :: axisymmetric
    real(dp), intent(in) :: x(:, :)
    integer :: p
    corner_area = 0
    do p = 1, shape%points
      corner_area = corner_area + &
                    shape%weight(p)*shape%n(corner, p)*area(matmul(x, shape%dn(:, :, p)))*radius_of(shape, p, axisymmetric, x)
    end do
  end function corner_area

  !> Heat that enters at a point per area, or volume, and its derivative by the temperature there.
  subroutine heat_at(load, point, label, place, temperature, time, area, given, fields, driving, heat, slope)
    type(heat_load_t), intent(in) :: load
    integer(i4), intent(in) :: point, label         !< label: of the node of a film at a node, else 0
    real(dp), intent(in) :: place(:), temperature, time(2), area, given(2), fields(:)
    real(dp), intent(in) :: driving(2)              !< TEMP and PRESS of DFLUX, which are those of mass diffusion alone
    real(dp), intent(out) :: heat, slope
    real(dp) :: values(2), sink
    sink = given(1)
    values = [merge(given(1), given(2), load%law == 0), 0.0_dp]
    if (load%by_user) call call_user(load, point, label, place, temperature, time, area, fields, driving, values, sink)
    select case (load%law)
    case (film)
      heat = values(1)*(sink - temperature)
      slope = values(2)*(sink - temperature) - values(1)
    case (radiation)
      associate (factor => load%stefan_boltzmann*values(1), zero => load%absolute_zero)
        heat = factor*((sink - zero)**4 - (temperature - zero)**4)
        slope = -4*factor*(temperature - zero)**3
      end associate
    case default
      heat = values(1)
      slope = values(2)
    end select
  end subroutine heat_at

  !> DFLUX or FILM at a point: FLUX or H, and SINK. Their TIME is that at the end of the increment.
  subroutine call_user(load, point, label, place, temperature, time, area, fields, driving, values, sink)
    type(heat_load_t), intent(in) :: load
    integer(i4), intent(in) :: point, label
    real(dp), intent(in) :: place(:), temperature, time(2), area, fields(:), driving(2)
    real(dp), intent(inout) :: values(2), sink
    procedure(dflux_procedure), pointer :: dflux
    procedure(film_procedure), pointer :: film_at
    integer(i4) :: kstep, kinc, noel, npt, jltyp, nfield, node_label
    real(dp) :: sol, now(2), coords(3), temp, press, field(max(size(fields), 1)), own_area
    character(len=80) :: sname
    character(len=4) :: name(1)
    character(len=len(current%routine)) :: routine
    call lay_out_guarded(work, [2])
    routine = current%routine
    current%routine = merge('FILM ', 'DFLUX', load%law == film)
    current%point = point
    sol = temperature
    kstep = current%step
    kinc = current%increment
    now = time
    noel = merge(0_i4, current%element, label > 0)
    npt = merge(0_i4, point, label > 0)
    coords = 0
    coords(:size(place)) = place
    jltyp = load%jltyp
    temp = driving(1)
    press = driving(2)
    field = 0
    field(:size(fields)) = fields
    nfield = size(fields, kind=i4)
    sname = load%surface
    node_label = label
    own_area = area
    name = merge('H   ', 'FLUX', load%law == film)
    associate (x => work%memory, s => work%start)
      x(s(1):s(1) + 1) = values
      if (load%law == film) then
        call c_f_procpointer(load%address, film_at)
        call film_at(x(s(1)), sink, sol, kstep, kinc, now, noel, npt, coords, jltyp, field, nfield, sname, node_label, own_area)
      else
        call c_f_procpointer(load%address, dflux)
        call dflux(x(s(1)), sol, kstep, kinc, now, noel, npt, coords, jltyp, temp, press, sname)
      end if
      call warn_of_writes(work, name, [character(len=1) :: '2'], point, load%reported)
      call warn_of_no_numbers(work, name, point, load%spoilt)
      values = x(s(1):s(1) + 1)
    end associate
    current%routine = routine
  end subroutine call_user
end module host_heat_loads
