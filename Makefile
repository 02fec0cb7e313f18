# Two commands matter: `make bench` runs the paper's matrix, `make test` the tests.
# Each sets up what it needs in .venv when it is missing.
PYTHON ?= python3
BIN := .venv/bin
INSTALLED := .venv/.installed
# What is installed from this folder beside the base: all planners, and rows as parquet.
EXTRAS := others,parquet
STORE ?= out/paper-static.db
JOBS ?= 2
ARGS ?=

.PHONY: help setup setup-dev browser kernels bench test test-loaded test-slow torture lint docs \
	perf harness faults sites results cluster-test cluster-scaling search-readings clean

help:
	@echo "make bench     run the matrix paper-static and print its tables (ARGS=--quick: two seeds)"
	@echo "make test      run the tests; test-slow, torture: the long ones; test-loaded; lint"
	@echo "make setup     make .venv with the command kbga-bench; . .venv/bin/activate"
	@echo "make docs      write the reference of the Python interface to out/docs"
	@echo "make results   remake results/: three quarters of an hour; results-NAME: one folder of it"
	@echo "make perf, make harness   measure the planners' times, and what the harness costs"
	@echo "make faults    let happen what may go wrong, and say what came of it (as root: disks too)"
	@echo "make sites     random building sites at places on earth, 1 mm to 1,000 km; half an hour"
	@echo "make cluster-test         run a matrix on SLURM, MPI and machines apart, on loopback"
	@echo "make cluster-scaling      measure rows per second on 1 to 8 workers"

setup: $(INSTALLED)
setup-dev: $(INSTALLED)-dev

$(INSTALLED): pyproject.toml
	test -x $(BIN)/python || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(BIN)/python -m pip install --quiet -e ".[$(EXTRAS)]"
	touch $@

# And what tests, linters and the reference need.
$(INSTALLED)-dev: $(INSTALLED)
	$(BIN)/python -m pip install --quiet --group dev -e ".[$(EXTRAS),dask,gdal]"
	touch $@

# The report is tested in Debian's chromium. Where it is missing and can't be installed, the tests
# that need it are skipped, and say so.
CHROMIUM := /usr/bin/chromium
browser:
	@test -x $(CHROMIUM) || { test "$$(id -u)" = 0 && apt-get update -qq \
		&& DEBIAN_FRONTEND=noninteractive apt-get install -y -qq chromium >/dev/null; } \
		|| echo "No $(CHROMIUM), and no right to install it: the report is not tested in a browser."

bench: setup
	mkdir -p $(dir $(STORE))
	$(BIN)/kbga-bench run paper-static --store $(STORE) --jobs $(JOBS) $(ARGS)
	$(BIN)/kbga-bench tables $(STORE)

# Compiled once, by two processes with a part each: two workers of pytest would both compile all.
kernels: setup-dev
	@$(BIN)/python -m tests.kernels kbga & \
		$(BIN)/python -m tests.kernels exact visibility-graph ompl-rrtstar grid-astar cmaes; wait

# What runs in a test; TESTS=FILE for some.
TESTS ?=
ORDINARY := $(BIN)/python -m pytest -q -m "not slow and not torture" -n 3 --dist worksteal

# The kernels' claims hold compiled and interpreted: the second line runs them without the JIT.
test: setup-dev browser kernels
	$(ORDINARY) $(TESTS)
	NUMBA_DISABLE_JIT=1 $(BIN)/python -m pytest -q -m "not slow and not torture" -n 2 tests/suite/geometry tests/kbga

# The same beside so many processes that never rest: no test depends on the machine's speed. They
# end with the shell that started them, however it ends.
LOAD ?= 8
BUSY := import itertools, os; shell = os.getppid(); \
	all(os.getppid() == shell for _ in itertools.repeat(0))
test-loaded: setup-dev browser kernels
	@busy=""; trap '[ -z "$$busy" ] || kill $$busy' EXIT; trap 'exit 130' INT TERM; \
	for _ in $$(seq $(LOAD)); do \
		$(BIN)/python -c '$(BUSY)' & busy="$$busy $$!"; \
	done; \
	$(ORDINARY) $(TESTS)

# Hours; ONE_IN=40 runs one in forty of them, others at each commit.
ONE_IN ?= 1
test-slow: setup-dev
	$(BIN)/python -m pytest -q -m slow --one-in $(ONE_IN) -n 2 --dist worksteal

# The harness is killed at 100 random moments of a matrix, and resumed.
torture: setup-dev
	$(BIN)/python -m pytest -q -m torture -n 2 --dist worksteal

lint: setup-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

# What can be imported, from the docstrings.
docs: setup-dev
	$(BIN)/python -m tests.reference out/docs

# One process measures everything, so that ratios hold; the record becomes the table of goals.
perf: setup-dev
	mkdir -p out
	$(BIN)/python -m pytest -q tests/perf --benchmark-only --benchmark-json=out/performance.json \
		--benchmark-columns=median,max,rounds --benchmark-sort=name
	$(BIN)/python -m tests.perf.performance_table out/performance.json results/performance

