# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Nodes, elements, sets, surfaces and systems of parts, instances and the assembly."""
