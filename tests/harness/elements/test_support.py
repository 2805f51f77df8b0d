# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The table of formulations: complete, the same on its page, and true of what is built."""

import importlib.util
import inspect
import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest

import uel
from uel import usersub
from uel.deck import read_deck
from uel.elements import build_blocks
from uel.elements.building import nodal_block
from uel.elements.materials.laws import Law, laws_of
from uel.elements.routine import Routine
from uel.elements.support import FORMULATIONS, STEPS, Feature, Support, name_of
from uel.errors import DeckError, Source
from uel.model import perturbations, procedures
from uel.model.element_types import BUILT_IN, CONTINUUM, DiscreteKind, Formulation
from uel.model.procedures import Procedure
from uel.model.properties import SolidSection
from uel.model.steps import Step
from uel.usersub import _binding

NODES = "*NODE, NSET=ALL\n1,\n2, 1.\n3, 1., 1.\n4, 0., 1.\n5, 0., 0., 1.\n6, 1., 0., 1.\n7, 1., 1., 1.\n8, 0., 1., 1.\n"


SPEC = importlib.util.spec_from_file_location("support", Path(__file__).parents[3] / "docs" / "support.py")
MANUAL = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(MANUAL)
YES, SMALL, IDLE, NO = MANUAL.YES, MANUAL.SMALL, MANUAL.IDLE, MANUAL.NO
types_of = MANUAL.types_of


def cells_of(page):
    """Marks of the page by row and head of the column."""
    cells, heads = {}, []
    for line in page.replace("\\*", "*").splitlines():
        row, *marks = [cell.strip() for cell in line.split("|")[1:-1]] or [""]
        if marks and not row:
            heads = marks
        elif set(marks) == {"---"}:
            continue
        elif len(marks) == len(heads):
            cells |= {(row, head): mark for head, mark in zip(heads, marks, strict=True)}
    return cells


CELLS = cells_of(MANUAL.support())


@pytest.mark.parametrize(
    ("column", "row", "mark"),
    [
        ("S3", "*PIEZOELECTRIC", IDLE),
        ("S3", "*FREQUENCY", YES),
        ("S3", "*DYNAMIC", SMALL),
        ("S3", "*EXPANSION", NO),
        ("C3D8E", "*PIEZOELECTRIC", YES),
        ("C3D8E", "*FREQUENCY", SMALL),
        ("DC2D3", "*STATIC", NO),
        ("DC2D3", "*HEAT TRANSFER", YES),
        ("C3D8", "*HEAT TRANSFER", IDLE),
        ("Un", "*HEAT TRANSFER", YES),
        ("C3D8", "SDVINI", YES),
    ],
)
def test_cells_of_the_manual(column, row, mark):
    assert CELLS[row, column] == mark


def test_the_manual_has_the_table():
    heads = {MANUAL.label(each): support for each, support in FORMULATIONS.items()}
    for (row, head), mark in CELLS.items():
        support = heads[head]
        if row in STEPS:
            large = support.supports(replace(STEPS[row], nlgeom=True))
            assert (mark != NO) == support.supports(STEPS[row])
            assert (mark == SMALL) == (mark not in (NO, IDLE) and not large)
        else:
            assert (mark == YES) == (row in support.laws | support.features)
            assert (mark == IDLE) == (row in support.ignored)
    assert {row for row, _ in CELLS} == {*map(str, Law), *STEPS, *map(str, Feature)}


def test_every_formulation_has_a_column_and_types():
    assert list(FORMULATIONS) == list(Formulation)
    assert {kind.formulation for kind in BUILT_IN.values()} <= set(FORMULATIONS)
    assert all(map(types_of, Formulation))


def test_every_procedure_has_a_row():
    kinds = [
        kind
        for module in (procedures, perturbations)
        for _, kind in inspect.getmembers(module, inspect.isclass)
        if issubclass(kind, Procedure) and not inspect.isabstract(kind)
    ]
    names = {name_of(Step(1, "", kind(), Source("", 0))) for kind in kinds}
    assert names | {"*STATIC, RIKS"} == set(STEPS)


