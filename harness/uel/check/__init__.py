# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks of user elements with the calls of a deck: one file per check, on a run that is recorded and replayed."""
