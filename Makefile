# Two of these do all the set-up: make demo, make test. Both leave .venv/bin/gapless behind.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --quiet --disable-pip-version-check
DEMO := out/demo

.PHONY: demo test browser bench docs clean

demo: $(VENV)/.run  ## simulate a drive and fuse it through three outages
	@mkdir -p $(DEMO)
	@rm -rf $(DEMO)/drive
	@$(BIN)/gapless simulate --duration 800 --mounting 1 -2 4 --late 0.15 --wheels 1 --out $(DEMO)/drive
	@echo
	@$(BIN)/gapless fuse $(DEMO)/drive --outages every=180,length=60,first=240 --force --out $(DEMO)
	@echo
	@echo "Open this in a browser: $(CURDIR)/$(DEMO)/report.html"

test: $(VENV)/.dev browser  ## lint, types, floors, tests
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/pytest -n 2

browser:  ## a Chromium for the tests of pages: found, or installed where that is allowed; without one they skip
	@for name in "$$GAPLESS_CHROMIUM" chromium chromium-browser google-chrome chrome; do \
	command -v "$$name" >/dev/null && exit 0; done; \
	{ test "$$(id -u)" = 0 && command -v apt-get >/dev/null && echo "installing chromium" && apt-get -qq update && \
	DEBIAN_FRONTEND=noninteractive apt-get -qq install --no-install-recommends chromium fonts-liberation >/dev/null; } || \
	echo "no Chromium was found, and none can be installed here: tests of pages are skipped"

bench: $(VENV)/.dev  ## speed as ratios: the kernel and the whole process against C, learners, denoising, bridges; how long learners train
	$(BIN)/python benchmarks/kernel.py
	$(BIN)/python benchmarks/process.py
	$(BIN)/python benchmarks/page.py
	$(BIN)/python benchmarks/cubature.py
	$(BIN)/python benchmarks/denoise.py
	$(BIN)/python benchmarks/learners.py --genetic
	$(BIN)/python benchmarks/bridges.py
	$(BIN)/python benchmarks/wheels.py

docs: $(VENV)/.dev  ## run the README's code again; its output, picture and tables follow
	$(BIN)/python docs/refresh.py

clean:
	rm -rf $(VENV) out build dist .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis

# made again only where pyproject.toml is newer
$(VENV)/.run: pyproject.toml | $(BIN)/python
	@echo "installing gapless into $(VENV)"
	@$(PIP) install -e .
	@touch $@

$(VENV)/.dev: pyproject.toml | $(BIN)/python
	@echo "installing gapless and what its tests need into $(VENV)"
	@$(PIP) install -e '.[dev]'
	@touch $(VENV)/.run $@

$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.exit("gapless needs Python 3.11 or newer; try make PYTHON=python3.12") if sys.version_info < (3, 11) else 0'
	@$(PYTHON) -m venv $(VENV)
