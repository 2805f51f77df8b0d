# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The table of formulations: which element types support which materials, steps and features, and its refusals.

`docs/generated.py` prints it in the manual.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Final, NamedTuple

from uel.elements.block import ElementBlock
from uel.elements.building import Building
from uel.elements.directions import first_element, is_user
from uel.elements.families.beam import beam_block
from uel.elements.families.cohesive import cohesive_block
from uel.elements.families.composite import composite_block
from uel.elements.families.continuum_shell import continuum_shell_block
from uel.elements.families.coupled import coupled_block, heat_block
from uel.elements.families.discrete import discrete_block
from uel.elements.families.generalised import generalised_block
from uel.elements.families.mass_diffusion import mass_diffusion_block
from uel.elements.families.membrane import membrane_block
from uel.elements.families.piezoelectric import piezoelectric_block
from uel.elements.families.shell import shell_block
from uel.elements.families.solid import solid_block
from uel.elements.families.user import user_block
from uel.elements.materials.laws import Law, laws_of
from uel.elements.materials.library import state_variables
from uel.errors import DeckError, Source, unsupported
from uel.model.element_types import Formulation
from uel.model.mesh import ElementGroup
from uel.model.model import Model
from uel.model.perturbations import Buckle, Frequency, ModalDynamic, StaticPerturbation, SteadyState
from uel.model.procedures import (
    CoupledTemperatureDisplacement,
    Dynamic,
    Geostatic,
    HeatTransfer,
    MassDiffusion,
    Riks,
    Static,
    Visco,
)
from uel.model.properties import (
    BeamSection,
    CohesiveSection,
    CompositeSection,
    MassSection,
    Material,
    MembraneSection,
    Orientation,
    RigidSection,
    Section,
    ShellSection,
    SolidSection,
    SpringSection,
    UserProperty,
    materials_of,
)
from uel.model.steps import Step


class Feature(StrEnum):
    """Options of a section or of the start of an analysis; values are their names in messages and in the manual."""

    VARYING = "*ORIENTATION with directions that differ from point to point"
    ORIENT = "*ORIENTATION, SYSTEM=USER"
    STRESS = "*INITIAL CONDITIONS, TYPE=STRESS"
    SDVINI = "SDVINI"
    ENHANCED = "*SECTION CONTROLS, HOURGLASS=ENHANCED"


class Limit(NamedTuple):
    """Steps that elements or materials do not support, and why."""

    refuses: Callable[[Step], bool]
    reason: str = ""


class Exclusion(NamedTuple):
    """Sets of laws and features: one of each set together are not supported; and the input expected instead."""

    sets: tuple[frozenset[str], ...]
    expected: str = ""


@dataclass(frozen=True)
class Support:
    """A column of the table: what elements of a formulation support.

    section          class of their section
    build            builder of a block of them
    laws             laws that their material may have
    ignored          laws that it may have without effect: those of fields that they do not have
    needs            sets of laws: it has at least one of each, besides a law for stresses if `laws` has any
    exclusions       laws and features that exclude each other
    limits           steps that they do not support
    features         features that they support
    mechanical_only  whether they have no effect in steps without displacements
    needs_density    whether they need *DENSITY in *DYNAMIC
    reasons          why they do not support a law
    """

    section: type
    build: Callable[[Building, ElementGroup], ElementBlock]
    laws: frozenset[Law] = frozenset()
    ignored: frozenset[Law] = frozenset()
    needs: tuple[frozenset[Law], ...] = ()
    exclusions: tuple[Exclusion, ...] = ()
    limits: tuple[Limit, ...] = ()
    features: frozenset[Feature] = frozenset()
    mechanical_only: bool = True
    needs_density: bool = False
    reasons: Mapping[Law, str] = field(default_factory=dict)

    @property
    def stresses(self) -> frozenset[Law]:
        """Laws of which a material needs one."""
        return self.laws & _STRESSES

    def supports(self, step: Step) -> bool:
        """Return whether elements support a step."""
        return not _exceeds(step, self.limits)


def _exceeds(step: Step, limits: Iterable[Limit]) -> bool:
    return any(limit.refuses(step) for limit in limits)


def _laws(*laws: Law | Iterable[Law]) -> frozenset[Law]:
    return frozenset().union(*({law} if isinstance(law, Law) else law for law in laws))


