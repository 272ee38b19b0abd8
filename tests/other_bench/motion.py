"""Motion of the gear, the paper's eqs. (1) to (6), all recordings at once, by the classical Runge-Kutta method.

The flex spline is clamped: phi is the angle of the wave generator, c that of the circular spline, the output, which
turns the same way, N + 1 times slower. The speed of the input is controlled; a brake gives the load.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from other_bench.schedule import Run
from other_bench.specimen import KINEMATIC

# Sampling rate, also the integrator's [Hz]; revolutions recorded, and time before that settles the start [s].
RATE, REVOLUTIONS, SETTLE = 12500.0, 12.2, 0.5
# Speed control: natural frequency on J_in alone, at critical damping [rad/s].
CONTROL = 2 * np.pi * 10
# How far the load swings, relative.
SWING_SHARE = 1e-3
ORDERS = np.array(list(KINEMATIC))[:, None]

Each = Float[np.ndarray, " run"]
# phi, its speed, c, its speed [rad], [rad/s], and what speed control has summed up [rad].
State = Float[np.ndarray, "5 run"]


class Motion(NamedTuple):
    """What moves during a recording, each (time,).

    Attributes
    ----------
    T_in, T_wg, T_out : array
        Torque of the motor, of the wave generator, of the output [N m].
    phi, omega : array
        Angle and speed of the wave generator [rad], [rad/s].
    turned : array
        Angle of the output since the bench was started [rad].
    """

    T_in: Float[np.ndarray, " time"]
    T_wg: Float[np.ndarray, " time"]
    T_out: Float[np.ndarray, " time"]
    phi: Float[np.ndarray, " time"]
    omega: Float[np.ndarray, " time"]
    turned: Float[np.ndarray, " time"]


class Drive:
    """The gears of several runs: the paper's symbols, each (run,)."""

    def __init__(self, runs: Sequence[Run]) -> None:
        def each(name: str) -> np.ndarray:
            return np.array([getattr(run.unit, name) for run in runs])

        self.k1, self.k2 = each("k1"), each("k2")
        self.b0, self.b1, self.b2, self.b3, self.theta_b = (each(name) for name in ("b0", "b1", "b2", "b3", "theta_b"))
        self.mu, self.sticky, self.J_in, self.J_out = (each(name) for name in ("mu", "sticky", "J_in", "J_out"))
        alpha, self.N = each("alpha"), each("N")
        self.sin, self.cos, self.tan = np.sin(alpha), np.cos(alpha), np.tan(alpha)
        self.tan_in = 1 / ((self.N + 1) * self.tan)  # eq. (4)
        # An error at the output is (N + 1) tan_in times as large at the spring.
        self.errors = each("kinematic").T * (self.N + 1) * self.tan_in
        self.proportional, self.integral = 2 * CONTROL * self.J_in, CONTROL**2 * self.J_in
        self.speed = np.array([run.speed for run in runs]) * np.pi / 30

    def start(self, c: Each, load: Each) -> State:
        """Steady state without kinematic error, at angles of the output and loads."""
        c_speed = self.speed / (self.N + 1)
        B = self.b0 + self.b1 * c_speed / self.sin
        T_fric = (B + self.mu * load / self.cos) / (1 - self.mu * self.tan)
        T_stiff = self.tan * (load + T_fric / self.sin)
        roots = [np.roots([k2, 0, k1, -T]) for k1, k2, T in zip(self.k1, self.k2, T_stiff, strict=True)]
        dphi = np.array([of_run[np.argmin(np.abs(of_run.imag))].real for of_run in roots])
        phi = (dphi + c / self.tan) / self.tan_in
        return np.array([phi, self.speed, c, c_speed, self.tan_in * T_stiff / self.integral])

    def torques(self, y: State) -> tuple[Each, Each, Each]:
        """T_in, T_wg and T_out; they follow from work: no energy is lost but T_fric's."""
        phi, omega, c, c_speed, summed = y
        lines = self.errors * np.exp(1j * ORDERS * phi)
        dphi = self.tan_in * phi - c / self.tan + lines.sum(axis=0).imag  # eq. (3)
        T_stiff = dphi * (self.k1 + self.k2 * dphi * dphi)  # eq. (2)
        sliding = c_speed / self.sin  # eq. (6)
        B = self.b0 + sliding * (self.b1 + self.b2 * sliding * sliding) + self.b3 * np.sin(c + self.theta_b)
        F_n = (T_stiff - B * self.cos) / (self.sin + self.mu * self.cos)
        T_fric = B + self.mu * F_n  # eq. (5)
        T_in = self.proportional * (self.speed - omega) + self.integral * summed
        T_wg = T_stiff * (self.tan_in + (ORDERS * lines).sum(axis=0).real)
        return T_in, T_wg, T_stiff / self.tan - T_fric / self.sin

    def rates(self, y: State, load: Each) -> State:
        """How the state changes: the equations of motion of both shafts, and of speed control."""
        T_in, T_wg, T_out = self.torques(y)
        drag = self.sticky * np.abs(np.sin(y[0] / 3))
        omega_rate = (T_in - T_wg - drag) / self.J_in
        return np.array([y[1], omega_rate, y[3], (T_out - load) / self.J_out, self.speed - y[1]])


def moved(runs: Sequence[Run]) -> list[Motion]:
    """The motion of every run, as long as its recording."""
    drive = Drive(runs)
    c0, mean_load, swing = (np.array([getattr(run, name) for run in runs]) for name in ("c0", "load", "swing"))
    samples = [int(np.ceil(REVOLUTIONS * 60 / run.n * RATE)) for run in runs]
    dt, settling = 1 / RATE, int(SETTLE * RATE)
    kept = np.empty((max(samples), len(Motion._fields), len(runs)))
    y = drive.start(c0, mean_load)
    for i in range(settling + len(kept)):
        load = mean_load * (1 + SWING_SHARE * np.sin(2 * np.pi * swing * i * dt))
        if i >= settling:
            kept[i - settling] = *drive.torques(y), y[0], y[1], y[2] - c0
        k1 = drive.rates(y, load)
        k2 = drive.rates(y + dt / 2 * k1, load)
        k3 = drive.rates(y + dt / 2 * k2, load)
        k4 = drive.rates(y + dt * k3, load)
        y = y + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return [Motion(*kept[:count, :, i].T) for i, count in enumerate(samples)]
