# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks of single arguments and of calls before the first increment: inputs, loads, DTIME, KINC, PNEWDT."""
