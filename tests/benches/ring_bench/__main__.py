"""Command: python -m ring_bench OUT --seed S --case K, with 20 cases of healthy and faulty gears."""

import argparse
import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from .bench import Bench, Gauges, record
from .drive import Drive
from .ring import Ring

TURN = 2 * np.pi


@dataclass(frozen=True)
class Effect:
    """Something that happens to a gear between two days."""

    name: str
    usual: float  # size; the actual one lies between 0.8 and 1.25 times it
    unit: str
    what: str
    apply: Callable[[Bench, float, float], Bench]  # bench, size, angle drawn at random
    library: bool = True


def in_ring(bench: Bench, **changes: object) -> Bench:
    """The bench with another ring."""
    return replace(bench, ring=replace(bench.ring, **changes))


def more(bench: Bench, waves: str, order: int, size: float, phase: float) -> Bench:
    """The bench with one more wave in its ring."""
    return in_ring(bench, **{waves: (*getattr(bench.ring, waves), (order, size, phase))})


def soften(bench: Bench, share: float) -> Bench:
    """The bench with less of the linear stiffness."""
    return replace(bench, drive=replace(bench.drive, k1=bench.drive.k1 * (1 - share)))


def shift_bridge(bench: Bench, size: float, angle: float) -> Bench:
    """The bench with one of s1 to s4 in another place."""
    shifts = bench.gauges.shifts.copy()
    shifts[1 + int(4 * angle / TURN)] += size
    return replace(bench, gauges=replace(bench.gauges, shifts=shifts))


EFFECTS = [
    Effect(
        "eccentric_wave_generator",
        25e-6,
        "m",
        "The wave generator is off centre, fixed to the housing.",
        lambda b, size, at: more(b, "fixed_waves", 1, size, at),
    ),
    Effect(
        "rotating_eccentricity",
        15e-6,
        "m",
        "The cam is off the axis of its shaft and turns with it.",
        lambda b, size, at: more(b, "cam_waves", 1, size, at),
    ),
    Effect(
        "cam_form",
        5e-6,
        "m",
        "The cam has a form error of three lobes that turns with it.",
        lambda b, size, at: more(b, "cam_waves", 3, size, at),
    ),
    Effect(
        "out_of_round",
        8e-6,
        "m",
        "The free flex spline has three waves around its circumference.",
        lambda b, size, at: more(b, "fixed_waves", 3, size, at),
    ),
    Effect(
        "worn_wave_generator",
        0.08,
        "share of w0",
        "Wear takes a share of the deflection.",
        lambda b, size, at: in_ring(b, wear=size),
    ),
    Effect(
        "root_tooth_crack",
        0.75,
        "share of stiffness",
        "A crack at the root of a tooth takes stiffness from ring and sleeve over some 8 degrees.",
        lambda b, size, at: in_ring(b, soft_spots=((at, 0.06, size, size),)),
    ),
    Effect(
        "mesh_shift",
        0.06,
        "rad",
        "The tooth force is centred further ahead of the lobes.",
        lambda b, size, at: in_ring(b, mesh_shift=b.ring.mesh_shift + size),
    ),
    Effect(
        "uneven_teeth",
        0.3,
        "share of force",
        "Pitch and stiffness of the teeth vary once around.",
        lambda b, size, at: more(b, "tooth_waves", 1, size, at),
    ),
    Effect(
        "reduced_stiffness",
        0.15,
        "share of k1",
        "The linear torsional stiffness has fallen.",
        lambda b, size, at: soften(b, size),
    ),
    Effect("gauge_position", 0.05, "rad", "The grids of one of s1 to s4 sit further around the collar.", shift_bridge),
    Effect(
        "dented_lobe",
        25e-6,
        "m",
        "A dent near an end of the cam's major axis, 6 degrees wide, turns with it.",
        lambda b, size, at: in_ring(b, dent=(size, 0.05, 0.3 * np.sin(at))),
        library=False,
    ),
    Effect(
        "loose_clamp",
        0.4,
        "share of stiffness",
        "The clamp of the collar is loose over some 30 degrees, so the shear flow goes around this sector.",
        lambda b, size, at: in_ring(b, soft_spots=((at, 0.25, 0.0, size),)),
        library=False,
    ),
    Effect(
        "soft_coupling",
        2.5e4,
        "N m/rad",
        "The coupling before the brake has gone soft, so the load swings as two inertias.",
        lambda b, size, at: replace(b, drive=replace(b.drive, coupling=size)),
        library=False,
    ),
    Effect(
        "creeping_cam",
        0.06,
        "rad",
        "The cam slips back on its shaft under load, by this angle until the end of the session.",
        lambda b, size, at: replace(b, creep=size),
        library=False,
    ),
]
HEALTHY = 6


