# The two commands of the README: `make demo` and `make test`. Each sets up .venv by itself.
PYTHON ?= python3
BIN := .venv/bin
READY := .venv/.ready
DEV := .venv/.dev

.PHONY: demo test install check bench fuzz clean

demo: $(READY)
	$(BIN)/hobtwin run scenes/spur_m2_z20

test: $(DEV)
	$(BIN)/pytest --numprocesses auto --dist worksteal -p no:benchmark -rs

install: $(DEV)

check: $(DEV)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/basedpyright

bench: $(DEV)
	$(BIN)/python -m benchmarks

$(READY): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "hobtwin needs Python 3.11 or newer")'
	@test -x $(BIN)/python || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e .
	@touch $@

$(DEV): $(READY)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[dev]'
	@touch $@

fuzz: $(DEV)
	$(BIN)/python tests/fuzz/fuzzing.py $(or $(N),2000)

clean:
	rm -rf .venv out build *.egg-info