ELASTIC = "*ELASTIC\n1., 0.3"
RUBBER = "*HYPERELASTIC, NEO HOOKE\n1., 0.1"
FIBRES = "*ANISOTROPIC HYPERELASTIC, {}LOCAL DIRECTIONS=1"
BASE = {
    Formulation.COHESIVE: "*ELASTIC, TYPE=TRACTION\n1., 1., 1.",
    Formulation.HEAT: "*CONDUCTIVITY\n1.",
    Formulation.DIFFUSION: "*DIFFUSIVITY\n1.\n*SOLUBILITY\n1.",
    Formulation.PIEZOELECTRIC: f"{ELASTIC}\n*DIELECTRIC\n1.",
    **dict.fromkeys(
        (Formulation.COUPLED, Formulation.COUPLED_PLANE_STRESS, Formulation.COUPLED_HYBRID),
        f"{ELASTIC}\n*CONDUCTIVITY\n1.",
    ),
}
"""Materials that elements take, *ELASTIC unless given."""

TEXTS = {
    Law.ISOTROPIC: ELASTIC,
    Law.HALF: "*ELASTIC\n1., 0.5",
    Law.ENGINEERING: "*ELASTIC, TYPE=ENGINEERING CONSTANTS\n1., 1., 1., 0., 0., 0., 1., 1.\n1.",
    Law.ORTHOTROPIC: "*ELASTIC, TYPE=ORTHOTROPIC\n1., 0., 1., 0., 0., 1., 1., 1.\n1.",
    Law.ANISOTROPIC: "*ELASTIC, TYPE=ANISOTROPIC\n1., 0., 1., 0., 0., 1., 0., 0.\n0., 1., 0., 0., 0., 0., 1., 0.\n"
    "0., 0., 0., 0., 1.",
    Law.LAMINA: "*ELASTIC, TYPE=LAMINA\n1., 1., 0., 1., 1., 1.",
    Law.TRACTION: "*ELASTIC, TYPE=TRACTION\n1., 1., 1.",
    Law.BY_FIELDS: "*ELASTIC\n1., 0.3, 0.\n2., 0.3, 1.",
    Law.PLASTIC: "*PLASTIC\n1., 0.",
    Law.KINEMATIC: "*PLASTIC, HARDENING=KINEMATIC\n1., 0.\n2., 1.",
    Law.UHARD: "*PLASTIC, HARDENING=USER, PROPERTIES=1\n1.",
    Law.HYPERELASTIC: RUBBER,
    Law.HYPERELASTIC_0: "*HYPERELASTIC, NEO HOOKE\n1., 0.",
    Law.UHYPER: "*HYPERELASTIC, USER, TYPE=COMPRESSIBLE, PROPERTIES=1\n1.",
    Law.UHYPER_0: "*HYPERELASTIC, USER, PROPERTIES=1\n1.",
    Law.HOLZAPFEL: f"{FIBRES.format('HOLZAPFEL, ')}\n1., 0.1, 1., 1., 0.",
    Law.HOLZAPFEL_0: f"{FIBRES.format('HOLZAPFEL, ')}\n1., 0., 1., 1., 0.",
    Law.INVARIANTS: f"{FIBRES.format('USER, TYPE=COMPRESSIBLE, FORMULATION=INVARIANT, ')}, PROPERTIES=1\n1.",
    Law.INVARIANTS_0: f"{FIBRES.format('USER, FORMULATION=INVARIANT, ')}, PROPERTIES=1\n1.",
    Law.VISCOELASTIC: "*VISCOELASTIC, TIME=PRONY\n0.1, 0., 1.",
    Law.NETWORKS: f"{RUBBER}\n*VISCOELASTIC, NONLINEAR, NETWORKID=1, SRATIO=0.5, LAW=STRAIN\n1., 1., 0.",
    Law.CREEP: "*CREEP\n1., 1., 0.",
    Law.UMAT: "*USER MATERIAL, CONSTANTS=1\n1.",
    Law.UMAT_0: "*USER MATERIAL, CONSTANTS=1, HYBRID FORMULATION=INCOMPRESSIBLE\n1.",
    Law.EXPANSION: "*EXPANSION\n1.",
    Law.EXPANSION_DIRECTED: "*EXPANSION, TYPE=ORTHO\n1., 2., 3.",
    Law.DAMAGE: "*DAMAGE INITIATION, CRITERION=MAXS\n1., 1., 1.",
    Law.USDFLD: "*USER DEFINED FIELD",
    Law.UVARM: "*USER OUTPUT VARIABLES\n1",
    Law.CONDUCTIVITY: "*CONDUCTIVITY\n1.",
    Law.SPECIFIC_HEAT: "*SPECIFIC HEAT\n1.",
    Law.LATENT_HEAT: "*LATENT HEAT\n1., 0., 1.",
    Law.HETVAL: "*HEAT GENERATION",
    Law.UMATHT: "*USER MATERIAL, TYPE=THERMAL, CONSTANTS=1\n1.",
    Law.DIFFUSIVITY: "*DIFFUSIVITY\n1.",
    Law.SOLUBILITY: "*SOLUBILITY\n1.",
    Law.PIEZOELECTRIC: "*PIEZOELECTRIC\n1., 0., 0., 0., 0., 0., 1., 0.\n0., 0., 0., 0., 1., 0., 0., 0.\n0., 0.",
    Law.DIELECTRIC: "*DIELECTRIC\n1.",
}
SECTIONS = {
    Formulation.COHESIVE: ", RESPONSE=TRACTION SEPARATION",
    Formulation.GENERALISED: ", REF NODE=8",
    Formulation.GENERALISED_HYBRID: ", REF NODE=8",
    Formulation.PLANE_BEAM: ", SECTION=CIRC",
    Formulation.BEAM: ", SECTION=CIRC",
}
PROCEDURES = {
    Formulation.HEAT: "*HEAT TRANSFER, STEADY STATE\n1., 1.",
    Formulation.DIFFUSION: "*MASS DIFFUSION, STEADY STATE\n1., 1.",
    **dict.fromkeys(
        (Formulation.COUPLED, Formulation.COUPLED_PLANE_STRESS, Formulation.COUPLED_HYBRID),
        "*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE\n1., 1.",
    ),
}
WITH_MATERIAL = [each for each, support in FORMULATIONS.items() if support.laws and each is not Formulation.USER]