_DIRECTED: Final = _laws(Law.ISOTROPIC, Law.ENGINEERING, Law.ORTHOTROPIC, Law.ANISOTROPIC)
_ELASTIC: Final = _laws(_DIRECTED, Law.LAMINA, Law.TRACTION, Law.HALF)
_FIELDS: Final = _laws(Law.BY_FIELDS, Law.USDFLD)
_HARDENING: Final = _laws(Law.PLASTIC, Law.KINEMATIC)
_PLASTIC: Final = _laws(_HARDENING, Law.UHARD)
_VISCOUS: Final = _laws(Law.VISCOELASTIC, Law.CREEP)
_COEFFICIENTS: Final = _laws(Law.HYPERELASTIC, Law.HOLZAPFEL)
_RUBBER: Final = _laws(_COEFFICIENTS, Law.UHYPER, Law.INVARIANTS)
_INCOMPRESSIBLE: Final = _laws(Law.HYPERELASTIC_0, Law.UHYPER_0, Law.HOLZAPFEL_0, Law.INVARIANTS_0)
_USER: Final = _laws(Law.UMAT, Law.UMAT_0)
_STRESSES: Final = _laws(_ELASTIC, _RUBBER, _INCOMPRESSIBLE, _USER)
OF_HEAT: Final = _laws(Law.CONDUCTIVITY, Law.SPECIFIC_HEAT, Law.LATENT_HEAT, Law.HETVAL, Law.UMATHT)
_DIFFUSION: Final = _laws(Law.DIFFUSIVITY, Law.SOLUBILITY)
_ELECTRIC: Final = _laws(Law.PIEZOELECTRIC, Law.DIELECTRIC)
_MECHANICAL: Final = _laws(
    _STRESSES, Law.BY_FIELDS, _PLASTIC, _VISCOUS, Law.NETWORKS, Law.EXPANSION, Law.EXPANSION_DIRECTED, Law.DAMAGE
)
_EXPANSION: Final = _laws(Law.EXPANSION, Law.EXPANSION_DIRECTED)

_ALL_RUBBER: Final = _laws(_RUBBER, _INCOMPRESSIBLE)
_LAW_EXCLUSIONS: Final = (
    Exclusion((_laws(Law.VISCOELASTIC), _laws(Law.CREEP))),
    Exclusion((_VISCOUS, _laws(_PLASTIC, _ALL_RUBBER, _USER))),
    Exclusion((_PLASTIC, _USER)),
    Exclusion((_VISCOUS, _laws(Law.BY_FIELDS, _ELASTIC - {Law.ISOTROPIC})), f"{Law.ISOTROPIC} with constant values"),
    Exclusion((_PLASTIC, _ELASTIC - {Law.ISOTROPIC, Law.HALF}), Law.ISOTROPIC),
    Exclusion((_ALL_RUBBER, _laws(_ELASTIC, _PLASTIC, _USER)), "only one of them"),
    Exclusion((_ALL_RUBBER, _laws(Law.EXPANSION_DIRECTED)), "TYPE=ISO"),
    Exclusion(
        (_laws(Law.NETWORKS), _STRESSES - {Law.HYPERELASTIC, Law.HYPERELASTIC_0}), f"{Law.HYPERELASTIC} by coefficients"
    ),
    Exclusion((_laws(Law.NETWORKS), _EXPANSION)),
)
_STRESS: Final = frozenset({Feature.STRESS})
_STRESS_EXCLUSIONS: Final = (
    Exclusion((_STRESS, _laws(_ALL_RUBBER, Law.HALF, Law.UMAT_0, Law.VISCOELASTIC))),
    Exclusion((_STRESS, _laws(Law.BY_FIELDS), _laws(Law.USDFLD))),
)
_HEAT_EXCLUSIONS: Final = (Exclusion((_laws(Law.HETVAL), _laws(Law.UMATHT))),)

