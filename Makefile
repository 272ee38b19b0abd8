# "make help" lists the targets. SMALL=1 takes the small grid.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/ready
DEV := $(VENV)/ready-dev
SWG := $(BIN)/swg
GRID := $(if $(SMALL),small,paper)
TABLES := table7 table8 table9 table10
# A small form is one process: further ones would take longer to start than their share of the work.
ALONE := $(if $(SMALL),workers=1)
# The study of transfer: gears to judge, experiments in the order of the report; the small form leaves some out.
STARTED := $(shell date +%s)
GEARS := $(if $(SMALL),gears_small,gears)
TRAINING := $(if $(SMALL),training_small,training)
ON_GEARS := zero_shot zero_shot_forest transfer_network $(if $(SMALL),,transfer_rezero inputs_gears_rocket)
BESIDE := fast_twin $(if $(SMALL),,no_reference units units_rezero)
ON_PAPER := zero_shot_disturbed
comma := ,
JUDGED := $(if $(SMALL),,'gears=[$(subst $() $(),$(comma),$(shell seq 20))]')
QUICK := $(if $(SMALL),shots=[1$(comma)2] draws=1 protocol.folds=2 protocol.development=0 \
         protocol.labelled=2 protocol.unlabelled=1 protocol.kept_out=1)
# Severities and positions at which the twin simulates faults, and gears to train the fast twin on.
FEW_NODES := $(if $(SMALL),resolution.draws=60 resolution.nodes=3 resolution.positions.eccentric_wave_generator=12 resolution.positions.tip_tooth_crack=12)
FEW_GEARS := $(if $(SMALL),classifier.gears=12 classifier.variants=4 classifier.epochs=10)
# Steps and gears of the networks that are trained on simulated gears.
FEW_STEPS := $(if $(SMALL),classifier=perceptron$(comma)resnet classifier.steps=40 features=residual protocol.sources=4 protocol.judged=4)
# The small forms of the loop's studies: effects of every place to hide and to search; undeclared effects that are left out.
FEW_EFFECTS := reduced_damping,warm_grease,flank_friction,input_unbalance,eccentric_wave_generator,cam_form,load_sharing,$(strip \
               )root_tooth_crack,tilting_moment,gauge_gain,channel_skew,mains_hum
LEFT_OUT := tilting_moment strong_tilting_moment channel_skew coning load_sharing stiffening_spring axial_thrust bridge_nonlinearity
# A few trials of the open choices on a small grid. Unusual values cost so much that a start with a single one is the best trial.
FEW_TRIALS := sampled=4 fitted=1 'starts=[{window: 75}]' prior_weight=10 repeats=2 \
              grid.variants=6 grid.positions=2 grid.references=1 'grid.loads_nm=[7$(comma)70]' judged.grid.variants=6 judged.grid.positions=2 \
              classifiers.mlp.iterations=20 classifiers.rf.trees=20 judged.classifiers.mlp.iterations=20 judged.classifiers.rf.trees=20 out=report/small
# Methods on microcontrollers that the small form leaves out.
LARGER := paper_forest paper_forest_selection_3 forest_20 extra_trees_10 extra_trees_30 paper_mlp mlp_32 mlp_128 cnn_16
# Recordings of real joints, where they are; no file of theirs may be in the project.
MEASURED ?= $(firstword $(wildcard measured ../shared/measured))
CORES := $(shell getconf _NPROCESSORS_ONLN)
EXAMPLES ?= yes  # EXAMPLES= builds the site without running them
# The four tables run side by side and share the cores; with two of them every table has one process.
JOBS := $(shell echo $$(( ($(CORES) + 3) / 4 )))

export MLFLOW_DISABLE_TELEMETRY := true
# Many processes start, and without byte code each would compile all that it imports anew. For the same reason nothing is
# compiled at installation: most of the packages' files are never imported.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help install install-dev site data experiments report paper paper-choices transfer loop blind other-benches robots sim-to-real joints embedded test lint scale benchmark convergence docs ui clean $(TABLES)

