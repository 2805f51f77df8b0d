# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Delamination specimens: deck builders, beam theory, measures of a run, and the demonstration."""
