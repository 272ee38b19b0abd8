"""Motion of many runs over a window of samples.

Without effects on the drive the motion repeats with the wave generator, but for the friction over an output revolution
(b3). While that hardly changes in the window, one revolution by harmonic balance serves all samples. All other motions
are integrated step by step.
"""

from dataclasses import fields

import numpy as np
from jaxtyping import Float

from swgsim.chain.dynamics import Drive
from swgsim.chain.harmonic_balance import one_revolution
from swgsim.chain.influence import harmonics
from swgsim.chain.motion import Motion, run
from swgsim.chain.settling import steady_state

# Points of a revolution per wave of the highest order of the kinematic error, as in harmonic balance.
PER_WAVE, LEAST_POINTS = 8, 32
# Orders of a motion below this share of the largest one are omitted.
NEGLIGIBLE_MOTION_ORDER = 1e-8
# Drift of the friction that no torque flange at the output resolves, whose readings repeat to 0.05 N m [N m].
UNRESOLVED_DRIFT = 0.02
CHANNELS = [field.name for field in fields(Motion) if field.name != "dt"]


def over_window(drive: Drive, start_angle: Float[np.ndarray, " run"], dt: float, count: int) -> Motion:
    """The steady motion of each run at ``count`` + 1 points that lie ``dt`` [s] apart.

    Parameters
    ----------
    drive : Drive
    start_angle : array (run,)
        Angle of the wave generator at the first point [rad].
    dt : float
    count : int
    """
    found = np.empty((6, len(drive), count + 1))
    left = np.array([bool(effects) for effects in drive.effects]) | (_drift(drive, count * dt) > UNRESOLVED_DRIFT)
    if not left.all():
        repeating = np.flatnonzero(~left)
        calm = drive if len(repeating) == len(drive) else drive.part(repeating.tolist())
        found[:, repeating], balanced = _repeated(calm, start_angle[repeating], dt, count)
        left[repeating[~balanced]] = True
    if left.any():
        others = np.flatnonzero(left)
        part = drive.part(others.tolist())
        motion = run(part, steady_state(part, start_angle[others]), dt, count)
        found[:, others] = [getattr(motion, name) for name in CHANNELS]
    return Motion.of(found, dt)


def _drift(drive: Drive, duration: float) -> Float[np.ndarray, " run"]:
    """Largest change of the output torque by that friction, from the middle of a window [N m]."""
    turned = drive.omega / (drive.p["N"] + 1) * duration / 2
    return drive.p["b3"] * np.minimum(turned, 2) / drive.sin_t


def _repeated(
    drive: Drive, start_angle: Float[np.ndarray, " run"], dt: float, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """Channels (channel, run, time) of motions that repeat, and which of them harmonic balance found.

    The friction over an output revolution (b3) is that in the middle of the window: the revolution that is computed is
    the middle one.
    """
    points = max(LEAST_POINTS, PER_WAVE * max(drive.error, default=1))
    before = 2 * np.pi * np.floor((count * dt / drive.period - 1).clip(0) / 2)
    turn, balanced = one_revolution(drive, start_angle + before, points, points)
    even = 2 * np.pi * np.arange(points) / points
    periodic = np.stack([getattr(turn, name)[:, :-1] for name in CHANNELS], axis=1)  # (run, channel, point)
    periodic[:, 0] -= even
    lines = np.fft.rfft(periodic, norm="forward")[..., :-1]
    lines[..., 1:] *= 2
    lines[~balanced] = 0  # they may have diverged, and must not decide which orders of the others are kept
    size = np.abs(lines).max(axis=0)
    orders = np.flatnonzero((size > NEGLIGIBLE_MOTION_ORDER * size.max(axis=1, keepdims=True)).any(axis=0))
    lines = lines[..., orders]
    weights = np.concatenate([lines.real, -lines.imag], axis=2)
    found, time = np.empty((6, len(drive), count + 1)), dt * np.arange(count + 1)
    for i, omega in enumerate(drive.omega):
        waves = harmonics(omega * time, orders)
        np.matmul(weights[i], np.concatenate([waves.real, waves.imag]), out=found[:, i])
    found[0] += drive.omega[:, None] * time - before[:, None]
    return found, balanced