def healthy_bench(rng: np.random.Generator, name: str) -> Bench:
    """A gear of its own, with the spreads of production and assembly."""

    def some(size: float) -> float:
        return size * rng.uniform(0.3, 1.0)

    def phase() -> float:
        return rng.uniform(0, TURN)

    ring = Ring(
        deflection=0.22e-3 * (1 + 0.02 * rng.normal()),
        cam_waves=((1, some(4e-6), phase()), (3, some(5e-7), phase()), (4, some(1.5e-6), 0.0)),
        fixed_waves=((1, some(6e-6), phase()), (2, some(2e-6), phase()), (3, some(1e-6), phase())),
        wall_waves=((1, some(0.02), phase()), (2, some(0.01), phase())),
        tooth_waves=((1, some(0.03), phase()), (2, some(0.02), phase()), (5, some(0.02), phase())),
        mesh_shift=0.01 * rng.normal(),
        sleeve_radial=2e6 * (1 + 0.05 * rng.normal()),
    )
    drive = Drive(
        motor_inertia=1.2e-4 * (1 + 0.03 * rng.normal()),
        k1=1.39e4 * rng.uniform(0.92, 1.08),
        k3=7.5e7 * rng.uniform(0.85, 1.15),
        coulomb=0.030 * rng.uniform(0.85, 1.15),
        churning=0.022 * rng.uniform(0.85, 1.15),
        load_friction=0.13 * rng.uniform(0.85, 1.15),
        position_friction=(some(0.06), phase()),
        error=((1, some(0.3e-4), phase()), (2, some(0.9e-4), phase()), (4, some(0.4e-4), phase())),
    )
    gauges = Gauges(
        gains=1 + 0.01 * rng.normal(size=5),
        zeros=0.01 * rng.normal(size=5),
        shifts=0.01 * rng.normal(size=5),
        warming=2e-4 * rng.normal(size=5),
    )
    return Bench(ring, drive, gauges, name=name)


def main() -> None:
    """Write the recordings of one case, and the truth about it."""
    parser = argparse.ArgumentParser(prog="ring_bench", description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--case", type=int, required=True, choices=range(HEALTHY + len(EFFECTS)))
    options = parser.parse_args()
    rng = np.random.default_rng([options.seed, options.case])
    before = healthy_bench(rng, f"ring{options.seed}_{options.case}")
    after = before
    truth = {"effect": None, "library": False, "size": 0.0, "unit": "", "what": "The gear is healthy."}
    if options.case >= HEALTHY:
        effect = EFFECTS[options.case - HEALTHY]
        size = effect.usual * rng.uniform(0.8, 1.25)
        after = effect.apply(before, size, rng.uniform(0, TURN))
        truth = {
            "effect": effect.name,
            "library": effect.library,
            "size": size,
            "unit": effect.unit,
            "what": effect.what,
        }
    for number, (day, folder, bench) in enumerate([("day1", "healthy", before), ("day2", "again", after)]):
        record(bench, day, options.out / folder, np.random.default_rng([options.seed, options.case, 1 + number]))
    (options.out / "truth.json").write_text(json.dumps(truth, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
