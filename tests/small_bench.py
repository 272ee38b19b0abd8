"""A small bench for runs from end to end: few and short recordings, on a coarse mesh that the model has as well."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from swgsim.bench.scatter import Bench
from swgsim.bench.virtual_bench import Instruments, Sessions, record_sessions
from swgsim.chain.chain import simulate_turns
from swgsim.effects import Effect
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.identification.data import model
from swgsim.recordings.recording import Recording

SECTORS = 40
POINTS = tuple(OperatingPoint(n, T) for n in (2000.0, 4000.0) for T in (10.0, 70.0))


@contextmanager
def coarse_model() -> Iterator[pytest.MonkeyPatch]:
    """The model on the mesh of the bench."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(model, "simulate_turns", lambda *of, **how: simulate_turns(*of, **{**how, "sectors": SECTORS}))
        yield patch


def recorded(
    gear: Gear, *effects: Effect, seed: int, points: tuple[OperatingPoint, ...] = POINTS
) -> tuple[Recording, ...]:
    """Two recordings of each operating point.

    They are so short that slow noise of an amplifier could not be separated from lines between the orders: it has none.
    """
    plan, still = Sessions(points, repeats=2, revolutions=5), Instruments(wander=0.0)
    return record_sessions(
        gear, effects, plan, Bench(), seed=seed, window=Window(), sectors=SECTORS, name="A", instruments=still
    )
