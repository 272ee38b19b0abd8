"""Motion that does not repeat with each revolution: integrated until the start is forgotten, then averaged.

A slow speed control lets the gear hunt: the speed falls towards the resonance, the ripple takes power, the speed rises
again. One period of that is about half a period of the speed control, so it takes some to tens of revolutions. The
lines of a recording are means over its revolutions. Here they are means over many.

The angle of the wave generator is the independent variable here, not the time: then revolutions can be averaged point
by point, and the mean of A(psi) + T_out B(psi) is that with the mean torque at each angle.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline

from swgsim.chain.dynamics import OMEGA_IN, PHI_IN, PHI_OUT, Drive, State
from swgsim.chain.equilibrium import resonance, uniform_rotation
from swgsim.chain.motion import Motion, NoSteadyState, steps_per_revolution

# Periods of the speed control until the start is forgotten, and over which revolutions are averaged.
SETTLING, AVERAGED = 4.0, 8.0
# Least number of revolutions for each of the two, and largest number. Two thirds of the largest suffice for a speed
# control of 1 Hz at 2000 rpm.
LEAST_TURNS, MOST_TURNS = 16, 400
# A mean speed that is further from the set speed, as a share of it, belongs to no operating point. Recordings are
# warned of at the same share.
SPEED_TOLERANCE = 0.02

# Over a revolution: time per angle, angle of the output per angle of the input, and three torques.
AVERAGED_QUANTITIES = 5


class Averaged(NamedTuple):
    """Mean revolution of each run, and the states after the last one, arrays (5, run)."""

    motion: Motion
    end: State


def mean_revolution(drive: Drive, start_angle: Float[np.ndarray, " run"], points: int) -> Averaged:
    """The mean revolution after a start from uniform rotation, in ``points`` even steps of time.

    The friction over an output revolution (b3) starts again with each revolution of the input, as in the harmonic
    balance.

    Parameters
    ----------
    drive : Drive
    start_angle : array (run,)
        Angle of the wave generator at the start [rad].
    points : int

    Raises
    ------
    NoSteadyState
        If a gear does not keep turning at about the set speed.
    """
    steps = points * -(-steps_per_revolution(drive) // points)
    state = uniform_rotation(drive)
    state[PHI_IN] = start_angle
    state[PHI_OUT] += start_angle / (drive.p["N"] + 1)
    periods = drive.p["control_frequency"] * drive.period  # of the speed control, in a revolution
    settling, averaged = (
        int(np.clip(np.ceil(of / periods.min()), LEAST_TURNS, MOST_TURNS)) for of in (SETTLING, AVERAGED)
    )
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):  # of runs that do not keep turning
        for _ in range(settling):
            state, _ = _revolution(drive, state, steps)
            if not np.isfinite(state).all():
                break
        weights = np.hanning(averaged + 2)[1:-1]  # so that it matters little where the mean begins and ends
        mean = np.zeros((AVERAGED_QUANTITIES, steps, len(drive)))
        for weight in weights / weights.sum():
            state, kept = _revolution(drive, state, steps)
            mean += weight * kept
            if not np.isfinite(state).all():
                break
        _require_speed(drive, state, mean)
    return Averaged(_even_in_time(drive, mean, start_angle, points), state)


def _revolution(drive: Drive, state: State, steps: int) -> tuple[State, Float[np.ndarray, "5 step run"]]:
    """The state after one revolution in even steps of the angle, counted from its start again; and what is kept."""
    kept, step = np.empty((AVERAGED_QUANTITIES, steps, len(drive))), 2 * np.pi / steps

    def rate(there: State) -> State:
        return drive.derivative(there, drive.torques(there)) / there[OMEGA_IN]

    for i in range(steps):  # as Drive.step, over the angle
        torques = drive.torques(state)
        by_angle = drive.derivative(state, torques) / state[OMEGA_IN]
        kept[:, i] = 1 / state[OMEGA_IN], by_angle[PHI_OUT], torques.T_in, torques.T_out, torques.T_flange
        k2 = rate(state + 0.5 * step * by_angle)
        k3 = rate(state + 0.5 * step * k2)
        k4 = rate(state + step * k3)
        state = state + step / 6 * (by_angle + 2 * (k2 + k3) + k4)
    state[PHI_IN] -= 2 * np.pi
    state[PHI_OUT] -= 2 * np.pi / (drive.p["N"] + 1)
    return state, kept


def _require_speed(drive: Drive, state: State, mean: Float[np.ndarray, "5 step run"]) -> None:
    """Refuse runs that do not turn at about the set speed."""
    ratio = 1 / (mean[0].mean(axis=0) * drive.omega)
    turning = np.isfinite(state).all(axis=0) & np.isfinite(mean).all(axis=(0, 1)) & (mean[0] > 0).all(axis=0)
    held = turning & (np.abs(ratio - 1) < SPEED_TOLERANCE)
    if held.all():
        return
    i = int(held.argmin())
    set_speed, load = drive.points[i].n_in_rpm, drive.points[i].T_out
    found = f"turns at {ratio[i] * set_speed:.4g} rpm in the mean" if turning[i] else "does not keep turning"
    raise NoSteadyState(
        f"the gear at {set_speed:g} rpm and {load:g} N m {found}: its speed control of "
        f"{drive.p['control_frequency'][i]:.3g} Hz does not hold the speed within {100 * SPEED_TOLERANCE:g} %; look at "
        f"the friction (b1 {drive.p['b1'][i]:.3g} N m s/rad, b2 {drive.p['b2'][i]:.3g} N m s^3/rad^3), at the "
        f"resonance of {resonance(drive)[i]:.3g} Hz, and at effects on the drive"
    )


def _even_in_time(
    drive: Drive, mean: Float[np.ndarray, "5 step run"], start_angle: Float[np.ndarray, " run"], points: int
) -> Motion:
    """The mean revolution at even times, from its values at even angles."""
    steps = mean.shape[1]
    angle = 2 * np.pi * np.arange(steps + 1) / steps
    share = np.arange(points + 1) / points
    channels = np.empty((6, len(drive), points + 1))
    for i, values in enumerate(np.moveaxis(mean, 2, 0)):
        time_per_angle, out_per_angle, *torques = np.concatenate([values, values[:, :1]], axis=1)
        passed = CubicSpline(angle, time_per_angle, bc_type="periodic").antiderivative()(angle)
        passed /= passed[-1]
        lead = np.append(angle[:-1] - 2 * np.pi * passed[:-1], 0.0)
        periodic = np.stack([lead, 1 / time_per_angle, out_per_angle / time_per_angle, *torques], axis=1)
        channels[:, i] = CubicSpline(passed, periodic, bc_type="periodic")(share).T
        channels[0, i] += start_angle[i] + 2 * np.pi * share
    return Motion.of(channels, drive.period / points)
