"""Gears with their unit-to-unit spread, and the twenty cases: six healthy, ten known effects, four unknown ones."""

from dataclasses import dataclass, replace

import numpy as np

from ritz_bench.drive import Drive
from ritz_bench.shell import Structure


@dataclass(frozen=True)
class Gear:
    """One gear with its gauges; gains and zeros belong to s0 to s4."""

    structure: Structure
    drive: Drive
    gains: np.ndarray
    zeros: np.ndarray  # mV/V


def draw_gear(rng):
    """Draw a healthy gear."""

    def term(order, size):
        return order, size * rng.uniform(0.5, 1.5), rng.uniform(-np.pi, np.pi)

    structure = Structure(
        wave=2.2e-4 * rng.normal(1, 0.02),
        cam=(term(1, 1.5e-6), term(3, 0.8e-6), term(6, 0.4e-6)),
        fixed=(term(1, 4e-6), term(2, 2e-6), term(3, 1e-6)),
        wall=(term(1, 0.006), term(2, 0.004)),
        teeth=(term(1, 0.02), term(3, 0.01), term(5, 0.01)),
        width=0.40 * rng.normal(1, 0.05),
        widening=rng.uniform(0.15, 0.35),
        gauges=tuple(rng.normal(0, 0.01, 8)),
    )
    friction = rng.normal(1, 0.1)
    drive = Drive(
        linear=1.39e4 * rng.normal(1, 0.06),
        cubic=7.5e7 * rng.normal(1, 0.1),
        damping=5.0 * rng.normal(1, 0.1),
        flank=1.6 * friction,
        flank_share=0.13 * friction * rng.normal(1, 0.05),
        bearing=0.008 * friction,
        churning=0.027 * rng.normal(1, 0.1),
        errors=(term(1, 2.5e-5), term(2, 6e-5), term(4, 3e-5)),
        cogging=(term(6, 0.0008), term(12, 0.0015)),
    )
    return Gear(structure, drive, rng.normal(1, 0.01, 5), rng.normal(0, 0.01, 5))


def shaped(gear, **changes):
    """Copy the gear with another structure; new terms of errors are added to the old ones."""
    old = gear.structure
    changes = {k: getattr(old, k) + v if k in ("cam", "fixed", "teeth") else v for k, v in changes.items()}
    return replace(gear, structure=replace(old, **changes))


def driven(gear, **changes):
    """Copy the gear with another drive."""
    return replace(gear, drive=replace(gear.drive, **changes))


def moved(gear, size, angle):
    """Copy the gear with the gauge of s1 to s4 whose quarter holds the angle bonded further around."""
    gauges = np.array(gear.structure.gauges)
    gauges[int(angle % (2 * np.pi) / (np.pi / 2))] += size
    return shaped(gear, gauges=tuple(gauges))


KNOWN = {  # name: size, unit, what is wrong
    "eccentric_wave_generator": (40e-6, "m", "The wave generator stands off centre, towards {angle:.3f} rad."),
    "rotating_eccentricity": (20e-6, "m", "The cam turns off its shaft's axis, phase {angle:.3f} rad."),
    "cam_form": (6e-6, "m", "The cam has a form error of three lobes, phase {angle:.3f} rad."),
    "root_tooth_crack": (0.85, "share", "The rim loses stiffness at {angle:.3f} rad, half width 0.05 rad."),
    "tip_tooth_crack": (0.8, "share", "Two teeth at {angle:.3f} rad lose a share of their force."),
    "uneven_teeth": (0.15, "share", "Tooth forces vary in three waves, phase {angle:.3f} rad."),
    "worn_wave_generator": (0.06, "share", "Wear takes a share of the deflection of the lobes."),
    "lobe_shift": (0.06, "rad", "Load turns the lobes ahead of the cam, by the size at 70 N m."),
    "reduced_stiffness": (0.2, "share", "The linear torsional stiffness fell by a share."),
    "gauge_position": (0.05, "rad", "The gauge whose quarter holds {angle:.3f} rad sits further around."),
}
UNKNOWN = {
    "chip_under_sleeve": (12e-6, "m", "A chip under the sleeve at {angle:.3f} rad lifts each lobe."),
    "bent_cardan_joint": (0.012, "rad", "A bent joint lets the cam lead twice per turn, phase {angle:.3f} rad."),
    "loose_clamp_sector": (0.7, "share", "The clamp is loose at {angle:.3f} rad, half width 0.4 rad."),
    "whirl_of_loose_axis": (15e-6, "m", "The loose axis of the cam whirls 0.43 times per revolution."),
}
CASES = [None] * 6 + list(KNOWN) + list(UNKNOWN)
CHANGES = {
    "eccentric_wave_generator": lambda gear, size, angle: shaped(gear, fixed=((1, size, angle),)),
    "rotating_eccentricity": lambda gear, size, angle: shaped(gear, cam=((1, size, angle),)),
    "cam_form": lambda gear, size, angle: shaped(gear, cam=((3, size, -angle),)),
    "root_tooth_crack": lambda gear, size, angle: shaped(gear, crack=(size, angle, 0.05)),
    "tip_tooth_crack": lambda gear, size, angle: shaped(gear, broken=(size, angle, 0.03)),
    "uneven_teeth": lambda gear, size, angle: shaped(gear, teeth=((3, size, angle),)),
    "worn_wave_generator": lambda gear, size, angle: shaped(gear, wave=gear.structure.wave * (1 - size)),
    "lobe_shift": lambda gear, size, angle: shaped(gear, lobe_shift=size),
    "reduced_stiffness": lambda gear, size, angle: driven(gear, linear=gear.drive.linear * (1 - size)),
    "gauge_position": moved,
    "chip_under_sleeve": lambda gear, size, angle: shaped(gear, chip=(size, angle, 0.1)),
    "bent_cardan_joint": lambda gear, size, angle: driven(gear, joint=(2, size, angle)),
    "loose_clamp_sector": lambda gear, size, angle: shaped(gear, clamp=(size, angle, 0.4)),
    "whirl_of_loose_axis": lambda gear, size, angle: shaped(gear, whirl=size),
}


def break_gear(gear, case, rng):
    """Bring the gear into the state of the case and tell the truth; sizes vary by a tenth, angles are random."""
    name, angle = CASES[case], float(rng.uniform(-np.pi, np.pi))
    if name is None:
        return gear, {"effect": None, "library": False, "size": 0.0, "unit": "", "what": "The gear is healthy."}
    size, unit, what = (KNOWN | UNKNOWN)[name]
    size = float(size * rng.uniform(0.9, 1.1))
    truth = {"effect": name, "library": name in KNOWN, "size": size, "unit": unit, "what": what.format(angle=angle)}
    return CHANGES[name](gear, size, angle), truth
