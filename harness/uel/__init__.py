# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run Abaqus decks with Abaqus user elements, without Abaqus."""

# without imports: until `main` takes interrupts, Python shows a traceback
TYPE_CHECKING = False
if TYPE_CHECKING:
    from uel.running.job import run

__all__ = ["run"]


def __getattr__(name: str) -> object:
    """Load numpy and scipy where something is run: the command takes an interrupt from its first moment on."""
    if name != "run":
        raise AttributeError(f"module 'uel' has no attribute '{name}'")
    from uel.running.job import run  # noqa: PLC0415

    return run
