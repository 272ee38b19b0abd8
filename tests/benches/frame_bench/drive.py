"""Motion: motor with speed control, input inertia, flex spline as a spring, output inertia and brake; in time."""

from dataclasses import dataclass

import numpy as np

RATIO = 101.0
RATE = 1e4  # Hz
TOOTH_ANGLE = np.radians(30.0)
WEDGE = 1 / np.tan(TOOTH_ANGLE)  # the radial kinematic error phi_err per rad of error at the output


@dataclass(frozen=True)
class Drive:
    """Two inertias with everything that acts between them; torques and angles of the output side unless noted."""

    stiffness: float = 1.39e4  # N m/rad of twist
    cubic: float = 7.5e7  # N m/rad^3
    damping: float = 5.0  # N m s/rad
    drag: float = 2.9  # N m, constant friction
    viscous: float = 1.05  # N m s/rad
    load_share: float = 0.134  # friction per transmitted torque
    ripple: float = 0.15  # N m, friction that varies with the output angle
    inertia_in: float = 1.2e-4  # kg m^2, at the input
    inertia_out: float = 0.1  # kg m^2
    errors: tuple = ()  # kinematic error: entries (order, amplitude in rad, phase)
    joint: float = 0.0  # rad at the input, second order error of a bent joint between encoder and wave generator
    control: float = 15.0  # Hz, natural frequency of the speed control


@dataclass(frozen=True)
class Motion:
    """Records of many runs at once, each (samples, runs)."""

    angle_in: np.ndarray
    cam_angle: np.ndarray
    speed_in: np.ndarray
    torque_in: np.ndarray
    angle_out: np.ndarray
    torque_out: np.ndarray


def cam_angle(drive: Drive, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Angle of the wave generator behind the joint, and its slope over the angle of the encoder."""
    return angle + drive.joint * np.sin(2 * angle), 1 + 2 * drive.joint * np.cos(2 * angle)


def _spring(drive: Drive, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Torque of the twisted flex spline and the slope of the twist over the input angle."""
    angle, speed, angle_out, speed_out, _ = state
    cam, slope = cam_angle(drive, angle)
    twist, lever = cam / RATIO - angle_out, 1 / RATIO
    for order, amplitude, phase in drive.errors:
        twist = twist + amplitude * np.sin(order * cam + phase)
        lever = lever + amplitude * order * np.cos(order * cam + phase)
    lever = lever * slope
    rate = lever * speed - speed_out
    return drive.stiffness * twist + drive.cubic * twist**3 + drive.damping * rate, lever


def _output(drive: Drive, friction: np.ndarray, spring: np.ndarray, angle: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Transmitted torque: what friction leaves of the torque of the spring, at an angle and speed of the output."""
    own = friction * (drive.drag + drive.viscous * speed + drive.ripple * np.sin(angle))
    return (spring - own) / (1 + friction * drive.load_share)


def simulate(
    drive: Drive,
    speed: np.ndarray,
    load: np.ndarray,
    friction: np.ndarray,
    start: np.ndarray,
    samples: int,
    settle: int = 5000,
) -> Motion:
    """Integrate runs side by side with Runge-Kutta steps of 0.1 ms.

    Each run has a set speed in rad/s, a torque of the brake in N m, a factor of all friction, and the input and output
    angle it starts from. The first `settle` steps are not kept.
    """
    pace = 2 * np.pi * drive.control
    gain, reset = 2 * pace * drive.inertia_in, pace**2 * drive.inertia_in
    own = friction * (drive.drag + drive.viscous * speed / RATIO)
    torque = load * (1 + friction * drive.load_share) + own
    offset = start[1] - start[0] / RATIO  # the friction sees the output from where the run begins

    def motor(state: np.ndarray) -> np.ndarray:
        return gain * (speed - state[1]) + reset * state[4]

    def slope(state: np.ndarray) -> np.ndarray:
        spring, lever = _spring(drive, state)
        out = _output(drive, friction, spring, state[2] + offset, state[3])
        return np.stack(
            [
                state[1],
                (motor(state) - spring * lever) / drive.inertia_in,
                state[3],
                (out - load) / drive.inertia_out,
                speed - state[1],
            ]
        )

    state = np.stack(
        [start[0], speed, start[0] / RATIO - torque / drive.stiffness, speed / RATIO, torque / RATIO / reset]
    )
    step, kept = 1 / RATE, []
    for index in range(settle + samples):
        if index >= settle:
            kept.append(state)
        a = slope(state)
        b = slope(state + step / 2 * a)
        c = slope(state + step / 2 * b)
        state = state + step / 6 * (a + 2 * b + 2 * c + slope(state + step * c))
    kept = np.stack(kept, axis=1)
    angle_out = kept[2] + offset
    out = _output(drive, friction, _spring(drive, kept)[0], angle_out, kept[3])
    return Motion(kept[0], cam_angle(drive, kept[0])[0], kept[1], motor(kept), angle_out, out)
