"""Periodic motion of many runs by harmonic balance of eqs. (1) to (6), instead of integration until it settles.

The equations of motion hold at even times over one revolution of the wave generator. The drive is nearly linear about
its uniform rotation. Each correction by that linear system leaves about a tenth of the residual, or half of it with the
strongest effects.
"""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Bool, Complex, Float

from swgsim.chain.dynamics import OMEGA_IN, OMEGA_OUT, PHI_IN, PHI_OUT, SPEED_ERROR, Drive, State
from swgsim.chain.equilibrium import uniform_rotation
from swgsim.chain.motion import Motion, kept_of

# Least number of times at which the equations hold: eight per wave of the highest order that is compared.
LEAST_TIMES = 96
# Largest relative size of the last correction, and largest number of corrections.
TOLERANCE, MOST_CORRECTIONS = 1e-9, 40
# Relative step of the differences.
STEP = 1e-6

# Order lines of the angles of input and output.
Lines = Complex[np.ndarray, "2 order run"]


def one_revolution(
    drive: Drive, start_angle: Float[np.ndarray, " run"], points: int, least: int = LEAST_TIMES
) -> tuple[Motion, Bool[np.ndarray, " run"]]:
    """One periodic revolution of the wave generator in ``points`` even steps of time, and which runs converged.

    The friction over an output revolution (b3) starts again with each revolution of the input here.

    Parameters
    ----------
    drive : Drive
    start_angle : array (run,)
        Angle of the wave generator at the start [rad].
    points : int
    least : int
        Least number of times at which the equations hold.
    """
    each = -(-least // points)
    each += each * points % 2  # an even number of times
    turn = 2 * np.pi * np.arange(points * each)[:, None] / (points * each)
    _, speed_in, phi_out, speed_out, speed_error = uniform_rotation(drive)
    # A factor i k omega on a line is its derivative with respect to time.
    i_k_omega = 1j * np.arange(len(turn) // 2 + 1)[:, None] * drive.omega
    i_k_omega[-1] = 0  # the derivative of the last line is 0 at all times
    # Deviation from uniform rotation; it is 0 for the input at the first time.
    lines = np.zeros((2, *i_k_omega.shape), complex)
    lines[1, 0] = phi_out

    def at_all_times() -> State:
        deviation_in, deviation_out = np.fft.irfft(lines, len(turn), axis=1, norm="forward")
        faster_in, faster_out = np.fft.irfft(i_k_omega * lines, len(turn), axis=1, norm="forward")
        return np.stack([
            start_angle + turn + deviation_in, speed_in + faster_in,
            (start_angle + turn) / (drive.p["N"] + 1) + deviation_out, speed_out + faster_out,
            speed_error - deviation_in,
        ])  # fmt: skip

    linear = _Linear(drive, at_all_times(), i_k_omega)
    speed = np.stack([speed_in, speed_out])
    with np.errstate(over="ignore", invalid="ignore"):  # of runs that do not converge
        for _ in range(MOST_CORRECTIONS):
            state = at_all_times()
            residual = i_k_omega**2 * lines - np.fft.rfft(accelerations(drive, state), axis=1, norm="forward")
            d_lines, d_error = linear.correction(residual)
            lines, speed_error = lines + d_lines, speed_error + d_error
            moved = np.abs(i_k_omega * d_lines).sum(axis=1) / speed + np.abs(d_lines[:, 0]) * drive.omega / speed
            settled = moved.max(axis=0) < TOLERANCE
            if settled.all():
                break
        return motion_of(drive, at_all_times(), each), settled


def motion_of(drive: Drive, state: State, each: int) -> Motion:
    """The motion of the state at even times over a revolution, one in ``each`` of which is kept."""
    kept = np.stack(kept_of(state, drive.torques(state)))[:, ::each]
    points = kept.shape[1]
    kept = np.concatenate([kept, kept[:, :1]], axis=1)
    kept[0, -1] += 2 * np.pi
    return Motion.of(np.ascontiguousarray(kept.swapaxes(1, 2)), drive.period / points)


def accelerations(drive: Drive, state: State) -> Float[np.ndarray, "2 time run"]:
    """Accelerations of input and output, eq. (1) [rad/s^2]."""
    return drive.derivative(state, drive.torques(state))[[OMEGA_IN, OMEGA_OUT]]


def nudged(drive: Drive, state: State) -> Iterator[tuple[Float[np.ndarray, "2 time run"], Float[np.ndarray, " run"]]]:
    """Change of the accelerations by a small step of each row of a state, and that step."""
    here = accelerations(drive, state)
    for row, values in enumerate(state):
        step, moved = STEP * np.maximum(np.abs(values).mean(axis=0), STEP), state.copy()
        moved[row] += step
        yield accelerations(drive, moved) - here, step


class _Linear:
    """Equations of motion linearised about the mean of a state; each order line has its own two equations.

    The integral of the speed error is E = integral of (omega - phi_in') dt. If phi_in leads uniform rotation by d, E is
    lower by d. So an acceleration a changes with d by da/dphi_in - da/dE.

    Attributes
    ----------
    by_lead : array (2, run)
        da/dphi_in - da/dE of input and output.
    inverse : array (order, run, 2, 2)
        Turns accelerations of one order line into leads of input and output.
    inverse_of_means : array (run, 2, 2)
        Turns mean accelerations into E and the mean lead of the output.
    """

    def __init__(self, drive: Drive, state: State, i_k_omega: Complex[np.ndarray, "order run"]) -> None:
        slopes = np.stack([change.mean(axis=1) / step for change, step in nudged(drive, state)])
        self.by_lead = slopes[PHI_IN] - slopes[SPEED_ERROR]
        by_angles = np.stack([self.by_lead, slopes[PHI_OUT]], axis=1)
        by_speeds = np.stack([slopes[OMEGA_IN], slopes[OMEGA_OUT]], axis=1)
        matrix = np.eye(2)[:, :, None, None] * i_k_omega**2 - by_angles[:, :, None] - i_k_omega * by_speeds[:, :, None]
        self.inverse = np.linalg.inv(np.moveaxis(matrix[:, :, 1:-1], (0, 1), (2, 3)))
        of_means = -np.stack([slopes[SPEED_ERROR], slopes[PHI_OUT]], axis=1)
        self.inverse_of_means = np.linalg.inv(np.moveaxis(of_means, 2, 0))

    def correction(self, residual: Lines) -> tuple[Lines, Float[np.ndarray, " run"]]:
        """Corrections of the lines and of the integral of the speed error that cancel the residual of the equations."""
        d_lines = np.zeros_like(residual)
        d_lines[:, 1:-1] = -np.einsum("orij,jor->ior", self.inverse, residual[:, 1:-1])
        d_lines[0, 0] = -2 * d_lines[0].real.sum(axis=0)  # the start angle is kept
        means = self.by_lead * d_lines[0, 0].real - residual[:, 0].real
        d_error, d_lines[1, 0] = np.einsum("rij,jr->ir", self.inverse_of_means, means)
        return d_lines, d_error
