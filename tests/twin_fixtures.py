"""One gear of a series on a coarse mesh, its recordings on a bench, and what is known before them."""

from dataclasses import replace
from functools import cache

from chain_fixtures import GEAR, SEVERITIES, small_plan

from swgsim.bench.scatter import Bench
from swgsim.dataset.faults import Variants
from swgsim.dataset.grid import Grid
from swgsim.dataset.simulate_cases import record
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import OperatingPoint
from swgsim.gear.population import Population
from swgsim.oracle.cells import Resolution
from swgsim.storage.labelled_signals import LabelledSignals
from swgsim.twin import Knowledge

POINTS = (OperatingPoint(4000.0, 20.0), OperatingPoint(4000.0, 60.0))
SECTORS = 40
# Small faults, so that a twin errs now and then.
SMALL = SEVERITIES | {
    "reduced_damping": (0.85, 0.99),
    "reduced_stiffness": (0.9, 0.99),
    "eccentric_wave_generator": (5e-6, 3e-5),
    "tip_tooth_crack": (0.02, 0.5),
}
DRAWN = Population(2).draw(GEAR, seed=5)[1]
PLAN = small_plan(
    gears=(DRAWN,),
    grid=Grid(POINTS, Variants(20, 1, SMALL, drawn=True), references=20, scatter=0.005, seed=5),
    bench=Bench(),
    sectors=SECTORS,
    window=Window(samples=160),
)
RESOLUTION = Resolution(
    draws=100,
    severities=dict.fromkeys(SMALL, 8),
    positions={"eccentric_wave_generator": 12, "tip_tooth_crack": 24},
    finer=2,
)
KNOWLEDGE = Knowledge(replace(PLAN, gears=(GEAR,)), RESOLUTION)


@cache
def recordings() -> LabelledSignals:
    """References and samples of the gear."""
    return record(PLAN, list(PLAN.grid.cases(DRAWN)))
