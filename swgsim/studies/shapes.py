"""Which physics gives the shapes of the paper's Fig. 6 (C2 to C4), with effects of the library as part of the fault.

``python -m swgsim.studies.shapes`` prints the table of docs/paper_choices.md.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from swgsim.chain.chain import SECTORS, Run, simulate
from swgsim.effects import CamForm, Effect, LoadSharing, RootToothCrack, RotatingEccentricity
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear
from swgsim.studies.claims import POSITIONS, amplitude, offsets_and_shape, reduced_stiffness
from swgsim.studies.examples import EXAMPLES, FIGURE_POINT, Subject

ECCENTRIC = EXAMPLES["eccentric_wave_generator"]
# What the healthy gear has, and what the faulty one has in addition.
C3_CASES: Mapping[str, tuple[tuple[Effect, ...], tuple[Effect, ...]]] = {
    "as it is": ((), (ECCENTRIC,)),
    "cam with three lobes of 20 µm": ((CamForm(3, 20e-6, 0.3),), (ECCENTRIC,)),
    "load spread over more teeth": ((LoadSharing(1.0),), (ECCENTRIC,)),
    "load on the deepest teeth": ((LoadSharing(-1.0),), (ECCENTRIC,)),
    "10 µm of the eccentricity turn with the wave generator": ((), (ECCENTRIC, RotatingEccentricity(10e-6, 0.0))),
}
# Cracked sectors of the rim, two teeth each.
C4_LENGTHS = (1, 3, 7)
# From a robot link to the brake of a test bench [kg m^2].
C2_INERTIAS = (1.0, 0.1, 0.02)


def signals(effects: Sequence[tuple[Effect, ...]], sectors: int = SECTORS) -> Float[np.ndarray, "run 5 time"]:
    """Signals of the paper's first gear with each of some tuples of effects, at the figures' operating point [mV/V]."""
    return simulate([Run(Gear(), FIGURE_POINT, each) for each in effects], Window(), sectors).signals


def eccentric(case: str, sectors: int = SECTORS) -> tuple[Float[np.ndarray, "2"], float]:
    """Offsets of s1 and s3, and change of their shape besides order 2, as shares of the amplitude (C3)."""
    before, added = C3_CASES[case]
    healthy, faulty = signals([before, (*before, *added)], sectors)
    offsets, _, shape = offsets_and_shape(healthy, faulty, Window())
    return offsets, shape


def cracked(length: int, sectors: int = SECTORS) -> tuple[float, int]:
    """Change of the least changed amplitude by a root crack over some sectors, and positions at which it reaches 1 %.

    The first is the median over twenty positions, as a share of the amplitude (C4).
    """
    pitch, severity = 2 * np.pi / sectors, EXAMPLES["root_tooth_crack"].stiffness_ratio  # type: ignore[attr-defined]
    around = pitch * (np.arange(length) - (length - 1) / 2)
    faults = [tuple(RootToothCrack(severity, theta=float(position + a)) for a in around) for position in POSITIONS]
    healthy, *faulty = signals([(), *faults], sectors)
    least = np.abs(amplitude(np.array(faulty)) / amplitude(healthy) - 1).min(axis=1)
    return float(np.median(least)), int((least >= 0.01).sum())


def main() -> None:
    """Print the figures of each claim."""
    for inertia in C2_INERTIAS:
        subject = Subject((Gear().with_transmission(J_out=inertia),))
        print(f"C2, load inertia {inertia:g} kg m²: {reduced_stiffness(subject).figure}")
    for case in C3_CASES:
        (s1, s3), shape = eccentric(case)
        print(f"C3, {case}: offsets s1 {100 * s1:+.0f} %, s3 {100 * s3:+.0f} %, shape {100 * shape:.2g} %")
    for length in C4_LENGTHS:
        median, reached = cracked(length)
        print(f"C4, {length} cracked sectors: least change {100 * median:.2g} % at the median, 1 % at {reached} of 20")


if __name__ == "__main__":
    main()
