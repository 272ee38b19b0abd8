"""Cache of steady states: a fit needs the same motions many times."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from swgsim.chain.dynamics import Drive
from swgsim.chain.motion import Motion
from swgsim.chain.settling import steady_revolution
from swgsim.effects.base import Effect
from swgsim.gear.gear import OperatingPoint, Transmission

# Largest number of cached motions, 3 kB each.
MOST_MOTIONS = 20_000


class Driven(NamedTuple):
    """Everything that a motion depends on; ``start_angle`` is the angle of the wave generator at its start [rad]."""

    transmission: Transmission
    point: OperatingPoint
    effects: tuple[Effect, ...]
    start_angle: float


_remembered: dict[tuple[Driven, int], tuple[np.ndarray, ...]] = {}


def forget() -> None:
    """Empty the cache, so that later results do not depend on earlier calls in any digit.

    Motions that are computed together are corrected until the last of them has converged.
    """
    _remembered.clear()


def one_turn(driven: Sequence[Driven], points: int, search: bool = True) -> Motion:
    """One revolution of the wave generator for each motion, in ``points`` even steps of time.

    Parameters
    ----------
    driven : sequence of Driven
    points : int
    search : bool
        As for :func:`~swgsim.chain.settling.steady_revolution`.
    """
    new = [each for each in driven if (each, points) not in _remembered]
    if len(_remembered) + len(new) > MOST_MOTIONS:
        forget()
        new = list(driven)
    if new:
        _remember(new, steady_revolution(*drive_of(new), points, search))
    return Motion(*(np.stack(part) for part in zip(*(_remembered[each, points] for each in driven), strict=True)))


def drive_of(driven: Sequence[Driven]) -> tuple[Drive, np.ndarray]:
    """The drive of some motions, and their start angles."""
    transmissions, points, effects, start = zip(*driven, strict=True)
    return Drive(transmissions, points, effects), np.array(start)


def _remember(driven: Sequence[Driven], found: Motion) -> None:
    dt = np.broadcast_to(found.dt, len(driven))
    of_runs = found.phi_in, found.omega_in, found.omega_out, found.T_in, found.T_out, found.T_flange, dt
    rows = zip(*of_runs, strict=True)
    points = found.phi_in.shape[1] - 1
    _remembered.update(zip([(each, points) for each in driven], rows, strict=True))
