"""Motor, gear, spring and link of a joint under position control; all quantities at the output.

Sharp Coulomb friction is set-valued and solved implicitly, so that the joint really sticks: V. Acary and B. Brogliato,
Numerical Methods for Nonsmooth Dynamical Systems, Springer 2008. Two masses on a spring: M. W. Spong, Modeling and
control of elastic joint robots, ASME J. Dyn. Syst. Meas. Control 109, 1987. Kinematic error of a strain wave gear:
T. D. Tuttle and W. P. Seering, A nonlinear model of a harmonic drive gear transmission, IEEE Trans. Robot. Autom. 12,
1996; its torque on the motor follows from virtual work.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float
from numba import njit

STEP = 0.25e-3  # s, of the integration
CYCLE = 1e-3  # s, of the drive: control, encoder and log


class Plant(NamedTuple):
    """Physics of a joint. Stiffness 0: motor and link are one body; bristle 0: no LuGre; width 0: sharp friction."""

    motor: float  # inertia of the motor, reflected to the output [kg m^2]
    link: float  # inertia of the link [kg m^2]
    gravity: float  # largest torque of gravity [N m]
    constant: float  # torque of the motor at the output per ampere [N m/A]
    coulomb: float  # [N m]
    viscous: float  # [N m s/rad]
    width: float = 0.0  # speed at which smooth friction is tanh(1) of Coulomb's [rad/s]
    load_friction: float = 0.0  # Coulomb friction per torque in the gear [1]
    bristle: float = 0.0  # LuGre: stiffness of the bristles [N m/rad]
    stiction: float = 0.0  # LuGre: friction at standstill [N m]
    stribeck: float = 1.0  # LuGre: Stribeck speed [rad/s]
    stiffness: float = 0.0  # of the joint at no load [N m/rad]
    cubic: float = 0.0  # its hardening [N m/rad^3]
    gap: float = 0.0  # backlash from stop to stop [rad]
    error: float = 0.0  # amplitude of the kinematic error, twice per revolution of the motor [rad]
    ratio: float = 100.0


class Drive(NamedTuple):
    """Position controller with feed-forward, and its encoder on the motor."""

    resolution: float  # of the encoder, at the output [rad]
    cut_off: float  # of the filter on the differenced angle [Hz]
    bandwidth: float  # of the controller: three equal poles [rad/s]
    gravity_known: float  # share of gravity that is fed forward
    limit: float  # largest torque [N m]
    lag: float = 0.3e-3  # of the current loop [s]


@njit(cache=True)
def stribeck(plant: Plant, speed: float) -> float:
    """LuGre's friction at steady speed without viscous part [N m]: the curve of D. P. Hess and A. Soom, Friction at a
    lubricated line contact operating at oscillating sliding velocities, J. Tribology 112, 1990.
    """
    return plant.coulomb + (plant.stiction - plant.coulomb) / (1 + (speed / plant.stribeck) ** 2)


@njit(cache=True)
def braked(plant: Plant, inertia: float, speed: float, push: float, load: float, bend: float) -> tuple[float, float]:
    """Speed and bending of the bristles after a step.

    LuGre: C. Canudas de Wit, H. Olsson, K. J. Astrom and P. Lischinsky, A new model for control of systems with
    friction, IEEE Trans. Autom. Control 40, 1995; with their damping sqrt(stiffness * inertia).
    """
    if plant.bristle > 0:
        bent = (bend + STEP * speed) / (1 + STEP * plant.bristle * abs(speed) / stribeck(plant, speed))
        damping = np.sqrt(plant.bristle * inertia)
        force = plant.bristle * bent + damping * (bent - bend) / STEP + plant.viscous * speed
        return speed + STEP * (push - force) / (inertia + STEP * plant.viscous), bent
    level = plant.coulomb + plant.load_friction * abs(load)
    if plant.width > 0:
        sense = np.tanh(speed / plant.width)
        slope = level / plant.width * (1 - sense**2) + plant.viscous
        return speed + STEP * (push - level * sense - plant.viscous * speed) / (inertia + STEP * slope), bend
    free = speed + STEP * push / inertia
    left = max(abs(free) - STEP * level / inertia, 0.0) / (1 + STEP * plant.viscous / inertia)
    return np.copysign(left, free), bend


@njit(cache=True)
def spring(plant: Plant, twist: float) -> float:
    """Torque of the joint's spring, which is loose within the gap [N m]."""
    bent = np.copysign(max(abs(twist) - plant.gap / 2, 0.0), twist)
    return plant.stiffness * bent + plant.cubic * bent**3


@njit(cache=True)
def moved(
    plant: Plant, drive: Drive, demand: Float[np.ndarray, "3 cycle"], base: float
) -> Float[np.ndarray, "6 cycle"]:
    """Move a joint along a trajectory.

    Parameters
    ----------
    plant, drive
    demand : array (3, cycle)
        Angle, speed and acceleration.
    base : float
        Angle of what carries the joint: gravity acts with the cosine of ``base`` plus the joint's angle [rad].

    Returns
    -------
    array (6, cycle)
        Angle of the motor, its speed, its speed as the drive computes it at the start of the cycle; means over the
        cycle of the current, of the torque from the gear on the link, and of the motor's acceleration.
    """
    whole, out = plant.motor + plant.link, np.empty((6, demand.shape[1]))
    steps = round(CYCLE / STEP)
    follow, keep = 1 - np.exp(-STEP / drive.lag), np.exp(-2 * np.pi * drive.cut_off * CYCLE)
    motor = link = seen = demand[0, 0]
    speed = link_speed = found = bend = total = load = 0.0
    current = drive.gravity_known * plant.gravity * np.cos(motor + base) / plant.constant
    damping = 2 * 0.03 * np.sqrt(plant.stiffness * plant.motor * plant.link / whole)
    twice, w = 2 * plant.ratio, drive.bandwidth
    for k in range(demand.shape[1]):
        last, seen = seen, np.floor(motor / drive.resolution) * drive.resolution
        found = keep * found + (1 - keep) * (seen - last) / CYCLE
        off = demand[0, k] - seen
        total += off * CYCLE
        wished = demand[2, k] + 3 * w * (demand[1, k] - found) + 3 * w**2 * off + w**3 * total
        torque = whole * wished + drive.gravity_known * plant.gravity * np.cos(seen + base)
        target = min(max(torque, -drive.limit), drive.limit) / plant.constant
        before, current_sum, load_sum = speed, 0.0, 0.0
        for _ in range(steps):
            current += follow * (target - current)
            drop = plant.gravity * np.cos(link + base)
            push = plant.constant * current
            if plant.stiffness > 0:
                twist = motor + plant.error * np.sin(twice * motor) - link
                lever = 1 + plant.error * twice * np.cos(twice * motor)
                load = spring(plant, twist) + damping * (lever * speed - link_speed)
                speed, bend = braked(plant, plant.motor, speed, push - lever * load, load, bend)
                link_speed += STEP * (load - drop) / plant.link
                link += STEP * link_speed
            else:
                once = speed
                speed, bend = braked(plant, whole, speed, push - drop, load, bend)
                load = plant.link * (speed - once) / STEP + drop
            motor += STEP * speed
            if plant.stiffness == 0:
                link = motor
            current_sum, load_sum = current_sum + current, load_sum + load
        out[:, k] = motor, speed, found, current_sum / steps, load_sum / steps, (speed - before) / CYCLE
    return out
