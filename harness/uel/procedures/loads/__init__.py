# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Loads, prescribed values, predefined fields and initial states through the steps."""
