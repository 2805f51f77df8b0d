# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Loads and heat that enter built-in elements through faces and volumes."""
