"""The periodic motion of many runs at once, by harmonic balance instead of integrating until it settles.

The equations of motion hold at even times over one revolution of the wave generator. The drive is nearly linear about
its uniform rotation, so each correction by that linear system leaves about a tenth of what was missed; half of it where
an effect is as strong as it may be.
"""

import numpy as np
from jaxtyping import Bool, Complex, Float

from swgsim.chain.dynamics import OMEGA_IN, OMEGA_OUT, PHI_IN, PHI_OUT, SPEED_ERROR, Drive, State
from swgsim.chain.motion import Motion, kept_of

# Times at which the equations hold, at least: eight for each wave of the highest order that the loop compares.
TIMES = 96
# The last correction is below this, relatively, and is one of so many.
TOLERANCE, CORRECTIONS = 1e-9, 40
# Of the differences, relatively.
STEP = 1e-6

# Input and output.
Lines = Complex[np.ndarray, "2 order run"]


def one_revolution(
    drive: Drive, start_angle: Float[np.ndarray, " run"], points: int
) -> tuple[Motion, Bool[np.ndarray, " run"]]:
    """One revolution of the wave generator from an angle on, in so many even steps of time, and which runs settled.

    The friction that varies over an output revolution (b3) begins anew with each revolution of the input here.

    Parameters
    ----------
    drive : Drive
    start_angle : array (run,)
        Of the wave generator [rad].
    points : int
    """
    each = -(-TIMES // points)
    each += each * points % 2  # an even number of times
    turn = 2 * np.pi * np.arange(points * each)[:, None] / (points * each)
    _, speed_in, phi_out, speed_out, speed_error = drive.at_rest_in_rotating_frame()
    by_time = 1j * np.arange(len(turn) // 2 + 1)[:, None] * drive.omega
    by_time[-1] = 0  # the derivative of the last one vanishes at all times
    # Of what deviates from uniform rotation; at the first time the angle of the input does not.
    lines = np.zeros((2, *by_time.shape), complex)
    lines[1, 0] = phi_out

    def at_all_times() -> State:
        beside_in, beside_out = np.fft.irfft(lines, len(turn), axis=1, norm="forward")
        faster_in, faster_out = np.fft.irfft(by_time * lines, len(turn), axis=1, norm="forward")
        return np.stack([
            start_angle + turn + beside_in, speed_in + faster_in,
            (start_angle + turn) / (drive.p["N"] + 1) + beside_out, speed_out + faster_out,
            speed_error - beside_in,
        ])  # fmt: skip

    linear = _Linear(drive, at_all_times(), by_time)
    speed = np.stack([speed_in, speed_out])
    with np.errstate(over="ignore", invalid="ignore"):  # of runs that do not settle
        for _ in range(CORRECTIONS):
            state = at_all_times()
            missed = by_time**2 * lines - np.fft.rfft(_accelerations(drive, state), axis=1, norm="forward")
            by, of_error = linear.correction(missed)
            lines, speed_error = lines + by, speed_error + of_error
            moved = np.abs(by_time * by).sum(axis=1) / speed + np.abs(by[:, 0]) * drive.omega / speed
            settled = moved.max(axis=0) < TOLERANCE
            if settled.all():
                break
        state = at_all_times()
        torques = drive.torques(state)
    kept = np.stack(kept_of(state, torques))[:, ::each]
    kept = np.concatenate([kept, kept[:, :1]], axis=1)
    kept[0, -1] += 2 * np.pi
    phi_in, omega_in, omega_out, T_in, T_out, T_flange = np.ascontiguousarray(kept.swapaxes(1, 2))
    return Motion(phi_in, omega_in, omega_out, T_in, T_out, T_flange, drive.period / points), settled


def _accelerations(drive: Drive, state: State) -> Float[np.ndarray, "2 time run"]:
    """Of input and output, eq. (1)."""
    return drive.derivative(state, drive.torques(state))[[OMEGA_IN, OMEGA_OUT]]


class _Linear:
    """The equations of motion made linear about a state, alike at all times; each line has two equations of its own.

    What the input is ahead is also what the integral of its speed error falls behind.
    """

    def __init__(self, drive: Drive, state: State, by_time: Complex[np.ndarray, "order run"]) -> None:
        slopes, here = np.empty((5, 2, len(drive))), _accelerations(drive, state)
        for row, values in enumerate(state):
            step, nudged = STEP * np.maximum(np.abs(values).mean(axis=0), STEP), state.copy()
            nudged[row] += step
            slopes[row] = (_accelerations(drive, nudged) - here).mean(axis=1) / step
        self.of_input = slopes[PHI_IN] - slopes[SPEED_ERROR]
        at = np.stack([self.of_input, slopes[PHI_OUT]], axis=1)
        fast = np.stack([slopes[OMEGA_IN], slopes[OMEGA_OUT]], axis=1)
        matrix = np.eye(2)[:, :, None, None] * by_time**2 - at[:, :, None] - by_time * fast[:, :, None]
        self.inverse = np.linalg.inv(np.moveaxis(matrix[:, :, 1:-1], (0, 1), (2, 3)))
        of_means = -np.stack([slopes[SPEED_ERROR], slopes[PHI_OUT]], axis=1)
        self.inverse_of_means = np.linalg.inv(np.moveaxis(of_means, 2, 0))

    def correction(self, missed: Lines) -> tuple[Lines, Float[np.ndarray, " run"]]:
        """What takes away what the equations miss: of the lines, and of the integral of the speed error."""
        by = np.zeros_like(missed)
        by[:, 1:-1] = -np.einsum("orij,jor->ior", self.inverse, missed[:, 1:-1])
        by[0, 0] = -2 * by[0].real.sum(axis=0)  # the angle stays where it starts
        means = self.of_input * by[0, 0].real - missed[:, 0].real
        of_error, by[1, 0] = np.einsum("rij,jr->ir", self.inverse_of_means, means)
        return by, of_error
