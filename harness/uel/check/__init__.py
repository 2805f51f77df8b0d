# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks of user elements on the recorded and replayed calls of a deck, one file per check."""
