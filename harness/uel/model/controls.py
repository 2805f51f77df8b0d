# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Solution controls (*CONTROLS) with Abaqus' defaults: tolerances, time incrementation, line search."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class FieldControls:
    """*CONTROLS, PARAMETERS=FIELD; names and defaults of the Abaqus manual.

    r_n residual, c_n correction, q_0 initial and q_u user-defined average flux (0: not set), r_p residual after
    i_p iterations, eps zero flux, c_eps correction at zero flux, r_l residual of a linear increment, c_f field
    conversion ratio, eps_l zero flux beside the time average of the largest one.
    """

    r_n: float = 5e-3
    c_n: float = 1e-2
    q_0: float = 0.0
    q_u: float = 0.0
    r_p: float = 2e-2
    eps: float = 1e-5
    c_eps: float = 1e-3
    r_l: float = 1e-8
    c_f: float = 1.0
    eps_l: float = 1e-5


@dataclass(frozen=True, slots=True)
class TimeControls:
    """*CONTROLS, PARAMETERS=TIME INCREMENTATION; names and defaults of the Abaqus manual.

    i_s_c and i_j_c replace i_s and i_j with CONVERT SDI=YES.
    """

    i_0: int = 4
    i_r: int = 8
    i_p: int = 9
    i_c: int = 16
    i_l: int = 10
    i_g: int = 4
    i_s: int = 12
    i_a: int = 5
    i_j: int = 6
    i_t: int = 3
    i_s_c: int = 50
    i_j_c: int = 50
    d_f: float = 0.25
    d_c: float = 0.5
    d_b: float = 0.75
    d_a: float = 0.85
    d_s: float = 0.25
    d_h: float = 0.25
    d_d: float = 1.5
    w_g: float = 0.75
    d_g: float = 0.8
    d_m: float = 1.5
    d_m_dyn: float = 1.25
    d_m_diff: float = 2.0
    d_l: float = 0.95
    d_e: float = 0.1


@dataclass(frozen=True, slots=True)
class LineSearchControls:
    """*CONTROLS, PARAMETERS=LINE SEARCH; n_ls = 0 turns it off, which is the default of Newton's method."""

    n_ls: int = 0
    s_max: float = 1.0
    s_min: float = 1e-4
    f_s: float = 0.25
    eta_s: float = 0.10


@dataclass(frozen=True, slots=True)
class Controls:
    """Solution controls: `default` for all fields, `fields` by name ('DISPLACEMENT', ...) where they differ.

    volume   largest difference of the changes of volume of hybrid elements, by displacements and by pressure
    coupling  largest error of the displacement of the reference node of a distributing coupling, over its length
    coupling_rotation  that of its rotation (radians)
    contact  largest penetration of points in contact over the largest increment of displacement
    contact_force  largest force that points give up or take on in a severe discontinuity iteration, over the time
                   average force, if it may end the increment
    """

    default: FieldControls = field(default_factory=FieldControls)
    fields: dict[str, FieldControls] = field(default_factory=dict)
    time: TimeControls = field(default_factory=TimeControls)
    line_search: LineSearchControls = field(default_factory=LineSearchControls)
    volume: float = 1e-5
    coupling: float = 1e-5
    coupling_rotation: float = 1e-5
    contact: float = 5e-3
    contact_force: float = 1.0
