# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Families of built-in elements: the routine that the driver calls, properties and state variables."""