def material_of(formulation, law):
    """A material that has a law, beside what it needs."""
    keyword = TEXTS[law].split("\n", maxsplit=1)[0]
    gives_stress = keyword.startswith(("*ELASTIC", "*HYPER", "*ANISO", "*USER M")) and law is not Law.UMATHT
    replaced = ("*ELASTIC", keyword) if gives_stress or law is Law.NETWORKS else (keyword,)
    parts = re.split(r"\n(?=\*)", BASE.get(formulation, ELASTIC))
    return "\n".join([*(part for part in parts if not part.startswith(replaced)), TEXTS[law]])


def deck_of(formulation, material, step="*STEP, NLGEOM"):
    name = next(
        (name for name in types_of(formulation) if re.fullmatch(r"C3D8\w*(?<!E)|CPS4E|S4|SC8R|M3D4|COH3D8", name)), None
    )
    name = name or types_of(formulation)[0]
    kind = BUILT_IN[name]
    step = "*STEP" if formulation is Formulation.PIEZOELECTRIC else step
    section = f"*{kind.section}, ELSET=E{SECTIONS.get(formulation, '')}"
    section += ", COMPOSITE\n1., 1, M" if formulation is Formulation.LAYERED else ", MATERIAL=M\n1."
    more = "*TRANSVERSE SHEAR STIFFNESS\n1., 1.\n" if "SHELL" in section or "BEAM" in section else ""
    return (
        f"{NODES}*ELEMENT, TYPE={name}, ELSET=E\n1, {', '.join(str(k + 1) for k in range(kind.nodes))}\n"
        f"{section}\n{more}*MATERIAL, NAME=M\n{material}\n{step}\n"
        f"{PROCEDURES.get(formulation, '*STATIC')}\n*BOUNDARY\n1, {kind.dofs(0)[0]}\n*END STEP\n"
    )


