"""Uniform rotation in equilibrium with the load: where each search for a steady motion begins, and its resonance."""

import numpy as np
from jaxtyping import Float

from swgsim.chain.dynamics import Drive, State

# Newton steps to the twist that carries the load; the cubic stiffness needs few.
NEWTON_STEPS = 8


def uniform_rotation(drive: Drive) -> State:
    """The state at phi_in = 0, as if there were neither kinematic error nor effects.

    Notes
    -----
    The load is known, and in equilibrium with it F_n = T_load / cos(alpha_tooth) + T_fric tan(alpha_tooth). Then
    eq. (5) is solved for T_fric, at phi_out = 0.
    """
    p, speed = drive.p, drive.omega / (drive.p["N"] + 1)
    sliding = drive.sliding_speed(speed)
    friction = drive.unloaded_friction(sliding, np.zeros_like(sliding))
    T_fric = (friction + p["mu"] * drive.T_load / drive.cos_t) / (1 - p["mu"] * drive.tan_t)
    T_stiff = drive.tan_t * (drive.T_load + T_fric / drive.sin_t)
    twist = T_stiff / p["k1"]
    for _ in range(NEWTON_STEPS):
        twist -= ((p["k1"] + p["k2"] * twist**2) * twist - T_stiff) / (p["k1"] + 3 * p["k2"] * twist**2)
    phi_out = drive.tan_t * (drive.phi_err(np.zeros_like(twist))[0] - twist)
    return np.stack([0 * twist, drive.omega, phi_out, speed, drive.tan_in * T_stiff / drive.gain_i])


def resonance(drive: Drive) -> Float[np.ndarray, " run"]:
    """Natural frequency of the two inertias on the gear's stiffness at the load [Hz]."""
    _, _, phi_out, _, _ = uniform_rotation(drive)
    twist = -phi_out / drive.tan_t + drive.phi_err(np.zeros_like(phi_out))[0]
    stiffness = (drive.p["k1"] + 3 * drive.p["k2"] * twist**2) / drive.tan_t**2
    reflected = (drive.p["N"] + 1) ** 2 * drive.p["J_in"]
    return np.sqrt(stiffness * (1 / reflected + 1 / drive.p["J_out"])) / (2 * np.pi)
