# Two commands matter: `make run` and `make test`. `make help` lists the rest.
.DEFAULT_GOAL := help
.PHONY: help setup dev run view serve test load soak compose-load compose-test check fuzz bench experiments catalogue train-grasps docs docs-serve pictures proto lock clean

SAMPLE ?= experiments/samples/bottle.npz
TASK ?= pouring
PICTURE ?= out/grasp.png

help:  ## List the targets
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

setup:  ## System libraries and .venv from the hashed lock
	@./setup.sh

dev:  ## The same with what tests, style and documentation need
	@./setup.sh dev

run: setup  ## The main job on a bundled view: region, grasps, explanation, timings, a picture
	@.venv/bin/sparge grasp $(SAMPLE) --task $(TASK) --save $(PICTURE)

view: setup  ## The page in the browser on http://127.0.0.1:8080: look, ask, teach, try
	@.venv/bin/sparge view $(VIEWS)

serve: setup  ## The embedded backend on http://127.0.0.1:8000
	@.venv/bin/sparge serve

test: dev  ## All tests, on every core (four at most)
	@.venv/bin/python -m pytest --numprocesses=auto --maxprocesses=4 --dist=worksteal

load: dev  ## The embedded backend under load: 1 to 64 clients, open loop; five minutes
	@.venv/bin/python -m tests.load

soak: dev  ## Ten minutes of load on the embedded backend with an eye on its memory
	@.venv/bin/python -m tests.load --clients --rates --soak 600

compose-load: dev  ## The same load on the images, on a Docker engine
	@docker compose up --detach --build --wait
	@.venv/bin/python -m tests.load --url http://127.0.0.1:8000 --compose $(notdir $(CURDIR)); \
	status=$$?; docker compose down; exit $$status

compose-test: dev  ## The images on a real Docker engine: build, ask, scale, kill, stop
	@docker info >/dev/null 2>&1 || { echo "compose-test: no Docker engine answers" >&2; exit 1; }
	@# The images choose OpenBLAS's kernels by the processor: so must what they are compared with.
	@SPARGE_COMPOSE_TEST=1 env --unset=OPENBLAS_CORETYPE .venv/bin/python -m pytest tests/compose

check: dev  ## ruff and mypy --strict
	@.venv/bin/ruff check .
	@.venv/bin/ruff format --check .
	@.venv/bin/mypy

CASES ?= 2000
FUZZ_SEED ?= $(shell date +%s)
FUZZ_LIMIT ?= 2h
FUZZED = tests/contract/test_conformance.py tests/services/gateway/test_file_reader.py \
	tests/services/gateway/test_hostile_files.py

fuzz: dev  ## Made-up requests to every service and damaged files, CASES of each; two hours at most
	@echo "FUZZ_SEED=$(FUZZ_SEED)"
	@SPARGE_FUZZ_CASES=$(CASES) SPARGE_FUZZ_SEED=$(FUZZ_SEED) timeout $(FUZZ_LIMIT) \
		.venv/bin/python -m pytest --numprocesses=auto --maxprocesses=4 --dist=worksteal $(FUZZED)

bench: dev  ## Reasoning under load: memory over 100,000 requests, decision times; half an hour
	@.venv/bin/python -m tests.bench

EXPERIMENTS ?= regions primitives grasps timing extension robustness shapes tuning demo

experiments: setup  ## Every table of the thesis beside ours, in results/report.html
	@for name in $(EXPERIMENTS); do .venv/bin/sparge experiment $$name $(OPTIONS) || exit 1; done

catalogue: setup  ## The contact sheet of all objects, docs/images/catalogue.png
	@.venv/bin/python -m experiments.contact_sheet

TRIALS ?= out/trials
OBJECTS ?=
TRIAL_PORT ?= 8399
TORCH ?= torch==2.13.0 --extra-index-url https://download.pytorch.org/whl/cpu

train-grasps: dev  ## The scorer of grasps anew: trials in physics, then training
	@.venv/bin/pip install --quiet --require-hashes -r requirements-training.lock
	@.venv/bin/pip install --quiet $(TORCH)
	@SPARGE_EXECUTION_WORKERS=2 .venv/bin/sparge serve --port $(TRIAL_PORT) --log-level warning & \
	backend=$$!; trap "kill $$backend" EXIT; \
	.venv/bin/python -m experiments.trials $(TRIALS) --url http://127.0.0.1:$(TRIAL_PORT) \
		--wait 300 --workers 2 $(if $(OBJECTS),--objects $(OBJECTS))
	@.venv/bin/python -m services.grasp_proposal.train $(TRIALS)

docs: dev  ## The documentation site, out/site/index.html; a broken link fails it
	@NO_MKDOCS_2_WARNING=1 .venv/bin/mkdocs build --quiet -f docs/site/mkdocs.yml
	@echo out/site/index.html

docs-serve: dev  ## The same on http://127.0.0.1:8100, built anew when a page changes
	@NO_MKDOCS_2_WARNING=1 .venv/bin/mkdocs serve --quiet -f docs/site/mkdocs.yml -a 127.0.0.1:8100

PICTURE_PORT ?= 8398

pictures: dev  ## The pictures of the documentation anew, docs/images, from answers of a backend
	@.venv/bin/sparge serve --port $(PICTURE_PORT) --log-level warning & \
	backend=$$!; trap "kill $$backend" EXIT; \
	.venv/bin/python -m experiments.pictures --url http://127.0.0.1:$(PICTURE_PORT) --wait 120

proto: dev  ## Write services/grpc/generated anew from proto/sparge.proto
	@.venv/bin/python -m grpc_tools.protoc --proto_path=proto --python_out=services/grpc/generated \
		--pyi_out=services/grpc/generated proto/sparge.proto

lock: dev  ## Write the dependency locks anew from pyproject.toml
	@docker/lock.sh

clean:  ## Remove what make made
	rm -rf .venv out results .mypy_cache .ruff_cache .pytest_cache .hypothesis
