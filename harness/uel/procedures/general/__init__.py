# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""General steps: increments brought into equilibrium by Newton's method."""
