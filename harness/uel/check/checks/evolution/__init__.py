# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks of what goes from increment to increment: energy, state variables, size of the increments."""
