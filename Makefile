# Everything below works on a bare checkout with Python 3.11 or newer on the path.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
ARGS ?=

.PHONY: search test check docs bench bench-search peers lock clean

search: $(VENV)/.installed  ## find a cup in the built-in kitchen, told step by step
	$(BIN)/qsr search kitchen --seed 7 $(ARGS)

test: $(VENV)/.installed  ## the whole test suite
	$(BIN)/python -m pytest -n 2 --dist worksteal $(ARGS)

check: $(VENV)/.installed  ## style, types and the architecture test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/python -m pytest -q tests/test_architecture.py

docs: $(VENV)/.installed  ## the figures and tables of docs/, made anew
	$(BIN)/python docs/make_figures.py $(ARGS)
	$(BIN)/python docs/make_terminal_picture.py

bench: $(VENV)/.installed  ## every benchmark but the long one of search, ratios printed
	for file in $(filter-out %bench_search.py,$(wildcard benchmarks/bench_*.py)); do $(BIN)/python $$file $(ARGS) || exit 1; done

bench-search: $(VENV)/.installed  ## search against its limits and its peers; pomdp-py's part needs `make peers`
	$(BIN)/python benchmarks/bench_search.py $(ARGS)

peers: .peers/.installed  ## pomdp-py with qsrlang, in an environment of their own

.peers/.installed: pyproject.toml
	$(PYTHON) -m venv .peers
	.peers/bin/python -m pip install --quiet --editable . "pomdp-py>=1.3.5" "pygame>=2.5" "opencv-python-headless>=4.8"
	touch $@

lock: $(VENV)/.installed  ## pin every dependency anew
	$(BIN)/pip-compile --quiet --strip-extras --all-build-deps --extra dev --no-emit-index-url \
	    --no-emit-find-links --no-emit-trusted-host --no-header -o requirements.lock pyproject.toml

$(VENV)/.installed: requirements.lock pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	touch $@

clean:
	rm -rf $(VENV) build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis runs
