! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> Every property of PROPS and JPROPS and every variable of SVARS, named once: the kernels index with the constants, the
!> messages and the tables of the documentation take names, units, ranges and meanings from the same rows. The sizes of
!> the elements are here too.
!>
!> A row of `reals` or `integers` says which families of elements have it; its position in the deck is the number of rows
!> up to it that the family has. New rows go to the end of the table, where they are the last of each family that has them: no
!> position in an existing deck moves. In a deck without a value for them they are 0, and its PROPERTIES stays what `elements` says.
!>
!> harness/uel/usersub/layout.py reads this file line by line: one row per line, its meaning after the row, on the same or the next
!> line.
module abaqus_layout
  use, intrinsic :: iso_c_binding, only: c_int
  use core_kinds, only: dp
  implicit none(type, external)
  private
  public :: real_item, integer_item, variable_item, element_item, faces_item
  public :: unknowns_of, variables_of, variables_of_points, nodes_of_face, face_nodes, reals_of, integers_of
  public :: real_position, integer_position, unpack, recommend, delamination_layout_version

  !> Permitted values of a real property. A property that may be zero is 0 if the deck leaves it out.
  integer, parameter, public :: positive = 1
  integer, parameter, public :: not_negative = 2
  integer, parameter, public :: below_one = 3       ! 0 <= value < 1
  integer, parameter, public :: up_to_one = 4       ! 0 <= value <= 1
  integer, parameter, public :: any_value = 5
  integer, parameter, public :: exponent = 6        ! 0 or at least 1/2
  integer, parameter, public :: estimated = 7       ! 0 <= value, or one of the two estimates
  integer, parameter, public :: above_one = 8       ! 0 or above 1
  integer, parameter, public :: any_integer = huge(1)

  ! values that choose among laws and estimates; 0 stands for what the element is made for, see `recommend`
  real(dp), parameter, public :: by_eigenvalues = -1.0_dp   ! BETAN, BETAT: needs the elements on both sides
  real(dp), parameter, public :: by_equation_21 = -2.0_dp
  integer, parameter, public :: consistent_closure = 1      ! CLOSURE
  integer, parameter, public :: paper_closure = 2

  ! families of elements, and sets of them, which are sums
  integer, parameter, public :: continuum = 1
  integer, parameter, public :: standard = 2
  integer, parameter, public :: next_to_quads = 4    ! stabilised, with the stress of U1 next to it
  integer, parameter, public :: self_contained = 8   ! stabilised, with its own quads
  integer, parameter, public :: standard_3d = 16
  integer, parameter, public :: self_contained_3d = 32   ! stabilised, with its own bricks
  integer, parameter, public :: continuum_3d = 64
  integer, parameter, public :: next_to_bricks = 128   ! stabilised, with the stress of U9 next to it
  integer, parameter, public :: with_solids = self_contained + self_contained_3d
  integer, parameter, public :: every_continuum = continuum + continuum_3d
  integer, parameter, public :: next_to_solids = next_to_quads + next_to_bricks
  integer, parameter, public :: stabilised = next_to_solids + with_solids
  integer, parameter, public :: every_standard = standard + standard_3d
  integer, parameter, public :: interfaces = every_standard + stabilised
  integer, parameter, public :: in_space = standard_3d + self_contained_3d + next_to_bricks
  integer, parameter, public :: in_plane = continuum + standard + next_to_quads + self_contained

  !> A real property of the elements of these families.
  type :: real_item
    integer :: row
    integer :: families
    character(len=12) :: name
    character(len=13) :: unit
    integer :: rule
  end type real_item

  !> An integer property and its lowest and highest value.
  type :: integer_item
    integer :: row
    integer :: families
    character(len=12) :: name
    integer :: lowest, highest
  end type integer_item

  !> A variable of an integration point; variable i of point k is SVARS((k - 1)*(variables of a point) + i). Those of an element
  !> as a whole come after its points.
  type :: variable_item
    integer :: position
    character(len=8) :: name
    character(len=13) :: unit
  end type variable_item

  !> An element type Un. `reals` and `integers` are the PROPERTIES and I PROPERTIES of decks from before rows were added to
  !> the tables of properties: the minimum counts.
  type :: element_item
    integer :: jtype, family, dimension, nodes, points, reals, integers
  end type element_item

  !> The nodes of an interface element on its bottom and top face; 0 where there is none. In the plane left to right, the middle
  !> last, in space counter-clockwise seen from the top, first the corners, then the midside nodes of the edges that begin there.
  type :: faces_item
    integer :: jtype
    integer :: solid               !< nodes of each of its own quads or bricks, of which the bottom one comes first; 0 without
    integer :: bottom(4), top(4)
    integer :: bottom_middles(4) = 0, top_middles(4) = 0
  end type faces_item

  ! rows of the table of reals
  integer, parameter, public :: p_thickness = 1
  integer, parameter, public :: p_alphan = 2
  integer, parameter, public :: p_alphat = 3
  integer, parameter, public :: p_sigmamax = 4
  integer, parameter, public :: p_taumax = 5
  integer, parameter, public :: p_gic = 6
  integer, parameter, public :: p_giic = 7
  integer, parameter, public :: p_viscosity = 8
  integer, parameter, public :: p_eta = 9
  integer, parameter, public :: p_power = 10
  integer, parameter, public :: p_shapen = 11
  integer, parameter, public :: p_shapet = 12
  integer, parameter, public :: p_blend = 13
  integer, parameter, public :: p_betan = 14
  integer, parameter, public :: p_betat = 15
  integer, parameter, public :: p_gammabot = 16
  integer, parameter, public :: p_friction = 17
  integer, parameter, public :: p_bottom_e1 = 18
  integer, parameter, public :: p_bottom_e2 = 19
  integer, parameter, public :: p_bottom_e3 = 20
  integer, parameter, public :: p_bottom_nu12 = 21
  integer, parameter, public :: p_bottom_nu13 = 22
  integer, parameter, public :: p_bottom_nu23 = 23
  integer, parameter, public :: p_bottom_g12 = 24
  integer, parameter, public :: p_bottom_angle = 25
  integer, parameter, public :: p_top_e1 = 26
  integer, parameter, public :: p_top_e2 = 27
  integer, parameter, public :: p_top_e3 = 28
  integer, parameter, public :: p_top_nu12 = 29
  integer, parameter, public :: p_top_nu13 = 30
  integer, parameter, public :: p_top_nu23 = 31
  integer, parameter, public :: p_top_g12 = 32
  integer, parameter, public :: p_top_angle = 33
  integer, parameter, public :: p_bottom_g13 = 34
  integer, parameter, public :: p_bottom_g23 = 35
  integer, parameter, public :: p_top_g13 = 36
  integer, parameter, public :: p_top_g23 = 37
  integer, parameter, public :: p_angle = 38

  type(real_item), parameter, public :: reals(38) = [ &
    real_item(p_thickness, in_plane, 'THICKNESS', 'length', positive), & !< thickness out of the plane
    real_item(p_alphan, interfaces, 'ALPHAN', 'stress/length', not_negative), &
      !< initial normal stiffness alpha_n; 0: infinite, only with the consistent law
    real_item(p_alphat, interfaces, 'ALPHAT', 'stress/length', not_negative), &
      !< initial tangential stiffness alpha_tau; 0: infinite, if ALPHAN is 0 too
    real_item(p_sigmamax, interfaces, 'SIGMAMAX', 'stress', positive), & !< mode I strength
    real_item(p_taumax, interfaces, 'TAUMAX', 'stress', positive), & !< mode II strength
    real_item(p_gic, interfaces, 'GIC', 'energy/area', positive), & !< mode I fracture energy, above SIGMAMAX**2/(2 ALPHAN)
    real_item(p_giic, interfaces, 'GIIC', 'energy/area', positive), & !< mode II fracture energy, above TAUMAX**2/(2 ALPHAT)
    real_item(p_viscosity, interfaces, 'VISCOSITY', 'time', not_negative), & !< relaxation time, see above; 0: none
    real_item(p_eta, interfaces, 'ETA', '1', exponent), & !< exponent of Benzeggagh and Kenane (LAW 2, 3); 0: power law
    real_item(p_power, interfaces, 'POWER', '1', exponent), & !< exponent of the power law (LAW 2, 3); 0: 1, the linear criterion
    real_item(p_shapen, interfaces, 'SHAPEN', '1', above_one), & !< exponent of the softening in opening (LAW 4); 0: 2, about linear
    real_item(p_shapet, interfaces, 'SHAPET', '1', above_one), & !< exponent of the softening in sliding (LAW 4); 0: 2, about linear
    real_item(p_blend, interfaces, 'BLEND', '1', up_to_one), & !< share of the secant matrix in AMATRX, with TANGENT 0
    real_item(p_betan, stabilised, 'BETAN', 'stress/length', estimated), &
      !< stabilisation beta_n; -1: local eigenvalues, -2: equation (21); 0: -1, in U3 and U10 -2
    real_item(p_betat, stabilised, 'BETAT', 'stress/length', estimated), &
      !< stabilisation beta_tau; -1: local eigenvalues, -2: equation (21); 0: -1, in U3 and U10 -2
    real_item(p_gammabot, stabilised, 'GAMMABOT', '1', below_one), &
      !< weight of the bottom stress; 0: equation (22), with the estimate of beta
    real_item(p_friction, stabilised, 'FRICTION', '1', not_negative), & !< coefficient of friction, with the consistent law; 0: none
    real_item(p_bottom_e1, with_solids, 'E1 BOTTOM', 'stress', positive), & !< Young's modulus along material axis 1
    real_item(p_bottom_e2, with_solids, 'E2 BOTTOM', 'stress', positive), & !< Young's modulus along material axis 2
    real_item(p_bottom_e3, with_solids, 'E3 BOTTOM', 'stress', not_negative), &
      !< Young's modulus along material axis 3; plane strain, bricks
    real_item(p_bottom_nu12, with_solids, 'NU12 BOTTOM', '1', any_value), & !< contraction along 2 under stress along 1
    real_item(p_bottom_nu13, with_solids, 'NU13 BOTTOM', '1', any_value), &
      !< contraction along 3 under stress along 1; plane strain, bricks
    real_item(p_bottom_nu23, with_solids, 'NU23 BOTTOM', '1', any_value), &
      !< contraction along 3 under stress along 2; plane strain, bricks
    real_item(p_bottom_g12, with_solids, 'G12 BOTTOM', 'stress', positive), & !< shear modulus in the plane 1-2
    real_item(p_bottom_angle, with_solids, 'ANGLE BOTTOM', 'degree', any_value), &
      !< of material axis 1 from x, counter-clockwise; bricks: from s about n, which is axis 3
    real_item(p_top_e1, with_solids, 'E1 TOP', 'stress', positive), & !< Young's modulus along material axis 1
    real_item(p_top_e2, with_solids, 'E2 TOP', 'stress', positive), & !< Young's modulus along material axis 2
    real_item(p_top_e3, with_solids, 'E3 TOP', 'stress', not_negative), &
      !< Young's modulus along material axis 3; plane strain, bricks
    real_item(p_top_nu12, with_solids, 'NU12 TOP', '1', any_value), & !< contraction along 2 under stress along 1
    real_item(p_top_nu13, with_solids, 'NU13 TOP', '1', any_value), &
      !< contraction along 3 under stress along 1; plane strain, bricks
    real_item(p_top_nu23, with_solids, 'NU23 TOP', '1', any_value), &
      !< contraction along 3 under stress along 2; plane strain, bricks
    real_item(p_top_g12, with_solids, 'G12 TOP', 'stress', positive), & !< shear modulus in the plane 1-2
    real_item(p_top_angle, with_solids, 'ANGLE TOP', 'degree', any_value), &
      !< of material axis 1 from x, counter-clockwise; bricks: from s about n, which is axis 3
    real_item(p_bottom_g13, self_contained_3d, 'G13 BOTTOM', 'stress', positive), & !< shear modulus in the plane 1-3
    real_item(p_bottom_g23, self_contained_3d, 'G23 BOTTOM', 'stress', positive), & !< shear modulus in the plane 2-3
    real_item(p_top_g13, self_contained_3d, 'G13 TOP', 'stress', positive), & !< shear modulus in the plane 1-3
    real_item(p_top_g23, self_contained_3d, 'G23 TOP', 'stress', positive), & !< shear modulus in the plane 2-3
    real_item(p_angle, continuum_3d, 'ANGLE', 'degree', any_value)] !< of material axis 1, from s about n, which is axis 3

  ! rows of the table of integers
  integer, parameter, public :: j_law = 1
  integer, parameter, public :: j_integration = 2
  integer, parameter, public :: j_tangent = 3
  integer, parameter, public :: j_sampling = 4
  integer, parameter, public :: j_offset_bottom = 5
  integer, parameter, public :: j_offset_top = 6
  integer, parameter, public :: j_plane = 7
  integer, parameter, public :: j_face = 8
  integer, parameter, public :: j_closure = 9
  integer, parameter, public :: j_formulation = 10
  integer, parameter, public :: j_brick_face = 11

  type(integer_item), parameter, public :: integers(11) = [ &
    integer_item(j_law, interfaces, 'LAW', 0, 4), &
      !< 0 or 1 bilinear (9) to (11), 2 bilinear by ETA or POWER, 3 exponential by ETA or POWER, 4 PPR
    integer_item(j_integration, interfaces, 'INTEGRATION', 0, 1), & !< 0 Gauss, 1 Newton-Cotes
    integer_item(j_tangent, interfaces, 'TANGENT', 0, 1), &
      !< 0 consistent (23), 1 secant (24), that is without the derivative of the damage; U3, U10: at constant bulk stress
    integer_item(j_sampling, stabilised, 'SAMPLING', 0, 2), &
      !< bulk stress: 0 middle of the face (quadratic elements: through two or four points), 1 face, 2 nearest Gauss point
    integer_item(j_offset_bottom, next_to_solids, 'OFFSETBOTTOM', -any_integer, any_integer), &
      !< element number of the quad or brick below minus its own
    integer_item(j_offset_top, next_to_solids, 'OFFSETTOP', -any_integer, any_integer), &
      !< element number of the quad or brick above minus its own
    integer_item(j_plane, continuum + self_contained, 'PLANE', 0, 1), & !< 0 plane stress, 1 plane strain
    integer_item(j_face, continuum, 'FACE', 0, 4), & !< face along a four-node stabilised interface (U3), as Abaqus counts; 0 none
    integer_item(j_closure, stabilised, 'CLOSURE', 0, 2), &
      !< damage from 1 a separation of the law's own (consistent), 2 the displacement jump (the paper's); 0: 1, in U3 and U10 2
    integer_item(j_formulation, continuum_3d, 'FORMULATION', 0, 2), &
      !< full integration with 0 the strain of the displacements, 1 incompatible modes (C3D8I), 2 the mean volume strain (C3D8)
    integer_item(j_brick_face, continuum_3d, 'FACE', 0, 6)] !< face along a stabilised interface (U10), as Abaqus counts; 0 none

  ! variables of a point of the continuum element
  integer, parameter, public :: v_e11 = 1
  integer, parameter, public :: v_e22 = 2
  integer, parameter, public :: v_e33 = 3
  integer, parameter, public :: v_e12 = 4
  integer, parameter, public :: v_s11 = 5
  integer, parameter, public :: v_s22 = 6
  integer, parameter, public :: v_s33 = 7
  integer, parameter, public :: v_s12 = 8

  type(variable_item), parameter, public :: continuum_variables(8) = [ &
    variable_item(v_e11, 'E11', '1'), & !< strain along x
    variable_item(v_e22, 'E22', '1'), & !< strain along y
    variable_item(v_e33, 'E33', '1'), & !< strain out of the plane; 0 in plane stress too, where it is not known
    variable_item(v_e12, 'E12', '1'), & !< engineering shear strain
    variable_item(v_s11, 'S11', 'stress'), & !< stress along x
    variable_item(v_s22, 'S22', 'stress'), & !< stress along y
    variable_item(v_s33, 'S33', 'stress'), & !< stress out of the plane
    variable_item(v_s12, 'S12', 'stress')] !< shear stress

  ! variables of a point of the continuum element in space
  integer, parameter, public :: b_e11 = 1
  integer, parameter, public :: b_e22 = 2
  integer, parameter, public :: b_e33 = 3
  integer, parameter, public :: b_e12 = 4
  integer, parameter, public :: b_e13 = 5
  integer, parameter, public :: b_e23 = 6
  integer, parameter, public :: b_s11 = 7
  integer, parameter, public :: b_s22 = 8
  integer, parameter, public :: b_s33 = 9
  integer, parameter, public :: b_s12 = 10
  integer, parameter, public :: b_s13 = 11
  integer, parameter, public :: b_s23 = 12

  type(variable_item), parameter, public :: brick_variables(12) = [ &
    variable_item(b_e11, 'E11', '1'), & !< strain along material axis 1
    variable_item(b_e22, 'E22', '1'), & !< strain along material axis 2
    variable_item(b_e33, 'E33', '1'), & !< strain along material axis 3
    variable_item(b_e12, 'E12', '1'), & !< engineering shear strain of axes 1 and 2
    variable_item(b_e13, 'E13', '1'), & !< engineering shear strain of axes 1 and 3
    variable_item(b_e23, 'E23', '1'), & !< engineering shear strain of axes 2 and 3
    variable_item(b_s11, 'S11', 'stress'), & !< stress along material axis 1
    variable_item(b_s22, 'S22', 'stress'), & !< stress along material axis 2
    variable_item(b_s33, 'S33', 'stress'), & !< stress along material axis 3
    variable_item(b_s12, 'S12', 'stress'), & !< shear stress of axes 1 and 2
    variable_item(b_s13, 'S13', 'stress'), & !< shear stress of axes 1 and 3
    variable_item(b_s23, 'S23', 'stress')] !< shear stress of axes 2 and 3

  ! variables of a point of the interface elements
  integer, parameter, public :: v_x = 1
  integer, parameter, public :: v_y = 2
  integer, parameter, public :: v_sepn = 3
  integer, parameter, public :: v_sept = 4
  integer, parameter, public :: v_tn = 5
  integer, parameter, public :: v_tt = 6
  integer, parameter, public :: v_damage = 7
  integer, parameter, public :: v_dissi = 8
  integer, parameter, public :: v_dissii = 9
  integer, parameter, public :: v_sn = 10
  integer, parameter, public :: v_st = 11
  integer, parameter, public :: v_dmax = 12
  integer, parameter, public :: v_dissv = 13
  integer, parameter, public :: v_wn = 14
  integer, parameter, public :: v_wt = 15
  integer, parameter, public :: v_dissf = 16
  integer, parameter, public :: v_maxn = 17
  integer, parameter, public :: v_maxt = 18

  type(variable_item), parameter, public :: interface_variables(18) = [ &
    variable_item(v_x, 'X', 'length'), & !< original position
    variable_item(v_y, 'Y', 'length'), & !< original position
    variable_item(v_sepn, 'SEPN', 'length'), & !< normal displacement jump, opening positive
    variable_item(v_sept, 'SEPT', 'length'), & !< tangential displacement jump
    variable_item(v_tn, 'TN', 'stress'), & !< normal traction, tension positive
    variable_item(v_tt, 'TT', 'stress'), & !< tangential traction
    variable_item(v_damage, 'DAMAGE', '1'), & !< acting damage, 0 to 1; consistent: (1 - K/ALPHAN) k/(K + k); LAW 4: see above
    variable_item(v_dissi, 'DISSI', 'energy/area'), & !< energy dissipated by damage in mode I
    variable_item(v_dissii, 'DISSII', 'energy/area'), & !< energy dissipated by damage in mode II
    variable_item(v_sn, 'SN', '1'), & !< stabilised S, normal; 1 in the standard element
    variable_item(v_st, 'ST', '1'), & !< stabilised S, tangential; 1 in the standard element
    variable_item(v_dmax, 'DMAX', '1'), & !< largest damage of the law so far; DAMAGE lags behind it with VISCOSITY
    variable_item(v_dissv, 'DISSV', 'energy/area'), & !< energy dissipated by the viscous regularisation
    variable_item(v_wn, 'WN', 'length'), & !< normal separation of the law: with CLOSURE 2 it is SEPN
    variable_item(v_wt, 'WT', 'length'), & !< tangential separation of the law: with CLOSURE 2 it is SEPT
    variable_item(v_dissf, 'DISSF', 'energy/area'), & !< energy dissipated by friction
    variable_item(v_maxn, 'MAXN', 'length'), & !< largest normal separation of the law so far, with LAW 4; else 0
    variable_item(v_maxt, 'MAXT', 'length')] !< largest tangential separation of the law so far, with LAW 4; else 0

  ! variables of a point of the interface elements in space
  integer, parameter, public :: w_x = 1
  integer, parameter, public :: w_y = 2
  integer, parameter, public :: w_z = 3
  integer, parameter, public :: w_sepn = 4
  integer, parameter, public :: w_seps = 5
  integer, parameter, public :: w_sept = 6
  integer, parameter, public :: w_tn = 7
  integer, parameter, public :: w_ts = 8
  integer, parameter, public :: w_tt = 9
  integer, parameter, public :: w_damage = 10
  integer, parameter, public :: w_dissi = 11
  integer, parameter, public :: w_dissii = 12
  integer, parameter, public :: w_sn = 13
  integer, parameter, public :: w_st = 14
  integer, parameter, public :: w_dmax = 15
  integer, parameter, public :: w_dissv = 16
  integer, parameter, public :: w_wn = 17
  integer, parameter, public :: w_ws = 18
  integer, parameter, public :: w_wt = 19
  integer, parameter, public :: w_dissf = 20
  integer, parameter, public :: w_maxn = 21
  integer, parameter, public :: w_maxt = 22

  type(variable_item), parameter, public :: surface_variables(22) = [ &
    variable_item(w_x, 'X', 'length'), & !< original position
    variable_item(w_y, 'Y', 'length'), & !< original position
    variable_item(w_z, 'Z', 'length'), & !< original position
    variable_item(w_sepn, 'SEPN', 'length'), & !< normal displacement jump, opening positive
    variable_item(w_seps, 'SEPS', 'length'), & !< displacement jump along s
    variable_item(w_sept, 'SEPT', 'length'), & !< displacement jump along t
    variable_item(w_tn, 'TN', 'stress'), & !< normal traction, tension positive
    variable_item(w_ts, 'TS', 'stress'), & !< traction along s
    variable_item(w_tt, 'TT', 'stress'), & !< traction along t
    variable_item(w_damage, 'DAMAGE', '1'), & !< acting damage, 0 to 1; consistent: (1 - K/ALPHAN) k/(K + k); LAW 4: see above
    variable_item(w_dissi, 'DISSI', 'energy/area'), & !< energy dissipated by damage in mode I
    variable_item(w_dissii, 'DISSII', 'energy/area'), & !< energy dissipated by damage in shear
    variable_item(w_sn, 'SN', '1'), & !< stabilised S, normal; 1 in the standard element
    variable_item(w_st, 'ST', '1'), & !< stabilised S of both shears; 1 in the standard element
    variable_item(w_dmax, 'DMAX', '1'), & !< largest damage of the law so far; DAMAGE lags behind it with VISCOSITY
    variable_item(w_dissv, 'DISSV', 'energy/area'), & !< energy dissipated by the viscous regularisation
    variable_item(w_wn, 'WN', 'length'), & !< normal separation of the law: with CLOSURE 2 it is SEPN
    variable_item(w_ws, 'WS', 'length'), & !< separation of the law along s: with CLOSURE 2 it is SEPS
    variable_item(w_wt, 'WT', 'length'), & !< separation of the law along t: with CLOSURE 2 it is SEPT
    variable_item(w_dissf, 'DISSF', 'energy/area'), & !< energy dissipated by friction
    variable_item(w_maxn, 'MAXN', 'length'), & !< largest normal separation of the law so far, with LAW 4; else 0
    variable_item(w_maxt, 'MAXT', 'length')] !< largest shear separation of the law so far, with LAW 4; else 0

  ! variables of a self-contained interface element
  integer, parameter, public :: o_betan = 1
  integer, parameter, public :: o_betat = 2
  integer, parameter, public :: o_gamman = 3
  integer, parameter, public :: o_gammat = 4

  type(variable_item), parameter, public :: own_variables(4) = [ &
    variable_item(o_betan, 'BETAN', 'stress/length'), & !< beta_n that acts; the eigenvalue problem is solved where it is 0
    variable_item(o_betat, 'BETAT', 'stress/length'), & !< beta_tau that acts
    variable_item(o_gamman, 'GAMMAN', '1'), & !< weight of the bottom stress that acts, normal
    variable_item(o_gammat, 'GAMMAT', '1')] !< weight of the bottom stress that acts, tangential

  type(element_item), parameter, public :: elements(12) = [ &
    element_item(1, continuum, 2, 4, 4, 1, 2), & !< continuum quad, stress from a material of the deck (UELMAT)
    element_item(2, standard, 2, 4, 2, 13, 3), & !< standard cohesive interface
    element_item(3, next_to_quads, 2, 4, 2, 17, 7), & !< stabilised cohesive interface, four nodes, next to U1 quads
    element_item(4, self_contained, 2, 8, 2, 33, 6), & !< stabilised cohesive interface, eight nodes, self-contained
    element_item(5, standard, 2, 6, 3, 13, 3), & !< standard cohesive interface between edges of three nodes
    element_item(6, self_contained, 2, 16, 3, 33, 6), & !< stabilised cohesive interface of eight-node quads, self-contained
    element_item(7, standard_3d, 3, 8, 4, 12, 3), & !< standard cohesive interface in space, four nodes on each face
    element_item(8, self_contained_3d, 3, 16, 4, 36, 5), & !< stabilised cohesive interface of eight-node bricks
    element_item(9, continuum_3d, 3, 8, 8, 1, 2), & !< continuum brick, stress from a material of the deck (UELMAT)
    element_item(10, next_to_bricks, 3, 8, 4, 16, 7), & !< stabilised cohesive interface in space, eight nodes, next to U9 bricks
    element_item(11, standard_3d, 3, 16, 9, 12, 3), & !< standard cohesive interface in space, eight nodes on each face
    element_item(12, self_contained_3d, 3, 40, 9, 36, 5)] !< stabilised cohesive interface of 20-node bricks

  type(faces_item), parameter, public :: faces(2:12) = [ &
    faces_item(2, 0, [1, 2, 0, 0], [4, 3, 0, 0]), & !< as COH2D4
    faces_item(3, 0, [1, 2, 0, 0], [4, 3, 0, 0]), & !< as U2
    faces_item(4, 4, [4, 3, 0, 0], [5, 6, 0, 0]), & !< edge 4-3 of the quad below, edge 1-2 of that above
    faces_item(5, 0, [1, 2, 5, 0], [4, 3, 6, 0]), & !< as U2, with middles
    faces_item(6, 8, [4, 3, 7, 0], [9, 10, 13, 0]), & !< as U4, with middles
    faces_item(7, 0, [1, 2, 3, 4], [5, 6, 7, 8]), & !< as COH3D8
    faces_item(8, 8, [5, 6, 7, 8], [9, 10, 11, 12]), & !< face 5-6-7-8 of the brick below, face 1-2-3-4 of that above
    faces_item(9, 0, [0, 0, 0, 0], [0, 0, 0, 0]), & !< none
    faces_item(10, 0, [1, 2, 3, 4], [5, 6, 7, 8]), & !< as U7
    faces_item(11, 0, [1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12], [13, 14, 15, 16]), & !< as C3D20 without nodes 17 to 20
    faces_item(12, 20, [5, 6, 7, 8], [21, 22, 23, 24], [13, 14, 15, 16], [29, 30, 31, 32])] !< as U8, with middles

