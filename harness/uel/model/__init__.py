# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The data everything else exchanges: the flattened model of a deck and the records of a run."""