_NO_DIFFUSION: Final = Limit(lambda step: step.procedure.concentrations, "they have no concentrations")
_SMALL_ROTATIONS: Final = Limit(
    lambda step: step.nlgeom and step.procedure.inertia, "their inertia is that of small rotations"
)
_NO_MASS: Final = Limit(
    lambda step: (
        step.procedure.inertia or step.procedure.finds_modes or step.procedure.harmonic or step.procedure.modal
    ),
    "it needs a mass, and that of their bounding planes is not documented",
)
_SMALL_STATICS: Final = Limit(
    lambda step: (
        step.nlgeom
        or step.procedure.inertia
        or step.procedure.temperatures
        or step.procedure.buckles
        or step.procedure.riks is not None
    ),
    "their potential is that of small displacements",
)
_NO_BUCKLING: Final = Limit(lambda step: step.procedure.buckles, "no call asks them for their initial stress matrix")
_NO_TIME: Final = Limit(lambda step: step.procedure.riks is not None, "no time passes")
_HEAT_STEPS: Final = Limit(
    lambda step: not (step.procedure.temperatures or step.procedure.concentrations), "they have no displacements"
)
_DIFFUSION_STEPS: Final = Limit(lambda step: not step.procedure.concentrations, "their dof 11 is a concentration")
_COUPLED_STEPS: Final = Limit(
    lambda step: not (step.procedure.temperatures and step.procedure.displacements),
    "they have displacements and temperatures",
)

_NO_PERTURBATION: Final = Limit(lambda step: step.procedure.linear, "its stresses depend on time")
LIMITS_OF_LAWS: Final[Mapping[Law, tuple[Limit, ...]]] = {
    **dict.fromkeys((*_VISCOUS, Law.NETWORKS), (_NO_PERTURBATION,)),
    # a yield stress that depends on the rate would let the stress of the base state relax
    Law.UHARD: (_NO_PERTURBATION,),
    **dict.fromkeys(_ALL_RUBBER, (Limit(lambda step: not step.nlgeom, "displacements are small without NLGEOM"),)),
}
"""Steps that materials do not support, whatever their elements are."""

_ALL: Final = frozenset(Feature)
_IGNORED: Final = _laws(OF_HEAT, _DIFFUSION, _ELECTRIC)
_SOLID: Final = Support(
    SolidSection,
    solid_block,
    _laws(_DIRECTED, _FIELDS, _PLASTIC, _VISCOUS, _RUBBER, Law.NETWORKS, Law.UMAT, _EXPANSION, Law.UVARM),
    ignored=_IGNORED,
    exclusions=(*_LAW_EXCLUSIONS, *_STRESS_EXCLUSIONS),
    limits=(_NO_DIFFUSION,),
    features=_ALL,
    needs_density=True,
)
_PLANE_STRESS: Final = replace(_SOLID, laws=_SOLID.laws - _RUBBER - {Law.NETWORKS} | {Law.LAMINA})
_HYBRID: Final = replace(
    _SOLID,
    laws=_laws(_SOLID.laws - _VISCOUS, _INCOMPRESSIBLE, Law.HALF, Law.UMAT_0),
    exclusions=(
        *_SOLID.exclusions,
        Exclusion((_laws(Law.HALF), _laws(_PLASTIC, _EXPANSION, Law.BY_FIELDS)), "nu < 0.5"),
    ),
)
_COUPLED: Final = replace(
    _SOLID,
    build=coupled_block,
    laws=_laws(_SOLID.laws - _VISCOUS - {Law.NETWORKS}, OF_HEAT),
    ignored=_laws(_DIFFUSION, _ELECTRIC),
    needs=(_laws(Law.CONDUCTIVITY, Law.UMATHT),),
    # points of UMATHT are others than those of the stresses, where USDFLD is called
    exclusions=(*_SOLID.exclusions, *_HEAT_EXCLUSIONS, Exclusion((_laws(Law.USDFLD), _laws(Law.UMATHT)))),
    limits=(_COUPLED_STEPS,),
)
_PLANES: Final = replace(
    _SOLID,
    build=generalised_block,
    laws=_SOLID.laws - _RUBBER - {Law.NETWORKS},
    limits=(_NO_DIFFUSION, _NO_MASS),
    needs_density=False,
)
_SURFACE: Final = Support(
    ShellSection,
    shell_block,
    _laws(_DIRECTED, Law.LAMINA, _FIELDS, _HARDENING, Law.UMAT, Law.UVARM),
    ignored=_IGNORED,
    exclusions=_LAW_EXCLUSIONS,
    limits=(_NO_DIFFUSION,),
    features=frozenset({Feature.VARYING, Feature.ENHANCED}),
    needs_density=True,
)
_LINE: Final = Support(
    SolidSection,
    discrete_block,
    _laws(Law.ISOTROPIC, Law.HALF, _FIELDS, Law.PLASTIC, Law.UMAT, Law.UVARM),
    ignored=_IGNORED,
    exclusions=_LAW_EXCLUSIONS,
    limits=(_NO_DIFFUSION,),
)
_BEAM: Final = replace(_LINE, section=BeamSection, build=beam_block, laws=_laws(_LINE.laws, _EXPANSION))
_WITHOUT_MATERIAL: Final = Support(SpringSection, discrete_block, limits=(_NO_DIFFUSION,))

