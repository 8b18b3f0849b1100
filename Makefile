# Needs only make and Python 3.11 or newer: every target makes its own environment in .venv.

SHELL := /bin/sh
.DEFAULT_GOAL := help
.SUFFIXES:
.DELETE_ON_ERROR:
.PHONY: help demo names schema checks kernels checked test wording verify validation docs bench wheel pure-wheel versions clean

DEMO_STUDY := studies/flexible-pendulum/identify.toml
DEMO_RUN := runs/demo
EVIDENCE := build/evidence.json
ALL := slow or not slow
RECORDING = $(shell grep -rl record_evidence tests --include='test_*.py')

# The first of these that runs, is new enough and can make an environment; PYTHON=... on the command line wins.
CANDIDATES := python3.13 python3.12 python3.11 python3 python
USABLE := import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))
PYTHON ?= $(firstword $(foreach candidate,$(CANDIDATES),\
	$(shell $(candidate) -c "$(USABLE)" >/dev/null 2>&1 && echo $(candidate))))

BIN := .venv/bin
EXE :=
ifeq ($(OS),Windows_NT)
BIN := .venv/Scripts
EXE := .exe
endif
# Python compiles what is imported; compiling all that is installed takes as long as unpacking it.
PIP := $(BIN)/python -m pip
QUIETLY := --quiet --disable-pip-version-check --constraint constraints.txt
INSTALL := $(PIP) install --no-compile $(QUIETLY)

BENCH_PIP := .venv-bench/bin/python -m pip install --quiet --disable-pip-version-check --constraint .venv-bench/constraints.txt

# The tests start hundreds of processes, which would all compile what they import.
unexport PYTHONDONTWRITEBYTECODE

help:
	@echo "make demo        identify a flexible double pendulum from measured motion, and write its report"
	@echo "make names       write the index of components and the stubs of public names from the sources"
	@echo "make schema      write the JSON schema of study files, which the package contains"
	@echo "make test        format, lint, types, layers, tests (what a change must pass)"
	@echo "make wording     write the messages of today into the snapshots of tests, for example TESTS=tests/unit/data"
	@echo "make verify      make test, the slow tests too, and whether the validation pages are up to date"
	@echo "make validation  write the validation pages from a full run of the verification tests"
	@echo "make docs        the documentation, as HTML in docs/_build"
	@echo "make bench       speed, beside a peer"
	@echo "make wheel       a wheel for this platform with all kernels compiled, in dist"
	@echo "make pure-wheel  a wheel without kernels for any platform, and the archive of the sources, in dist"
	@echo "make versions    the README's examples and all templates with the lowest and the newest versions of the dependencies"
	@echo "make clean       remove the environment and everything built"

demo: .venv/core.stamp
	$(BIN)/dalembert run $(DEMO_STUDY) --out $(DEMO_RUN) --force
	@echo "The report: $(CURDIR)/$(DEMO_RUN)/report.html"

# Only the standard library, so that it runs where the sources do not import.
names: $(BIN)/python$(EXE)
	$(BIN)/python tools/public_names.py

schema: .venv/core.stamp
	$(BIN)/dalembert schema > src/dalembert/study/study.schema.json

checks: .venv/test.stamp
	$(BIN)/ruff format --check
	$(BIN)/ruff check
	$(BIN)/pyright
	$(BIN)/lint-imports

# Compiled once, on all cores: tests that begin together would compile the same things twice.
kernels: .venv/core.stamp
	$(BIN)/dalembert compile

# At once, since the checks and what they need beyond the package use one core.
checked: .venv/core.stamp
	$(MAKE) --jobs=2 checks kernels

test: checked
	$(BIN)/pytest -n auto --dist loadfile

# Messages in tests are snapshots. This writes the messages of today into the tests below TESTS: read the difference.
wording: .venv/test.stamp
	$(BIN)/pytest -n 0 --inline-snapshot=create,fix $(TESTS)

verify: .venv/verify.stamp checked
	$(BIN)/pytest -n auto --dist loadfile --no-loadscope-reorder -m "$(ALL)" --evidence=$(EVIDENCE)
	$(BIN)/python docs/validation.py $(EVIDENCE) --check

validation: .venv/verify.stamp kernels
	$(BIN)/pytest -n auto --dist loadfile --no-loadscope-reorder $(RECORDING) -m "$(ALL)" --evidence=$(EVIDENCE)
	$(BIN)/python docs/validation.py $(EVIDENCE)

docs: .venv/docs.stamp
	$(BIN)/sphinx-build --fail-on-warning --keep-going --quiet docs docs/_build
	@echo "The documentation: $(CURDIR)/docs/_build/index.html"

# The wheel contains all kernels as one object file, so that its users compile nothing.
wheel: .venv/core.stamp
	DALEMBERT_KERNELS=1 $(PIP) wheel $(QUIETLY) --no-build-isolation --no-deps --wheel-dir dist .
	@ls dist/*.whl

pure-wheel: .venv/core.stamp
	$(PIP) wheel $(QUIETLY) --no-build-isolation --no-deps --wheel-dir dist .
	$(BIN)/python -m hatchling build --target sdist --directory dist
	@ls dist/*-any.whl dist/*.tar.gz

versions: .venv/test.stamp
	$(BIN)/python tools/versions.py lowest newest

bench: .venv-bench/stamp
	.venv-bench/bin/python -m benchmarks

clean:
	rm -rf .venv .venv-bench build dist docs/_build .pytest_cache .ruff_cache .import_linter_cache .hypothesis
	find src tests studies benchmarks docs -name __pycache__ -type d -prune -exec rm -rf {} + 2>/dev/null || true

$(BIN)/python$(EXE):
	@test -n "$(PYTHON)" || { echo "No usable Python was found (looked for $(CANDIDATES))." \
		"dalembert needs Python 3.11 or newer with the venv module: install one" \
		"(on Debian and Ubuntu: python3 and python3-venv), or name one with 'make PYTHON=/path/to/python3.11'."; exit 1; } >&2
	@$(PYTHON) -c "$(USABLE)" || { echo "'$(PYTHON)' is older than Python 3.11, or has no venv module:" \
		"name a newer one with 'make PYTHON=/path/to/python3.11'."; exit 1; } >&2
	$(PYTHON) -m venv .venv

# One stamp an environment; it is made anew when the dependencies change.
.venv/core.stamp: $(BIN)/python$(EXE) pyproject.toml constraints.txt
	$(INSTALL) hatchling editables
	$(INSTALL) --no-build-isolation --editable .
	@touch $@

# The benchmarks use a separate environment, because their peers need other versions of some packages.
.venv-bench/stamp: $(BIN)/python$(EXE) pyproject.toml constraints.txt benchmarks/constraints.txt
	$(PYTHON) -m venv .venv-bench
	grep -v $$(sed -n 's/^\([a-z-]*\)==.*/-e ^\1==/p' benchmarks/constraints.txt) constraints.txt > .venv-bench/constraints.txt
	cat benchmarks/constraints.txt >> .venv-bench/constraints.txt
	$(BENCH_PIP) hatchling editables
	$(BENCH_PIP) --no-build-isolation --editable ".[bench]"
	@touch $@

.venv/%.stamp: .venv/core.stamp
	$(INSTALL) --no-build-isolation --editable ".[$*]"
	@touch $@
