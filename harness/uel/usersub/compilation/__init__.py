# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compile and link a user's files as Abaqus does, with the diagnostics of the compiler."""
