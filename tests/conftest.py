# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests take from their surroundings: nothing.

Examples of hypothesis are the same in every run, whatever the machine; others with --hypothesis-profile=other.
"""

import os
import signal
from collections import Counter
from collections.abc import Iterator
from zlib import crc32

import pytest
from hypothesis import HealthCheck, settings

# they come ignored in the background of a shell and behind nohup, and runs that tests interrupt would not end
for each, handler in {signal.SIGINT: signal.default_int_handler, signal.SIGHUP: signal.SIG_DFL}.items():
    if signal.getsignal(each) == signal.SIG_IGN:
        signal.signal(each, handler)

# no deadline, and examples may be slow: another program may take the processor for a while
PATIENT = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}
settings.register_profile("same", derandomize=True, **PATIENT)
settings.register_profile("other", print_blob=True, **PATIENT)
settings.load_profile("same")


def pytest_addoption(parser: pytest.Parser) -> None:
    """make test SHARE=n."""
    parser.addoption("--share", type=int, default=1, metavar="N", help="one test in N, which ones by the seed")


def pytest_configure(config: pytest.Config) -> None:
    """make test CORES=each: a worker sees one core, as on a machine that has no other."""
    worker = getattr(config, "workerinput", None)
    if worker is not None and "UEL_TESTS_OWN_CORE" in os.environ:
        cores = sorted(os.sched_getaffinity(0))
        os.sched_setaffinity(0, {cores[int(worker["workerid"].removeprefix("gw")) % len(cores)]})


@pytest.fixture(scope="session", autouse=True)
def current_folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """One without a folder `harness`: where the sources are, Python would take them in place of the built package."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("current"))
        yield


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark as long what sample(n) leaves to make test-all; before the tests are selected, and put in another order.

    Of them those stay whose name and seed fall to the share.
    """
    cases = Counter[str]()
    for item in items:
        sample = item.get_closest_marker("sample")
        if sample is not None:
            function = item.nodeid.partition("[")[0]
            if cases[function] % sample.args[0]:
                item.add_marker(pytest.mark.long)
            cases[function] += 1
    share, seed = config.getoption("share"), config.getoption("randomly_seed", None)
    kept: list[pytest.Item] = []
    left: list[pytest.Item] = []
    for item in items:
        (left if crc32(f"{seed} {item.nodeid}".encode()) % share else kept).append(item)
    config.hook.pytest_deselected(items=left)
    items[:] = kept
