# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks of RHS and AMATRX: tangent, symmetry, rigid-body motions, zero modes, patch test."""
