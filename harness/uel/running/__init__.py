# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run a job: in one process or several, from the start or a restart, isolated from what user code does."""