# Everything in results/ that comes from a matrix: three quarters of an hour on two cores, nothing
# else running.
STUDIES := resolution obstacles plus kbga-plus readings ablation mutation-rate penalty first-population tuning
CAMPAIGNS := ompl-tuning paper-static paper-dynamic all-planners alignment rivals $(STUDIES)
PAPER := paper-static paper-dynamic resolution
NO_ROWS := --leave-out paths --leave-out traces
# What stands in paper-static is not drawn again, and a study has a figure of its own.
NO_PICTURES := --leave-out comparisons --leave-out paper-pictures
BRIEF := --leave-out events --leave-out scene-pictures --leave-out long-tables
$(STUDIES:%=results-%): LEAVE := $(NO_ROWS) $(NO_PICTURES)
# The paper's Figure 13 is of the ablation.
results-ablation: LEAVE := $(NO_ROWS) --leave-out events --leave-out comparisons
# Figures of the paper and of the study come out of these traces.
results-resolution results-first-population: LEAVE := --leave-out paths --leave-out events $(NO_PICTURES)
results-penalty results-tuning: LEAVE := $(NO_ROWS) --leave-out events $(NO_PICTURES)
results-paper-static results-paper-dynamic: LEAVE := --leave-out paths
results-all-planners: LEAVE := $(NO_ROWS) --leave-out paper-pictures
results-alignment results-ompl-tuning results-plus: LEAVE := $(NO_ROWS) --leave-out events $(NO_PICTURES)
results-kbga-plus results-rivals: LEAVE := $(NO_ROWS) $(NO_PICTURES) $(BRIEF)

results: $(CAMPAIGNS:%=results-%)
	rm -f out/paper.db
	$(BIN)/kbga-bench merge out/paper.db $(PAPER:%=out/%.db)
	$(BIN)/kbga-bench tables out/paper.db --format markdown --output results/paper
	$(BIN)/kbga-bench tables out/paper.db --format csv --output results/paper
	$(BIN)/kbga-bench report out/paper-static.db -o out/report.html

$(CAMPAIGNS:%=results-%): results-%: setup
	mkdir -p out
	$(BIN)/kbga-bench run $* --store out/$*.db --jobs $(JOBS)
	$(BIN)/kbga-bench results out/$*.db results/$* $(LEAVE)

# On maps of your own, which are not copied: MAPS=FOLDER.
results-real-maps results-real-maps-tuning results-kbga-plus-maps: results-%: setup
	@test -d "$(MAPS)" || { echo "Say where maps are, MAPS=FOLDER. Where they are to be had stands" \
		"in suite/scenes/maps/README.md."; exit 2; }
	mkdir -p out
	$(BIN)/kbga-bench run $* --maps $(MAPS) --store out/$*.db --jobs $(JOBS)
	$(BIN)/kbga-bench results out/$*.db results/$* $(NO_ROWS) $(NO_PICTURES) $(BRIEF)

# The search for the reading of the paper; what it tried stays in out/, so that it can go on.
search-readings: setup
	$(BIN)/python -m tests.perf.readings results/readings-search --jobs $(JOBS)

# What the harness itself costs. On a machine that does nothing else.
harness: setup
	$(BIN)/python -m tests.perf.harness results/harness $(ARGS)

# What goes wrong on real machines is brought about here, for real. As root it fills and locks small
# disks of its own; another clock needs a C compiler. What was not tried is said in the table.
faults: setup
	$(BIN)/python -m tests.perf.faults results/harness $(ARGS)

# Whether it holds anywhere: 1,000 random building sites at each place and of each size.
sites: setup
	$(BIN)/python -m tests.perf.sites results/sites $(ARGS)

# SLURM, MPI, and workers without a shared disk, all on loopback. What is missing is installed
# where it can be, by root with apt; else a trial says that it is not available here, and why.
CLUSTER_PACKAGES := munge slurm-wlm openmpi-bin libopenmpi-dev iproute2
TRIALS ?=
cluster-test: setup-dev
	@dpkg -s $(CLUSTER_PACKAGES) >/dev/null 2>&1 || { test "$$(id -u)" = 0 && apt-get update -qq \
		&& DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
		--no-install-recommends $(CLUSTER_PACKAGES) >/dev/null; } \
		|| echo "Not all of $(CLUSTER_PACKAGES) are here, and there is no right to install them."
	@$(BIN)/python -m pip install --quiet --group cluster \
		|| echo "The Python packages of the group cluster can't be installed."
	$(BIN)/python -m tests.suite.harness.cluster.trials $(TRIALS)

# On a machine that does nothing else.
cluster-scaling: setup-dev
	$(BIN)/python -m tests.perf.cluster_scaling results/harness $(ARGS)

clean:
	rm -rf .venv out build *.egg-info .pytest_cache .mypy_cache .ruff_cache .hypothesis .benchmarks
