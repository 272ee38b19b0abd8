"""The steady motion of a gear, by four methods in turn: each takes the runs that the one before could not solve.

====  ==================  ================================================  ================================
try   method              finds                                             where
====  ==================  ================================================  ================================
1     harmonic balance    a nearly linear periodic motion, of many runs     :mod:`swgsim.chain.harmonic_balance`
2     shooting            the same, or its state alone                      :func:`swgsim.chain.motion.shooting`
3     Newton's method     a stable periodic motion with changes of flank    :mod:`swgsim.chain.newton`
4     mean revolution     a motion that does not repeat, such as hunting    :mod:`swgsim.chain.unsteady`
====  ==================  ================================================  ================================
"""

from collections.abc import Sequence
from dataclasses import fields

import numpy as np
from jaxtyping import Float

from swgsim.chain.dynamics import Drive, State
from swgsim.chain.harmonic_balance import one_revolution
from swgsim.chain.motion import Motion, NoSteadyState, advance, revolve, shooting
from swgsim.chain.newton import LEAST_TIMES, stable_revolution
from swgsim.chain.unsteady import mean_revolution


def steady_state(drive: Drive, start_angle: Float[np.ndarray, " run"] | None = None) -> State:
    """The states of runs in their steady motion, with the wave generator at about a start angle.

    Parameters
    ----------
    drive : Drive
    start_angle : array (run,), optional
        Angle of the wave generator [rad], 0 if not given.

    Raises
    ------
    NoSteadyState
        If a gear does not keep turning at about the set speed, or needs too many steps of integration.
    """
    start = np.zeros(len(drive)) if start_angle is None else start_angle
    state, converged = shooting(drive)
    if start.any():
        with np.errstate(over="ignore", invalid="ignore"):  # of runs that did not converge
            state = advance(drive, state, start)
    left = np.flatnonzero(~converged).tolist()
    if left:
        _, state[:, left] = _searched(drive.part(left), start[left], LEAST_TIMES)
    return state


def steady_revolution(drive: Drive, start_angle: Float[np.ndarray, " run"], points: int, search: bool = True) -> Motion:
    """One revolution of each run in its steady motion, in ``points`` even steps of time.

    Parameters
    ----------
    drive : Drive
    start_angle : array (run,)
        Angle of the wave generator at the start [rad].
    points : int
    search : bool
        Whether to search long for a motion that harmonic balance does not find.

    Raises
    ------
    NoSteadyState
        As for :func:`steady_state`; without the search, if a motion is not found at once.
    """
    found, balanced = one_revolution(drive, start_angle, points)
    left = np.flatnonzero(~balanced).tolist()
    if left and not search:
        raise NoSteadyState(f"harmonic balance finds no steady motion of {len(left)} runs")
    if left:
        _put(found, left, _shot(drive.part(left), start_angle[left], points))
    return found


def _shot(drive: Drive, start: Float[np.ndarray, " run"], points: int) -> Motion:
    """One revolution of each run, integrated from its state at the start."""
    state, converged = shooting(drive)
    with np.errstate(over="ignore", invalid="ignore"):  # of runs that did not converge
        found = revolve(drive, advance(drive, state, start) if start.any() else state, points)
    left = np.flatnonzero(~converged).tolist()
    if left:
        _put(found, left, _searched(drive.part(left), start[left], points)[0])
    return found


def _searched(drive: Drive, start: Float[np.ndarray, " run"], points: int) -> tuple[Motion, State]:
    """One revolution of each run, and its state at the start angle, by the methods for few runs."""
    found = Motion.of(np.empty((6, len(drive), points + 1)), drive.period / points)
    state, left = np.empty((5, len(drive))), []
    for i, angle in enumerate(start.tolist()):
        periodic = stable_revolution(drive.part([i]), angle, points)
        if periodic:
            _put(found, [i], periodic.motion)
            state[:, [i]] = periodic.start
        else:
            left.append(i)
    if left:
        motion, state[:, left] = mean_revolution(drive.part(left), start[left], points)
        _put(found, left, motion)
    return found, state


def _put(found: Motion, runs: Sequence[int], motion: Motion) -> None:
    """Write the motion of some runs into that of all."""
    for field in fields(Motion):
        getattr(found, field.name)[runs] = getattr(motion, field.name)
