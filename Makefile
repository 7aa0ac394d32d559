# `make match` plays the showcase and writes its replay; `make test` runs the tests.
# Both create .venv on first use, and compile what they need for this machine.

# The first interpreter of a supported version; override with `make PYTHON=...`.
PYTHON ?= $(shell for p in python3 python3.13 python3.12 python3.11; do \
	$$p -c 'import sys; sys.exit(not (3, 11) <= sys.version_info[:2] < (3, 14))' 2>/dev/null && echo $$p && break; done)
BIN := .venv/bin
INSTALLED := .venv/.installed
PLAYING := .venv/.playing

# Without bytecode, every process that a test starts compiles robobt anew.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: match test test-fast durations install lint docs notebooks pictures clean

match: $(PLAYING)
	@mkdir -p out
	$(BIN)/robobt match striker_vs_goalkeeper --trials 20 --record out/match.html
	@echo "Open out/match.html in a browser to watch the first trial."

test: $(INSTALLED)
	$(BIN)/python -m pytest -n 2 --dist worksteal

# Everything but the slowest tests, under a minute.
test-fast: $(INSTALLED)
	$(BIN)/python -m pytest -n 2 --dist worksteal -m "not slow and not integration"

# The whole suite, and the twenty tests that take most processor time.
durations: $(INSTALLED)
	$(BIN)/python -m pytest -n 2 --dist worksteal -p tests.dearest

# Style, types, the order of the rooms, and that each public name says what it takes and returns.
lint: $(INSTALLED)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache
	$(BIN)/python -m pytest tests/test_docstrings.py

# The site, in out/site: a broken link fails.
docs: $(INSTALLED)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[docs]'
	$(BIN)/python -m mkdocs build --strict

# The notebooks of the tutorials with what they print and show, from examples/*.py; some four minutes.
notebooks: $(INSTALLED)
	$(BIN)/python -m tests.notebooks

# The animations in README and docs, and with Chromium the pictures of the live page.
pictures: $(INSTALLED)
	@mkdir -p out
	$(BIN)/robobt match striker_vs_goalkeeper --trials 1 --record out/striker.robobt.arrows
	$(BIN)/robobt show out/striker.robobt.arrows --out docs/images/striker.gif --robot "blue 0"
	$(BIN)/robobt match six_v_six --trials 1 --set ends.time_limit=30 --record out/six.robobt.arrows
	$(BIN)/robobt show out/six.robobt.arrows --out docs/images/six.gif --from 10 --to 20
	$(BIN)/python -m tests.live.pictures

install: $(INSTALLED)

$(INSTALLED): pyproject.toml constraints.txt hatch_build.py $(wildcard robobt/league/wire/proto/*.proto)
	@test -n "$(PYTHON)" || { echo "robobt needs Python 3.11, 3.12 or 3.13: install one, or name it with make PYTHON=..."; exit 1; }
	@echo "Setting up .venv; the first time takes a few minutes."
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[dev]'
	$(BIN)/python -m robobt.cli.compile_ahead --training
	@touch $@

# What playing and watching need, and no more; an environment with everything has that too.
$(PLAYING): pyproject.toml constraints.txt hatch_build.py $(wildcard robobt/league/wire/proto/*.proto)
	@test -n "$(PYTHON)" || { echo "robobt needs Python 3.11, 3.12 or 3.13: install one, or name it with make PYTHON=..."; exit 1; }
	@test -e .venv || $(PYTHON) -m venv .venv
	@test -e $(INSTALLED) || { echo "Setting up .venv; the first time takes a minute or two."; \
		$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e '.[record]' \
		&& $(BIN)/python -m robobt.cli.compile_ahead; }
	@touch $@

clean:
	rm -rf .venv out
