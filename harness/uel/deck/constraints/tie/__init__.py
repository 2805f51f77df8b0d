# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""*TIE: its reader, the faces of its surfaces, and the weights of main nodes by projection or as means."""
