# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The explorer of one interface element, `uel law`: its paths, its files, and the paper's law seen through it."""

import csv
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from uel.cli import main
from uel.delamination import law, softening
from uel.delamination.law_report import Exploration, advice, explore, path_points
from uel.errors import KernelError, UelError
from uel.paper.decks import FOLDER

COMPLIANT = ("ALPHAN=2e4", "ALPHAT=3e4")
PAPER = ("CLOSURE=2", "BETAN=-2", "BETAT=-2")


@pytest.fixture
def curves(tmp_path):
    """Explore with options; the curves by label."""

    def curves(**options):
        found, _ = explore(Exploration(output_dir=tmp_path, **options))
        return {curve.label: curve.columns for curve in found}

    return curves


def test_figure_2_of_the_paper(curves):
    """Strengths and fracture energies of table 2 in the pure modes; in mixed mode equations (10) and (11)."""
    found = curves(increments=1000, angles=(0.0, 45.0, 90.0))
    opened, mixed, slid = found.values()
    assert list(found) == ["0°", "45°", "90°"]
    assert opened["TN"].max() == pytest.approx(30.0, rel=1e-3)
    assert slid["TT"].max() == pytest.approx(60.0, rel=1e-3)
    assert opened["WORK"][-1] == pytest.approx(0.26, rel=1e-4)
    assert slid["WORK"][-1] == pytest.approx(1.002, rel=1e-4)
    assert max(np.abs(opened["TT"]).max(), np.abs(slid["TN"]).max()) < 1e-10
    # equal stiffnesses: equal tractions at 45 degrees, equal shares of the energy
    assert mixed["TN"].max() == pytest.approx((30.0**-2 + 60.0**-2) ** -0.5, rel=1e-3)
    assert mixed["WORK"][-1] == pytest.approx(2 / (1 / 0.26 + 1 / 1.002), rel=1e-4)
    # the curve ends where a thousandth of the lower strength is left
    assert np.hypot(mixed["TN"][-1], mixed["TT"][-1]) == pytest.approx(0.03, rel=1e-3)


@pytest.mark.sample(2)
@pytest.mark.parametrize("kind", [("LAW=1",), ("LAW=4", "SHAPEN=3", "SHAPET=1.5")], ids=lambda kind: kind[0])
def test_every_element_shows_the_same_law(curves, kind):
    """With the quads in equilibrium, T = <sigma>.n: equations (16) and (17) become T = alpha (1 - d) g."""
    asked = {"angles": (0.0, 50.0, 90.0), "increments": 50, "unload": (0.3,), "close": 0.05}
    papers = {4: PAPER, 6: PAPER}
    found = {
        element: curves(properties=(*COMPLIANT, *kind, *papers.get(element, ())), element=element, **asked)
        for element in (2, 4, 5, 6)
    }
    for label, columns in found[2].items():
        for element, other in found.items():
            for name in ("SEPN", "SEPT", "TN", "TT", "DAMAGE", "DISSI", "DISSII", "WORK"):
                np.testing.assert_allclose(other[label][name], columns[name], atol=1e-8)
            assert (other[label]["SN"] < 1).any() == (element in (4, 6))


def test_ppr_law_in_the_pure_modes(curves):
    """Strengths and fracture energies of table 2, the peaks smooth; with infinite stiffness the peak is the start."""
    opened, slid = curves(properties=(*COMPLIANT, "LAW=4"), increments=1000, angles=(0.0, 90.0)).values()
    assert opened["TN"].max() == pytest.approx(30.0, rel=1e-4)
    assert slid["TT"].max() == pytest.approx(60.0, rel=1e-4)
    assert opened["WORK"][-1] == pytest.approx(0.26, rel=1e-4)
    assert slid["WORK"][-1] == pytest.approx(1.002, rel=1e-4)
    rigid = ("LAW=4", "ALPHAN=0", "ALPHAT=0", "CLOSURE=1")
    # exponent 2: strength (1 - w/w_final), w_final = 2 G/strength
    column = curves(properties=rigid, angles=(0.0,), element=4, increments=50)["0°"]
    np.testing.assert_allclose(column["TN"][1:], 30.0 * (1 - column["SEPN"][1:] * 30.0 / 0.52), atol=1e-6)


