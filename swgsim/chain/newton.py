"""Periodic motion of one run by Newton's method on the equations of the harmonic balance, and whether it is stable.

:mod:`swgsim.chain.harmonic_balance` corrects with the linear system about the mean of a motion. Close to a resonance
with little load the flanks change within a revolution, and the mean describes no instant. Here the slopes of eqs. (1)
to (6) at every instant make the correction. Each takes a dense solution, some milliseconds.

More load keeps one flank in contact, which makes the gear nearly linear. So where Newton's method fails, the load is
raised and then lowered again in steps (continuation). Each motion is the start for the next load.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from swgsim.chain.dynamics import OMEGA_IN, OMEGA_OUT, PHI_IN, PHI_OUT, SPEED_ERROR, Drive, State
from swgsim.chain.equilibrium import uniform_rotation
from swgsim.chain.harmonic_balance import TOLERANCE, accelerations, motion_of, nudged
from swgsim.chain.motion import Motion

# Least number of times at which the equations hold: a change of the flank has more orders than a smooth motion.
LEAST_TIMES = 192
# Largest number of corrections, and least share of one that is tried.
MOST_CORRECTIONS, LEAST_SHARE = 25, 1e-3
# Loads that are added, one after the other [N m]. The first one is above the largest ripple of such gears.
ADDED_LOADS = (80.0, 70.0, 60.0, 50.0, 40.0, 30.0, 25.0, 20.0, 15.0, 10.0, 7.5, 5.0, 2.5, 0.0)


class Periodic(NamedTuple):
    """One periodic revolution of one run, and its state at the start angle, an array (5, 1)."""

    motion: Motion
    start: State


def stable_revolution(drive: Drive, start_angle: float, points: int) -> Periodic | None:
    """A periodic revolution that the gear returns to after a disturbance; none if no such motion is found.

    Parameters
    ----------
    drive : Drive
        Of one run.
    start_angle : float
        Angle of the wave generator at the start [rad].
    points : int
        Even steps of time.
    """
    each = -(-LEAST_TIMES // points)
    each += each * points % 2  # an even number of times
    with np.errstate(over="ignore", invalid="ignore"):  # of a search that fails
        for loads in ((0.0,), ADDED_LOADS):
            unknown = None
            for added in loads:
                equations = _Equations(drive.with_more_load(added), start_angle, points * each)
                found, converged = equations.solved(equations.uniform if unknown is None else unknown)
                unknown = found if converged else unknown
            if converged and equations.stable(found):
                state = equations.state(found)
                return Periodic(motion_of(drive, state, each), state[:, 0])
    return None


class _Equations:
    """Equations of motion of one run at even times over a revolution, for deviations from uniform rotation.

    The unknowns are the leads of input and output at all times [rad], and the integral of the speed error at the start
    [rad]: an array (2 times + 1,). The lead of the input is 0 at the first time. The residuals are the accelerations
    that do not belong to the motion, each as a share of the mean speed: an array (2 times,).
    """

    def __init__(self, drive: Drive, start_angle: float, times: int) -> None:
        self.drive, self.times, self.omega = drive, times, float(drive.omega[0])
        self.turn = 2 * np.pi * np.arange(times)[:, None] / times
        self.uniform_state = uniform_rotation(drive)
        self.uniform_state[PHI_IN] = start_angle
        orders, lines = np.arange(times // 2 + 1)[:, None], np.fft.rfft(np.eye(times), axis=0)
        i_k_omega = 1j * orders * self.omega
        self.acceleration = np.fft.irfft(i_k_omega**2 * lines, times, axis=0)
        i_k_omega[-1] = 0  # the derivative of the last line is 0 at all times
        self.speed = np.fft.irfft(i_k_omega * lines, times, axis=0)
        self.scale = np.repeat(self.uniform_state[[OMEGA_IN, OMEGA_OUT], 0], times)

    @property
    def uniform(self) -> Float[np.ndarray, " unknown"]:
        """The unknowns of uniform rotation in equilibrium with the load."""
        phi_out, speed_error = self.uniform_state[[PHI_OUT, SPEED_ERROR], 0]
        return np.concatenate([np.zeros(self.times), np.full(self.times, phi_out), [speed_error]])

    def state(self, unknown: Float[np.ndarray, " unknown"]) -> State:
        """The state at all times, an array (5, time, 1)."""
        lead_in, lead_out = unknown[: self.times, None], unknown[self.times : -1, None]
        start, speed_in, _, speed_out, _ = self.uniform_state
        angle = start + self.turn
        return np.stack([
            angle + lead_in, speed_in + self.speed @ lead_in,
            angle / (self.drive.p["N"] + 1) + lead_out, speed_out + self.speed @ lead_out,
            unknown[-1] - lead_in,
        ])  # fmt: skip

    def residual(self, unknown: Float[np.ndarray, " unknown"]) -> Float[np.ndarray, " equation"]:
        """Accelerations that the torques do not explain, as shares of the mean speeds [1/s]."""
        leads = unknown[:-1].reshape(2, self.times).T
        explained = accelerations(self.drive, self.state(unknown))[..., 0]
        return ((self.acceleration @ leads).T - explained).ravel() / self.scale

    def slopes(self, unknown: Float[np.ndarray, " unknown"]) -> Float[np.ndarray, "5 2 time"]:
        """Change of the accelerations of input and output with each part of the state, at all times."""
        return np.stack([(change / step)[..., 0] for change, step in nudged(self.drive, self.state(unknown))])

    def jacobian(self, unknown: Float[np.ndarray, " unknown"]) -> Float[np.ndarray, "equation unknown"]:
        """Change of the residuals with the unknowns."""
        slopes, times = self.slopes(unknown), self.times
        found = np.empty((2, times, 2 * times + 1))
        for row, slope in zip(found, slopes.swapaxes(0, 1), strict=True):
            row[:, :times] = -slope[OMEGA_IN, :, None] * self.speed - np.diag(slope[PHI_IN] - slope[SPEED_ERROR])
            row[:, times:-1] = -slope[OMEGA_OUT, :, None] * self.speed - np.diag(slope[PHI_OUT])
            row[:, -1] = -slope[SPEED_ERROR]
        found[0, :, :times] += self.acceleration
        found[1, :, times:-1] += self.acceleration
        return found.reshape(2 * times, -1) / self.scale[:, None]

    def solved(self, unknown: Float[np.ndarray, " unknown"]) -> tuple[Float[np.ndarray, " unknown"], bool]:
        """Newton's method; a correction is halved until it lessens the residuals. Second, whether it converged."""
        residual = self.residual(unknown)
        for _ in range(MOST_CORRECTIONS):
            correction = np.zeros_like(unknown)
            try:
                correction[1:] = np.linalg.solve(self.jacobian(unknown)[:, 1:], -residual)
            except np.linalg.LinAlgError:
                return unknown, False
            share, size = 1.0, np.linalg.norm(residual)
            while True:
                there = unknown + share * correction
                residual = self.residual(there)
                if np.linalg.norm(residual) < (1 - 0.1 * share) * size or share < LEAST_SHARE:
                    break
                share /= 2
            unknown = there
            leads = correction[:-1].reshape(2, self.times)
            moved = np.abs(self.speed @ leads.T).max(axis=0) + np.abs(leads.mean(axis=1)) * self.omega
            if (moved / self.scale[:: self.times]).max() < TOLERANCE:
                return unknown, True
        return unknown, False

    def stable(self, unknown: Float[np.ndarray, " unknown"]) -> bool:
        """Whether small deviations from a periodic motion are smaller after a revolution (Floquet).

        A motion that is only later than another one is the same motion. Such deviations keep the sum of the angle of
        the input and the integral of the speed error, so these two count as one, as in the harmonic balance.
        """
        slopes = self.slopes(unknown)
        rates = np.zeros((self.times, 4, 4))  # of leads and speeds, as in a state
        rates[:, 0, 1] = rates[:, 2, 3] = 1
        for row, slope in ((1, slopes[:, 0]), (3, slopes[:, 1])):
            rates[:, row] = np.transpose([slope[PHI_IN] - slope[SPEED_ERROR], *slope[OMEGA_IN:SPEED_ERROR]])
        half = 0.5 * self.drive.period[0] / self.times * rates
        steps = np.linalg.solve(np.eye(4) - half, np.eye(4) + half)
        revolution = np.eye(4)
        for step in steps:
            revolution = step @ revolution
        return bool(np.abs(np.linalg.eigvals(revolution)).max() < 1)
