# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples of hypothesis: the same in every run, whatever the machine; others with --hypothesis-profile=other."""

from hypothesis import settings

# no deadline: another program may take the processor for a while
settings.register_profile("same", deadline=None, derandomize=True)
settings.register_profile("other", deadline=None, print_blob=True)
settings.load_profile("same")
