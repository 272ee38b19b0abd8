"""Flex spline as an elastic shell: Ritz functions, contact of the wave generator, tooth forces and strain gauges."""

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import cho_factor, cho_solve

RADIUS, LENGTH, MODULUS, POISSON = 21.6e-3, 30e-3, 209e9, 0.295
SLEEVE_WALL, RIM_WALL, RIM_START, RIM_LINE = 0.43e-3, 0.62e-3, 0.65, 0.83  # walls in m, places as shares of the length
DEGREE, HARMONICS, TEETH = 6, 10, 200
CLAMP = (5e7, 2e11, 2e11, 1.2e4)  # springs of the diaphragm per metre: axial, tangential, radial (N/m^2), tilt (N)
BED = 3e9  # radial stiffness of the wave generator's bearing per metre of circumference, N/m^2
GAUGE_FACTOR, TRANSVERSE, GAUGE_PLACE, GRID = 2.0, 0.01, 0.25, (3.0e-3, 1.5e-3)  # place as a share, length and width
TORQUES = np.array([3.0, 22.0, 46.0])  # N m, nodes of the tables
CONTACT_POINTS, ANGLES, ORDERS = 96, 64, 24


@dataclass(frozen=True)
class Structure:
    """Shape, errors and damage of flex spline, wave generator and gauges; terms are (order, size, phase)."""

    wave: float = 2.2e-4  # deflection of the lobes, m
    cam: tuple = ()  # errors that turn with the wave generator, m
    fixed: tuple = ()  # errors fixed to the flex spline, m
    wall: tuple = ()  # uneven wall, share
    teeth: tuple = ()  # uneven tooth forces, share
    width: float = 0.40  # half width of the tooth forces at no load, rad
    widening: float = 0.25  # share by which the width grows up to 70 N m
    lobe_shift: float = 0.0  # angle by which the lobes lead the cam at 70 N m, rad
    crack: tuple = (0.0, 0.0, 0.05)  # share of the lost rim stiffness, angle, width
    broken: tuple = (0.0, 0.0, 0.03)  # share of the lost tooth force, angle, width
    chip: tuple = (0.0, 0.0, 0.1)  # height of a particle on the sleeve, angle, width
    clamp: tuple = (0.0, 0.0, 0.4)  # share of the lost clamp stiffness, angle, width
    whirl: float = 0.0  # radius of the whirl of the wave generator's axis, m
    gauges: tuple = (0.0,) * 8  # errors of the places of s1 to s4 and of the four pairs of s0, rad