help:  ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | awk -F ':.*## ' '{printf "make %-12s %s\n", $$1, $$2}'

$(READY): pyproject.toml constraints.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check --no-compile --constraint constraints.txt --editable '.[data,rocket,choices]'
	touch $@

$(DEV): $(READY)
	$(BIN)/pip install --quiet --disable-pip-version-check --no-compile --constraint constraints.txt --editable '.[data,rocket,choices,formats,dask,slurm,postgresql,embedded,dev,site]'
	touch $@

install: $(READY)  ## virtual environment with what the commands need
install-dev: $(DEV)  ## the same with tests, linters, documentation and all extras

data: $(READY)  ## the clean and the disturbed data set
	$(SWG) generate grid=$(GRID) condition=clean $(ALONE)
	$(SWG) generate grid=$(GRID) condition=disturbed $(ALONE)

experiments: data  ## the paper's Tables VII to X, every job a run in MLflow
	@$(MAKE) --no-print-directory --jobs=$(CORES) $(TABLES)

$(TABLES): $(READY)
	$(SWG) train experiment=$@ grid=$(GRID) workers=$(JOBS)

report: $(READY)  ## report/index.html and report/report.json from the finished runs (SMALL=1: in report/small)
	$(SWG) report grid=$(GRID)

paper: $(READY)  ## data sets, runs and report of the paper's tables (SMALL=1: a small grid, report/small, about a minute)
	@started=$$(date +%s) && $(MAKE) --no-print-directory experiments && \
	    $(SWG) report grid=$(GRID) started=$$started
	@echo "open report/$(if $(SMALL),small/)index.html; 'make ui' shows the runs"

paper-choices: $(READY)  ## the choices that the paper leaves open, fitted to its tables, report/paper_choices.html (SMALL=1: a minute)
	OMP_NUM_THREADS=1 $(SWG) paper-choices $(if $(SMALL),$(FEW_TRIALS)) $(ALONE)

# Some experiments run beside the others, because the fast twin and the end of a sweep leave a core idle.
transfer: data  ## beyond the paper: networks, transfer to gears never seen, report/transfer.html (SMALL=1: two minutes)
	@set -e; \
	for grid in $(GEARS) $(TRAINING); do $(SWG) generate grid=$$grid condition=bench $(ALONE); done; \
	for name in $(BESIDE); do $(SWG) train experiment=$$name grid=$(GEARS) $(QUICK) $(FEW_GEARS) workers=1; done & beside=$$!; \
	$(SWG) twin grid=$(GEARS) $(JUDGED) $(FEW_NODES) $(ALONE); \
	for name in $(ON_PAPER); do $(SWG) train experiment=$$name grid=$(GRID) $(ALONE); done; \
	for name in $(ON_GEARS); do $(SWG) train experiment=$$name grid=$(GEARS) $(QUICK) $(ALONE); done; \
	$(SWG) train experiment=inputs_gears grid=$(GEARS) training=$(TRAINING)-bench $(QUICK) $(FEW_STEPS) $(ALONE); \
	$(if $(SMALL),,$(SWG) train experiment=inputs_gears features=residual protocol.sources=20;) \
	wait $$beside; \
	$(SWG) transfer-report grid=$(GEARS) paper_grid=$(GRID) started=$(STARTED)
	@echo "open report/transfer.html; 'make ui' shows the runs"

loop: $(READY)  ## closing the loop once, from nothing: record, hide an effect, find it; loop/answer/page.html (about a minute)
	@set -e; rm -rf loop; \
	$(SWG) record out=loop/commissioning seed=1 sessions.name=commissioning & healthy=$$!; \
	$(SWG) record out=loop/recordings seed=2 'hidden=[{eccentric_wave_generator: {r: 1.0e-5, theta: 1.0}}]'; \
	wait $$healthy; \
	$(SWG) close-loop recordings=loop/recordings commissioning=loop/commissioning \
	    truth=loop/recordings.truth.json out=loop/answer
	@echo "open loop/answer/page.html; 'make ui' shows the run"