FORMULATIONS: Final[Mapping[Formulation, Support]] = {
    Formulation.SOLID: _SOLID,
    Formulation.PLANE_STRESS: _PLANE_STRESS,
    Formulation.HYBRID: _HYBRID,
    # further unknowns leave no room for a pressure
    Formulation.HYBRID_MODES: replace(_SOLID, laws=_SOLID.laws - _VISCOUS - _COEFFICIENTS - {Law.NETWORKS}),
    Formulation.COUPLED: _COUPLED,
    Formulation.COUPLED_PLANE_STRESS: replace(_COUPLED, laws=_COUPLED.laws - _RUBBER | {Law.LAMINA}),
    Formulation.COUPLED_HYBRID: replace(_COUPLED, laws=_COUPLED.laws - _COEFFICIENTS),
    Formulation.GENERALISED: _PLANES,
    Formulation.GENERALISED_HYBRID: replace(_PLANES, laws=_PLANES.laws - _VISCOUS),
    Formulation.PIEZOELECTRIC: Support(
        SolidSection,
        piezoelectric_block,
        _laws(_DIRECTED, Law.LAMINA, _ELECTRIC),
        ignored=_laws(OF_HEAT, _DIFFUSION),
        needs=(_laws(Law.DIELECTRIC),),
        limits=(_NO_DIFFUSION, _SMALL_STATICS),
    ),
    Formulation.LAYERED: Support(
        CompositeSection,
        composite_block,
        _laws(_DIRECTED, _FIELDS, _HARDENING, Law.UMAT, _EXPANSION),
        ignored=_IGNORED,
        exclusions=_LAW_EXCLUSIONS,
        limits=(_NO_DIFFUSION,),
        features=frozenset({Feature.VARYING, Feature.ENHANCED}),
        needs_density=True,
    ),
    Formulation.HEAT: Support(
        SolidSection,
        heat_block,
        _laws(OF_HEAT, Law.USDFLD, Law.UVARM),
        ignored=_laws(_MECHANICAL, _DIFFUSION, _ELECTRIC),
        needs=(_laws(Law.CONDUCTIVITY, Law.UMATHT),),
        exclusions=_HEAT_EXCLUSIONS,
        limits=(_HEAT_STEPS,),
        mechanical_only=False,
        features=frozenset({Feature.VARYING, Feature.ORIENT, Feature.SDVINI}),
    ),
    Formulation.DIFFUSION: Support(
        SolidSection,
        mass_diffusion_block,
        _DIFFUSION,
        ignored=_laws(_MECHANICAL, OF_HEAT, _ELECTRIC),
        needs=(_laws(Law.DIFFUSIVITY), _laws(Law.SOLUBILITY)),
        limits=(_DIFFUSION_STEPS,),
        mechanical_only=False,
        features=frozenset({Feature.SDVINI}),
    ),
    Formulation.COHESIVE: Support(
        CohesiveSection,
        cohesive_block,
        _laws(Law.TRACTION, Law.DAMAGE),
        ignored=_IGNORED,
        limits=(_NO_DIFFUSION,),
        reasons={
            Law.UMAT: "Abaqus calls UMAT with separations and tractions; expected *ELASTIC, TYPE=TRACTION with *DAMAGE "
            "INITIATION and *DAMAGE EVOLUTION, or a user element instead"
        },
    ),
    Formulation.SHELL: replace(_SURFACE, limits=(_NO_DIFFUSION, _SMALL_ROTATIONS)),
    Formulation.CONTINUUM_SHELL: replace(_SURFACE, build=continuum_shell_block),
    Formulation.MEMBRANE: replace(
        _SURFACE,
        section=MembraneSection,
        build=membrane_block,
        exclusions=(*_LAW_EXCLUSIONS, *_STRESS_EXCLUSIONS),
        features=frozenset({Feature.VARYING, Feature.STRESS, Feature.SDVINI}),
    ),
    Formulation.PLANE_BEAM: _BEAM,
    Formulation.BEAM: replace(_BEAM, limits=(_NO_DIFFUSION, _SMALL_ROTATIONS)),
    Formulation.TRUSS: replace(
        _LINE, features=frozenset({Feature.VARYING, Feature.ORIENT, Feature.SDVINI}), needs_density=True
    ),
    Formulation.SPRING: _WITHOUT_MATERIAL,
    Formulation.DASHPOT: replace(_WITHOUT_MATERIAL, limits=(_NO_DIFFUSION, _NO_TIME)),
    Formulation.MASS: replace(_WITHOUT_MATERIAL, section=MassSection),
    Formulation.RIGID: replace(_WITHOUT_MATERIAL, section=RigidSection),
    Formulation.USER: Support(
        UserProperty,
        user_block,
        _laws(_DIRECTED, Law.LAMINA, _PLASTIC, _VISCOUS, Law.UMAT),
        ignored=_IGNORED,
        exclusions=_LAW_EXCLUSIONS,
        limits=(_NO_DIFFUSION, _NO_BUCKLING),
        mechanical_only=False,
        features=frozenset({Feature.SDVINI}),
    ),
}
"""Support of each formulation."""

