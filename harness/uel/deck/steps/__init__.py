# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*STEP: procedures, loads, prescribed values, controls and output requests."""
