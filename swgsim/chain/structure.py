"""Cache of influence maps of structures.

An effect of temperature or speed scales the imposed displacement by another factor in every recording. Maps are smooth
in the factor, so maps of close factors are interpolated between a few common ones.
"""

from collections.abc import Sequence
from functools import lru_cache
from math import prod
from typing import NamedTuple

import numpy as np
from scipy.interpolate import BarycentricInterpolator

from swgsim.chain.influence import LOAD_STEP, InfluenceMap, influence_map
from swgsim.effects.base import Effect, overrides
from swgsim.effects.frozen import ScaledDisplacement
from swgsim.effects.quantity import quantities
from swgsim.flexspline.flexspline import solve_flex_spline
from swgsim.flexspline.gauges import GaugeSet
from swgsim.flexspline.silk_hat import SilkHat
from swgsim.flexspline.structure_factors import StructureFactors
from swgsim.gear.gear import Gear, WaveGenerator

# Distance of the factors whose maps are computed, and those around a factor for interpolation, exact to 1e-8 mV/V.
STEP, AROUND = 0.01, np.arange(-1, 3)


class Structure(NamedTuple):
    """Everything that an influence map depends on, except the mesh."""

    hat: SilkHat
    alpha_tooth: float
    wave_generator: WaveGenerator
    gauges: GaugeSet
    effects: tuple[Effect, ...]
    factors: StructureFactors
    load: float

    @classmethod
    def of(cls, gear: Gear, effects: Sequence[Effect], T_out: float) -> "Structure":
        """The structure of a gear, with the effects that act on it, about an output torque [N m]."""
        places = ("wave_generator", "engaged", "mesh", "carried", "cracks")
        touching = tuple(effect for effect in effects if overrides(effect, *places))
        alpha_tooth = gear.transmission.alpha_tooth
        load = round(T_out / LOAD_STEP) * LOAD_STEP if gear.wave_generator.presses_only else 0.0
        return cls(gear.flex_spline, alpha_tooth, gear.wave_generator, gear.gauges, touching, gear.factors, load)


def map_of(structure: Structure, sectors: int) -> InfluenceMap:
    """The influence map of a structure with a number of sectors."""
    effects = structure.effects
    scaling = [number for number, effect in enumerate(effects) if isinstance(effect, ScaledDisplacement)]
    in_a_row = scaling == list(range(scaling[0], scaling[-1] + 1)) if scaling else False
    factor = prod(effect.factor for effect in effects if isinstance(effect, ScaledDisplacement))
    nodes = (np.floor(factor / STEP) + AROUND) * STEP
    bounds = quantities(ScaledDisplacement)["factor"]
    smooth = not structure.wave_generator.presses_only  # else points of the contact come and go
    if not (in_a_row and smooth) or nodes[0] < bounds.low or nodes[-1] > bounds.high:
        return _computed(structure, sectors)
    before, after = effects[: scaling[0]], effects[scaling[-1] + 1 :]
    scaled = (structure._replace(effects=(*before, ScaledDisplacement(float(node)), *after)) for node in nodes)
    maps = [_computed(each, sectors).coefficients for each in scaled]
    return InfluenceMap(BarycentricInterpolator(nodes, maps)(factor))


@lru_cache(maxsize=512)
def _computed(structure: Structure, sectors: int) -> InfluenceMap:
    flex = solve_flex_spline(structure.hat, structure.alpha_tooth, sectors)
    return influence_map(
        flex, structure.wave_generator, structure.gauges, structure.effects, structure.factors, structure.load
    )
