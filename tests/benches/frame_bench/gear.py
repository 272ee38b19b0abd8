"""Gear: wave generator and teeth on the frame, the spread from unit to unit, and the twenty cases."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from . import frame
from .drive import WEDGE, Drive

LOBES = 216e-6  # m, deflection under the lobes


@dataclass(frozen=True)
class Wave:
    """Radial displacement amplitude cos(order (theta - psi) + phase), or cos(order theta - phase) if it stands."""

    order: int
    amplitude: float
    phase: float
    turns: bool = True


@dataclass(frozen=True)
class Gear:
    """One unit; lengths in m, angles in rad, signals in mV/V, bridges in the order s0 to s4."""

    drive: Drive
    gains: np.ndarray
    positions: np.ndarray
    zeros: np.ndarray
    thermal: np.ndarray  # per kelvin
    normal_share: float
    lobes: float
    waves: tuple  # what the wave generator imposes besides its lobes
    zone: float  # half width of the zone of engagement
    mesh_shift: float  # by which the zone leads the lobes
    teeth: tuple  # factors of the tooth force: entries (order, share, phase)
    depth: float = 0.8  # gain of a tooth's force per share of displacement in the lobes
    lobe_lead: float = 0.01  # by which the lobes lead the cam at 70 N m
    tips: tuple = ()  # broken teeth: entries (sector, share of force lost)
    damages: tuple = ()
    patch: tuple = (0.0, 0.0, 0.1)  # worn teeth that turn with the circular spline: share, angle, width
    axial: tuple = (0.0, 5.0)  # axial float of the wave generator: amplitude, Hz
    hum: float = 6e-4
    ring: float = 5e-4
    ring_frequency: float = 412.0
    bridges: tuple = field(init=False)

    def __post_init__(self) -> None:
        """Solve the frame once for the bridges of this unit."""
        places = np.concatenate(
            [np.pi / 4 + np.arange(4) * np.pi / 2 + self.positions[0], np.arange(4) * np.pi / 2 + self.positions[1:]]
        )
        solved = frame.influence(places, self.normal_share, self.damages)
        object.__setattr__(self, "bridges", tuple(np.vstack([x[:4].mean(axis=0), x[4:]]) for x in solved))


def new_gear(rng: np.random.Generator) -> Gear:
    """A healthy unit with the spread of manufacture."""
    phase = rng.uniform(0, 2 * np.pi, 12)
    errors = tuple(
        (order, rng.uniform(low, high), phase[order])
        for order, low, high in ((1, 1e-5, 2.5e-5), (2, 2e-5, 4e-5), (4, 1e-5, 2.5e-5))
    )
    spread = 1 + rng.normal(0, 1, 6) * (0.04, 0.1, 0.1, 0.1, 0.05, 0.05)
    nominal = Drive()
    drive = Drive(
        stiffness=nominal.stiffness * spread[0],
        drag=nominal.drag * spread[1],
        viscous=nominal.viscous * spread[2],
        load_share=nominal.load_share * spread[3],
        inertia_out=nominal.inertia_out * spread[4],
        control=nominal.control * spread[5],
        errors=errors,
    )
    waves = (
        Wave(1, rng.uniform(1e-6, 5e-6), phase[5], turns=False),
        Wave(1, rng.uniform(1e-6, 4e-6), phase[6]),
        Wave(3, rng.uniform(2e-7, 8e-7), phase[7]),
        Wave(4, rng.uniform(2e-6, 4e-6), 0.0),
        Wave(6, rng.uniform(2e-7, 8e-7), 0.0),
        Wave(2, rng.uniform(1e-6, 3e-6), phase[8], turns=False),
    )
    return Gear(
        drive,
        gains=1 + rng.normal(0, 0.01, 5),
        positions=rng.normal(0, 0.01, 5),
        zeros=rng.normal(0, 0.01, 5),
        thermal=rng.normal(0, 2e-4, 5),
        normal_share=rng.normal(0.04, 0.01),
        lobes=LOBES * rng.normal(1, 0.01),
        waves=waves,
        zone=rng.uniform(0.62, 0.74),
        mesh_shift=rng.normal(0, 0.02),
        teeth=((1, rng.uniform(0, 0.02), phase[9]), (2, rng.uniform(0, 0.02), phase[10])),
        ring_frequency=rng.uniform(390, 430),
    )


def strain_signals(
    gear: Gear, cam: np.ndarray, torque: np.ndarray, angle_out: np.ndarray, time: np.ndarray, phase: float
) -> np.ndarray:
    """Signals of the five bridges without zeros (samples, 5), from angles, torque and the phase of the axial float."""
    theta = frame.ANGLES - cam[:, None]
    ahead = theta - gear.lobe_lead * torque[:, None] / 70
    other = sum(
        wave.amplitude
        * (
            np.cos(wave.order * theta + wave.phase)
            if wave.turns
            else np.cos(wave.order * frame.ANGLES - wave.phase)[None, :]
        )
        for wave in gear.waves
    )
    axial = gear.axial[0] * np.sin(2 * np.pi * gear.axial[1] * time + phase)[:, None]
    moved = (gear.lobes * np.cos(2 * ahead) + other) / (1 + axial / frame.CONTACT_HEIGHT)

    from_lobe = np.remainder(ahead - gear.mesh_shift + np.pi / 2, np.pi) - np.pi / 2
    share = np.where(abs(from_lobe) < gear.zone, 1 + np.cos(np.pi * from_lobe / gear.zone), 0.0)
    share = share * np.maximum(1 + gear.depth * other / gear.lobes, 0)
    for order, part, lag in gear.teeth:
        share = share * (1 + part * np.cos(order * frame.ANGLES - lag))
    for sector, part in gear.tips:
        share[:, sector] *= 1 - part
    part, angle, width = gear.patch
    from_patch = np.remainder(frame.ANGLES - angle_out[:, None] - angle + np.pi, 2 * np.pi) - np.pi
    share = share * (1 - part * np.exp(-((from_patch / width) ** 2) / 2))
    share = torque[:, None] * share / share.sum(axis=1, keepdims=True)
    press, tooth = gear.bridges
    return gear.gains * (moved @ press.T + share @ tooth.T)


@dataclass(frozen=True)
class Case:
    """An effect: its name, whether the library has it, range and unit of its size, its sentence and its action."""

    name: str
    library: bool
    low: float
    high: float
    unit: str
    what: str
    apply: Callable[[Gear, float, np.random.Generator], Gear]


def _wave(order: int, turns: bool) -> Callable:
    """Add a wave of the given order to what the wave generator imposes."""
    return lambda gear, size, rng: replace(
        gear, waves=(*gear.waves, Wave(order, size, rng.uniform(0, 2 * np.pi), turns))
    )


def _damage(place: str, width: int) -> Callable:
    """Weaken the frame at a random sector."""
    return lambda gear, size, rng: replace(
        gear, damages=(frame.Damage(place, int(rng.integers(frame.SECTORS)), size, width),)
    )


CASES = (
    Case(
        "eccentric_wave_generator",
        True,
        12e-6,
        24e-6,
        "m",
        "The axis of the wave generator stands off centre.",
        _wave(1, turns=False),
    ),
    Case(
        "rotating_eccentricity",
        True,
        10e-6,
        18e-6,
        "m",
        "The cam is off the axis of its shaft and turns with it.",
        _wave(1, turns=True),
    ),
    Case("cam_form", True, 4e-6, 7e-6, "m", "The cam has a form error of three lobes.", _wave(3, turns=True)),
    Case(
        "root_tooth_crack",
        True,
        0.8,
        0.95,
        "share of stiffness lost",
        "A crack at the root of a tooth parts two columns of nodes.",
        _damage("sleeve", 1),
    ),
    Case(
        "tip_tooth_crack",
        True,
        0.85,
        1.0,
        "share of force lost",
        "The teeth of one sector carry hardly any force.",
        lambda gear, size, rng: replace(gear, tips=((int(rng.integers(frame.SECTORS)), size),)),
    ),
    Case(
        "uneven_teeth",
        True,
        0.15,
        0.25,
        "share",
        "Errors of the teeth vary their force once around the flex spline.",
        lambda gear, size, rng: replace(gear, teeth=(*gear.teeth, (1, size, rng.uniform(0, 2 * np.pi)))),
    ),
    Case(
        "lobe_shift",
        True,
        0.05,
        0.09,
        "rad at 70 N m",
        "Load turns the lobes ahead of the cam.",
        lambda gear, size, rng: replace(gear, lobe_lead=gear.lobe_lead + size),
    ),
    Case(
        "kinematic_error_order",
        True,
        5e-5,
        9e-5,
        "rad of phi_err",
        "Assembly adds a third order to the kinematic error.",
        lambda gear, size, rng: replace(
            gear, drive=replace(gear.drive, errors=(*gear.drive.errors, (3, size / WEDGE, rng.uniform(0, 2 * np.pi))))
        ),
    ),
    Case(
        "reduced_stiffness",
        True,
        0.15,
        0.25,
        "share lost",
        "The linear stiffness of the flex spline has fallen.",
        lambda gear, size, rng: replace(gear, drive=replace(gear.drive, stiffness=gear.drive.stiffness * (1 - size))),
    ),
    Case(
        "gauge_position",
        True,
        0.03,
        0.06,
        "rad",
        "The grids of one bridge sit further around the collar.",
        lambda gear, size, rng: replace(gear, positions=gear.positions + size * (np.arange(5) == rng.integers(1, 5))),
    ),
    Case(
        "bent_shaft_joint",
        False,
        3e-3,
        6e-3,
        "rad of input angle",
        "A universal joint ahead of the wave generator runs at an angle, so the cam leads and lags twice a turn.",
        lambda gear, size, rng: replace(gear, drive=replace(gear.drive, joint=size)),
    ),
    Case(
        "loose_clamp_bolt",
        False,
        0.85,
        0.97,
        "share of clamp stiffness lost",
        "One of twelve bolts of the collar is loose, so a twelfth of its edge is hardly held.",
        _damage("clamp", 6),
    ),
    Case(
        "worn_patch_of_circular_spline",
        False,
        0.6,
        0.9,
        "share of tooth force lost",
        "A patch of worn teeth travels with the circular spline past the lobes.",
        lambda gear, size, rng: replace(gear, patch=(size, rng.uniform(0, 2 * np.pi), 0.22)),
    ),
    Case(
        "axial_float",
        False,
        6e-4,
        1.2e-3,
        "m",
        "The wave generator floats to and fro on its shaft at a few hertz, so the deflection swells and fades.",
        lambda gear, size, rng: replace(gear, axial=(size, rng.uniform(6.0, 9.0))),
    ),
)
HEALTHY = 6


def make_case(seed: int, number: int) -> tuple[Gear, Gear, dict]:
    """Healthy gear, its state on the second day, and the truth about a case."""
    gear = new_gear(np.random.default_rng([seed, number, 0]))
    if number < HEALTHY:
        truth = {"effect": None, "library": False, "size": 0.0, "unit": "", "what": "The gear is healthy."}
        return gear, gear, truth
    rng, case = np.random.default_rng([seed, number, 1]), CASES[number - HEALTHY]
    size = float(rng.uniform(case.low, case.high))
    truth = {"effect": case.name, "library": case.library, "size": size, "unit": case.unit, "what": case.what}
    return gear, case.apply(gear, size, rng), truth
