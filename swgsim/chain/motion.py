"""Motion of many runs: the periodic steady state, and the integration over a window."""

from dataclasses import dataclass, fields
from math import ceil

import numpy as np
from jaxtyping import Bool, Float

from swgsim.chain.dynamics import OMEGA_IN, OMEGA_OUT, PHI_IN, PHI_OUT, SPEED_ERROR, Drive, State, Torques
from swgsim.chain.equilibrium import resonance, uniform_rotation

# Least numbers of integration steps: 24 per cycle of order 4 of the kinematic error, and 40 per cycle of the resonance.
STEPS_PER_REVOLUTION = 96
STEPS_PER_OSCILLATION = 40
MOST_STEPS = 20_000
# Relative correction below which a steady state is accepted although rounding stops the convergence.
STALLED = 1e-6


class NoSteadyState(ValueError):
    """The steady motion of a gear at an operating point is not found. A fit takes no step there."""


@dataclass(frozen=True)
class Motion:
    """Motion of many runs over a window; arrays (run, time), the last point closes the window.

    Attributes
    ----------
    phi_in : array
        Angle of the wave generator relative to the flex spline [rad].
    omega_in, omega_out : arrays
        Angular speeds [rad/s].
    T_in, T_out, T_flange : arrays
        Torque at the input, torque transmitted to the output, and torque at the output flange [N m].
    dt : float or array (run,)
        Time between points [s].
    """

    phi_in: Float[np.ndarray, "run time"]
    omega_in: Float[np.ndarray, "run time"]
    omega_out: Float[np.ndarray, "run time"]
    T_in: Float[np.ndarray, "run time"]
    T_out: Float[np.ndarray, "run time"]
    T_flange: Float[np.ndarray, "run time"]
    dt: float | Float[np.ndarray, " run"]

    @classmethod
    def of(cls, channels: Float[np.ndarray, "six run time"], dt: float | Float[np.ndarray, " run"]) -> "Motion":
        """The motion of six arrays in the order of the attributes."""
        phi_in, omega_in, omega_out, T_in, T_out, T_flange = channels
        return cls(phi_in, omega_in, omega_out, T_in, T_out, T_flange, dt)

    def repeated(self, times: int) -> "Motion":
        """``times`` repetitions of one revolution of the wave generator in the steady state."""
        points = self.phi_in.shape[1] - 1
        turn, within = np.divmod(np.arange(times * points + 1), points)
        omega_in, omega_out, T_in, T_out, T_flange = (
            each[:, within] for each in (self.omega_in, self.omega_out, self.T_in, self.T_out, self.T_flange)
        )
        phi_in = self.phi_in[:, within] + 2 * np.pi * turn
        return Motion(phi_in, omega_in, omega_out, T_in, T_out, T_flange, self.dt)

    @property
    def efficiency(self) -> Float[np.ndarray, " run"]:
        """Efficiency eta = P_out / P_in (section II-A), over the whole wave-generator revolutions of the window [-]."""
        angle = self.phi_in - self.phi_in[:, :1]
        turns = np.floor(angle[:, -1] / (2 * np.pi) + 1e-9)
        if turns.min() < 1:
            short = float(angle[:, -1].min() / (2 * np.pi))
            raise ValueError(f"window of {short:.4f} revolutions: efficiency needs at least one; lengthen the window")
        end = 2 * np.pi * turns
        return _energy(self.T_out * self.omega_out, angle, end) / _energy(self.T_in * self.omega_in, angle, end)


