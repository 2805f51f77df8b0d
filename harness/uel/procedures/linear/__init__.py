# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Linear perturbation steps about the state at the end of the last general step."""