BRIDGING = ("LAW=5", "SIGMABRIDGE=3", "TAUBRIDGE=12", "GIBRIDGE=0.1", "GIIBRIDGE=0.3")
TABLE = ("LAW=6", "SEPARATION1=0.2", "TRACTION1=1", "SEPARATION2=0.5", "TRACTION2=0.2")
LAWS = [("LAW=1",), ("LAW=2", "ETA=2.3"), ("LAW=3", "POWER=1.5"), ("LAW=4", "SHAPET=3"), BRIDGING, TABLE]


def test_bridging_and_table_in_mode_one(curves):
    """Lines of 27 MPa and 0.16 N/mm, 3 MPa and 0.1 N/mm; a plateau up to 0.2, then lines, with an area of 0.43."""
    rigid = {"angles": (0.0,), "element": 4, "increments": 50}
    stiff = ("ALPHAN=0", "ALPHAT=0", "CLOSURE=1")
    column = curves(properties=(*BRIDGING, *stiff), **rigid)["0°"]
    w = column["SEPN"][1:]
    lines = [strength * np.maximum(0, 1 - w * strength / (2 * energy)) for strength, energy in ((27, 0.16), (3, 0.1))]
    np.testing.assert_allclose(column["TN"][1:], sum(lines), atol=1e-6)
    column = curves(properties=(*TABLE, *stiff), **rigid)["0°"]
    w = column["SEPN"][1:] / (0.26 / 30.0 / 0.43)
    np.testing.assert_allclose(column["TN"][1:], 30.0 * np.interp(w, [0, 0.2, 0.5, 1], [1, 1, 0.2, 0]), atol=1e-6)


@pytest.mark.parametrize("kind", [("LAW=2",), BRIDGING, TABLE], ids=lambda kind: kind[0])
@pytest.mark.parametrize("stiffness", [COMPLIANT, ("ALPHAN=1e7", "ALPHAT=1e6")], ids=["compliant", "stiff"])
def test_shares_of_the_pure_modes_are_those_of_the_element(curves, kind, stiffness):
    """Dissipated share as a function of the secant, from which the advice on the strengths follows, beside SPENT."""
    found = curves(properties=(*kind, *stiffness), angles=(0.0, 90.0), increments=100)
    words = law.standard_properties() | law.read_properties((*kind, *stiffness))
    for (columns, letter), mode in zip(
        ((found["0°"], "N"), (found["90°"], "T")), softening.pure_modes(words), strict=True
    ):
        softened = (columns["DAMAGE"] > 0) & (columns["DAMAGE"] < 1)
        secants = columns[f"T{letter}"][softened] / columns[f"SEP{letter}"][softened]
        np.testing.assert_allclose(mode.shares_at(secants), columns["SPENT"][softened], rtol=1e-7)
        assert softened.sum() > 20


LARGE = ("TAUBRIDGE=150", "GIIBRIDGE=0.5")
"""Bridging that in mode II, at 200 MPa, is a larger part than in mode I."""


@pytest.mark.parametrize(
    ("kind", "alike"),
    [((*BRIDGING[:2], BRIDGING[3], *LARGE), False), (BRIDGING[:2] + BRIDGING[3:4], True), (TABLE, True)],
)
def test_advice_on_laws_of_several_lines(kind, alike):
    """With k_I = k_II and one shape in both modes the energy stays between the toughnesses."""
    weak = (*kind, "TAUMAX=200", "ALPHAN=0", "ALPHAT=0")
    found = advice(Exploration(properties=weak))
    better = 30.0 * np.sqrt(1.002 / 0.26)
    assert f"With this SIGMAMAX, TAUMAX = {better:.3g}" in found
    assert ("the same parts of the bridging in both modes, keep it between." in found) != alike
    if alike:
        assert not advice(Exploration(properties=(*weak, f"TAUMAX={better}")))


