"""The motion of the drive: motor, gear, coupling and brake, integrated in time."""

from dataclasses import dataclass

import numpy as np

RPM = np.pi / 30
RATIO = 101.0  # the flex spline is clamped, the circular spline is the output
RATE = 10_000.0  # samples per second
SAMPLES = 3600
SETTLE = 8000  # steps before the recording begins


@dataclass(frozen=True)
class Drive:
    """Inertias, stiffness and friction of one drive, in SI units."""

    motor_inertia: float = 1.2e-4
    output_inertia: float = 0.2  # before the coupling
    brake_inertia: float = 0.3  # behind it; both are 0.5 kg m^2
    k1: float = 1.39e4  # stiffness at the output [N m/rad]
    k3: float = 7.5e7  # cubic stiffness at the output [N m/rad^3]
    twist_damping: float = 4.0  # at the output [N m s/rad]
    coupling: float = 2e6  # [N m/rad]
    coulomb: float = 0.03  # friction at the input [N m]
    churning: float = 0.022  # friction at the input at 2000 rpm and 25 degC [N m]
    load_friction: float = 0.13  # friction at the input as a share of the torque there
    position_friction: tuple[float, float] = (0.04, 0.0)  # share of the Coulomb friction, order 2, and its phase
    error: tuple[tuple[int, float, float], ...] = ()  # kinematic error: waves per turn (order, amplitude [rad], phase)
    control: float = 2 * np.pi * 3  # bandwidth of the speed control [rad/s]


@dataclass(frozen=True)
class Conditions:
    """What differs between recordings; each entry is an array over them."""

    speed: np.ndarray  # [rad/s]
    load: np.ndarray  # torque of the brake [N m]
    friction: np.ndarray  # factor
    temperature: np.ndarray  # [degC]
    angle: np.ndarray  # of the input when the motion begins [rad]
    spline: np.ndarray  # angle of the circular spline when the motion begins [rad]


def kinematic_error(drive: Drive, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Kinematic error at the output and its slope, over the angle of input minus output."""
    error, slope = np.zeros_like(angle), np.zeros_like(angle)
    for order, amplitude, phase in drive.error:
        error = error + amplitude * np.cos(order * angle - phase)
        slope = slope - order * amplitude * np.sin(order * angle - phase)
    return error, slope


def friction(drive: Drive, now: Conditions, angle: np.ndarray, speed: np.ndarray, torque: np.ndarray) -> np.ndarray:
    """Friction torque at the input."""
    share, phase = drive.position_friction
    coulomb = drive.coulomb * (1 + share * np.cos(2 * angle - phase))
    thinning = np.exp(-0.02 * (now.temperature - 25))
    churning = drive.churning * thinning * (np.maximum(speed, 0) / (2000 * RPM)) ** 0.7
    return now.friction * (coulomb + churning + drive.load_friction * torque / RATIO)


def elastic_torque(drive: Drive, now: Conditions, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Torque that the gear transmits, and the slope of the kinematic error."""
    angle, speed, output, output_speed = state[:4]
    error, slope = kinematic_error(drive, angle - output - now.spline)
    twist = angle / RATIO - output + error
    rate = speed / RATIO - output_speed + slope * (speed - output_speed)
    return drive.k1 * twist + drive.k3 * twist**3 + drive.twist_damping * rate, slope


def control_torque(drive: Drive, now: Conditions, state: np.ndarray) -> np.ndarray:
    """Torque of the motor under proportional-integral speed control."""
    inertia = drive.motor_inertia + (drive.output_inertia + drive.brake_inertia) / RATIO**2
    return inertia * (2 * drive.control * (now.speed - state[1]) + drive.control**2 * state[6])


def motion(drive: Drive, now: Conditions, state: np.ndarray) -> np.ndarray:
    """Time derivative of the state: input, output and brake (angle and speed each), sum of the speed error."""
    angle, speed, output, output_speed, brake, brake_speed, _ = state
    torque, slope = elastic_torque(drive, now, state)
    drag = friction(drive, now, angle, speed, torque)
    damping = 2e-4 * drive.coupling
    shaft = drive.coupling * (output - brake) + damping * (output_speed - brake_speed)
    motor = control_torque(drive, now, state)
    return np.array(
        [
            speed,
            (motor - drag - torque * (1 / RATIO + slope)) / drive.motor_inertia,
            output_speed,
            (torque * (1 + slope) - shaft) / drive.output_inertia,
            brake_speed,
            (shaft - now.load) / drive.brake_inertia,
            now.speed - speed,
        ]
    )


def start(drive: Drive, now: Conditions) -> np.ndarray:
    """State of steady motion without kinematic error."""
    twist = now.load / drive.k1
    for _ in range(20):
        twist = now.load / (drive.k1 + drive.k3 * twist**2)
    output = now.angle / RATIO - twist
    inertia = drive.motor_inertia + (drive.output_inertia + drive.brake_inertia) / RATIO**2
    needed = now.load / RATIO + friction(drive, now, now.angle + np.pi / 4, now.speed, now.load)
    brake = output - now.load / drive.coupling
    slow = now.speed / RATIO
    return np.array([now.angle, now.speed, output, slow, brake, slow, needed / (inertia * drive.control**2)])


def simulate(drive: Drive, now: Conditions) -> dict[str, np.ndarray]:
    """Integrate by the Runge-Kutta method; returns phi_in [rad], n_in [rpm], T_in and T_out [N m] over time."""
    state, step = start(drive, now), 1 / RATE
    kept = np.empty((4, len(now.speed), SAMPLES))
    for i in range(-SETTLE, SAMPLES):
        if i >= 0:
            torque = elastic_torque(drive, now, state)[0]
            kept[:, :, i] = state[0], state[1] / RPM, control_torque(drive, now, state), torque
        k1 = motion(drive, now, state)
        k2 = motion(drive, now, state + step / 2 * k1)
        k3 = motion(drive, now, state + step / 2 * k2)
        k4 = motion(drive, now, state + step * k3)
        state = state + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return dict(zip(("phi_in", "n_in", "T_in", "T_out"), kept, strict=True))
