# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
"""Run a command as on another machine: `make test PROCESSOR=Nehalem CORES=1`.

The processor decides which kernels OpenBLAS uses, which loops numpy uses, and which functions glibc uses for exp, sin
and pow: sums are in another order, and products with or without fused additions.
"""

import argparse
import os
import sys

import numpy as np

OWN_CORE = "UEL_TESTS_OWN_CORE"
"""Set where each worker of the tests takes one core (tests/conftest.py)."""
WITHOUT_AVX2 = ("Prescott", "Nehalem", "Sandybridge")
WITHOUT_AVX512 = (*WITHOUT_AVX2, "Haswell")
PROCESSORS = ("this", *WITHOUT_AVX512)


def environment(processor: str) -> dict[str, str]:
    """Variables that make OpenBLAS, numpy and glibc compute as on a processor, by its name in OpenBLAS."""
    if processor == "this":
        return {}
    found = np.show_config(mode="dicts")["SIMD Extensions"].get("found", [])
    # also on a machine that already pretends to be older
    beyond = os.environ.get("NPY_DISABLE_CPU_FEATURES", "").split()
    beyond += [name for name in found if processor in WITHOUT_AVX2 or name.startswith(("X86_V4", "AVX512"))]
    missing = ["AVX512F", *(("AVX2", "FMA") if processor in WITHOUT_AVX2 else ())]
    return {
        "OPENBLAS_CORETYPE": processor,
        "NPY_DISABLE_CPU_FEATURES": " ".join(beyond),
        "GLIBC_TUNABLES": "glibc.cpu.hwcaps=" + ",".join(f"-{name}" for name in missing),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--processor", choices=PROCESSORS, default="this", help="processor to imitate (%(default)s)")
    parser.add_argument(
        "--cores",
        default="all",
        help="how many of the cores to use; 'each': one for each worker of the tests (%(default)s)",
    )
    parser.add_argument("command", nargs=argparse.REMAINDER)
    options = parser.parse_args()
    if not options.command:
        parser.error("no command")
    if options.cores == "each":
        os.environ[OWN_CORE] = "1"
    elif options.cores != "all":
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: int(options.cores)])
    os.environ.update(environment(options.processor))
    os.execvp(options.command[0], options.command)


if __name__ == "__main__":
    sys.exit(main())