@pytest.mark.sample(4)
@pytest.mark.parametrize("kind", LAWS, ids=lambda kind: kind[0])
def test_consistent_closure_shows_its_law(curves, kind):
    """t(w) + beta w = <sigma>.n + beta g with T = <sigma>.n is w = g: the law itself, at any stiffness."""
    asked = {"increments": 60, "unload": (0.3,), "angles": (0.0, 50.0, 90.0)}
    for stiffness in (("ALPHAN=2e4", "ALPHAT=3e4"), ("ALPHAN=1e8", "ALPHAT=1e8"), ("ALPHAN=0", "ALPHAT=0")):
        rigid = stiffness[0] == "ALPHAN=0"
        asked["close"] = 0.0 if rigid else 0.05
        standard = curves(properties=(*kind, *(("ALPHAN=1e9", "ALPHAT=1e9") if rigid else stiffness)), **asked)
        consistent = curves(properties=(*kind, *stiffness, "CLOSURE=1"), element=4, **asked)
        for label, columns in standard.items():
            for name in ("TN", "TT"):
                # the rise of the PPR law is felt up to sqrt(G/stiffness), 1.6e-5 mm
                tolerance = (0.5 if kind[0] == "LAW=4" else 1e-3) if rigid else 1e-6
                np.testing.assert_allclose(consistent[label][name], columns[name], atol=tolerance)


def test_unloading_and_closing(curves):
    """Back to the origin on the secant; pressed together with the undamaged stiffness; then on as if never unloaded."""
    there_and_back = curves(properties=COMPLIANT, angles=(40.0,), unload=(0.2, 0.5), close=0.1)["40°"]
    straight = curves(properties=COMPLIANT, angles=(40.0,))["40°"]
    closed = there_and_back["SEPN"] < 0
    assert there_and_back["SEPN"].min() == pytest.approx(-0.1 * np.hypot(straight["SEPN"], straight["SEPT"])[-1])
    np.testing.assert_allclose(there_and_back["TN"][closed], 2e4 * there_and_back["SEPN"][closed])
    damage = there_and_back["DAMAGE"]
    assert (np.diff(damage) >= 0).all()
    back = ~closed & np.isclose(damage, np.roll(damage, 1)) & (damage > 0) & (damage < 1)
    assert back.sum() == 2 * 41
    np.testing.assert_allclose(
        there_and_back["TT"][back], 3e4 * (1 - damage[back]) * there_and_back["SEPT"][back], atol=1e-9
    )
    for name in ("TN", "DISSI", "DISSII", "WORK"):
        assert there_and_back[name][-1] == pytest.approx(straight[name][-1], abs=1e-9)


def test_path_goes_through_its_points(curves):
    points = path_points("0.003,0 0.003,0.01; -0.0001,0.002")
    columns = curves(properties=COMPLIANT, path=points, increments=10)["path"]
    separations = np.column_stack([columns["SEPN"], columns["SEPT"]])
    np.testing.assert_allclose(separations[::10], np.vstack([[0, 0], points]), atol=1e-15)
    assert len(separations) == 31
    np.testing.assert_allclose(columns["TIME"][[0, -1]], [0, 1])


def test_viscosity_sees_the_duration(curves):
    """The damage lags the more, the quicker the curve is run through; none of it changes the reach."""
    slow, quick = (curves(properties=("VISCOSITY=0.1",), angles=(0.0,), duration=t)["0°"] for t in (1000.0, 1.0))
    assert quick["SEPN"][-1] == slow["SEPN"][-1]
    assert slow["TN"].max() == pytest.approx(30.0, rel=0.05)
    assert quick["TN"].max() > 60.0
    assert (quick["DAMAGE"] <= quick["DMAX"]).all()


def test_rate_sees_the_duration(curves):
    """The curves begin slowly and end at twice their mean rate, where no traction is left."""
    rates = ("RATEREFERENCE=0.01", "RATELIMIT=1e3", "STRENGTHRATE=0.1", "TOUGHNESSRATE=0.2")
    for duration in (1e6, 1.0, 1e-3):
        opened = curves(properties=rates, angles=(0.0,), duration=duration)["0°"]
        rate = 2 * opened["SEPN"][-1] / duration
        # 2 G/strength at this rate, to a thousandth of the traction
        assert opened["SEPN"][-1] == pytest.approx(2 * 0.26 / 30 * (1 + rate / 0.01) ** 0.1, rel=2e-3)
        assert opened["SPENT"][-1] > 0.998