_STEPS: Final = tuple(
    Step(1, "", procedure, Source("", 0))
    for procedure in (
        Static(),
        Static(riks=Riks()),
        Visco(),
        Geostatic(),
        Dynamic(),
        HeatTransfer(),
        CoupledTemperatureDisplacement(),
        MassDiffusion(),
        StaticPerturbation(),
        Frequency(),
        Buckle(),
        SteadyState(),
        ModalDynamic(),
    )
)


def name_of(step: Step) -> str:
    """Return the name of the procedure of a step, for messages and the manual."""
    procedure = step.procedure
    options = {
        "RIKS": procedure.riks is not None,
        "PERTURBATION": procedure.linear
        and not any((procedure.finds_modes, procedure.buckles, procedure.harmonic, procedure.modal)),
    }
    return ", ".join([f"*{procedure.keyword}", *(name for name, given in options.items() if given)])


STEPS: Final[Mapping[str, Step]] = {name_of(step): step for step in _STEPS}
"""A step of each procedure, by its name."""


def formulation_of(model: Model, group: ElementGroup) -> Formulation | None:
    """Return the formulation of a group, None if the type has none."""
    if group.definition is not None:
        return Formulation.USER
    kind = group.built_in
    if kind is None:
        return None
    if isinstance(group.section, CompositeSection):
        return Formulation.LAYERED
    found = kind.formulation
    return Formulation.DIFFUSION if found is Formulation.HEAT and model.diffusive else found


def elements_of(group: ElementGroup) -> str:
    """Name the elements of a group, for messages."""
    if group.definition is not None:
        return f"user elements ({group.type})"
    return f"elements of type {group.type}{' with layers' if isinstance(group.section, CompositeSection) else ''}"


def check_support(model: Model, group: ElementGroup, support: Support) -> None:
    """Check the material, features and steps of a group against its formulation. Raises DeckError."""
    elements = elements_of(group)
    stressed = bool(support.stresses) and group.definition is None
    features = dict(_features(model, group, stressed=stressed))
    for material in {material.name: material for material in materials_of(group.section)}.values():
        _check_material(material, features, support, elements, group.section.source)
        for law, source in laws_of(material).items():
            _check_steps(model.steps, LIMITS_OF_LAWS.get(law, ()), f"material {material.name} with {law} ({source})")
    for feature, source in features.items():
        if feature not in support.features:
            have = (name for name, other in FORMULATIONS.items() if feature in other.features)
            where = f"{elements} (section at {group.section.source})"
            raise unsupported(source, feature, where, instead=_instead(have))
    _check_steps(model.steps, support.limits, elements, mechanical_only=support.mechanical_only)
    dynamic = any(step.procedure.inertia for step in model.steps)
    for material in materials_of(group.section):
        if dynamic and support.needs_density and not material.density:
            message = f"material {material.name} has no *DENSITY, which {elements} need in *DYNAMIC"
            raise DeckError(material.source, f"{message} (section at {group.section.source})")