def _energy(power: np.ndarray, angle: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Integral of each row's power up to the angle ``end`` [W per time step]."""
    total = np.zeros_like(power)
    np.cumsum(0.5 * (power[:, 1:] + power[:, :-1]), axis=1, out=total[:, 1:])
    return np.array([np.interp(e, row_angle, row) for e, row_angle, row in zip(end, angle, total, strict=True)])


def steps_per_revolution(drive: Drive) -> int:
    """Integration steps of a batch per revolution of the wave generator.

    Raises
    ------
    NoSteadyState
        If a run is so slow or stiff that it needs more than MOST_STEPS.
    """
    frequency = resonance(drive)
    needed = np.ceil(STEPS_PER_OSCILLATION * frequency * drive.period)
    i = int(needed.argmax())
    if needed[i] > MOST_STEPS:
        raise NoSteadyState(
            f"{drive.points[i].n_in_rpm} rpm with a resonance of {frequency[i]:.3g} Hz needs {needed[i]:.0f} "
            f"steps per revolution, limit {MOST_STEPS}: raise speed or inertia, or lower the stiffness"
        )
    return max(STEPS_PER_REVOLUTION, int(needed[i]))


def advance(drive: Drive, state: State, angle: Float[np.ndarray, " run"]) -> State:
    """The state of each run after a rotation of the wave generator by about an angle [rad], positive or negative."""
    steps = int(np.ceil(np.abs(angle).max() / (2 * np.pi) * steps_per_revolution(drive)))
    for _ in range(steps):
        state = drive.step(state, drive.torques(state), angle / drive.omega / steps)
    return state


def run(drive: Drive, state: State, dt: float, count: int) -> Motion:
    """Integrate ``count`` steps of ``dt`` seconds from a state and keep every step."""
    substeps = int(np.ceil(dt / (drive.period / steps_per_revolution(drive)).min() - 1e-9))
    return _integrate(drive, state, dt, substeps, count)


def revolve(drive: Drive, state: State, points: int) -> Motion:
    """Integrate one revolution of the wave generator in ``points`` even steps of time, and keep every step."""
    substeps = ceil(steps_per_revolution(drive) / points)
    return _integrate(drive, state, drive.period / points, substeps, points)


def _integrate(drive: Drive, state: State, dt: float | Float[np.ndarray, " run"], substeps: int, count: int) -> Motion:
    """Motion at ``count`` + 1 points ``dt`` apart, with ``substeps`` integration steps between them."""
    step = np.full(len(drive), dt / substeps)
    kept = np.empty((len(fields(Motion)) - 1, count + 1, len(drive)))  # all but the time between points
    for i in range(count + 1):
        torques = drive.torques(state)
        kept[:, i] = kept_of(state, torques)
        if i < count:
            state = drive.step(state, torques, step)
            for _ in range(substeps - 1):
                state = drive.step(state, drive.torques(state), step)
    return Motion.of(np.ascontiguousarray(np.swapaxes(kept, 1, 2)), dt)


def kept_of(state: State, torques: Torques) -> tuple[np.ndarray, ...]:
    """Quantities of an instant that a motion keeps, in its order."""
    return state[PHI_IN], state[OMEGA_IN], state[OMEGA_OUT], torques.T_in, torques.T_out, torques.T_flange


@np.errstate(over="ignore", invalid="ignore")  # of runs that do not converge
def shooting(drive: Drive, tolerance: float = 1e-8) -> tuple[State, Bool[np.ndarray, " run"]]:
    """The state at phi_in = 0 that repeats after one revolution of the wave generator, and which runs converged.

    The friction over an output revolution (b3) changes so slowly that it counts as constant here. The last relative
    correction is below the tolerance; for a nearly linear drive each is a hundredth of the one before.
    """
    unknown = [OMEGA_IN, PHI_OUT, OMEGA_OUT, SPEED_ERROR]
    size, runs = len(unknown), len(drive)
    slow = drive.omega / (drive.p["N"] + 1)
    scale = np.stack([drive.omega, 0 * slow + 2 * np.pi / (drive.p["N"] + 1), slow, drive.T_load / drive.gain_i + 1e-3])
    goal = np.stack([2 * np.pi + 0 * slow, 0 * slow, 2 * np.pi / (drive.p["N"] + 1), 0 * slow])
    state = uniform_rotation(drive)

    # The return map is nearly linear: its Jacobian at the start, by differences, serves all iterations.
    nudged = np.repeat(state, size + 1, axis=1)
    for i, row in enumerate(unknown):
        nudged[row, i + 1 :: size + 1] += 1e-6 * scale[i]
    turn = np.full(runs, 2 * np.pi)
    change = advance(drive.repeated(size + 1), nudged, np.repeat(turn, size + 1)) - nudged
    change = change[:4].reshape(4, runs, size + 1)
    slopes = (change[..., 1:] - change[..., :1]) / (1e-6 * scale.T)
    inverse = np.linalg.inv(np.moveaxis(slopes, 1, 0))
    miss = change[..., 0] - goal
    for _ in range(30):
        correction = np.einsum("rij,jr->ir", inverse, miss)
        state[unknown] -= correction
        worst = np.abs(correction / scale).max(axis=0)
        if worst.max() < tolerance:
            break
        miss = (advance(drive, state, turn) - state)[:4] - goal
    return state, worst < STALLED
