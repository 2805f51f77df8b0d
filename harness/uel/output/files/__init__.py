# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of a job: .dat, .msg, .sta, history, interface, field output and kept states."""
