# A fresh machine needs python3 (3.11 or newer) and make; everything else goes into .venv.
#   make run     start the emulator with its defaults (ARGS="..." passes options on)
#   make test    the default test suite (ARGS="..." passes options on)
#   make bench   measure; prints a table and writes bench.json
#   make fuzz    a million commands of random programs (ARGS="--commands N --seed N" for another run)
#   make lint    ruff and mypy
#   make docs    the documentation as a site in build/docs/html; needs no network
#   make pictures  draw the pictures of docs/tuning anew

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
ARGS ?=
# One more than two cores have, because many tests wait for real ports.
JOBS ?= 3

.PHONY: run test bench fuzz lint docs pictures clean

run: $(STAMP)
	@exec $(BIN)/python -m emulator serve $(ARGS)

test: $(STAMP)
	@exec $(BIN)/python -m pytest -n $(JOBS) $(ARGS)

bench: $(STAMP)
	@exec $(BIN)/python -m tests.bench $(ARGS)

fuzz: $(STAMP)
	@exec $(BIN)/python -m tests.fuzz $(ARGS)

lint: $(STAMP)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

docs: $(STAMP)
	@$(BIN)/python -m documentation build/docs

# The seven steps of the tuning guide, and a change of gain sets in motion.
TUNING := docs/tuning
pictures: $(STAMP)
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[plot]'
	$(BIN)/python -m emulator tune $(TUNING)/demonstration.toml --out $(TUNING) --gains \
	  SGP=2 SGP=15 SGP=15,SGV=2 SGP=105,SGV=2 SGP=105,SGV=2.6 SGP=105,SGV=2.3 SGP=85,SGV=2.3
	$(BIN)/python -m emulator scope $(TUNING)/demonstration.toml --run $(TUNING)/gain_sets.txt \
	  --signals axis1.position.error,axis1.servo.proportional,axis1.servo.velocity_feedforward,axis1.servo.output \
	  --out $(TUNING)/gain-sets.png

# The stamp makes the second run instant; a changed pyproject.toml installs again.
$(STAMP): pyproject.toml
	@command -v $(PYTHON) >/dev/null || { echo "$(PYTHON) not found: install Python 3.11 or newer" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "Python 3.11 or newer is needed, $(PYTHON) is $$($(PYTHON) -V 2>&1); try: make PYTHON=python3.11 $(MAKECMDGOALS)" >&2; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || \
	  { echo "$(PYTHON) has no venv/ensurepip: install your system's package for it (Debian, Ubuntu: python3-venv)" >&2; exit 1; }
	@echo "Preparing $(VENV) (once, about a minute) ..." >&2
	@test -x $(BIN)/python && $(BIN)/python -m pip --version >/dev/null 2>&1 || $(PYTHON) -m venv --clear $(VENV)
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[test]'
	@touch $@

clean:
	rm -rf $(VENV) build *.egg-info .pytest_cache .mypy_cache .ruff_cache
