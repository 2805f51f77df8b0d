# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""The process that is watched, and the signals that it gets."""

import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from uel.interrupts import ENDS, Interrupted, collected, held, raise_interrupts
from uel.running.isolation import _GLANCE, HANGS, End, _state, _Watch, run_isolated
from uel.shared_progress import Within, new_slate


@pytest.fixture
def module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Run a module of this text apart; returns how it ended, and what it said."""

    def run_module(text: str, call_limit: float = 0.0) -> tuple[End, str]:
        (tmp_path / "apart_module.py").write_text(text)
        monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
        with (tmp_path / "said").open("w") as errors:
            end = run_isolated("apart_module", [str(tmp_path)], call_limit, errors=errors)
        return end, (tmp_path / "said").read_text()

    return run_module


def test_exit_code_of_a_process_that_comes_to_its_end(module) -> None:
    assert module("def main(words):\n    return 1\n") == (End(1, True, "", ""), "")


@pytest.mark.parametrize("given", ["", "3"])
def test_threads_of_openblas_in_a_process(module, monkeypatch: pytest.MonkeyPatch, given: str) -> None:
    """One, unless the user says otherwise; memory in cycles is collected again after the imports."""
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    if given:
        monkeypatch.setenv("OPENBLAS_NUM_THREADS", given)
    code = "int(os.environ['OPENBLAS_NUM_THREADS']) if gc.isenabled() else 99"
    text = f"import gc, os\ndef main(words):\n    return {code}\n"
    assert module(text) == (End(int(given or 1), True, "", ""), "")


def test_parts_of_numpy_that_are_loaded_where_they_are_used(module) -> None:
    text = (
        "import sys\nimport numpy\nimport scipy.sparse\ndef loaded():\n    return 'unittest' in sys.modules\n"
        "def main(words):\n    before = loaded()\n    numpy.testing.assert_equal(1, 1)\n"
        "    from numpy.testing import assert_allclose\n    numpy.f2py.crackfortran.crackline\n"
        "    return 10 * before + loaded()\n"
    )
    assert module(text) == (End(1, True, "", ""), "")


@pytest.mark.parametrize("way", ["os._exit(0)", "sys.exit(0)"])
def test_process_that_does_not_come_to_its_end(module, way: str) -> None:
    end, _ = module(f"import os, sys\ndef main(words):\n    {way}\n")
    assert (end.finished, end.code, end.reason) == (False, 0, "ended (exit code 0)")


@pytest.mark.long
def test_end_that_hangs_behind_the_result(module) -> None:
    """The exit code is known by then."""
    end, _ = module("import atexit, time\natexit.register(time.sleep, 600)\ndef main(words):\n    return 0\n")
    assert (end.finished, end.code) == (True, 0)


def test_interrupt_within_an_import(module) -> None:
    """Where a module takes it for something else."""
    text = (
        "import os, signal, time\ntry:\n    os.kill(os.getpid(), signal.SIGINT)\n    time.sleep(0.05)\n"
        "except BaseException as error:\n    raise ImportError from error\ndef main(words):\n    return 0\n"
    )
    end, said = module(text)
    assert (end.finished, end.code, said) == (True, 1, "uel: interrupted (SIGINT)\n")


@pytest.mark.long
def test_process_that_waits_for_ever_after_a_call_was_left(module, tmp_path: Path) -> None:
    (tmp_path / "user.f").write_text("      subroutine uexternaldb(lop)\n      call xit\n      end\n")
    text = (
        "import time\nfrom pathlib import Path\nfrom uel.errors import UelError\nfrom uel.usersub import load\n"
        "def main(words):\n    folder = Path(words[0])\n"
        "    library = load(folder / 'user.f', job='job', output_dir=folder)\n"
        "    try:\n        library.external_database(0, 0, (0.0, 0.0), 0.0, 3, 4)\n"
        "    except UelError:\n        time.sleep(600)\n"
    )
    end, _ = module(text)
    assert (end.finished, end.reason) == (False, HANGS)
    assert end.location == "in UEXTERNALDB for element 0, step 3, increment 4, iteration 0: XIT or STOP"


def test_process_that_a_debugger_has_stopped_is_left_alone(tmp_path: Path) -> None:
    """Its call takes as long as the user looks at it; a request to end ends it all the same."""
    _, slate = new_slate()
    slate.within = Within.CALL
    with subprocess.Popen(["sleep", "600"]) as process:
        try:
            watch = _Watch(process, slate, 1.0)
            looks = int(20 / _GLANCE)
            process.send_signal(signal.SIGSTOP)
            while _state(process.pid)[0] != "T":
                time.sleep(0.01)
            assert {watch.glance([]) for _ in range(looks)} == {""}
            assert {watch.glance([signal.SIGINT]) for _ in range(looks)} == {"", "interrupted (SIGINT)"}
            process.send_signal(signal.SIGCONT)
        finally:
            process.kill()


def test_call_whose_process_does_not_hold_its_limit() -> None:
    _, slate = new_slate()
    slate.within = Within.LOADING
    with subprocess.Popen(["sleep", "600"]) as process:
        try:
            watch = _Watch(process, slate, 1.0)
            said = [watch.glance([]) for _ in range(int(8 / _GLANCE))]
            assert said[0] == ""
            assert said[-1] == "ended because loading the library of user routines took longer than 1 s (--call-limit)"
            # another call
            slate.calls = 2
            assert watch.glance([]) == ""
        finally:
            process.kill()


@pytest.fixture
def own_signals():
    before = {each: signal.getsignal(each) for each in ENDS}
    yield
    for each, handler in before.items():
        signal.signal(each, handler)


def test_signal_waits_for_the_end_of_a_block(own_signals: None) -> None:
    raise_interrupts()
    reached = []

    def block() -> None:
        with held():
            signal.raise_signal(signal.SIGTERM)
            reached.append("within")
        reached.append("behind")

    with pytest.raises(Interrupted, match=r"ended by a user or the system \(SIGTERM\)"):
        block()
    assert reached == ["within"]
    # those that follow have no effect
    signal.raise_signal(signal.SIGINT)


def test_signals_that_are_ignored_stay_so(own_signals: None) -> None:
    """As nohup has it."""
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    with collected() as found:
        signal.raise_signal(signal.SIGHUP)
        signal.raise_signal(signal.SIGTERM)
    assert found == [signal.SIGTERM]
    assert signal.getsignal(signal.SIGHUP) == signal.SIG_IGN


def test_command_as_a_module() -> None:
    result = subprocess.run(
        [sys.executable, "-m", "uel", "solvers"], capture_output=True, text=True, check=True, env=os.environ
    )
    assert "superlu" in result.stdout


def test_process_that_another_thread_watches(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It gets the signals that the main thread collects, and all that it prints is in one file."""
    text = "import time\ndef main(words):\n    print('begun', flush=True)\n    time.sleep(600)\n"
    (tmp_path / "apart_module.py").write_text(text)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    signals: list[int] = []
    said = tmp_path / "said"
    with said.open("w") as log, ThreadPoolExecutor(1) as thread:
        future = thread.submit(run_isolated, "apart_module", [], 0.0, output=log, errors=log, signals=signals)
        while "begun" not in said.read_text():
            assert not future.done()
            time.sleep(0.01)
        signals.append(signal.SIGTERM)
        assert future.result() == End(1, True, "", "", True)
    assert said.read_text() == "begun\nuel: ended by a user or the system (SIGTERM)\n"
