# "make help" lists the targets. SMALL=1 takes the small grid.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/ready
GRID := $(if $(SMALL),small,paper)
TABLES := table7 table8 table9 table10
# The study of transfer: gears to judge, experiments in the order of the report; the small form leaves some out.
STARTED := $(shell date +%s)
GEARS := $(if $(SMALL),gears_small,gears)
FOREIGN := $(if $(SMALL),,far-bench few-bench few-noisy few-other_day)
ON_GEARS := zero_shot $(if $(SMALL),inputs_small,inputs inputs_features) transfer_network transfer_forest \
            $(if $(SMALL),,zero_shot_lines zero_shot_signals inputs_operating_point no_reference) \
            $(if $(SMALL),,transfer_extra_trees transfer_cnn transfer_map transfer_map_foreign)
ON_PAPER := zero_shot_disturbed $(if $(SMALL),,forest_robustness network_robustness)
comma := ,
QUICK := $(if $(SMALL),shots=[1$(comma)2] draws=1 protocol.folds=2 protocol.development=0 \
         protocol.labelled=2 protocol.unlabelled=1 protocol.kept_out=1)
# The small forms of the loop's studies: effects of every place to hide and to search; undeclared effects that are left out.
FEW_EFFECTS := reduced_damping,warm_grease,flank_friction,input_unbalance,eccentric_wave_generator,cam_form,load_sharing,$(strip \
               )root_tooth_crack,tilting_moment,gauge_gain,channel_skew,mains_hum
LEFT_OUT := tilting_moment strong_tilting_moment channel_skew coning load_sharing stiffening_spring axial_thrust bridge_nonlinearity
# Methods on microcontrollers that the small form leaves out.
LARGER := paper_forest paper_forest_selection_3 forest_20 extra_trees_10 extra_trees_30 paper_mlp mlp_32 mlp_128 cnn_16
# Recordings of real joints, where they are; no file of theirs may be in the project.
MEASURED ?= $(firstword $(wildcard measured ../shared/measured))
CORES := $(shell nproc)
# The four tables run side by side and share the cores; with two of them every table has one process.
JOBS := $(shell echo $$(( ($(CORES) + 3) / 4 )))

export MLFLOW_DISABLE_TELEMETRY := true

.DEFAULT_GOAL := help
.PHONY: help install data experiments report paper transfer loop blind sim-to-real joints embedded test lint fuzz chaos scale benchmark convergence docs ui clean $(TABLES)

help:  ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | awk -F ':.*## ' '{printf "make %-12s %s\n", $$1, $$2}'

$(READY): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev,rocket,dask,slurm,postgresql,embedded]'
	touch $@

install: $(READY)  ## virtual environment with everything in it

data: $(READY)  ## the clean and the disturbed data set
	$(BIN)/python scripts/generate.py grid=$(GRID) condition=clean
	$(BIN)/python scripts/generate.py grid=$(GRID) condition=disturbed

experiments: data  ## the paper's Tables VII to X, every job a run in MLflow
	@$(MAKE) --no-print-directory --jobs=$(CORES) $(TABLES)

$(TABLES): $(READY)
	$(BIN)/python scripts/train.py experiment=$@ grid=$(GRID) workers=$(JOBS)

report: $(READY)  ## report/index.html and report/report.json from what has been run
	$(BIN)/python scripts/report.py grid=$(GRID)

paper: $(READY)  ## from nothing to the paper's tables beside ours (SMALL=1: a small grid, about a minute)
	@started=$$(date +%s) && $(MAKE) --no-print-directory experiments && \
	    $(BIN)/python scripts/report.py grid=$(GRID) started=$$started
	@echo "open report/index.html; 'make ui' shows the runs"