@pytest.mark.parametrize(("kind", "jtype"), [("u2", 2), ("u3", 2), ("u4", 4)])
def test_properties_of_a_deck(kind, jtype):
    found, values = law.deck_properties(FOLDER / "dcb" / f"dcb_{kind}_1e8.inp", "interface")
    assert found == jtype
    assert (values["ALPHAN"], values["SIGMAMAX"], values["GIIC"], values["LAW"]) == (1e8, 30.0, 1.002, 1)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"properties": ["ALPHAM=3"]}, r"'ALPHAM=3': expected NAME=VALUE with a name among ALPHAN, ALPHAT"),
        ({"properties": ["ALPHAN"]}, r"'ALPHAN': expected NAME=VALUE"),
        ({"properties": ["GIC=much"]}, r"'GIC=much': 'MUCH' is not a finite number"),
        ({"deck": FOLDER / "dcb/dcb_u4_1e8.inp", "elset": "GLUE"}, r"ELSET=GLUE; expected one of INTERFACE"),
        ({"deck": FOLDER / "quad_cook/cook_u1.inp"}, r"cook_u1.inp: no interface elements"),
        ({"properties": ["CLOSURE=1"]}, r"CLOSURE: U2 has no such property .* ignore it; --element U4 or U6 has it$"),
        ({"properties": ["OFFSETTOP=1"], "element": 4}, r"OFFSETTOP: U4 has no such property and would ignore it$"),
        ({"properties": ["ETA=1.45"]}, r"ETA: LAW 1 ignores it; LAW 2, 3, 5 or 6 has it$"),
        ({"properties": ["SHAPET=3", "LAW=3"], "element": 4}, r"SHAPET: LAW 3 ignores it; LAW 4 has it$"),
        ({"properties": ["E1_TOP=1", "LAW=2", "ETA=2", "POWER=2"], "element": 6}, r"POWER: ignored where ETA is not 0"),
        ({"properties": ["SIGMAMAX=30", "GIC=1e9"]}, r"traction at 0 degrees does not fall"),
    ],
)
def test_what_cannot_be_explored(curves, options, message):
    with pytest.raises(UelError, match=message):
        curves(**options)


@pytest.mark.parametrize("text", ["1", "1,2,3", "1,2 3", "a,b", ""])
def test_paths_that_make_no_sense(text):
    with pytest.raises(UelError, match=r"expected points NORMAL,TANGENTIAL"):
        path_points(text)


def test_a_rigid_interface_cannot_be_closed(curves):
    rigid = ("ALPHAN=0", "ALPHAT=0", "CLOSURE=1")
    with pytest.raises(UelError, match=r"no equilibrium of the quads with the interface at a separation of \[-"):
        curves(properties=rigid, element=4, unload=(0.3,), close=0.05)


def test_message_of_the_element_comes_through(curves):
    with pytest.raises(KernelError, match=r"PROPS\(2\) ALPHAN = -1.*positive"):
        curves(properties=["ALPHAN=-1"])


@pytest.fixture
def figures(monkeypatch):
    """Figures that are drawn, in place of their files."""
    kept = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: kept.append(figure))
    return kept


def test_picture_names_element_properties_and_units(curves, figures):
    curves(properties=("LAW=2", "ETA=1.45", "CLOSURE=1"), element=4, angles=(0.0,), increments=20)
    curves(deck=FOLDER / "dcb" / "dcb_u4_1e8.inp", angles=(0.0,), increments=20)
    mine, of_deck = figures
    expected = (
        "U4: ALPHAN=1e+06, ALPHAT=1e+06, SIGMAMAX=30, TAUMAX=60, GIC=0.26, GIIC=1.002, ETA=1.45, LAW=2, CLOSURE=1"
    )
    assert mine.get_supxlabel().replace("\n", " ") == expected
    assert mine.axes[0].get_ylabel() == "Normal traction [MPa]"
    # a deck does not tell its units
    assert of_deck.axes[0].get_ylabel() == "Normal traction"
    assert not any(axis.texts for figure in figures for axis in figure.axes)


