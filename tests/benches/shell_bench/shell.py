"""The flex spline as a shell of revolution: one linear system for each wave number around the circumference."""

from dataclasses import dataclass

import numpy as np

WAVES = 25  # wave numbers 0 to 24
CORNER = 40  # node where the collar meets the sleeve


@dataclass(frozen=True)
class Shell:
    """A hat: a thin sleeve with the teeth at its open end, and a collar outwards, clamped at its outer edge.

    Lengths in m. ``seat`` is the stiffness of the wave generator's bearing, in N per m of arc and m of deflection.
    """

    radius: float = 21.6e-3
    length: float = 32e-3
    wall: float = 0.38e-3
    clamp_radius: float = 32e-3
    collar: float = 0.5e-3
    band: float = 10e-3
    seat: float = 6e8
    modulus: float = 209e9
    poisson: float = 0.295
    gauge_radius: float = 25.5e-3


def strain_matrix(n, r, length, slope_r, slope_z):
    """Strains (8 x 10) at the middle of a straight element of Mindlin's theory with two nodes.

    Per node: displacement radially, around and axially, rotation of the normal along the meridian and around.
    Rows: membrane strain along, around and shear, the three curvatures, transverse shear along and around.
    """
    along, across = np.array([slope_r, 0, slope_z, 0, 0]), np.array([slope_z, 0, -slope_r, 0, 0])
    outwards, around, _, tip, swing = np.eye(5)
    halves = []
    for slope in (-1 / length, 1 / length):
        rows = [
            slope * along,
            (n * around + outwards) / (2 * r),
            slope * around - (slope_r * around + n * along) / (2 * r),
            slope * tip,
            (n * swing + slope_r * tip) / (2 * r),
            slope * swing - (slope_r * swing + n * tip) / (2 * r),
            tip / 2 + slope * across,
            (swing - (n * across + slope_z * around) / r) / 2,
        ]
        halves.append(rows)
    return np.hstack(halves)


def elasticity(shell, t):
    """Stiffness of a wall of thickness t against the eight strains."""
    nu, out = shell.poisson, np.zeros((8, 8))
    plane = shell.modulus / (1 - nu**2) * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
    out[:3, :3], out[3:6, 3:6] = t * plane, t**3 / 12 * plane
    out[6:, 6:] = np.eye(2) * shell.modulus / (2 + 2 * nu) * 5 / 6 * t
    return out


def transfer(shell):
    """Strains at the gauges for each wave number.

    Returns
    -------
    seat, push, turn : ndarray
        For 1 m of displacement of the wave generator, and for 1 N/m of radial and of tangential load at the teeth.
        The last axis holds shear, and strain along less around. Functions of theta are real parts of X exp(i n theta).
    """
    collar, sleeve = np.linspace(shell.clamp_radius, shell.radius, CORNER + 1), np.linspace(0, shell.length, 73)[1:]
    r = np.concatenate([collar, np.full(sleeve.size, shell.radius)])
    z = np.concatenate([np.zeros(collar.size), sleeve])
    size = 5 * r.size + 1  # the collar has a swing of its own at the corner
    radial = np.arange(0, 5 * r.size, 5)
    weight = np.where(z >= shell.length - shell.band, shell.radius, 0.0)
    weight *= shell.radius / weight.sum()
    force = np.zeros((size, 2))
    force[radial, 0] = force[radial + 1, 1] = weight
    mid, length = (r[1:] + r[:-1]) / 2, np.hypot(np.diff(r), np.diff(z))
    gauge = int(np.argmin(abs(mid[:CORNER] - shell.gauge_radius)))
    push, turn = np.zeros((2, WAVES, 2), complex)
    for n in range(WAVES):
        stiffness = np.zeros((size, size))
        for e in range(length.size):
            strain = strain_matrix(n, mid[e], length[e], np.diff(r)[e] / length[e], np.diff(z)[e] / length[e])
            wall = elasticity(shell, shell.collar if e < CORNER else shell.wall)
            at = np.arange(5 * e, 5 * e + 10)
            at[9] = size - 1 if e == CORNER - 1 else at[9]
            stiffness[np.ix_(at, at)] += strain.T @ wall @ strain * mid[e] * length[e]
            if e == gauge:
                back = strain[:3] - shell.collar / 2 * strain[3:6]
                sense, place = np.array([back[2], back[0] - back[1]]), at
        stiffness[radial, radial] += shell.seat * weight
        moved = np.zeros((size, 2))
        moved[5:] = np.linalg.solve(stiffness[5:, 5:], force[5:])
        push[n], turn[n] = (sense @ moved[place]).T * [[-1j, 1], [1, 1j]]
    return shell.seat * push, push, turn
