"""One revolution in the steady state, remembered: fitting a model asks for the same motions again and again."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from swgsim.dynamics import Drive, State
from swgsim.effects.base import Effect
from swgsim.gear import OperatingPoint, Transmission
from swgsim.motion import Motion, advance, revolve, steady_state

# Motions that are remembered at most, 3 kB each.
MOST = 20_000


class Driven(NamedTuple):
    """All that a motion depends on; ``start_angle`` is that of the wave generator at its beginning [rad]."""

    transmission: Transmission
    point: OperatingPoint
    effects: tuple[Effect, ...]
    start_angle: float


_remembered: dict[tuple[Driven, int], tuple[np.ndarray, ...]] = {}


def forget() -> None:
    """Begin anew, so that what follows depends in no digit on what was asked before.

    The steps of the integrator suit the stiffest motion of those that are computed together.
    """
    _remembered.clear()


def settled(driven: Sequence[Driven]) -> tuple[Drive, State]:
    """The drive of some motions, and their state where they begin."""
    transmissions, points, effects, start = zip(*driven, strict=True)
    drive = Drive(transmissions, points, effects)
    state = steady_state(drive)
    return drive, advance(drive, state, np.array(start)) if any(start) else state


def one_turn(driven: Sequence[Driven], points: int) -> Motion:
    """One revolution of the wave generator of each, in so many even steps of time.

    Parameters
    ----------
    driven : sequence of Driven
    points : int
    """
    new = [each for each in driven if (each, points) not in _remembered]
    if len(_remembered) + len(new) > MOST:
        forget()
        new = list(driven)
    if new:
        found = revolve(*settled(new), points)
        dt = np.broadcast_to(found.dt, len(new))
        rows = zip(found.phi_in, found.omega_in, found.omega_out, found.T_in, found.T_out, dt, strict=True)
        _remembered.update(zip([(each, points) for each in new], rows, strict=True))
    return Motion(*(np.stack(part) for part in zip(*(_remembered[each, points] for each in driven), strict=True)))
