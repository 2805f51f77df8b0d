# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The first user routine that a process calls gets its arguments as later ones do."""

import subprocess
import sys

USER = """\
      subroutine uexternaldb(lop,lrestart,time,dtime,kstep,kinc)
      include 'aba_param.inc'
      dimension time(2)
      write (7,'(4i3,3f6.2)') lop, lrestart, kstep, kinc, time, dtime
      end
"""
CALL = """\
import sys
from pathlib import Path
from uel import usersub
library = usersub.load(Path(sys.argv[1]), job="job", output_dir=Path(sys.argv[2]))
library.external_database(2, 1, (1.5, 2.5), 0.25, 3, 4)
print(library.messages()[0].text)
"""


def test_arguments_of_the_first_call(tmp_path):
    """With some compiler options the C library loses registers at the first access of a thread to its variables."""
    file = tmp_path / "user.f"
    file.write_text(USER)
    found = subprocess.run(
        [sys.executable, "-c", CALL, str(file), str(tmp_path)], capture_output=True, text=True, check=True
    )
    assert list(map(float, found.stdout.split())) == [2, 1, 3, 4, 1.5, 2.5, 0.25]
