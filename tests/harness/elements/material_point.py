# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""One point of a built-in material, as MATERIAL_LIB_MECH gives it to UELMAT."""

import numpy as np

COMPONENTS = {"PSTRESS": [0, 1, 3], "PSTRAIN": [0, 1, 2, 3], "TWOD": [0, 1, 2, 3], "THREED": [0, 1, 2, 3, 4, 5]}


class MaterialPoint:
    """One material point of a UELMAT whose unknowns are its strains."""

    def __init__(self, library, block, matrix, call):
        self.library, self.block, self.matrix, self.call = library, block, matrix, call
        self.n = matrix.shape[0]

    def __call__(self, strain, increment=None):
        """Stress and tangent at a strain; the increment is the whole strain unless given."""
        strain = np.array(strain, dtype=float)
        minus_stress = np.zeros(self.n)
        self.matrix.data[:] = 0
        du = strain if increment is None else np.array(increment, dtype=float)
        self.report = self.block.evaluate(self.call, strain, du, minus_stress, self.matrix.data)
        return -minus_stress, self.matrix.toarray()

    def free(self, prescribed, start):
        """Strains and stresses with the prescribed strains {component: value} and no other stress, by Newton."""
        strain = np.array(start, dtype=float)
        others = [k for k in range(self.n) if k not in prescribed]
        for component, value in prescribed.items():
            strain[component] = value
        for _ in range(50):
            stress, tangent = self(strain)
            if abs(stress[others]).max() < 1e-9 * abs(stress).max():
                return strain, stress
            strain[others] -= np.linalg.solve(tangent[np.ix_(others, others)], stress[others])
        raise AssertionError(f"stresses {stress} remain at {strain}")
