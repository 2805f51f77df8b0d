# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The command `uel`, also as `python -m uel`."""

import signal
import sys

if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    # until `main` takes interrupts they end the process without a traceback
    signal.signal(signal.SIGINT, signal.SIG_DFL)

from uel.cli import main
from uel.interrupts import take_interrupts


def command() -> int:
    """Take interrupts, and run the command; returns the exit code."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_DFL:
        try:
            take_interrupts()
            return main()
        except KeyboardInterrupt:
            return 1
    return main()


if __name__ == "__main__":
    sys.exit(command())
