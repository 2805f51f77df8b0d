# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m uel.cli` is `uel`."""

import sys

from uel.cli.command import main

sys.exit(main())
