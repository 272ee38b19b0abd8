"""Gears as they leave the factory, and the twenty cases."""

from dataclasses import dataclass, replace

import numpy as np

from .drive import Drive
from .mesh import TEETH, THETA, TURN, Grids, Mesh
from .shell import Shell

HEALTHY, KNOWN = 6, 10
TO_MODEL = 1.715  # phi_err over the error at the output: N tan(alpha_in)


@dataclass(frozen=True)
class Gear:
    """A gear on its bench, with gains and zeros (mV/V) of s0 to s4.

    ``crack`` is the share of shear that s2 gains while the crack beside it is open.
    ``chipped`` counts neighbouring teeth of the circular spline without tips.
    """

    mesh: Mesh
    grids: Grids
    gains: np.ndarray
    zeros: np.ndarray
    drive: Drive
    crack: float = 0.0
    chipped: int = 0


def build(rng):
    """Draw a healthy gear."""

    def near(value, spread):
        return value * (1 + spread * rng.normal())

    main = near(0.21e-3, 0.01)
    small = ((3, 3, 1.5e-6), (1, 1, 5e-6), (1, 0, 8e-6), (2, 0, 4e-6), (3, 0, 3e-6))
    waves = [(2, 2, main, 0.0), (4, 4, 0.0075 * main, 0.0)]
    waves += [(n, m, a * rng.uniform(0.3, 1), rng.uniform(0, TURN)) for n, m, a in small]
    shell = Shell(wall=near(0.38e-3, 0.02), collar=near(0.5e-3, 0.02))
    pitch = 0.2e-6 * rng.normal(size=TEETH)
    mesh = Mesh(shell, tuple(waves), near(3e-6, 0.1), near(0.02, 0.25), pitch, np.ones(TEETH))
    grids = Grids(0.01 * rng.normal(size=8), 0.06 + 0.01 * rng.normal(size=8))
    errors = [(k, near(a, 0.2), rng.uniform(0, TURN)) for k, a in ((1, 0.2e-4), (2, 0.5e-4), (4, 0.25e-4))]
    drive = Drive(
        stiffness=near(1.39e4, 0.08),
        cubic=near(7.5e7, 0.1),
        errors=tuple(errors),
        churning=near(0.030, 0.1),
        coulomb=near(0.8, 0.1),
        flank=near(0.12, 0.1),
    )
    return Gear(mesh, grids, 1 + 0.01 * rng.normal(size=5), 0.01 * rng.normal(size=5), drive)


def wave(orders, low, high, what):
    """Return an effect that adds a wave of displacement; ``orders`` are the choices of (n, order)."""

    def effect(rng, gear):
        (n, m), size, phase = rng.choice(orders), rng.uniform(low, high), rng.uniform(0, TURN)
        waves = (*gear.mesh.waves, (int(n), int(m), size, phase))
        return replace(gear, mesh=replace(gear.mesh, waves=waves)), size, "m", f"{what} n = {n}, {phase:.2f} rad."

    return effect


def worn_wave_generator(rng, gear):
    size = rng.uniform(0.06, 0.12)
    waves = tuple((n, m, a * (1 - size) if i < 2 else a, p) for i, (n, m, a, p) in enumerate(gear.mesh.waves))
    return replace(gear, mesh=replace(gear.mesh, waves=waves)), size, "1", "Wear takes a share of the deflection."


def uneven_teeth(rng, gear):
    size, k, phase = rng.uniform(0.2, 0.3), int(rng.integers(1, 4)), rng.uniform(0, TURN)
    mesh = replace(gear.mesh, shares=1 + size * np.cos(k * THETA - phase))
    return replace(gear, mesh=mesh), size, "1", f"Tooth forces vary around the flex spline: k = {k}, {phase:.2f} rad."


def mesh_shift(rng, gear):
    size = rng.uniform(0.08, 0.15)
    mesh = replace(gear.mesh, shift=gear.mesh.shift + size)
    return replace(gear, mesh=mesh), size, "rad", "The teeth carry their load ahead of the lobes."


def kinematic_error_order(rng, gear):
    order, size, phase = int(rng.integers(1, 5)), rng.uniform(0.4e-4, 0.7e-4), rng.uniform(0, TURN)
    drive = replace(gear.drive, errors=(*gear.drive.errors, (order, size, phase)))
    what = f"The kinematic error gains order {order}, {phase:.2f} rad; the size counts in phi_err."
    return replace(gear, drive=drive), size * TO_MODEL, "rad", what


def reduced_stiffness(rng, gear):
    size = rng.uniform(0.15, 0.25)
    drive = replace(gear.drive, stiffness=gear.drive.stiffness * (1 - size))
    return replace(gear, drive=drive), size, "1", "The linear stiffness is down by a share."


def gauge_position(rng, gear):
    size, gauge = rng.uniform(0.06, 0.1), int(rng.integers(1, 5))
    grids = replace(gear.grids, position=gear.grids.position + size * (np.arange(8) == 3 + gauge))
    return replace(gear, grids=grids), size, "rad", f"Gauge s{gauge} was bonded again, further around the collar."


def breathing_crack(rng, gear):
    size = rng.uniform(0.08, 0.15)
    return replace(gear, crack=size), size, "1", "A crack beside s2 opens at positive shear only and adds to it."


def loose_disc(rng, gear):
    size, frequency = rng.uniform(0.25, 0.4), rng.uniform(70.0, 90.0)
    drive = replace(gear.drive, disc=size, disc_frequency=frequency)
    what = f"A share of the load inertia is loose on its hub and swings at {frequency:.0f} Hz."
    return replace(gear, drive=drive), size, "1", what


def chipped_circular_spline(rng, gear):
    size = int(rng.integers(9, 14))
    what = "Teeth of the circular spline lost their tips; the gap wanders around the flex spline with the output."
    return replace(gear, chipped=size), float(size), "teeth", what


EFFECTS = {
    "eccentric_wave_generator": wave([(1, 0)], 50e-6, 90e-6, "The wave generator stands off centre:"),
    "rotating_eccentricity": wave([(1, 1)], 25e-6, 50e-6, "The cam is off the axis of its shaft:"),
    "cam_form": wave([(3, 3), (5, 5)], 6e-6, 12e-6, "The form of the cam has lobes too many:"),
    "out_of_round": wave([(2, 0), (3, 0)], 20e-6, 45e-6, "The flex spline is out of round:"),
    "worn_wave_generator": worn_wave_generator,
    "uneven_teeth": uneven_teeth,
    "mesh_shift": mesh_shift,
    "kinematic_error_order": kinematic_error_order,
    "reduced_stiffness": reduced_stiffness,
    "gauge_position": gauge_position,
    "oldham_orbit": wave([(1, 2)], 10e-6, 16e-6, "The Oldham disc swings the wave generator around twice a turn:"),
    "breathing_crack": breathing_crack,
    "loose_disc": loose_disc,
    "chipped_circular_spline": chipped_circular_spline,
}


def case_of(seed, case):
    """Return the healthy gear, the gear of the other day, and the truth about it."""
    gear = build(np.random.default_rng([seed, case, 0]))
    if case < HEALTHY:
        return gear, gear, {"effect": None, "library": True, "size": 0.0, "unit": "", "what": "The gear is healthy."}
    name = list(EFFECTS)[case - HEALTHY]
    changed, size, unit, what = EFFECTS[name](np.random.default_rng([seed, case, 1]), gear)
    known = case < HEALTHY + KNOWN
    return gear, changed, {"effect": name, "library": known, "size": size, "unit": unit, "what": what}
