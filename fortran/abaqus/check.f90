! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Checks of what an element is called with: counts, ranges of the properties, kind of analysis.
module abaqus_check
  use core_kinds, only: dp
  use core_status, only: status_type, sentence, too_brittle, zero_length, edges_apart, small_beta, &
    too_brittle_mixed, late_secant, no_root
  use abaqus_layout, only: elements, reals, integer_item, &
    continuum_integers, standard_integers, four_node_integers, eight_node_integers, &
    positive, not_negative, below_one, up_to_one, exponent, estimated, above_one, any_integer, p_alphan, p_alphat, p_gic, p_giic, &
    p_betan, p_betat, p_shapen, p_shapet, p_friction, j_law, j_four_closure, j_eight_closure
  use cohesive_parameters, only: ppr_law
  use abaqus_report, only: fatal
  implicit none(type, external)
  private
  public :: call_is_good, closure_of, refuse

  !> Types that hold the quads on both sides.
  integer, parameter :: self_contained(2) = [4, 6]

contains

  !> True if the counts fit the element type and every property is in its range; if not, a message has been sent.
  function call_is_good(jtype, jelem, ndofel, nsvars, nprops, mcrd, nnode, njprop, ndload, lflags, props, jprops) &
    result(good)
    integer, intent(in) :: jtype, jelem, ndofel, nsvars, nprops, mcrd, nnode, njprop, ndload, lflags(*)
    real(dp), intent(in) :: props(*)
    integer, intent(in) :: jprops(*)
    logical :: good

    good = .false.
    if (.not. count_fits('NODES = %I', nnode, elements(jtype)%nodes)) return
    if (.not. count_fits('number of unknowns %I', ndofel, elements(jtype)%unknowns)) return
    if (.not. count_fits('PROPERTIES = %I', nprops, elements(jtype)%reals)) return
    if (.not. count_fits('I PROPERTIES = %I', njprop, elements(jtype)%integers)) return
    if (nsvars < elements(jtype)%variables) then
      call fatal(jtype, jelem, 'VARIABLES = %I, at least %I are needed', &
        [nsvars, elements(jtype)%variables], [real(dp) ::])
    else if (mcrd < 2 .or. mcrd > 3) then
      call fatal(jtype, jelem, 'COORDINATES = %I, 2 is expected', [mcrd], [real(dp) ::])
    else if (lflags(2) /= 0) then
      call fatal(jtype, jelem, 'NLGEOM is on, but this element is for small displacements: give NLGEOM=NO', &
        [integer ::], [real(dp) ::])
    else if (ndload /= 0) then
      call fatal(jtype, jelem, 'takes no distributed load: load its nodes', [integer ::], [real(dp) ::])
    else
      good = reals_are_good(jtype, jelem, props)
      if (good) good = integers_are_good(jtype, jelem, jprops)
      if (good .and. jtype > 1) good = closure_is_good(jtype, jelem, props, jprops)
    end if

  contains

    logical function count_fits(what, found, expected)
      character(len=*), intent(in) :: what
      integer, intent(in) :: found, expected

      count_fits = found == expected
      if (.not. count_fits) call fatal(jtype, jelem, '*USER ELEMENT has ' // what // ', %I is expected', &
        [found, expected], [real(dp) ::])
    end function count_fits

  end function call_is_good

  !> True if every real property is in its range.
  function reals_are_good(jtype, jelem, props) result(good)
    integer, intent(in) :: jtype, jelem
    real(dp), intent(in) :: props(*)
    logical :: good
    integer :: i

    good = .true.
    do i = 1, elements(jtype)%reals
      select case (reals(i)%rule)
      case (positive)
        good = props(i) > 0.0_dp
      case (not_negative)
        good = props(i) >= 0.0_dp
      case (estimated)
        good = props(i) >= 0.0_dp .or. (any(jtype == self_contained) .and. .not. abs(props(i) + 1.0_dp) > 0.0_dp)
      case (below_one)
        good = props(i) >= 0.0_dp .and. props(i) < 1.0_dp
      case (up_to_one)
        good = props(i) >= 0.0_dp .and. props(i) <= 1.0_dp
      case (exponent)
        good = props(i) >= 0.5_dp .or. abs(props(i)) <= 0.0_dp
      case (above_one)
        good = props(i) > 1.0_dp .or. abs(props(i)) <= 0.0_dp
      case default
        good = abs(props(i)) <= huge(1.0_dp)
      end select
      if (.not. good) then
        call fatal(jtype, jelem, 'PROPS(%I) ' // trim(reals(i)%name) // ' = %R, expected is ' // &
          trim(expectation(reals(i)%rule)), [i], [props(i)])
        return
      end if
    end do
  end function reals_are_good

  !> What a rule asks for, in words.
  pure function expectation(rule) result(text)
    integer, intent(in) :: rule
    character(len=48) :: text

    select case (rule)
    case (positive)
      text = 'a positive value'
    case (not_negative)
      text = 'zero or a positive value'
    case (up_to_one)
      text = 'a value from 0 to 1'
    case (estimated)
      text = 'zero or a positive value, or -1 in U4 and U6'
    case (below_one)
      text = 'zero or a value between 0 and 1'
    case (exponent)
      text = 'zero or at least 0.5'
    case (above_one)
      text = 'zero or more than 1'
    case default
      text = 'a finite value'
    end select
  end function expectation

  !> True if every integer property is in its range.
  function integers_are_good(jtype, jelem, jprops) result(good)
    integer, intent(in) :: jtype, jelem
    integer, intent(in) :: jprops(*)
    logical :: good

    select case (jtype)
    case (1)
      good = within(continuum_integers)
    case (2, 5)
      good = within(standard_integers)
    case (3)
      good = within(four_node_integers)
    case default
      good = within(eight_node_integers)
    end select

  contains

    logical function within(items)
      type(integer_item), intent(in) :: items(:)
      integer :: i

      within = .true.
      do i = 1, size(items)
        if (items(i)%highest == any_integer) cycle
        within = jprops(i) >= items(i)%lowest .and. jprops(i) <= items(i)%highest
        if (.not. within) then
          call fatal(jtype, jelem, 'JPROPS(%I) ' // trim(items(i)%name) // ' = %I, expected is %I to %I', &
            [i, jprops(i), items(i)%lowest, items(i)%highest], [real(dp) ::])
          return
        end if
      end do
    end function within

  end function integers_are_good

  !> True if what the consistent closure alone can do is asked of it alone: an initial stiffness that is infinite (0), in
  !> both directions, and friction. Nor is it asked for a PPR law that falls infinitely fast at its end.
  function closure_is_good(jtype, jelem, props, jprops) result(good)
    integer, intent(in) :: jtype, jelem
    real(dp), intent(in) :: props(*)
    integer, intent(in) :: jprops(*)
    logical :: good
    integer, parameter :: positions(2) = [p_alphan, p_alphat], shapes(2) = [p_shapen, p_shapet]
    logical :: infinite
    integer :: i

    infinite = closure_of(jtype, jprops) == 1 .and. .not. maxval(props(positions)) > 0.0_dp
    good = .true.
    do i = 1, 2
      good = infinite .or. props(positions(i)) > 0.0_dp
      if (good) cycle
      call fatal(jtype, jelem, 'PROPS(%I) ' // trim(reals(positions(i))%name) // ' = %R, expected is a positive ' // &
        'value; 0, an infinite stiffness, goes with CLOSURE = 1 and for both directions', [positions(i)], &
        [props(positions(i))])
      return
    end do
    if (jtype == 2 .or. jtype == 5) return
    good = closure_of(jtype, jprops) == 1 .or. .not. props(p_friction) > 0.0_dp
    if (.not. good) call fatal(jtype, jelem, 'PROPS(%I) ' // trim(reals(p_friction)%name) // ' = %R goes with ' // &
      'CLOSURE = 1, else 0 is expected', [p_friction], [props(p_friction)])
    if (.not. good .or. closure_of(jtype, jprops) == 0 .or. jprops(j_law) /= ppr_law) return
    do i = 1, 2
      good = props(shapes(i)) >= 2.0_dp .or. .not. props(shapes(i)) > 0.0_dp
      if (good) cycle
      call fatal(jtype, jelem, 'PROPS(%I) ' // trim(reals(shapes(i))%name) // ' = %R: with CLOSURE = 1 zero or ' // &
        'at least 2 is expected; below, the law falls infinitely fast at its end', [shapes(i)], [props(shapes(i))])
      return
    end do
  end function closure_is_good

  !> CLOSURE of an interface element; the standard one has but the paper's.
  pure function closure_of(jtype, jprops) result(closure)
    integer, intent(in) :: jtype, jprops(*)
    integer :: closure

    select case (jtype)
    case (3)
      closure = jprops(j_four_closure)
    case (4, 6)
      closure = jprops(j_eight_closure)
    case default
      closure = 0
    end select
  end function closure_of

  !> Sends the message for the status of a kernel; U4 and U6 count their quads in status%item.
  subroutine refuse(jtype, jelem, status)
    integer, intent(in) :: jtype, jelem
    type(status_type), intent(in) :: status
    integer :: position, pairs(4)
    character(len=8) :: side

    side = ' '
    if (any(jtype == self_contained)) then
      if (status%item == 1) side = 'bottom'
      if (status%item == 2) side = 'top'
    end if
    select case (status%code)
    case (too_brittle, late_secant)
      position = merge(p_gic, p_giic, status%item == 1)
      call fatal(jtype, jelem, 'PROPS(%I) ' // trim(reals(position)%name) // ' = %R, ' // &
        trim(sentence(status%code)) // '; more than %R is expected', [position], [status%value, status%expected])
    case (too_brittle_mixed)
      call fatal(jtype, jelem, 'PROPS(%I) ' // trim(reals(p_alphan)%name) // ' = %R, ' // &
        trim(sentence(status%code)) // ' where mode II has %I per cent of the energy; more than %R is expected', &
        [p_alphan, status%item], [status%value, status%expected])
    case (small_beta)
      position = merge(p_betan, p_betat, status%item == 1)
      call fatal(jtype, jelem, 'PROPS(%I) ' // trim(reals(position)%name) // ': beta = %R, ' // &
        trim(sentence(status%code)) // '; more than %R is expected: give it, or with 0 refine the mesh', &
        [position], [status%value, status%expected])
    case (no_root)
      call fatal(jtype, jelem, 'point or mode %I: ' // trim(sentence(status%code)), [status%item], [real(dp) ::])
    case (zero_length)
      call fatal(jtype, jelem, trim(sentence(status%code)), [integer ::], [real(dp) ::])
    case (edges_apart)
      select case (jtype)
      case (4)
        pairs = [5, 4, 6, 3]
      case (6)
        pairs = [9, 4, 10, 3]
      case default
        pairs = [4, 1, 3, 2]
      end select
      call fatal(jtype, jelem, trim(sentence(status%code)) // ', node %I must lie on %I and %I on %I' // &
        trim(merge(', and the middle nodes on each other', repeat(' ', 36), jtype > 4)) // &
        '; they are %R apart, at most %R is expected', pairs, [status%value, status%expected])
    case default
      call fatal(jtype, jelem, trim(adjustl(trim(side) // ' quad')) // ' ' // trim(sentence(status%code)) // &
        '; it is %R', [integer ::], [status%value])
    end select
  end subroutine refuse

end module abaqus_check
