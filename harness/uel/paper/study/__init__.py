# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Parameter study: specimens, layups, stiffnesses, elements and meshes in one table, and criteria for it."""