blind: $(READY)  ## the loop judged on sealed cases, report/blind.json (SMALL=1: 6 cases, 12 effects)
	$(SWG) blind $(if $(SMALL),cases=6 seed=4 'sectors=[130$(comma)110]' 'library=[$(FEW_EFFECTS)]' blind=blind/small) $(ALONE)

other-benches: $(DEV)  ## the loop on gears that other authors simulated, report/other_benches.json (SMALL=1: one gear of each)
	OMP_NUM_THREADS=1 $(BIN)/python tests/benches benches $(if $(SMALL),--cases 6 --report report/small)

robots: $(DEV)  ## the loop on virtual robot joints of other physics: false effects, report/robots.json (SMALL=1: a dozen joints)
	OMP_NUM_THREADS=1 $(BIN)/python tests/robots robots $(if $(SMALL),--count 6 --foreign 1 --report report/small)

sim-to-real: $(READY)  ## classifiers before and after the loop found an undeclared effect, report/sim_to_real.html (SMALL=1: one effect)
	$(SWG) sim-to-real $(if $(SMALL),grid.variants=4 $(addprefix ~undeclared.,$(LEFT_OUT))) $(ALONE)

joints: $(READY)  ## real robot joints (files: docs/joint_recordings.md), report/joints.html (SMALL=1: one joint)
	$(SWG) joints $(if $(MEASURED),folder=$(MEASURED)) $(if $(SMALL),'only=*joint 1')
	@echo "open report/joints.html, and joints/*/page.html for every case"

embedded: $(DEV)  ## classifiers as C on microcontrollers, report/embedded.md; flash and instructions after scripts/install_arm.sh (SMALL=1: three of them)
	$(SWG) generate grid=$(GEARS) condition=bench $(ALONE)
	$(SWG) generate grid=$(GRID) condition=disturbed $(ALONE)
	$(SWG) embedded unseen=$(GEARS)-bench disturbed=$(GRID)-disturbed \
	    $(if $(SMALL),judged=2 proof=72 counted=4 $(addprefix ~methods.,$(LARGER))) $(ALONE)
	$(SWG) export grid=$(GEARS) target=c numbers=int16
	$(SWG) export grid=$(GEARS) target=onnx

test: $(DEV)  ## all tests and doctests (FAST=1: without the slow ones)
	OMP_NUM_THREADS=1 $(BIN)/python -m pytest -n $(CORES) --dist worksteal -q $(if $(FAST),-m "not slow") $(if $(FAST),,--doctest-modules swgsim learn tests)

lint: $(DEV)  ## style and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

scale: $(DEV)  ## data sets larger than the memory: 15 minutes, 12 GiB (docs/scale.md)
	$(BIN)/python scripts/large.py

benchmark: $(READY)  ## the chain against the obvious ways of doing the same (SMALL=1: a network trained on fewer recordings)
	$(SWG) benchmark $(if $(SMALL),trained=720)

convergence: $(READY)  ## gauge signals against the mesh of the flex spline
	$(BIN)/python -m swgsim.studies.convergence

docs: $(DEV)  ## the pictures of the README and of the calibration of diagnoses, and the page of the effects
	$(BIN)/python -m swgsim.studies.flexspline_figures docs/flexspline.png
	$(BIN)/python -m swgsim.studies.effect_gallery docs
	$(BIN)/python tests/diagnosis_calibration.py docs/diagnosis_calibration.png

site: $(DEV)  ## the documentation site, docs/_build/html/index.html, built strictly and offline
	$(BIN)/sphinx-build -W --keep-going -q -b html $(if $(EXAMPLES),,-D plot_gallery=0) docs docs/_build/html
	@echo "open docs/_build/html/index.html"

ui: $(READY)  ## the runs in the MLflow page, on this machine only
	$(SWG) ui

clean:  ## remove data sets, runs and reports
	rm -rf data mlruns models report outputs loop blind joints embedded docs/_build docs/gallery
