# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Properties of the laws of several lines, for the tests that go over all laws."""

BRIDGING = {"LAW": 5, "ETA": 1.45, "SIGMABRIDGE": 5.0, "TAUBRIDGE": 12.0, "GIBRIDGE": 0.1, "GIIBRIDGE": 0.3}
TABLE = {"LAW": 6, "SEPARATION1": 0.2, "TRACTION1": 1.0, "SEPARATION2": 0.5, "TRACTION2": 0.2}
