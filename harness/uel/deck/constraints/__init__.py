# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Equations, multi-point constraints, couplings, rigid bodies and ties."""
