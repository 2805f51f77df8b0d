# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Compile and link a user's files as Abaqus does, and say what the compiler says."""
