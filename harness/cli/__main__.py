# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m harness.cli` is `uel`."""

import sys

from harness.cli.command import main

sys.exit(main())