def _check_material(
    material: Material, features: Mapping[Feature, Source], support: Support, elements: str, section: Source
) -> None:
    """Check that a material has no law that is not supported and lacks none. Raises DeckError."""
    where, place = f"{elements} (material {material.name}, section at {section})", f" (section at {section})"
    laws = laws_of(material)
    for law, source in laws.items():
        if law not in support.laws | support.ignored:
            have = (name for name, other in FORMULATIONS.items() if law in other.laws)
            raise unsupported(source, law, where, reason=support.reasons.get(law, ""), instead=_instead(have))
    for needed in (support.stresses, *support.needs):
        if needed and not needed & laws.keys():
            in_short = needed <= _STRESSES and len(needed) > 1
            words = list(dict.fromkeys(law.keyword if in_short else law for law in Law if law in needed))
            listed = f"{', '.join(words[:-1])} or {words[-1]}" if len(words) > 1 else words[0]
            raise DeckError(material.source, f"material {material.name} has no {listed}, which {elements} need{place}")
    sources: dict[str, Source] = {name: place for part in (features, laws) for name, place in part.items()}
    for sets, expected in support.exclusions:
        if all(names & sources.keys() for names in sets):
            together = [next(name for name in sources if name in names) for names in sets]
            instead = f"expected {expected}" if expected else ""
            raise unsupported(sources[together[0]], " beside ".join(together), where, instead=instead)


def _check_steps(steps: Iterable[Step], limits: Sequence[Limit], where: str, *, mechanical_only: bool = False) -> None:
    """Check the steps. Raises DeckError, which names those that are supported, or NLGEOM if that is the reason."""
    for step in (step for step in steps if _exceeds(step, limits)):
        reason = next(limit.reason for limit in limits if limit.refuses(step))
        name, other = name_of(step), replace(step, nlgeom=not step.nlgeom)
        if not _exceeds(other, limits):
            name += " with NLGEOM" if step.nlgeom else ""
            instead = f"supported {'without' if step.nlgeom else 'with'} NLGEOM"
        else:
            instead = _instead(
                name
                for name, each in STEPS.items()
                if (each.procedure.displacements or not mechanical_only)
                and not (_exceeds(each, limits) and _exceeds(replace(each, nlgeom=True), limits))
            )
        raise unsupported(step.source, name, where, reason=reason, instead=instead)


_MOST_NAMED: Final = 5
"""Names in a message; the manual has all of them."""


def _instead(names: Iterable[str]) -> str:
    """Return the end of a message: the names that are supported."""
    listed = list(names)
    more = f" and {len(listed) - _MOST_NAMED} more" if len(listed) > _MOST_NAMED else ""
    return f"supported: {', '.join(listed[:_MOST_NAMED])}{more}" if listed else ""


def _features(model: Model, group: ElementGroup, *, stressed: bool) -> Iterator[tuple[Feature, Source]]:
    """Yield the features of a group, each with its source. User elements get no initial stresses in Abaqus."""
    section = group.section
    for orientation in _orientations(section):
        if orientation.system is not None:
            yield Feature.ORIENT if is_user(orientation) else Feature.VARYING, orientation.source
    first = first_element(model, group)
    for entry in model.initial_stresses if stressed else ():
        if ((entry.elements >= first) & (entry.elements < first + len(group.labels))).any():
            yield Feature.STRESS, entry.source
    user = next((entry for entry in model.initial_solutions if entry.elements is None), None)
    if user is not None and any(map(state_variables, materials_of(section))):
        yield Feature.SDVINI, user.source
    controls = getattr(section, "controls", None)
    if controls is not None and controls.enhanced and getattr(group.built_in, "hourglass_control", False):
        yield Feature.ENHANCED, section.source


def _orientations(section: Section) -> Iterator[Orientation]:
    """Yield the orientations of a section or of its layers."""
    layers = section.layers if isinstance(section, CompositeSection) else (section,)
    for part in layers:
        orientation = getattr(part, "orientation", None)
        if orientation is not None:
            yield orientation
