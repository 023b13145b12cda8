# Every command sets up what it needs: a bare machine with make and Python 3.11, 3.12 or 3.13 is enough.
NAMES  := python3.11 python3.12 python3.13
PYTHON ?= $(or $(firstword $(foreach name,$(NAMES),$(call runs,$(name)))),python3.11)
# pyenv has each name on the path, and those that are not chosen only say so: then it is taken from where pyenv keeps it.
runs    = $(shell $(1) -c '' >/dev/null 2>&1 && echo $(1))
CHOSEN  = $(or $(firstword $(foreach path,$(PYTHON) $(wildcard $(HOME)/.pyenv/versions/*/bin/$(notdir $(PYTHON))),$(call runs,$(path)))),$(PYTHON))
VENV   := .venv
BIN    := $(VENV)/bin
# Wheels only: a package without one is an error at once, not a compiler's message after minutes.
PIP    := $(BIN)/python -m pip --disable-pip-version-check install -qq --only-binary :all: -c constraints.txt

# Bytecode beside our own modules, as pip writes it for packages: some machines write none while they run.
COMPILE := @$(BIN)/python -m compileall -q tamp grounding

.DEFAULT_GOAL := help
.PHONY: help solve test check format bench

help:  ## this list
	@grep -E '^[a-z]+:.*## ' $(MAKEFILE_LIST) | awk -F':.*## ' '{printf "  make %-8s %s\n", $$1, $$2}'

solve: $(VENV)/.installed  ## plan problems/four_objects.yaml, write plan.json
	$(BIN)/tamp-solve domains/cupboard.pddl problems/four_objects.yaml --out plan.json
	@echo "The plan is $(CURDIR)/plan.json. Check it: $(BIN)/tamp-verify plan.json"

test: $(VENV)/.developing  ## run all tests
	$(BIN)/pytest -n 2

check: $(VENV)/.developing  ## ruff, pyright, import-linter
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/pyright
	$(BIN)/lint-imports

format: $(VENV)/.developing  ## mend what ruff can mend
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: $(VENV)/.developing  ## the quick benchmarks, a table each
	$(BIN)/python -m benchmarks.cold_start
	$(BIN)/python -m benchmarks.solve one_object four_objects --seeds 5
	$(BIN)/python -m benchmarks.collision --states 5000 --edges 500 --scenes 5
	$(BIN)/python -m benchmarks.inverse_kinematics --poses 500
	$(BIN)/python -m benchmarks.motion
	$(BIN)/python -m benchmarks.search
	$(BIN)/python -m benchmarks.classical --time 5

$(BIN)/python:
	@$(CHOSEN) -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 13))' 2>/dev/null || { \
	  echo "tamp needs Python 3.11, 3.12 or 3.13, and '$(PYTHON)' is none of them."; \
	  echo "Install one (Debian 12: apt install python3.11-venv; elsewhere: pyenv, uv python install 3.11),"; \
	  echo "or say where it is: make PYTHON=/path/to/python3.13 $(MAKECMDGOALS)"; exit 1; }
	@$(CHOSEN) -m venv $(VENV) || { \
	  echo "'$(CHOSEN) -m venv' failed: on Debian and Ubuntu, apt install python3-venv"; rm -rf $(VENV); exit 1; }

$(VENV)/.installed: pyproject.toml constraints.txt | $(BIN)/python
	@echo "installing tamp into $(VENV) (about a minute)"
	$(PIP) -e .
	$(COMPILE)
	@touch $@

$(VENV)/.developing: pyproject.toml constraints.txt | $(BIN)/python
	@echo "installing tamp and its developers' tools into $(VENV) (about a minute)"
	$(PIP) -e .[dev]
	$(COMPILE)
	@touch $@ $(VENV)/.installed
