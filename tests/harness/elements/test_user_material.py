# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""UMAT on built-in elements and UVARM, in whole jobs: a strip of two elements that is pulled."""

from pathlib import Path

import numpy as np
import pytest

from uel.errors import DeckError, KernelError

HERE = Path(__file__).parent
DECK = """\
*NODE
1, 0., 0.
2, 3., 0.
3, 4., 0.
4, 0., 2.
5, 3., 2.
6, 4., 2.
*ELEMENT, TYPE={type}, ELSET=ALL
1, 1, 2, 5, 4
{last}, 2, 3, 6, 5
*SOLID SECTION, ELSET=ALL, MATERIAL=FLEXIBLE{orientation}
*MATERIAL, NAME=FLEXIBLE
{material}
*BOUNDARY
1, 1, 2
4, 1
*STEP
*STATIC
0.25, 1., , 0.25
*BOUNDARY
3, 1, 1, 0.4
6, 1, 1, 0.4
*NODE PRINT
RF
*END STEP
"""
USER = "*USER MATERIAL, CONSTANTS=3\n1000., 0.3, {}\n*DEPVAR\n7\n*USER OUTPUT VARIABLES\n5"


@pytest.fixture
def run_strip(run_deck):
    def run_strip(material, *, type="CPE4", last=2, orientation="", user=HERE / "points.f"):
        return run_deck(DECK.format(material=material, type=type, last=last, orientation=orientation), user)

    return run_strip


@pytest.mark.parametrize("type", ["CPE4", "CPS4", "CAX4"])
def test_umat_does_what_the_elastic_material_does(run_strip, type):
    """The same constants: the same stresses and energies, and as many iterations."""
    built_in, user = run_strip("*ELASTIC\n1000., 0.3", type=type), run_strip(USER.format(0), type=type)
    for name in ("S11", "S22", "S33", "S12", "E22", "U"):
        np.testing.assert_allclose(user.field(name), built_in.field(name), rtol=1e-9, atol=1e-9)
    assert [line.total_iterations for line in user.status] == [line.total_iterations for line in built_in.status]
    assert user.history["ALLSE"][-1] == pytest.approx(built_in.history["ALLSE"][-1], rel=1e-9)


@pytest.mark.parametrize("type", ["CPE4", "CAX4"])
def test_what_umat_is_given(run_strip, type):
    """At the end of four increments; means over the four points of elements that are 3 by 2 and 1 by 2."""
    result = run_strip(USER.format(0), type=type)
    expected = {
        "SDV1": [4, 4],  # increments, not iterations
        "SDV2": [0.75, 0.75],  # TIME is that of the start
        "SDV3": [0.25, 0.25],
        "SDV4": [1.5, 3.5],
        "SDV5": [1, 1],
        "SDV6": [3104, 3104],
        "SDV7": [np.sqrt(6), np.sqrt(2)],
    }
    for name, values in expected.items():
        np.testing.assert_allclose(result.field(name), values, rtol=1e-12, err_msg=name)


def test_uvarm_sees_the_point_and_the_common_block(run_strip):
    """Means of 11 to 14 and 21 to 24; TEMP is not known (JRCD = 1); UMAT saw element 2, point 4, last."""
    result = run_strip(USER.format(0))
    np.testing.assert_allclose(result.field("UVARM1"), result.field("S22"), atol=1e-9)
    np.testing.assert_allclose(result.field("UVARM2"), [101.5, 103.5])
    np.testing.assert_allclose(result.field("UVARM3"), [4, 4])
    np.testing.assert_allclose(result.field("UVARM4"), [1012.5, 1022.5])
    np.testing.assert_allclose(result.field("UVARM5"), [24, 24])


def test_uvarm_is_given_where_the_point_is_now(run_strip, monkeypatch):
    """With NLGEOM COORD is current (User Subroutines Guide, UVARM): the mean over the points is that of the nodes."""
    monkeypatch.setattr(f"{__name__}.DECK", DECK.replace("*STEP", "*STEP, NLGEOM"))
    result = run_strip(USER.format(0))
    nodes = np.array([[0, 0], [3, 0], [4, 0], [0, 2], [3, 2], [4, 2.0]]) + result.field("U")[:, :2]
    means = np.array([nodes[[0, 1, 4, 3]].mean(axis=0), nodes[[1, 2, 5, 4]].mean(axis=0)])
    np.testing.assert_allclose(result.field("UVARM2"), means @ [1, 100], rtol=1e-9)


def test_umat_cuts_the_increment_back(run_strip):
    """PNEWDT = 0.5 where the increment exceeds 0.2, as all that the deck asks for do."""
    lines = run_strip(USER.format(1)).status
    assert lines[0].cutback
    assert {line.time_increment for line in lines if not line.cutback} <= {0.125, 0.1875}


def test_xit_in_umat_and_uvarm(run_strip):
    with pytest.raises(
        KernelError, match=r"element 1 \(type CPE4\): UMAT at integration point 1 stopped the analysis \(XIT\)"
    ):
        run_strip(USER.format(2))
    message = (
        r"element 99 \(type CPE4\): UVARM at integration point 1 stopped the analysis \(XIT\).* \(step 1, increment 2\)"
    )
    with pytest.raises(KernelError, match=message):
        run_strip(USER.format(0), last=99)