@pytest.mark.parametrize("formulation", WITH_MATERIAL, ids=str)
def test_laws(tmp_path, formulation):
    """Each cell of the page: what is supported is built, or misses its routine; the rest is refused."""
    library = usersub.load(None, job="job", output_dir=tmp_path)
    wrong = []
    for law in Law:
        (tmp_path / "deck.inp").write_text(deck_of(formulation, material_of(formulation, law)))
        model = read_deck(tmp_path / "deck.inp")
        section = model.groups[0].section
        material = section.layers[0].material if hasattr(section, "layers") else section.material
        assert law in laws_of(material)
        error = ""
        try:
            build_blocks(model, library)
        except DeckError as found:
            error = str(found).replace(f"{tmp_path}/", "")
        refused = re.search(r"inp:\d+: \*[^;]* is not supported for elements of type", error) is not None
        missing = re.search(r" needs [A-Z_]+; ", error) is not None
        if refused != (CELLS[law, MANUAL.label(formulation)] == NO) or (error and not refused and not missing):
            wrong.append(f"{law}: {error}")
    assert wrong == []


@dataclass(frozen=True)
class LinkType:
    """An axial spring of the stiffness that is the thickness of its section."""

    section: ClassVar = "SOLID SECTION"
    formulation: ClassVar = "links"
    name: str = "LINK2"
    nodes: int = 2
    dimension: int = 3

    def dofs(self, node):
        return (1, 2, 3)


def link_block(building, group):
    routine = Routine(
        address=_binding.address_of("discrete"),
        jtype=DiscreteKind.AXIAL_SPRING,
        mcrd=3,
        svars=2,
        props=np.array([group.section.thickness]),
        jprops=np.zeros(0, dtype=np.int64),
    )
    return nodal_block(building, group, group.built_in, routine, None)


LINK = f"{NODES}*ELEMENT, TYPE=LINK2, ELSET=E\n1, 1, 2\n*SOLID SECTION, ELSET=E, MATERIAL=M\n4.\n*MATERIAL, NAME=M\n"
PULL = "*STEP\n*STATIC\n*BOUNDARY\n1, 1, 3\n2, 2, 3\n*CLOAD\n2, 1, 2.\n*END STEP\n"


def test_family_of_its_own(tmp_path, monkeypatch):
    """A type, its builder and a column of the table: three files, and the rest takes it from there."""
    monkeypatch.setitem(BUILT_IN, "LINK2", LinkType())
    monkeypatch.setitem(FORMULATIONS, "links", Support(SolidSection, link_block, frozenset({Law.ISOTROPIC})))
    (tmp_path / "link.inp").write_text(f"{LINK}{ELASTIC}\n{PULL}")
    displacements = uel.run(tmp_path / "link.inp", output_dir=tmp_path, quiet=True).field("U")
    assert displacements[1, 0] == pytest.approx(0.5)
    (tmp_path / "link.inp").write_text(f"{LINK}{RUBBER}\n{PULL}")
    message = r"link\.inp:\d+: \*HYPERELASTIC is not supported for elements of type LINK2 .*; supported: continuum"
    with pytest.raises(DeckError, match=message):
        uel.run(tmp_path / "link.inp", output_dir=tmp_path, quiet=True)


def test_type_of_a_family(tmp_path, monkeypatch):
    """One row: reader, section, loads, output and element are those of its family."""
    monkeypatch.setitem(BUILT_IN, "BRICK", replace(CONTINUUM["C3D8"], name="BRICK"))
    found = []
    for name in ("C3D8", "BRICK"):
        text = deck_of(Formulation.SOLID, ELASTIC, "*STEP").replace("TYPE=C3D8", f"TYPE={name}")
        text = text.replace("*BOUNDARY\n1, 1", "*DLOAD\nE, P2, 1.\n*BOUNDARY\n1, 1, 3\n2, 1, 3\n3, 1, 3\n4, 1, 3")
        (tmp_path / f"{name}.inp").write_text(text)
        found.append(uel.run(tmp_path / f"{name}.inp", output_dir=tmp_path, quiet=True).field("U"))
    np.testing.assert_array_equal(found[0], found[1])
    assert np.abs(found[0]).max() > 0.1
