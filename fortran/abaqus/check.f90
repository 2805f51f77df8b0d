! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Checks of the arguments of an element: counts, ranges of the properties, kind of analysis.
module abaqus_check
  use core_kinds, only: dp
  use core_status, only: status_type, sentence, too_brittle, zero_length, faces_apart, small_beta, &
    too_brittle_mixed, late_secant, no_root, along_normal, layer_slants, layer_twists, bridging_strength, bridging_energy, &
    brittle_tip, brittle_bridging, brittle_mixed_line, no_table, table_gap, table_separation, table_traction, falls_with_rate
  use abaqus_layout, only: elements, faces, reals, integers, rows_of_reals, rows_of_integers, expectations, every_continuum, &
    with_solids, next_to_solids, &
    positive, not_negative, below_one, up_to_one, exponent, estimated, above_one, above_minus_one, load_ratio, any_integer, &
    p_alphan, p_alphat, p_gic, p_giic, p_sigmamax, p_taumax, p_betan, p_betat, p_shapen, p_shapet, p_friction, p_direction1, &
    p_sigmabridge, p_taubridge, p_gibridge, p_giibridge, p_separation1, p_separation2, p_traction1, j_law, j_closure, &
    j_formulation_bottom, j_formulation_top, j_fatigue, p_temperature1, p_temperature2, p_temperature3, p_strength2, p_strength3, &
    p_toughness2, p_toughness3, p_ratereference, p_ratelimit, p_strengthrate, p_toughnessrate
  use abaqus_properties, only: family_of, unknowns_of, variables_of, real_position, integer_position, unpack, recommend, &
    by_eigenvalues, by_equation_21, consistent_closure, complete_closure
  use cohesive_law_properties, only: bilinear_law, mixed_bilinear_law, ppr_law
  use elements_bulk_solid, only: has_formulation, reduced_integration
  use abaqus_report, only: fatal
  implicit none(type, external)
  private
  public :: call_is_good, report_status