def test_a_job_without_umat_is_refused(run_strip):
    with pytest.raises(DeckError, match=r"deck.inp:13: \*USER MATERIAL: material FLEXIBLE needs UMAT; .* has UEL"):
        run_strip(USER.format(0), user=HERE / "spring.f")


def test_global_directions_are_no_orientation(run_strip):
    axes = "\n*ORIENTATION, NAME=GLOBAL\n2., 0., 0., 1., 1., 0."
    turned, plain = run_strip(USER.format(0) + axes, orientation=", ORIENTATION=GLOBAL"), run_strip(USER.format(0))
    np.testing.assert_array_equal(turned.field("S11"), plain.field("S11"))


def test_without_uvarm_its_variables_are_left_out(run_strip):
    assert run_strip("*ELASTIC\n1000., 0.3\n*USER OUTPUT VARIABLES\n2", user=None).status


COUNTS = f"""      include '{HERE.parent / "umat.inc"}'
      do k = 1, nstatv
        statev(k) = statev(k) + 10*npt + k
      end do
      ddsdde = 0
      do k = 1, ntens
        ddsdde(k,k) = props(1)
      end do
      stress = stress + props(1)*dstran
      end
"""


def test_points_do_not_share_state_variables(run_strip):
    """To the last one: means over the four points after four increments."""
    result = run_strip("*USER MATERIAL, CONSTANTS=1\n1000.\n*DEPVAR\n3", user=COUNTS)
    for k in (1, 2, 3):
        np.testing.assert_allclose(result.field(f"SDV{k}"), 4 * (10 * 2.5 + k), err_msg=str(k))


BEYOND = "*USER MATERIAL, CONSTANTS=4\n1000., {}, {}, {}\n"
LOST = "at integration point 1; the run goes on, but what is written there is lost"


@pytest.mark.parametrize(
    ("array", "first", "last", "depvar", "message"),
    [
        (1, 3, 3, "*DEPVAR\n2", "STATEV: entry 3 of 2 (*DEPVAR)"),
        (1, 1, 1, "", "STATEV: entry 1 of 0 (*DEPVAR)"),
        (1, 0, 0, "*DEPVAR\n2", "STATEV: entry 0 of 2 (*DEPVAR)"),
        (1, 3, 9000, "*DEPVAR\n2", "STATEV: entry 3 of 2 (*DEPVAR)"),
        (2, 5, 6, "", "STRESS: entry 5 of 4 (NTENS)"),
        (3, 17, 36, "", "DDSDDE: entry 17 of 16 (NTENS x NTENS)"),
    ],
)
def test_a_write_outside_an_array_is_told_once(run_strip, array, first, last, depvar, message):
    """With its element and point; all else is as without it."""
    sound = run_strip("*ELASTIC\n1000., 0.")
    wrong = run_strip(BEYOND.format(array, first, last) + depvar, user=HERE / "beyond.f")
    np.testing.assert_allclose(wrong.field("U"), sound.field("U"), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(wrong.field("S11"), sound.field("S11"), rtol=1e-9, atol=1e-9)
    text = " ".join(wrong.file(".msg").read_text().split())
    assert f"***WARNING: element 1: UMAT writes outside {message} {LOST}" in text
    assert text.count("writes outside") == 1


def test_a_material_that_keeps_to_its_arrays_gives_no_warning(run_strip, tmp_path):
    run_strip(USER.format(0))
    assert "outside" not in (tmp_path / "deck.msg").read_text()


@pytest.mark.nan
def test_no_number_of_umat_is_told_with_its_point(run_strip, tmp_path):
    """Before the element's RHS, which is none either, ends the run."""
    wrong = tmp_path / "none.f"
    lines = (HERE / "beyond.f").read_text().replace("include '../umat.inc'", f"include '{HERE.parent / 'umat.inc'}'")
    at_last = "if (noel.eq.2.and.npt.eq.3) stress(2)=sqrt(-1-stran(1)**2)"
    wrong.write_text(lines.replace("      do i=nint(props(3))", f"      {at_last}\n      do i=nint(props(3))"))
    with pytest.raises(KernelError, match=r"element 2 \(type CPE4\): RHS\(\d\) is NaN or infinite"):
        run_strip(BEYOND.format(1, 1, 0), user=wrong)
    text = " ".join((tmp_path / "deck.msg").read_text().split())
    told = "***WARNING: element 2: UMAT sets an entry of STRESS to NaN or infinity, entry 2, at integration point 3"
    assert text.count(told) == 1


def test_an_array_used_before_allocate(run_strip, tmp_path):
    """The message names routine and point, and says what a segmentation fault is."""
    text = (
        (HERE / "beyond.f")
        .read_text()
        .replace("'../umat.inc'", f"'{HERE.parent / 'umat.inc'}'\n      real*8, allocatable :: a(:)")
    )
    (tmp_path / "none.f").write_text(
        text.replace("      ddsdde=0\n", "      ddsdde=0\n      if (npt.eq.3) a(2)=dtime\n")
    )
    message = r"element 1 \(type CPE4\): UMAT at integration point 3 .*: in UMAT, none.f line \d+: segmentation fault"
    with pytest.raises(KernelError, match=message):
        run_strip(BEYOND.format(1, 1, 0), user=tmp_path / "none.f")
