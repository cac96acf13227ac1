# Every target sets up what it needs first, and that is quick when nothing has changed.
# PYTHON=/path/to/python3.12 chooses another Python than the default.

.DEFAULT_GOAL := help
SHELL := /bin/sh
export PYTHON

.PHONY: help
help:  ## show this table
	@sed -n 's/^\([a-z]*\):.*## /\1|/p' Makefile | while IFS='|' read -r name does; do \
	  printf '  make %-10s %s\n' "$$name" "$$does"; done

.PHONY: setup
setup:  ## install ROS 2 Jazzy and the tools into .venv, and build the packages
	@scripts/setup

# With what a requirements-<extra>.txt names as well.
setup-%:
	@scripts/setup $*

.PHONY: test
test: setup-test setup-docs setup-physics setup-console setup-record  ## check the code with ruff and mypy, then run every test
	@lint=0; ./env python3 scripts/lint.py || lint=$$?; \
	ROS_PYTHON_CHECK_FIELDS=1 ./env python3 -m pytest -n 2 || exit $$?; \
	[ $$lint -eq 0 ] || echo 'The tests pass, but ruff or mypy found something: see above.'; \
	exit $$lint

.PHONY: coverage
coverage: setup-test setup-docs setup-physics setup-console setup-record  ## run every test, and show in out/coverage/ which lines none of them runs
	@./env python3 -m coverage erase; tests=0; \
	./env python3 -m coverage run -m pytest -n 2 || tests=$$?; \
	./env python3 -m coverage combine --quiet && ./env python3 -m coverage report && \
	./env python3 -m coverage html --quiet && exit $$tests

.PHONY: lint
lint: setup-test  ## check the code with ruff and mypy
	@./env python3 scripts/lint.py

.PHONY: format
format: setup-test  ## lay the code out as lint expects it
	@./env ruff check --fix . && ./env ruff format .

.PHONY: demo
demo: setup  ## fly Barker's basic test maneuver, with figures in out/
	@./env python3 -m wrist_control.demo

.PHONY: bench
bench: setup-test setup-physics setup-console  ## measure how fast it is, as ratios within one run
	@for script in bench/bench_*.py; do ./env python3 "$$script" || exit $$?; done

.PHONY: mutants
mutants: setup-test  ## put small faults into the code and see that the tests find them
	@./env python3 scripts/mutants.py

.PHONY: hour
hour: setup  ## hold every wrist's stick for a simulated hour: nothing may drift or grow
	@./env python3 scripts/hour.py

.PHONY: campaign
campaign: setup  ## attack the library and the nodes, with a million steps and messages
	@./env python3 scripts/campaign.py

.PHONY: compare
compare: setup  ## fly every wrist through the same maneuvers and compare them
	@./env python3 -m wrist_control.studies.compare

.PHONY: dexterity
dexterity: setup  ## map where each wrist can turn the hand well
	@./env python3 -m wrist_control.studies.dexterity_maps

.PHONY: judge
judge: setup-physics  ## let MuJoCo move every wrist, and compare it with our kinematics
	@./env python3 -m wrist_control.studies.judge

.PHONY: reachy
reachy: setup  ## compare with the kinematics of a Reachy Mini's maker, fetched into out/reachy
	@./env python3 -m pip install --quiet --no-deps --require-hashes --only-binary :all: \
	  --upgrade --target out/reachy -r scripts/reachy_mini.txt
	@./env python3 -m wrist_control.studies.reachy_mini out/reachy

.PHONY: gallery
gallery: setup  ## draw every wrist as its mechanism, still and in motion
	@./env python3 -m wrist_control.studies.gallery

.PHONY: console
console: setup-console  ## hold the stick of a simulated wrist in a web page
	@./env console --ros-args -p start:=three_gimbal

.PHONY: docs
docs: setup-docs  ## write docs/wrists.md from the code, and build the site in out/site
	@./env python3 scripts/wrist_table.py
	@./env python3 -m sphinx -q -E -W --keep-going -n docs out/site
	@echo 'built: out/site/index.html'

.PHONY: clean
clean:  ## remove everything that setup made; figures in out/ stay
	@rm -rf .venv build install log .setup.lock .mypy_cache .pytest_cache .ruff_cache