contains

  !> True if the counts fit the element type and every property is in its range; if not, a message has been sent.
  function call_is_good(itype, jelem, ndofel, nsvars, nprops, mcrd, nnode, njprop, ndload, props, jprops, values, &
    options) result(good)
    integer, intent(in) :: itype, jelem, ndofel, nsvars, nprops, mcrd, nnode, njprop, ndload
    real(dp), intent(in) :: props(*)
    integer, intent(in) :: jprops(*)
    real(dp), intent(out) :: values(size(reals))         !< properties by their rows in the layout, if the counts fit
    integer, intent(out) :: options(size(integers))
    logical :: good

    good = .false.
    associate (element => elements(itype))
      if (.not. count_fits('NODES = %I', nnode, element%nodes)) return
      if (.not. count_fits('number of unknowns %I', ndofel, unknowns_of(itype))) return
      if (.not. count_fits('PROPERTIES = %I', nprops, element%reals)) return
      if (.not. count_fits('I PROPERTIES = %I', njprop, element%integers)) return
      if (nsvars < variables_of(itype)) then
        call fatal(itype, jelem, 'VARIABLES = %I: expected at least %I', [nsvars, variables_of(itype)], [real(dp) ::])
      else if (mcrd < element%dimension .or. mcrd > 3) then
        call fatal(itype, jelem, 'COORDINATES = %I: expected %I', [mcrd, element%dimension], [real(dp) ::])
      else if (ndload /= 0) then
        call fatal(itype, jelem, 'does not take distributed loads: load its nodes', [integer ::], [real(dp) ::])
      else
        call unpack(itype, props, jprops, values, options)
        good = reals_are_good(itype, jelem, values)
        if (good) good = integers_are_good(itype, jelem, options)
        if (.not. good) return
        call recommend(itype, values, options)
        if (iand(element%family, with_solids) /= 0) good = formulations_fit(itype, jelem, options)
        if (good .and. iand(element%family, every_continuum) == 0) good = options_fit(itype, jelem, values, options)
      end if
    end associate

  contains

    logical function count_fits(what, found, expected)
      character(len=*), intent(in) :: what
      integer, intent(in) :: found, expected

      count_fits = found == expected
      if (.not. count_fits) then
        call fatal(itype, jelem, '*USER ELEMENT has ' // what // ': expected %I', [found, expected], [real(dp) ::])
      end if
    end function count_fits

  end function call_is_good

  !> True if every real property is in its range.
  function reals_are_good(itype, jelem, values) result(good)
    integer, intent(in) :: itype, jelem
    real(dp), intent(in) :: values(:)
    logical :: good
    integer :: i, position, family

    good = .true.
    family = family_of(itype)
    do position = 1, elements(itype)%reals
      i = rows_of_reals(position, family)
      select case (reals(i)%rule)
      case (positive)
        good = values(i) > 0.0_dp
      case (not_negative)
        good = values(i) >= 0.0_dp
      case (estimated)
        good = values(i) >= 0.0_dp .or. is(values(i), by_equation_21) .or. (is(values(i), by_eigenvalues) &
          .and. iand(elements(itype)%family, with_solids) /= 0)
      case (below_one)
        good = values(i) >= 0.0_dp .and. values(i) < 1.0_dp
      case (up_to_one)
        good = values(i) >= 0.0_dp .and. values(i) <= 1.0_dp
      case (exponent)
        good = values(i) >= 0.5_dp .or. abs(values(i)) <= 0.0_dp
      case (above_one)
        good = values(i) > 1.0_dp .or. abs(values(i)) <= 0.0_dp
      case (above_minus_one)
        good = values(i) > -1.0_dp .and. values(i) <= huge(1.0_dp)
      case (load_ratio)
        good = abs(values(i)) <= 1.0_dp
      case default
        good = abs(values(i)) <= huge(1.0_dp)
      end select
      if (good) cycle
      call refuse_real(itype, jelem, i, values(i), ': expected ' // trim(expectations(reals(i)%rule)))
      return
    end do
  end function reals_are_good

  !> Whether a value is this one.
  pure logical function is(value, this)
    real(dp), intent(in) :: value, this

    is = .not. abs(value - this) > 0.0_dp
  end function is

  !> Sends the message 'PROPS(position) NAME = value' and a text.
  subroutine refuse_real(itype, jelem, row, value, text)
    integer, intent(in) :: itype, jelem
    integer, intent(in) :: row                !< of the property in the layout
    real(dp), intent(in) :: value
    character(len=*), intent(in) :: text

    call fatal(itype, jelem, 'PROPS(%I) ' // trim(reals(row)%name) // ' = %R' // text, [real_position(itype, row)], [value])
  end subroutine refuse_real

  !> True if every integer property is in its range.
  function integers_are_good(itype, jelem, options) result(good)
    integer, intent(in) :: itype, jelem
    integer, intent(in) :: options(:)
    logical :: good
    integer :: i, position, family

    good = .true.
    family = family_of(itype)
    do position = 1, elements(itype)%integers
      i = rows_of_integers(position, family)
      if (integers(i)%highest == any_integer) cycle
      good = options(i) >= integers(i)%lowest .and. options(i) <= integers(i)%highest
      if (good) cycle
      call fatal(itype, jelem, 'JPROPS(%I) ' // trim(integers(i)%name) // ' = %I: expected %I to %I', &
        [integer_position(itype, i), options(i), integers(i)%lowest, integers(i)%highest], [real(dp) ::])
      return
    end do
  end function integers_are_good

  !> True if the solids of a self-contained element have their formulations.
  function formulations_fit(itype, jelem, options) result(good)
    integer, intent(in) :: itype, jelem
    integer, intent(in) :: options(:)
    logical :: good
    integer, parameter :: rows(2) = [j_formulation_bottom, j_formulation_top]
    integer :: side

    do side = 1, 2
      associate (dim => elements(itype)%dimension, nodes => faces(itype)%solids(side))
        good = has_formulation(dim, nodes, options(rows(side)))
        if (good) cycle
        call fatal(itype, jelem, 'JPROPS(%I) ' // trim(integers(rows(side))%name) // ' = %I: a ' // trim(solid_name(dim, nodes)) &
          // ' of %I nodes does not have it; expected 0' // trim(merge(' or 3', '     ', has_formulation(dim, nodes, &
          reduced_integration))), [integer_position(itype, rows(side)), options(rows(side)), nodes], [real(dp) ::])
        return
      end associate
    end do
  end function formulations_fit

  !> Shape of a solid with so many nodes.
  pure function solid_name(dim, nodes) result(name)
    integer, intent(in) :: dim, nodes
    character(len=11) :: name

    select case (10*nodes + dim)
    case (32, 62)
      name = 'triangle'
    case (42, 82)
      name = 'quad'
    case (43, 103)
      name = 'tetrahedron'
    case (63, 153)
      name = 'wedge'
    case default
      name = 'brick'
    end select
  end function solid_name

  !> True if the properties fit each other: both beta come from one estimate; only the consistent law allows an infinite initial
  !> stiffness (0), in both directions, and friction, but not a PPR law that falls infinitely fast at its end.
  function options_fit(itype, jelem, values, options) result(good)
    integer, intent(in) :: itype, jelem
    real(dp), intent(in) :: values(:)
    integer, intent(in) :: options(:)
    logical :: good
    integer, parameter :: alphas(2) = [p_alphan, p_alphat], shapes(2) = [p_shapen, p_shapet]
    logical :: consistent, infinite
    integer :: i

    good = options(j_fatigue) >= 0
    if (.not. good) then
      call fatal(itype, jelem, 'JPROPS(%I) FATIGUE = %I: expected zero or the number of a step', &
        [integer_position(itype, j_fatigue), options(j_fatigue)], [real(dp) ::])
      return
    end if
    good = options(j_fatigue) == 0 .or. any(options(j_law) == [bilinear_law, mixed_bilinear_law])
    if (.not. good) then
      call fatal(itype, jelem, 'JPROPS(%I) FATIGUE = %I, but LAW = %I, which has no fatigue: expected LAW = 1 or 2', &
        [integer_position(itype, j_fatigue), options(j_fatigue), options(j_law)], [real(dp) ::])
      return
    end if
    good = temperatures_fit(itype, jelem, values, options)
    if (good) good = rates_fit(itype, jelem, values, options)
    if (.not. good) return
    consistent = any(options(j_closure) == [consistent_closure, complete_closure])
    good = options(j_closure) /= complete_closure .or. iand(elements(itype)%family, next_to_solids) == 0
    if (.not. good) then
      call fatal(itype, jelem, 'JPROPS(%I) CLOSURE = 3, the complete form, requires an element that has the nodes of its ' // &
        'solids; expected 1 or 2', [integer_position(itype, j_closure)], [real(dp) ::])
      return
    end if
    infinite = consistent .and. .not. maxval(values(alphas)) > 0.0_dp
    good = .not. (any_is(by_eigenvalues) .and. any_is(by_equation_21))
    if (.not. good) then
      i = merge(p_betan, p_betat, is(values(p_betan), by_equation_21))
      call refuse_real(itype, jelem, i, values(i), ', equation (21), but the other beta is 0 or -1, local eigenvalues: ' // &
        'expected one estimate for both')
      return
    end if
    do i = 1, 2
      good = infinite .or. values(alphas(i)) > 0.0_dp
      if (good) cycle
      call refuse_real(itype, jelem, alphas(i), values(alphas(i)), ': expected a positive value; 0, an infinite ' // &
        'stiffness, requires the consistent law (CLOSURE = 1 or 3) and 0 in both directions')
      return
    end do
    good = consistent .or. .not. values(p_friction) > 0.0_dp
    if (.not. good) call refuse_real(itype, jelem, p_friction, values(p_friction), &
      ': without the consistent law (CLOSURE = 1 or 3), expected 0')
    if (.not. good .or. .not. consistent .or. options(j_law) /= ppr_law) return
    do i = 1, 2
      good = values(shapes(i)) >= 2.0_dp .or. .not. values(shapes(i)) > 0.0_dp
      if (good) cycle
      call refuse_real(itype, jelem, shapes(i), values(shapes(i)), ': with the consistent law, expected zero or at ' // &
        'least 2; below 2, the law falls infinitely fast at its end')
      return
    end do

  contains

    pure logical function any_is(estimate)
      real(dp), intent(in) :: estimate

      any_is = is(values(p_betan), estimate) .or. is(values(p_betat), estimate)
    end function any_is

  end function options_fit

  !> True if the table of temperatures is in order, and the law takes it.
  function temperatures_fit(itype, jelem, values, options) result(good)
    integer, intent(in) :: itype, jelem
    real(dp), intent(in) :: values(:)
    integer, intent(in) :: options(:)
    logical :: good
    integer, parameter :: temperatures(3) = [p_temperature1, p_temperature2, p_temperature3]
    integer, parameter :: strengths(3) = [0, p_strength2, p_strength3], toughnesses(3) = [0, p_toughness2, p_toughness3]
    integer :: k, row

    good = .true.
    do k = 2, 3
      row = temperatures(k)
      if (values(strengths(k)) > 0.0_dp) then
        good = values(row) > values(temperatures(k - 1))
        if (.not. good) call refuse_real(itype, jelem, row, values(row), ': expected more than ' // &
          trim(reals(temperatures(k - 1))%name))
      else
        if (values(toughnesses(k)) > 0.0_dp) row = toughnesses(k)
        good = .not. abs(values(row)) > 0.0_dp
        if (.not. good) call refuse_real(itype, jelem, row, values(row), ', but no ' // trim(reals(strengths(k))%name) // &
          ': expected both')
      end if
      if (.not. good) return
    end do
    good = .not. values(p_strength3) > 0.0_dp .or. values(p_strength2) > 0.0_dp
    if (.not. good) then
      call refuse_real(itype, jelem, p_strength3, values(p_strength3), ', but no STRENGTH2: expected it before')
      return
    end if
    good = options(j_law) /= ppr_law .or. .not. values(p_strength2) > 0.0_dp
    if (.not. good) call refuse_real(itype, jelem, p_strength2, values(p_strength2), &
      ', which LAW 4 does not have: expected LAW 1, 2, 3, 5 or 6, or zero')
  end function temperatures_fit

  !> True if the properties of the rate are complete and in order, and the law takes them.
  function rates_fit(itype, jelem, values, options) result(good)
    integer, intent(in) :: itype, jelem
    real(dp), intent(in) :: values(:)
    integer, intent(in) :: options(:)
    logical :: good
    integer, parameter :: others(3) = [p_ratelimit, p_strengthrate, p_toughnessrate]
    character(len=:), allocatable :: text
    integer :: row

    row = p_ratereference
    text = ''
    if (.not. values(row) > 0.0_dp) then
      row = others(maxloc(values(others), 1))
      if (values(row) > 0.0_dp) text = ', but no RATEREFERENCE: expected both'
    else if (.not. maxval(values([p_strengthrate, p_toughnessrate])) > 0.0_dp) then
      text = ', but neither STRENGTHRATE nor TOUGHNESSRATE: expected one of them'
    else if (.not. values(p_ratelimit) > values(row)) then
      row = p_ratelimit
      text = ': expected more than RATEREFERENCE'
    else if (values(p_toughnessrate) > 0.0_dp .and. values(p_toughnessrate) < values(p_strengthrate)) then
      row = p_toughnessrate
      text = ': expected zero or at least STRENGTHRATE, below which the traction would fall with the rate'
    else if (options(j_law) == ppr_law) then
      text = ', which LAW 4 does not have: expected LAW 1, 2, 3, 5 or 6, or zero'
    else if (options(j_fatigue) > 0) then
      text = ', but FATIGUE, whose time is the number of cycles: expected one of them'
    end if
    good = len(text) == 0
    if (.not. good) call refuse_real(itype, jelem, row, values(row), text)
  end function rates_fit

  !> Sends the message for the status of a kernel; self-contained elements count their quads or bricks in status%item.
  subroutine report_status(itype, jelem, status)
    integer, intent(in) :: itype, jelem
    type(status_type), intent(in) :: status
    character(len=*), parameter :: apart = '; they are %R apart, expected at most %R, since the stress of the solids ' // &
      'beside it acts at one place: a layer with a thickness needs a standard element'
    integer :: row, nodes
    character(len=8) :: side

    side = ' '
    nodes = elements(itype)%nodes
    if (iand(elements(itype)%family, with_solids) /= 0 .and. any(status%item == [1, 2])) then
      side = merge('bottom ', 'top    ', status%item == 1)
      nodes = faces(itype)%solids(status%item)
    end if
    select case (status%code)
    case (too_brittle, late_secant)
      row = merge(p_gic, p_giic, status%item == 1)
      call fatal(itype, jelem, 'PROPS(%I) ' // trim(reals(row)%name) // ' = %R, ' // trim(sentence(status%code)) // &
        '; expected more than %R', [real_position(itype, row)], [status%value, status%expected])
    case (too_brittle_mixed, brittle_mixed_line)
      call fatal(itype, jelem, 'PROPS(%I) ' // trim(reals(p_alphan)%name) // ' = %R, ' // &
        trim(sentence(status%code)) // ' where mode II has %I per cent of the energy; expected more than %R', &
        [real_position(itype, p_alphan), status%item], [status%value, status%expected])
    case (bridging_strength)
      row = merge(p_sigmabridge, p_taubridge, status%item == 1)
      call refuse_part(row, merge(p_sigmamax, p_taumax, status%item == 1))
    case (bridging_energy)
      row = merge(p_gibridge, p_giibridge, status%item == 1)
      call refuse_part(row, merge(p_gic, p_giic, status%item == 1))
    case (brittle_tip, brittle_bridging)
      row = merge(p_gibridge, p_giibridge, status%item == 1)
      call fatal(itype, jelem, 'PROPS(%I) ' // trim(reals(row)%name) // ' = %R, ' // trim(sentence(status%code)) // '; expected ' &
        // trim(merge('less', 'more', status%code == brittle_tip)) // ' than %R', [real_position(itype, row)], &
        [status%value, status%expected])
    case (no_table)
      call refuse_real(itype, jelem, p_separation1, status%value, ': ' // trim(sentence(status%code)) // &
        '; expected a value between 0 and 1')
    case (table_gap)
      row = p_separation1 + (p_separation2 - p_separation1)*(status%item - 1)
      call refuse_real(itype, jelem, row, status%value, ': ' // trim(sentence(status%code)) // '; expected 0')
    case (table_separation)
      row = p_separation1 + (p_separation2 - p_separation1)*(status%item - 1)
      call fatal(itype, jelem, 'PROPS(%I) ' // trim(reals(row)%name) // ' = %R: ' // trim(sentence(status%code)) // &
        '; expected more than %R', [real_position(itype, row)], [status%value, status%expected])
    case (table_traction)
      row = p_traction1 + (p_separation2 - p_separation1)*(status%item - 1)
      call fatal(itype, jelem, 'PROPS(%I) ' // trim(reals(row)%name) // ' = %R: ' // trim(sentence(status%code)) // &
        '; expected a positive value up to %R', [real_position(itype, row)], [status%value, status%expected])
    case (falls_with_rate)
      call fatal(itype, jelem, 'PROPS(%I) ' // trim(reals(p_toughnessrate)%name) // ' = %R: ' // trim(sentence(status%code)) // &
        '; expected at least %R', [real_position(itype, p_toughnessrate)], [status%value, status%expected])
    case (small_beta)
      row = merge(p_betan, p_betat, status%item == 1)
      call fatal(itype, jelem, 'PROPS(%I) ' // trim(reals(row)%name) // ': beta = %R, ' // &
        trim(sentence(status%code)) // '; expected more than %R, or 0 for the estimate', &
        [real_position(itype, row)], [status%value, status%expected])
    case (no_root)
      call fatal(itype, jelem, 'point or mode %I: ' // trim(sentence(status%code)), [status%item], [real(dp) ::])
    case (along_normal)
      call fatal(itype, jelem, 'PROPS(%I) DIRECTION1 to DIRECTION3: ' // trim(sentence(status%code)) // ', %R degrees; ' // &
        'expected at least %R, as the axis of a cylinder has everywhere, or zeros', [real_position(itype, p_direction1)], &
        [status%value, status%expected])
    case (zero_length)
      call fatal(itype, jelem, trim(sentence(status%code)), [integer ::], [real(dp) ::])
    case (layer_slants)
      call fatal(itype, jelem, trim(sentence(status%code)) // '; at point %I it is %R above it and %R aside: expected more ' // &
        'above than aside', [status%item], [status%expected, status%value])
    case (layer_twists)
      call fatal(itype, jelem, trim(sentence(status%code)) // '; at point %I an edge of %R differs by %R: expected a smaller ' // &
        'difference', [status%item], [status%expected, status%value])
    case (faces_apart)
      associate (top => faces(itype)%top, bottom => faces(itype)%bottom)
        if (elements(itype)%dimension == 3) then
          call fatal(itype, jelem, trim(sentence(status%code)) // ': nodes ' // repeat('%I, ', count(top > 0) - 1) // &
            '%I must lie on ' // repeat('%I, ', count(top > 0) - 1) // '%I' // &
            trim(merge(', and the middle nodes on each other', repeat(' ', 36), faces(itype)%top_middles(1) > 0)) // &
            apart, [pack(top, top > 0), pack(bottom, bottom > 0)], [status%value, status%expected])
          return
        end if
        call fatal(itype, jelem, trim(sentence(status%code)) // ': node %I must lie on %I and %I on %I' // &
          trim(merge(', and the middle nodes on each other', repeat(' ', 36), top(3) > 0)) // &
          apart, [top(1), bottom(1), top(2), bottom(2)], [status%value, status%expected])
      end associate
    case default
      call fatal(itype, jelem, trim(adjustl(trim(side) // ' ' // solid_name(elements(itype)%dimension, nodes))) // ' ' // &
        trim(sentence(status%code)) // '; it is %R', [integer ::], [status%value])
    end select

  contains

    !> Sends the message for a property that is no part of another one.
    subroutine refuse_part(part, total)
      integer, intent(in) :: part, total   !< rows in the layout

      call refuse_real(itype, jelem, part, status%value, ': ' // trim(sentence(status%code)) // '; expected a positive value ' // &
        'below ' // trim(reals(total)%name))
    end subroutine refuse_part

  end subroutine report_status

end module abaqus_check
