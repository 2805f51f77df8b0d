# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Import of the compiled host (fortran/host), whose typed interface is in `_binding` and its siblings.

The extension is loaded with RTLD_GLOBAL: user libraries find XIT, MATERIAL_LIB_MECH and the rest in it by name.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uel.errors import UelError

# threads that wait for each other give their core away soon: on a busy machine another process has work for it
os.environ.setdefault("GOMP_SPINCOUNT", "2000")
_flags = sys.getdlopenflags()
sys.setdlopenflags(_flags | os.RTLD_GLOBAL)
try:
    from uel.usersub import _host as host
except ImportError as error:
    raise UelError(f"the compiled host does not load: {error}; `uel doctor` says what to do") from None
finally:
    sys.setdlopenflags(_flags)


def padded(names: Sequence[str]) -> NDArray[np.bytes_]:
    """Return the names as CHARACTER*80."""
    return np.array([name.ljust(80) for name in names], dtype="S80")


__all__ = ["host", "padded"]
