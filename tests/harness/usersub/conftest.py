# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
import pytest

from uel import usersub


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    """Every test compiles anew, into its own cache folder."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "uel" / "compiled"


@pytest.fixture
def load(tmp_path):
    """Load a text as user routines; the file's name decides its form."""
    loaded = []

    def load(text, name="user.f", *, deck=None, output_dir=None):
        file = tmp_path / name
        file.write_text(text)
        loaded.append(usersub.load(file, job="job", output_dir=output_dir or tmp_path / "out", deck=deck))
        return loaded[-1]

    yield load
    for library in loaded:
        library.close()
