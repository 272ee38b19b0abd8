"""Motion of motor, gear and load: two inertias with the torsion of the flex spline between, integrated in time."""

from dataclasses import dataclass

import numpy as np

RATIO, STEP, SETTLING, SAMPLES = 101, 1e-4, 0.7, 3600  # the circular spline is the output; s
REFERENCE = 2000 * 2 * np.pi / 60  # speed at which the churning is given, rad/s


@dataclass(frozen=True)
class Drive:
    """Inertias, torsion, friction and control of one gear; terms are (order, size, phase)."""

    inertia_in: float = 1.2e-4  # rotor and wave generator, kg m^2
    inertia_out: float = 1.0  # load, kg m^2
    linear: float = 1.39e4  # torsional stiffness seen from the output, N m/rad
    cubic: float = 7.5e7  # N m/rad^3
    damping: float = 5.0  # torsional damping, N m s/rad
    flank: float = 1.6  # friction of the flanks at no load, N m at the output
    flank_share: float = 0.13  # friction of the flanks as a share of the torque
    bearing: float = 0.008  # constant brake of the wave generator, N m
    churning: float = 0.027  # brake by the grease at 2000 rpm, N m; it grows with speed^(2/3)
    errors: tuple = ()  # kinematic error as an angle of the output, rad
    cogging: tuple = ((6, 0.0008, 0.4), (12, 0.0015, 1.1))  # torque of the motor, N m
    control: float = 5.0  # natural frequency of the speed control, Hz
    joint: tuple = (2, 0.0, 0.0)  # lead of the wave generator over the motor's encoder by a cardan joint, rad
    inertia_joint: float = 2e-5  # inertia behind the joint, kg m^2


@dataclass(frozen=True)
class Runs:
    """Operating points with their scatter, one entry per recording."""

    speed: np.ndarray  # set speed, rad/s
    torque: np.ndarray  # torque of the brake, N m
    friction: np.ndarray  # factor of all friction
    start: np.ndarray  # angle of the wave generator, rad
    drift: np.ndarray  # change of the speed within the recording, share
    bend: np.ndarray  # place where the drift bends, as a share of the duration


def sines(terms, angle):
    """Sum of size sin(order angle + phase) over the terms, and its derivative."""
    value = sum((size * np.sin(order * angle + phase) for order, size, phase in terms), 0 * angle)
    slope = sum((order * size * np.cos(order * angle + phase) for order, size, phase in terms), 0 * angle)
    return value, slope


def accelerations(drive, runs, state, set_speed):
    """Time derivative of the state (angle, speed, output angle, output speed, integral) and the two torques."""
    angle, speed, output, output_speed, integral = state
    order, lead, _ = drive.joint
    error, slope = sines((*drive.errors, (order, lead / RATIO, drive.joint[2])), angle)
    lever = 1 / RATIO + slope
    twist = angle / RATIO + error - output
    spring = drive.linear * twist + drive.cubic * twist**3 + drive.damping * (lever * speed - output_speed)
    friction = runs.friction * (drive.flank + drive.flank_share * np.abs(spring)) * np.tanh(output_speed / 0.05)
    transmitted = spring - friction
    brake = runs.friction * (drive.bearing + drive.churning * (np.abs(speed) / REFERENCE) ** (2 / 3))
    inertia = drive.inertia_in + drive.inertia_out / RATIO**2
    natural = 2 * np.pi * drive.control
    motor = 2 * natural * inertia * (set_speed - speed) + natural**2 * inertia * integral
    motor = motor + sines(drive.cogging, angle)[0]
    joint = drive.inertia_joint * order**2 * speed**2 * sines((drive.joint,), angle)[0]
    gain = (motor - brake - lever * spring + joint) / drive.inertia_in
    change = np.stack([speed, gain, output_speed, (transmitted - runs.torque) / drive.inertia_out, set_speed - speed])
    return change, motor, transmitted


def set_speeds(runs, time):
    """Set speed with its slow drift; time is 0 at the begin of the recording."""
    part = np.clip(time / (SAMPLES * STEP), 0, 1) - runs.bend
    return runs.speed * (1 + runs.drift * (part**2 - 1 / 3))


def first_state(drive, runs):
    """State near the steady motion, which shortens the settling."""
    spring = (runs.torque + runs.friction * drive.flank) / (1 - runs.friction * drive.flank_share)
    twist = spring / (drive.linear + drive.cubic * (spring / drive.linear) ** 2)
    brake = runs.friction * (drive.bearing + drive.churning * (runs.speed / REFERENCE) ** (2 / 3)) + spring / RATIO
    inertia = drive.inertia_in + drive.inertia_out / RATIO**2
    integral = brake / ((2 * np.pi * drive.control) ** 2 * inertia)
    output = runs.start / RATIO + sines(drive.errors, runs.start)[0] - twist
    return np.stack([runs.start, runs.speed, output, runs.speed / RATIO, integral])


def move(drive, runs):
    """Integrate all recordings at once by the Runge-Kutta method of order 4.

    Returns
    -------
    tuple of numpy.ndarray
        Angle and speed of the motor, its torque and the transmitted torque, each (recording, sample).
    """
    state, kept = first_state(drive, runs), []
    for step in range(round(SETTLING / STEP) + SAMPLES):
        time = step * STEP - SETTLING
        wanted = [set_speeds(runs, time + part * STEP) for part in (0, 0.5, 1)]
        first, motor, transmitted = accelerations(drive, runs, state, wanted[0])
        if time > -STEP / 2:
            kept.append((state[0], state[1], motor, transmitted))
        second = accelerations(drive, runs, state + STEP / 2 * first, wanted[1])[0]
        third = accelerations(drive, runs, state + STEP / 2 * second, wanted[1])[0]
        fourth = accelerations(drive, runs, state + STEP * third, wanted[2])[0]
        state = state + STEP / 6 * (first + 2 * second + 2 * third + fourth)
    return tuple(np.array(kept).transpose(1, 2, 0))
