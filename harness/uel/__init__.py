# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run Abaqus decks with Abaqus user elements, without Abaqus."""

# without imports: until `main` takes interrupts, Python shows a traceback
TYPE_CHECKING = False
if TYPE_CHECKING:
    from uel.running.job import run
    from uel.running.options import RoutineOptions
    from uel.solver.options import SolverOptions

__all__ = ["RoutineOptions", "SolverOptions", "run"]

_MODULES = {"RoutineOptions": "uel.running.options", "SolverOptions": "uel.solver.options", "run": "uel.running.job"}


def __getattr__(name: str) -> object:
    """Load numpy and scipy where something is run: the command takes an interrupt from its first moment on."""
    if name not in _MODULES:
        raise AttributeError(f"module 'uel' has no attribute '{name}'")
    from importlib import import_module  # noqa: PLC0415

    return getattr(import_module(_MODULES[name]), name)
