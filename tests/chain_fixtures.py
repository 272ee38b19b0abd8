"""Small gears, plans and structures that several tests of the chain share."""

from dataclasses import replace
from functools import cache

import numpy as np

from swgsim.chain.influence import InfluenceMap, influence_map
from swgsim.dataset.faults import Variants
from swgsim.dataset.grid import Grid
from swgsim.dataset.plan import Plan
from swgsim.flexspline.flexspline import FlexSpline, solve_flex_spline
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear, OperatingPoint

GEAR = Gear()
SECTORS = 60
SEVERITIES = {
    "reduced_damping": (0.67, 0.9),
    "reduced_stiffness": (0.8, 0.95),
    "eccentric_wave_generator": (2e-5, 1e-4),
    "root_tooth_crack": (0.1, 0.01),
    "tip_tooth_crack": (0.5, 1.0),
}


@cache
def flex_spline(sectors: int = SECTORS) -> FlexSpline:
    """The default flex spline on a coarse mesh."""
    return solve_flex_spline(GEAR.flex_spline, GEAR.transmission.alpha_tooth, sectors)


def map_of(*effects: object, sectors: int = SECTORS) -> InfluenceMap:
    """The influence map of an ideal gear with effects."""
    return influence_map(flex_spline(sectors), GEAR.wave_generator, GEAR.gauges, effects)


def small_plan(**changes: object) -> Plan:
    """Two gears, two operating points, two variants of each class."""
    second = replace(GEAR, number=2, gauges=replace(GEAR.gauges, offset=(0.001, 0.002, 0.0, -0.001, 0.003)))
    points = (OperatingPoint(2000, 39), OperatingPoint(4000, 70))
    grid = Grid(points, Variants(2, 1, SEVERITIES), references=2, seed=5)
    plan = Plan((GEAR, second), grid, Window(), sectors=SECTORS, configuration="small test plan")
    return replace(plan, **changes)


def amplitude(values: np.ndarray) -> float:
    """Half the range of a signal."""
    return 0.5 * float(np.ptp(values))