def test_picture_of_unloading_has_arrows_and_shows_the_tension(curves, figures):
    """A pressure of many times the strength is cut off, and named."""
    column = curves(properties=COMPLIANT, angles=(0.0,), unload=(0.5,), close=1.0)["0°"]
    normal, tangential = figures[0].axes
    lowest, highest = normal.get_ylim()
    assert column["TN"].min() < -10.0 * column["TN"].max()
    assert -lowest == pytest.approx(0.5 * column["TN"].max())
    assert highest == pytest.approx(1.05 * column["TN"].max())
    (label,) = [text.get_text() for text in normal.texts if text.get_text()]
    assert label == f"down to {column['TN'].min():.3g}"
    # up, down to the pressure, up again
    arrows = [text for text in normal.texts if not text.get_text()]
    assert len(arrows) == 3
    directions = [np.sign(arrow.xy[0] - arrow.xyann[0]) for arrow in arrows]
    assert directions == [1.0, -1.0, 1.0]
    assert not tangential.texts


def test_command_writes_data_and_pictures(tmp_path, capsys):
    words = ["law", "TAUMAX=50", "--angles", "0", "90", "SIGMAMAX=20", "--increments", "50", "--surface", "GIC=0.3"]
    assert main([*words, "--job", "mine", "--output-dir", str(tmp_path / "new")]) == 0
    printed = capsys.readouterr().out
    assert "max TN" in printed and "mine_surface.png" in printed
    with (tmp_path / "new/mine.csv").open() as file:
        assert file.readline().startswith("# U2: ALPHAN=")
        rows = list(csv.DictReader(file))
    assert len(rows) == 2 * 51
    assert {row["CURVE"] for row in rows} == {"0°", "90°"}
    assert max(float(row["TN"]) for row in rows) == pytest.approx(20, rel=0.05)
    assert max(float(row["TT"]) for row in rows) == pytest.approx(50, rel=0.05)
    for name in ("mine.png", "mine_surface.png"):
        assert (tmp_path / "new" / name).read_bytes().startswith(b"\x89PNG")


def test_command_takes_a_path_and_says_what_is_wrong(tmp_path: Path, capsys):
    assert main(["law", "--path", "0.01,0.01", "--element", "U6", "--output-dir", str(tmp_path)]) == 0
    assert (tmp_path / "law.csv").read_text().splitlines()[1].startswith("CURVE,TIME,X,Y,SEPN,SEPT,TN,TT,")
    assert main(["law", "--path", "nowhere", "--output-dir", str(tmp_path)]) == 2
    assert capsys.readouterr().err.startswith("uel: 'nowhere': expected points")


@pytest.mark.parametrize(
    ("stiff", "least", "most", "better"),
    [
        # 1/k is 2 G/strength^2 - 1/alpha in each mode: k = 375 and 5062.5 without stiffness, and the extreme of
        # 0.3 k_I/(K + k_I) + 0.8 K/(K + k_II) is at (K + k_II)/(K + k_I) = 90/15, K = 562.5: 0.12 + 0.08
        ("0", 0.2, 0.9, 15.0 * np.sqrt(0.8 / 0.3)),
        ("1e8", 0.2, 0.9, 15.0 * np.sqrt(0.8 / 0.3)),
    ],
)
def test_advice_on_the_strengths(stiff, least, most, better):
    words = ("SIGMAMAX=15", "TAUMAX=90", "GIC=0.3", "GIIC=0.8", f"ALPHAN={stiff}", f"ALPHAT={stiff}")
    found = advice(Exploration(properties=words))
    assert f"dissipates {least:.3g} to {most:.3g}, beyond GIC = 0.3 and GIIC = 0.8" in found
    assert f"TAUMAX = {better:.3g} keeps it between" in found
    assert not advice(Exploration(properties=(*words, f"TAUMAX={better}")))
    assert not advice(Exploration(properties=(*words, "LAW=3")))


def test_no_advice_where_the_energy_stays_between_the_toughnesses():
    """The paper's law, and 60/60 MPa with 0.3/1.2 N/mm, whose order of the modes matters but less."""
    assert not advice(Exploration())
    assert not advice(Exploration(properties=("SIGMAMAX=60", "TAUMAX=60", "GIC=0.3", "GIIC=1.2")))


def test_command_gives_the_advice(tmp_path, capsys):
    words = ["law", "--angles", "0", "--increments", "20", "--output-dir", str(tmp_path)]
    assert main(words) == 0
    assert "softens in one mode" not in capsys.readouterr().out
    assert main([*words, "TAUMAX=200"]) == 0
    assert "A point that softens in one mode and fails in the other dissipates" in capsys.readouterr().out
