# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks of the memory that a call reads and writes, and of what it leaves to later calls."""
