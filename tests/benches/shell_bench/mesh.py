"""Teeth that share the load by depth of engagement, and the map from angle and torque to the gauges."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import RectBivariateSpline

from .shell import WAVES, Shell, transfer

TURN = 2 * np.pi
TEETH, ANGLES = 200, 720  # ANGLES: steps of the wave generator in the map
THETA = TURN * np.arange(TEETH) / TEETH
TORQUES = np.concatenate([[0.3, 1.0, 2.0], np.arange(4.0, 20.0, 3.0), np.arange(22.0, 71.0, 6.0)])
PLACES = np.pi / 4 * np.array([1, 3, 5, 7, 0, 2, 4, 6])  # four grid pairs of s0, then s1 to s4
HALF_BRIDGE = 500.0  # mV/V for a shear strain of 1: gauge factor 2, two active arms


@dataclass(frozen=True)
class Mesh:
    """What deforms the flex spline.

    Each of ``waves`` is (n, order, amplitude, phase): w = amplitude cos(n theta - order phi - phase), in m; the first
    is the main one. A tooth touches once the output has closed its gap; its force grows with depth of engagement.
    """

    shell: Shell
    waves: tuple
    gap: float  # halfway between the axes, in m
    shift: float  # of the load ahead of the lobes, in rad
    errors: np.ndarray  # of pitch, in m
    shares: np.ndarray  # 1 for a good tooth
    stiffness: float = 2e7  # of a tooth, in N/m
    flank: float = 0.52  # rad


@dataclass(frozen=True)
class Grids:
    """Errors of position and direction of the eight gauge grids in rad, in the order of PLACES."""

    position: np.ndarray
    direction: np.ndarray


def tooth_forces(mesh, phi):
    """Tangential force of each tooth in N, with the axes angle, torque, tooth."""
    ahead = THETA - mesh.shift - np.zeros((phi.size, 1, 1))
    depth = sum(a * np.cos(n * ahead - m * phi[:, None, None] - p) for n, m, a, p in mesh.waves) / mesh.waves[0][2]
    stiffness = mesh.stiffness * mesh.shares * np.clip(0.25 + depth, 0, None)
    gap = mesh.gap * (1 - depth) + mesh.errors
    target = TORQUES[:, None] / mesh.shell.radius
    x = np.full((phi.size, TORQUES.size, 1), 30e-6)
    for _ in range(12):  # Newton from above: monotone, as the sum of forces is convex
        surplus = np.sum(stiffness * np.maximum(x - gap, 0), -1, keepdims=True) - target
        x = x - surplus / np.sum(stiffness * (x > gap), -1, keepdims=True)
    force = stiffness * np.maximum(x - gap, 0)
    return force * target / force.sum(-1, keepdims=True)


def sense(field, grids):
    """Signal of each grid for each wave number in mV/V. It rises with the load, seen from the back of the collar."""
    twist = 2 * grids.direction[:, None]
    around = np.exp(1j * np.arange(WAVES) * (PLACES + grids.position)[:, None])
    return -HALF_BRIDGE * around * (np.cos(twist) * field[:, 0] + np.sin(twist) * field[:, 1])


def tooth_signal(mesh, grids):
    """Signal of each grid for each wave number, for 1 N at a tooth at theta = 0."""
    _, push, turn = transfer(mesh.shell)
    line = np.where(np.arange(WAVES) == 0, 1, 2)[:, None] / (TURN * mesh.shell.radius)
    return sense(-line * (turn + np.tan(mesh.flank) * push), grids)


def periodic(values):
    """Spline over an angle, of which the values cover one turn, and over the torque."""
    wide = np.arange(-8, len(values) + 8)
    return RectBivariateSpline(TURN * wide / len(values), TORQUES, values[wide % len(values)], s=0)


def gauge_map(mesh, grids):
    """Splines over angle and torque, one for each of the eight grids, in mV/V."""
    phi = TURN * np.arange(ANGLES) / ANGLES
    spectrum = tooth_forces(mesh, phi) @ np.exp(-1j * np.outer(THETA, np.arange(WAVES)))
    signal = (spectrum @ tooth_signal(mesh, grids).T).real
    seat = sense(transfer(mesh.shell)[0], grids)
    for n, m, a, p in mesh.waves:
        signal += (seat[:, n] * a * np.exp(-1j * (m * phi + p))[:, None]).real[:, None, :]
    return [periodic(signal[..., g]) for g in range(PLACES.size)]


def one_tooth(mesh):
    """Spline of the force of a tooth over its angle ahead of the major axis and over the torque."""
    return periodic(tooth_forces(mesh, np.zeros(1))[0].T)
