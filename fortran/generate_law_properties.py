# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Write the Fortran module cohesive_law_properties, the values of LAW and the properties of the cohesive laws.

The build calls it. The generator of abaqus_layout, which reads the same file, refuses what is wrong in it.
"""

from __future__ import annotations

import tomllib

from generate_layout import laws_of, main, parameter, properties_of_law

HEAD = """\
! SPDX-FileCopyrightText: The uel-harness authors
! SPDX-License-Identifier: BSD-3-Clause
!> The values of LAW, and the properties of the cohesive laws as a deck has them. Written by generate_law_properties.py
!> from properties.toml: edit that, not this file.
module cohesive_law_properties
  use core_kinds, only: dp
  implicit none(type, external)
  private
"""


def layout(text: str) -> str:
    """Text of the module, from that of properties.toml."""
    data = tomllib.loads(text)
    lines = [parameter(f"{name}_law", number) for number, name in enumerate(laws_of(data), start=1)]
    lines += ["", "  type, public :: law_properties"]
    for row in properties_of_law(data):
        lines += [f"    !> {row['meaning']}, {row['unit']}", f"    real(dp) :: {row['name'].lower()} = 0.0_dp"]
    return "\n".join([HEAD, *lines, "  end type law_properties", "", "end module cohesive_law_properties"]) + "\n"


if __name__ == "__main__":
    main(layout, __doc__)