contains

  !> Number of unknowns of Un; 0 where there is no such type.
  pure function unknowns_of(jtype) result(number)
    integer, intent(in) :: jtype
    integer :: number

    number = 0
    if (jtype >= 1 .and. jtype <= size(elements)) number = elements(jtype)%dimension*elements(jtype)%nodes
  end function unknowns_of

  !> Number of SVARS of Un, VARIABLES of *USER ELEMENT; 0 where there is no such type.
  pure function variables_of(jtype) result(number)
    integer, intent(in) :: jtype
    integer :: number

    number = 0
    if (jtype < 1 .or. jtype > size(elements)) return
    number = variables_of_points(jtype)
    if (iand(elements(jtype)%family, with_solids) /= 0) number = number + size(own_variables)
  end function variables_of

  !> Number of SVARS of the points of Un, which it needs at least.
  pure function variables_of_points(jtype) result(number)
    integer, intent(in) :: jtype
    integer :: number

    number = size(interface_variables)
    if (iand(elements(jtype)%family, in_space) /= 0) number = size(surface_variables)
    if (elements(jtype)%family == continuum) number = size(continuum_variables)
    if (elements(jtype)%family == continuum_3d) number = size(brick_variables)
    number = elements(jtype)%points*number
  end function variables_of_points

  !> Number of nodes of each face of the interface element Un.
  pure function nodes_of_face(jtype) result(number)
    integer, intent(in) :: jtype
    integer :: number

    number = count(faces(jtype)%bottom > 0) + count(faces(jtype)%bottom_middles > 0)
  end function nodes_of_face

  !> Nodes of its bottom and its top face, a column each.
  pure function face_nodes(jtype) result(nodes)
    integer, intent(in) :: jtype
    integer :: nodes(nodes_of_face(jtype), 2)

    nodes(:, 1) = present_of(size(nodes, 1), [faces(jtype)%bottom, faces(jtype)%bottom_middles])
    nodes(:, 2) = present_of(size(nodes, 1), [faces(jtype)%top, faces(jtype)%top_middles])
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

  !> Number of real properties that Un may have, PROPERTIES of *USER ELEMENT.
  pure function reals_of(jtype) result(number)
    integer, intent(in) :: jtype
    integer :: number

    number = real_position(jtype, size(reals))
  end function reals_of

  !> Number of integer properties that Un may have, I PROPERTIES of *USER ELEMENT.
  pure function integers_of(jtype) result(number)
    integer, intent(in) :: jtype
    integer :: number

    number = integer_position(jtype, size(integers))
  end function integers_of

  !> Position in PROPS of the property in a row of `reals`.
  pure function real_position(jtype, row) result(position)
    integer, intent(in) :: jtype, row
    integer :: position

    position = count(iand(reals(1:row)%families, elements(jtype)%family) /= 0)
  end function real_position

  !> Position in JPROPS of the property in a row of `integers`.
  pure function integer_position(jtype, row) result(position)
    integer, intent(in) :: jtype, row
    integer :: position

    position = count(iand(integers(1:row)%families, elements(jtype)%family) /= 0)
  end function integer_position

  !> Properties by their rows in `reals` and `integers`; 0 where Un has no such property or the deck no value for it.
  pure subroutine unpack(jtype, nprops, props, njprop, jprops, values, options)
    integer, intent(in) :: jtype, nprops, njprop
    real(dp), intent(in) :: props(nprops)
    integer, intent(in) :: jprops(njprop)
    real(dp), intent(out) :: values(size(reals))
    integer, intent(out) :: options(size(integers))
    integer :: row, position, family

    family = elements(jtype)%family
    values = 0.0_dp
    position = 0
    do row = 1, size(reals)
      if (iand(reals(row)%families, family) == 0) cycle
      if (position == nprops) exit
      position = position + 1
      values(row) = props(position)
    end do
    options = 0
    position = 0
    do row = 1, size(integers)
      if (iand(integers(row)%families, family) == 0) cycle
      if (position == njprop) exit
      position = position + 1
      options(row) = jprops(position)
    end do
  end subroutine unpack

  !> Puts what a zero stands for in its place: the bilinear law and, in a self-contained element, the consistent closure and beta
  !> from the local eigenvalues, in U3 and U10, which follow the paper, its closure and (21).
  pure subroutine recommend(jtype, values, options)
    integer, intent(in) :: jtype
    real(dp), intent(inout) :: values(size(reals))
    integer, intent(inout) :: options(size(integers))
    integer, parameter :: betas(2) = [p_betan, p_betat]
    logical :: follows_paper

    if (iand(elements(jtype)%family, interfaces) /= 0 .and. options(j_law) == 0) options(j_law) = 1
    if (iand(elements(jtype)%family, stabilised) == 0) return
    follows_paper = iand(elements(jtype)%family, next_to_solids) /= 0
    if (options(j_closure) == 0) options(j_closure) = merge(paper_closure, consistent_closure, follows_paper)
    where (.not. abs(values(betas)) > 0.0_dp) values(betas) = merge(by_equation_21, by_eigenvalues, follows_paper)
  end subroutine recommend

  !> Marks a library as holding these elements, so that a host may name their SVARS.
  function delamination_layout_version() result(version) bind(c, name='delamination_layout_version')
    integer(c_int) :: version

    version = 1_c_int
  end function delamination_layout_version

end module abaqus_layout
