# SPDX-FileCopyrightText: The uel-harness authors
# SPDX-License-Identifier: BSD-3-Clause
#
# make demo   install what is missing, build, run three elements and a snap-back, draw them, compare with beam theory
# make test   the same set-up, then the quick test suite on all cores
# make help   the rest

PYTHON ?= python3
VENV ?= .venv
MESON_ARGS ?= -Dbuildtype=release
PYTEST_ARGS ?=
SELECT ?= not long
# processes that share the tests
WORKERS ?= auto
# what tests/programs/machine.py makes of the processor, how many cores it takes (each: one for a worker); WORKERS=0 for none
PROCESSOR ?= this
CORES ?= all
# a number: tests come in a random order, and hypothesis takes other examples; with WORKERS=1 the same run each time
SEED ?=
# one test in so many, which ones by SEED
SHARE ?= 1

BIN := $(VENV)/bin
INSTALLED := $(VENV)/.installed
RANKS := $(VENV)/.ranks/.installed
BUILD := build/$(notdir $(VENV))
COPY := $(BUILD)-copy
# the build backend and the tools it calls are found through PATH
RUN := PATH="$(CURDIR)/$(BIN):$$PATH"
# the package in $(COPY); known after it is there
SITE = $(shell find $(CURDIR)/$(COPY) -type d -name uel -prune -exec dirname {} +)
# the processes share the cores: one thread of linear algebra each
PYTEST = $(RUN) PYTHONPATH=$(SITE) MESONPY_EDITABLE_SKIP=$(CURDIR)/$(BUILD) \
	OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 MKL_NUM_THREADS=1 \
	$(BIN)/python tests/programs/machine.py --processor $(PROCESSOR) --cores $(CORES) $(BIN)/pytest \
	-n $(WORKERS) --maxprocesses 16 --dist worksteal --share $(SHARE) \
	$(if $(SEED),-p randomly --randomly-seed=$(SEED) --hypothesis-profile=other --hypothesis-seed=$(SEED))

.DEFAULT_GOAL := help
.PHONY: help demo ranks copy test test-all test-debug test-matrix bench start lint docs decks clean

help:
	@sed -n 's/^# make/make/p' $(firstword $(MAKEFILE_LIST))
	@echo 'make test-all    the quick tests and the long ones'
	@echo 'make ranks       what the tests of several processes and of PARDISO need, 1 GB; without it they are skipped'
	@echo 'make test-debug  the quick tests on kernels with run-time checks'
	@echo 'make test-matrix both, on clean clones, as on several machines: tests/programs/matrix.py'
	@echo 'make bench       speed ratios, measured in one run'
	@echo 'make start       what a small job costs before it computes'
	@echo 'make lint        what CI checks before the tests'
	@echo 'make docs        the manual, in build/site'
	@echo 'make decks       write the decks of abaqus_inputs again'
	@echo 'make clean       remove the environment, the build and the demo'

$(INSTALLED): pyproject.toml meson.build .ci/toolchain
	@PYTHON=$(PYTHON) bash .ci/toolchain
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --upgrade pip
	$(BIN)/pip install --quiet --group dev
	$(RUN) $(BIN)/pip install --quiet --no-build-isolation --editable . \
		-Cbuild-dir=$(BUILD) $(addprefix -Csetup-args=,$(MESON_ARGS))
	@touch $@

demo: $(INSTALLED)
	$(RUN) $(BIN)/python -m uel.paper.demo --output-dir demo

ranks: $(RANKS)

# MPI and PARDISO for the tests, in folders of their own: in the environment they would change what other tests see
$(RANKS): $(INSTALLED)
	@for extra in mpi fast; do $(BIN)/python -c 'import sys, tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))\
	["project"]["optional-dependencies"][sys.argv[1]], sep="\n")' $$extra > $(VENV)/$$extra.txt; done
	@$(BIN)/pip install --quiet --prefix $(VENV)/.ranks --requirement $(VENV)/mpi.txt && \
		$(BIN)/pip install --quiet --target $(VENV)/.ranks/fast --no-deps --requirement $(VENV)/fast.txt && touch $@ || \
		echo 'MPI and PARDISO are not installed: their tests are skipped'

# what users get, and with bytecode: an editable package is looked for and compiled by each of the processes anew
copy: $(INSTALLED)
	@rm -rf $(COPY).new
	$(RUN) $(BIN)/meson install -C $(BUILD) --quiet --destdir $(CURDIR)/$(COPY).new
	@rm -rf $(COPY) && mv $(COPY).new $(COPY)

test: copy
	$(PYTEST) -m '$(SELECT)' $(PYTEST_ARGS)

test-all: copy
	$(PYTEST) $(PYTEST_ARGS)

test-debug:
	@$(MAKE) --no-print-directory test VENV=.venv-debug MESON_ARGS='-Dbuildtype=debug' SELECT='not long and not nan'

test-matrix:
	$(PYTHON) tests/programs/matrix.py

bench: $(INSTALLED)
	@failed=0; for program in bench limit contact; do \
		$(RUN) $(BIN)/python tests/programs/benchmarks/$$program.py || failed=1; done; exit $$failed

start: copy
	$(RUN) PYTHONPATH=$(SITE) MESONPY_EDITABLE_SKIP=$(CURDIR)/$(BUILD) $(BIN)/python tests/programs/benchmarks/start.py

lint: $(INSTALLED)
	$(RUN) $(BIN)/ruff check .
	$(RUN) $(BIN)/ruff format --check .
	$(RUN) $(BIN)/mypy
	$(RUN) $(BIN)/fortitude check
	$(RUN) $(BIN)/codespell

# links that lead nowhere are errors, within the pages and to files of the repository
docs: $(INSTALLED)
	$(BIN)/pip install --quiet --group docs
	$(RUN) $(BIN)/sphinx-build --fail-on-warning --keep-going --quiet -c docs . build/site
	@echo 'build/site/docs/index.html'

decks: $(INSTALLED)
	$(RUN) $(BIN)/python -m uel.paper.decks

clean:
	rm -rf .venv .venv-debug build demo
