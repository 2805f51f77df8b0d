# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks of the user's files and of the run of the deck, which call no element; debug replays the run."""
