"""The drive: motor and wave generator, the twisting flex spline, and the load, integrated in time."""

from dataclasses import dataclass

import numpy as np

RATE = 10_000  # Hz
LENGTH = 3600
SETTLE = 5000  # steps before a recording
RATIO = 101.0


@dataclass(frozen=True)
class Drive:
    """Parameters of the drive; stiffness, damping and friction of the mesh count at the output, in SI units.

    ``errors`` holds the kinematic error at the output, as (order, amplitude, phase).
    ``disc`` is the share of the load inertia that hangs on a loose hub, with ``disc_frequency`` in Hz.
    """

    input_inertia: float = 1.1e-4
    load_inertia: float = 0.3
    stiffness: float = 1.39e4
    cubic: float = 7.5e7
    damping: float = 2.5
    errors: tuple = ()
    seal: float = 0.012
    churning: float = 0.030
    coulomb: float = 0.8
    ripple: float = 0.05
    flank: float = 0.12
    control: float = 8.0
    control_damping: float = 1.0
    disc: float = 0.0
    disc_frequency: float = 60.0


@dataclass(frozen=True)
class Motion:
    """Recorded motion, each of shape (samples, recordings)."""

    angle: np.ndarray
    speed: np.ndarray
    output: np.ndarray
    motor: np.ndarray
    torque: np.ndarray


def run(drive, speed, load, friction, angle, output):
    """Integrate all recordings at once (Runge-Kutta of order 4).

    Parameters
    ----------
    speed, load, friction, angle, output : ndarray
        Set speed in rad/s, load torque in N m, friction relative to nominal for (mesh, churning),
        angles at the start in rad; one for each recording.
    """
    omega = 2 * np.pi * drive.control
    gain, integral = 2 * drive.control_damping * omega * drive.input_inertia, omega**2 * drive.input_inertia
    main, disc = drive.load_inertia * (1 - drive.disc), drive.load_inertia * drive.disc
    hub = disc * (2 * np.pi * drive.disc_frequency) ** 2
    hub_damping = 0.04 * disc * 2 * np.pi * drive.disc_frequency

    def torques(y):
        wave = sum(a * np.sin(k * y[0] + p) for k, a, p in drive.errors)
        slope = sum(a * k * np.cos(k * y[0] + p) for k, a, p in drive.errors)
        lever = 1 / RATIO + slope
        twist = y[0] / RATIO + wave - y[2]
        spring = drive.stiffness * twist + drive.cubic * twist**3 + drive.damping * (lever * y[1] - y[3])
        rub = friction[0] * drive.coulomb * (1 + drive.ripple * np.sin(y[2]))
        out = (spring - rub) / (1 + friction[0] * drive.flank)
        drag = drive.seal + friction[1] * drive.churning * (abs(y[1]) / 209.44) ** (2 / 3)
        return lever * spring + drag, out, gain * (speed - y[1]) + y[4]

    def rates(y):
        brake, out, motor = torques(y)
        dy = np.empty_like(y)
        link = hub * (y[2] - y[5]) + hub_damping * (y[3] - y[6])
        dy[0], dy[2], dy[5] = y[1], y[3], y[6]
        dy[1] = (motor - brake) / drive.input_inertia
        dy[3] = (out - load - link if disc else out - load) / main
        dy[4] = integral * (speed - y[1])
        dy[6] = link / disc if disc else dy[3]
        return dy

    spring = load * (1 + friction[0] * drive.flank) + friction[0] * drive.coulomb
    twist = spring / drive.stiffness
    for _ in range(20):
        twist = spring / (drive.stiffness + drive.cubic * twist**2)
    start = angle - speed * SETTLE / RATE
    y = np.array([start, speed, start / RATIO - twist, speed / RATIO, 0 * speed, 0 * speed, speed / RATIO])
    shift = output - angle / RATIO  # the zero of the output is free
    y[5], y[4] = y[2], torques(y)[0]
    step, kept = 1 / RATE, np.empty((LENGTH, 5, speed.size))
    for i in range(SETTLE + LENGTH):
        if i >= SETTLE:
            _, out, motor = torques(y)
            kept[i - SETTLE] = y[0], y[1], y[2] + shift, motor, out
        a = rates(y)
        b = rates(y + step / 2 * a)
        c = rates(y + step / 2 * b)
        y = y + step / 6 * (a + 2 * b + 2 * c + rates(y + step * c))
    return Motion(*np.moveaxis(kept, 1, 0))
