"""The gauge chain as a forward model: features of recordings from a gear, effects and the conditions of each one."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from swgsim.chain.chain import SECTORS, Run, distinct, simulate_turns
from swgsim.chain.influence import lobes
from swgsim.chain.motion import NoSteadyState
from swgsim.effects.base import Effect, overrides
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.identification.data.features import Layout
from swgsim.identification.data.unit_lines import Lines, OwnLines

# Samples per revolution; the highest order that is fitted needs more than twice its number.
SAMPLES_PER_TURN = 64
# Recordings whose features are found at once: as many as a cache of the processor holds.
AT_ONCE = 64


@dataclass(frozen=True)
class Situation:
    """An operating point and the conditions under which something was recorded there."""

    point: OperatingPoint
    conditions: Conditions


@dataclass(frozen=True)
class Model:
    """A gear with the effects that are known of it.

    Attributes
    ----------
    gear : Gear
    effects : tuple of Effect
    own_lines : Lines or None
        Where the lines of this gear lie off the chain's, as commissioning found them.
    """

    gear: Gear
    effects: tuple[Effect, ...] = ()
    own_lines: Lines | None = None

    def run(self, situation: Situation) -> Run:
        """The run of the chain in a situation."""
        run = Run(self.gear, situation.point, self.effects, conditions=situation.conditions)
        if self.own_lines is None:
            return run
        gear = run.affected_gear
        moving = tuple(effect for effect in run.acting if overrides(effect, "wave_generator"))
        stroke = lobes(gear.wave_generator, gear.flex_spline.radius, moving) if moving else 1.0
        return replace(run, effects=(OwnLines(self.own_lines, gear.gauges, stroke), *self.effects))

    def plus(self, *effects: Effect) -> "Model":
        """The model with more effects."""
        return replace(self, effects=(*self.effects, *effects))

    def without(self, number: int) -> "Model":
        """The model without one of its effects."""
        return replace(self, effects=self.effects[:number] + self.effects[number + 1 :])


def predict(
    models: Sequence[Model],
    situations: Sequence[Situation],
    layout: Layout,
    sectors: int = SECTORS,
    *,
    search: bool = True,
) -> Float[np.ndarray, "model situation feature"]:
    """Features of every situation by every model, all in one go: what runs have in common is computed once.

    Without ``search``, a motion that is not found at once is an error (NoSteadyState).
    """
    pairs = [(m, s) for m in models for s in situations]
    _, row = distinct([_key(*each) for each in pairs])
    _, first = np.unique(row, return_index=True)
    runs = [m.run(s) for m, s in (pairs[i] for i in first)]
    recordings = simulate_turns(runs, revolutions=1, points=SAMPLES_PER_TURN, sectors=sectors, search=search)
    some = (recordings[i : i + AT_ONCE] for i in range(0, len(recordings), AT_ONCE))
    found = np.concatenate([layout.of(each) for each in some])
    return found[row].reshape(len(models), len(situations), len(layout))


def predict_with_others(
    model: Model, others: Sequence[Model], situations: Sequence[Situation], layout: Layout, sectors: int = SECTORS
) -> tuple[Float[np.ndarray, "situation feature"], Float[np.ndarray, "other situation feature"]]:
    """Features of every situation by a model, and by others that need not exist: nan where one has no steady state.

    Raises
    ------
    NoSteadyState
        If the model itself has none.
    """
    try:
        found = predict([model, *others], situations, layout, sectors=sectors)
        return found[0], found[1:]
    except NoSteadyState:
        known = predict([model], situations, layout, sectors=sectors)[0]
    beside = np.full((len(others), *known.shape), np.nan)
    for other, row in zip(others, beside, strict=True):
        with suppress(NoSteadyState):
            row[:] = predict([other], situations, layout, sectors=sectors)[0]
    return known, beside


def _key(model: Model, situation: Situation) -> tuple:
    """All that a run of the chain depends on; the conditions only where an effect looks at them while recording.

    Models count as different: to compare their gears takes longer than it saves.
    """
    acting = tuple(effect.at(situation.point, situation.conditions) for effect in model.effects)
    seeing = any(overrides(effect, "gauge", "acquisition") for effect in acting)
    return id(model), acting, situation.point, situation.conditions if seeing else None