transfer: data  ## beyond the paper: networks, transfer to gears never seen, report/transfer.html (SMALL=1: under two minutes)
	@set -e; \
	for set in $(GEARS)-bench $(FOREIGN); do $(BIN)/python scripts/generate.py grid=$${set%-*} condition=$${set##*-}; done; \
	$(BIN)/python scripts/oracle.py grid=$(GEARS); \
	for name in $(ON_PAPER); do $(BIN)/python scripts/train.py experiment=$$name grid=$(GRID); done; \
	for name in $(ON_GEARS); do $(BIN)/python scripts/train.py experiment=$$name grid=$(GEARS) $(QUICK); done; \
	$(if $(SMALL),,$(BIN)/python scripts/train.py experiment=harder_splits grid=$(GEARS);) \
	$(BIN)/python scripts/transfer_report.py grid=$(GEARS) paper_grid=$(GRID) started=$(STARTED)
	@echo "open report/transfer.html; 'make ui' shows the runs"

loop: $(READY)  ## closing the loop once, from nothing: record, hide an effect, find it; loop/answer/page.html (45 s)
	@set -e; rm -rf loop; \
	$(BIN)/python scripts/record.py out=loop/commissioning seed=1 sessions.name=commissioning; \
	$(BIN)/python scripts/record.py out=loop/recordings seed=2 'hidden=[{eccentric_wave_generator: {r: 1.0e-5, theta: 1.0}}]'; \
	$(BIN)/python scripts/close_loop.py recordings=loop/recordings commissioning=loop/commissioning \
	    truth=loop/recordings.truth.json out=loop/answer
	@echo "open loop/answer/page.html; 'make ui' shows the run"

blind: $(READY)  ## the loop judged on sealed cases, report/blind.json (SMALL=1: 20 cases, 12 effects)
	$(BIN)/python scripts/blind.py $(if $(SMALL),cases=20 seed=4 'sectors=[130$(comma)110]' 'library=[$(FEW_EFFECTS)]' blind=blind/small)

sim-to-real: $(READY)  ## classifiers before and after the loop found an undeclared effect, report/sim_to_real.html (SMALL=1: one effect)
	$(BIN)/python scripts/sim_to_real.py $(if $(SMALL),grid.variants=4 $(addprefix ~undeclared.,$(LEFT_OUT)))

joints: $(READY)  ## real robot joints (files: docs/joint_recordings.md), report/joints.html (SMALL=1: one joint)
	$(BIN)/python scripts/joints.py $(if $(MEASURED),folder=$(MEASURED)) $(if $(SMALL),'only=*joint 1')
	@echo "open report/joints.html, and joints/*/page.html for every case"

embedded: $(READY)  ## classifiers as C on microcontrollers, report/embedded.md; flash and instructions after scripts/install_arm.sh (SMALL=1: three of them)
	$(BIN)/python scripts/generate.py grid=$(GEARS) condition=bench
	$(BIN)/python scripts/generate.py grid=$(GRID) condition=disturbed
	$(BIN)/python scripts/embedded.py unseen=$(GEARS)-bench disturbed=$(GRID)-disturbed \
	    $(if $(SMALL),judged=2 proof=72 counted=4 $(addprefix ~methods.,$(LARGER)))
	$(BIN)/python scripts/export.py grid=$(GEARS) target=c numbers=int16
	$(BIN)/python scripts/export.py grid=$(GEARS) target=onnx

test: $(READY)  ## all tests
	OMP_NUM_THREADS=1 $(BIN)/python -m pytest -n 2 --dist loadfile -q

lint: $(READY)  ## style and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

fuzz: $(READY)  ## every reader on damaged files, SECONDS=300 in all (docs/reliability.md)
	OMP_NUM_THREADS=1 ARROW_DEFAULT_MEMORY_POOL=system $(BIN)/python scripts/fuzz.py --seconds $(or $(SECONDS),300)

chaos: $(READY)  ## data sets and sweeps killed at random moments, KILLS=200 (docs/reliability.md)
	OMP_NUM_THREADS=1 $(BIN)/python scripts/chaos.py --kills $(or $(KILLS),200)

scale: $(READY)  ## data sets larger than the memory: 15 minutes, 12 GiB (docs/scale.md)
	$(BIN)/python scripts/large.py

benchmark: $(READY)  ## the chain against the obvious ways of doing the same
	$(BIN)/python scripts/benchmark.py

convergence: $(READY)  ## gauge signals against the mesh of the flex spline
	$(BIN)/python -m swgsim.studies.convergence

docs: $(READY)  ## the picture of the README and the page of the effects
	$(BIN)/python -m swgsim.studies.flexspline_figures docs/flexspline.png
	$(BIN)/python -m swgsim.studies.effect_gallery docs

ui: $(READY)  ## the runs in the MLflow page, on this machine only
	$(BIN)/python scripts/ui.py

clean:  ## remove data sets, runs and reports
	rm -rf data mlruns models report outputs loop blind joints embedded
