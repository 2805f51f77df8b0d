# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Many runs: the engine that repeats nothing that is done, and `uel batch`."""