def wrap(angle):
    """Bring an angle into -pi..pi."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


def hump(angle, term):
    """Gaussian of height, centre and width `term` over the circumference."""
    return term[0] * np.exp(-0.5 * (wrap(angle - term[1]) / term[2]) ** 2)


def waves(terms, angle):
    """Sum of size cos(order angle - phase) over the terms."""
    return sum((size * np.cos(order * angle - phase) for order, size, phase in terms), np.zeros_like(angle))


def functions(x, angle, dx=0, da=0):
    """Values (point, function) of the Ritz functions, or of their derivatives along axis and circumference."""
    axial = np.eye(DEGREE + 1)
    axial = legendre.legder(axial, dx) * (2 / LENGTH) ** dx if dx else axial
    axial = legendre.legval(2 * x / LENGTH - 1, axial).T
    n = np.arange(HARMONICS + 1)
    phase = np.outer(angle, n) + da * np.pi / 2
    around = np.hstack([np.cos(phase) * n**da, (np.sin(phase) * n**da)[:, 1:]])
    return (axial[:, :, None] * around[:, None, :]).reshape(len(x), -1)


def strains(x, angle):
    """Rows of membrane strains and curvatures (6, point, coordinate) of axial, tangential and radial motion."""
    f, fx, fa = functions(x, angle), functions(x, angle, 1), functions(x, angle, 0, 1)
    o, r = np.zeros_like(f), RADIUS
    rows = [(fx, o, o), (o, fa / r, f / r), (fa / r, fx, o), (o, o, -functions(x, angle, 2))]
    rows += [(o, fa / r**2, -functions(x, angle, 0, 2) / r**2), (o, 2 * fx / r, -2 * functions(x, angle, 1, 1) / r)]
    return np.stack([np.hstack(row) for row in rows])


def wall(structure, x, angle):
    """Thickness of the wall."""
    return np.where(x > RIM_START * LENGTH, RIM_WALL, SLEEVE_WALL) * (1 + waves(structure.wall, angle))


def stiffness(structure):
    """Stiffness of the Ritz coordinates: membrane and bending energy of the shell, springs of the diaphragm."""
    nodes, weights = legendre.leggauss(12)
    around = np.arange(120) * 2 * np.pi / 120
    x, angle = (grid.ravel() for grid in np.meshgrid((nodes + 1) * LENGTH / 2, around, indexing="ij"))
    area = np.repeat(weights * LENGTH / 2, 120) * RADIUS * 2 * np.pi / 120
    t = wall(structure, x, angle)
    sound = 1 - np.where(x > RIM_START * LENGTH, hump(angle, structure.crack), 0)
    membrane = MODULUS / (1 - POISSON**2) * t * area * sound
    shear, total = (1 - POISSON) / 2, 0.0
    rows = strains(x, angle)
    for (first, second, third), factor in ((rows[:3], membrane), (rows[3:], membrane * t**2 / 12)):
        both = first + POISSON * second
        total = total + (both * factor[:, None]).T @ first + shear * (third * factor[:, None]).T @ third
        total = total + ((second + POISSON * first) * factor[:, None]).T @ second
    end, held = np.zeros(120), (1 - hump(around, structure.clamp)) * RADIUS * 2 * np.pi / 120
    f, tilt = functions(end, around), functions(end, around, 1)
    o = np.zeros_like(f)
    for row, spring in zip(((f, o, o), (o, f, o), (o, o, f), (o, o, tilt)), CLAMP, strict=True):
        row = np.hstack(row)
        total = total + spring * (row * held[:, None]).T @ row
    return total


def grid(structure, centre, direction, aside):
    """Row of the mean strain of one grid at `direction` to the axis, with transverse sensitivity."""
    along, w_along = legendre.leggauss(5)
    across, w_across = legendre.leggauss(3)
    a, c = (m.ravel() for m in np.meshgrid(along * GRID[0] / 2, across * GRID[1] / 2, indexing="ij"))
    cos, sin = np.cos(direction), np.sin(direction)
    x = GAUGE_PLACE * LENGTH + a * cos - c * sin
    angle = centre + (aside + a * sin + c * cos) / RADIUS
    rows = strains(x, angle)
    axial, hoop, shear = rows[:3] + wall(structure, x, angle)[:, None] / 2 * rows[3:]
    strain = (cos**2 + TRANSVERSE * sin**2) * axial + (sin**2 + TRANSVERSE * cos**2) * hoop
    strain = strain + (1 - TRANSVERSE) * sin * cos * shear
    return np.outer(w_along, w_across).ravel() @ strain / 4


def bridges(structure):
    """Rows of the signals s0 to s4 in mV/V; span resistors trim s0 to the sensitivity of a single pair."""
    places = np.concatenate([np.arange(4) * np.pi / 2, np.arange(4) * np.pi / 2 + np.pi / 4]) + structure.gauges
    pairs = [grid(structure, p, -np.pi / 4, 1e-3) - grid(structure, p, np.pi / 4, -1e-3) for p in places]
    return 1000 * GAUGE_FACTOR / 4 * np.stack([np.mean(pairs[4:], axis=0), *pairs[:4]])


def cam_shape(structure, theta, phi, lead, axis):
    """Radial displacement that the wave generator asks for, over (angle of the cam, place)."""
    own = theta - phi - lead
    shape = structure.wave * (np.cos(2 * own) + 0.0075 * np.cos(4 * own)) + waves(structure.cam, theta - phi)
    shape = shape + waves(structure.fixed, theta + 0 * phi) + hump(theta, structure.chip)
    return shape + axis[0] * np.cos(theta) + axis[1] * np.sin(theta)


def tooth_forces(structure, theta, phi, torque, axis):
    """Tangential force of each tooth: a Gaussian at each lobe; teeth that stand further out carry more."""
    lead = structure.lobe_shift * torque / 70
    width = structure.width * (1 + structure.widening * torque / 70)
    force = np.exp(-0.5 * (wrap(2 * (theta - phi - lead)) / 2 / width) ** 2)
    plain = cam_shape(Structure(structure.wave), theta, phi, lead, (0, 0))
    force = force * (1 + (cam_shape(structure, theta, phi, lead, axis) - plain) / structure.wave)
    force = force * (1 + waves(structure.teeth, theta)) * (1 - hump(theta, structure.broken))
    return force * torque / RADIUS / force.sum(axis=1, keepdims=True)


def contact(compliance, demand):
    """Forces of a unilateral spring bed, found by iteration of the set of points in contact."""
    soft = 1 / (BED * RADIUS * 2 * np.pi / CONTACT_POINTS)
    touching = demand > 0
    for _ in range(30):
        both = touching[:, :, None] & touching[:, None, :]
        matrix = np.where(both, compliance, 0) + soft * np.eye(CONTACT_POINTS)
        force = np.linalg.solve(matrix, np.where(touching, demand, 0)[..., None])[..., 0]
        now = demand - force @ compliance.T > 0
        if np.array_equal(now, touching):
            break
        touching = now
    return force


def tables(structure):
    """Fourier coefficients (axis, torque, signal, order) of the signals over the angle of the wave generator.

    The first table is for the axis in its place, two more for the axis displaced by the radius of a whirl.
    """
    theta, teeth = (np.arange(m) * 2 * np.pi / m for m in (CONTACT_POINTS, TEETH))
    phi = np.arange(ANGLES)[:, None] * 2 * np.pi / ANGLES
    press, pull = (functions(np.full(len(a), RIM_LINE * LENGTH), a) for a in (theta, teeth))
    press = np.hstack([0 * press, 0 * press, press])
    pull = np.hstack([0 * pull, -pull, -np.tan(np.pi / 6) * pull])  # the circular spline holds back and presses inward
    rows = np.vstack([press, bridges(structure)])
    answer = cho_solve(cho_factor(stiffness(structure)), np.vstack([press, pull]).T)
    by_press, by_pull = np.split(rows @ answer, [CONTACT_POINTS], axis=1)
    result = []
    for axis in ((0, 0), (structure.whirl, 0), (0, structure.whirl))[: 3 if structure.whirl else 1]:
        signals = []
        for torque in TORQUES:
            force = tooth_forces(structure, teeth, phi, torque, axis)
            shape = cam_shape(structure, theta, phi, structure.lobe_shift * torque / 70, axis)
            pressure = contact(by_press[:CONTACT_POINTS], shape - force @ by_pull[:CONTACT_POINTS].T)
            signals.append(pressure @ by_press[CONTACT_POINTS:].T + force @ by_pull[CONTACT_POINTS:].T)
        result.append(np.fft.rfft(np.stack(signals), axis=1)[:, : ORDERS + 1].transpose(0, 2, 1) / ANGLES)
    return np.stack(result)


def signals(table, phi, torque, whirl_angle):
    """Signals (5, ...) at angles of the wave generator and torques, quadratic between the nodes of torque."""
    turn, value = np.exp(1j * phi), 0.0
    parts = [np.ones_like(phi)]
    if len(table) == 3:
        parts = [1 - np.cos(whirl_angle) - np.sin(whirl_angle), np.cos(whirl_angle), np.sin(whirl_angle)]
    for part, coefficients in zip(parts, table, strict=True):
        for k, node in enumerate(TORQUES):
            others = np.delete(TORQUES, k)
            share = part * (torque - others[0]) * (torque - others[1]) / ((node - others[0]) * (node - others[1]))
            series = np.zeros((5, *phi.shape), complex)
            for order in range(ORDERS, 0, -1):
                series = (series + 2 * coefficients[k, :, order].reshape(5, *[1] * phi.ndim)) * turn
            value = value + share * (series.real + coefficients[k, :, 0].real.reshape(5, *[1] * phi.ndim))
    return value
