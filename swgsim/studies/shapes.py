"""Which physics gives the shapes of the paper's Figs. 6 and 7 (C2 to C4, C9), with effects of the library.

``python -m swgsim.studies.shapes`` prints the table of docs/paper_choices.md.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from swgsim.chain.chain import SECTORS, Run, simulate
from swgsim.effects import CamForm, Effect, LoadSharing, RootToothCrack, RotatingEccentricity, TipToothCrack
from swgsim.gear.acquisition import Window
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.storage.orders import order_lines
from swgsim.studies.claims import POSITIONS, RESOLUTION, amplitude, offsets_and_shape, reduced_stiffness
from swgsim.studies.examples import EXAMPLES, FIGURE_POINT, PAPER_POINTS, Subject
from swgsim.studies.finding import percent

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
# Teeth of 200 that a tip crack takes, and load that the mesh carries without torque, as a torque [N m].
C9_CASES = {"as it is": (4, 0.0), "ten teeth": (10, 0.0), "mesh loaded by 5 N m without torque": (4, 5.0)}
TIP_LOSSES = (0.5, 0.75, 1.0)  # of conf/grid/paper
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


def departing(teeth: int, preload: float, load: float, sectors: int = SECTORS) -> float:
    """Share of the tip cracks of gear1 that are seen in the DFT of s1 - s3 or s2 - s4 at a load [N m] (C9).

    Its gauges are not quite alike, so healthy lines do not vanish and hide changes of phase. Tooth forces are in
    proportion to load, so a preload of the mesh acts like more load.
    """
    gear = Gear.load("gear1")
    width = teeth * 2 * np.pi / gear.flex_spline.teeth
    tips = [(TipToothCrack(loss, float(position), width),) for loss in TIP_LOSSES for position in POSITIONS]
    window, seen = Window(), []
    for speed in {point.n_in_rpm for point in PAPER_POINTS}:
        point = OperatingPoint(speed, load + preload)
        s = simulate([Run(gear, point, tip) for tip in [(), *tips]], window, sectors).signals
        lines = np.abs(order_lines(s[:, 1:3] - s[:, 3:5], speed, window.rate, 6))[:, :, 1:]
        seen.append(np.abs(lines[1:] - lines[0]).max(axis=(1, 2)) > RESOLUTION)
    return float(np.mean(seen))


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
    loads = sorted({point.T_out for point in PAPER_POINTS})
    for case, (teeth, preload) in C9_CASES.items():
        shares = [departing(teeth, preload, load) for load in loads]
        at_loads = ", ".join(f"{percent(share)} at {load:g} N m" for share, load in zip(shares, loads, strict=True))
        print(f"C9, {case}: {percent(float(np.mean(shares)))} of the tip cracks are seen; {at_loads}")


if __name__ == "__main__":
    main()
