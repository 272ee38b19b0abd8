"""Which physics gives the shapes of the paper's Figs. 6 and 7 (C2 to C4, C9), with effects of the library.

``python -m swgsim.studies.shapes`` prints the figures of docs/paper_choices.md.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from swgsim.chain.chain import Run, simulate
from swgsim.dataset.faults import widened
from swgsim.effects import CamForm, LoadSharing, RotatingEccentricity, TipToothCrack
from swgsim.gear.gear import Gear, OperatingPoint
from swgsim.storage.orders import order_lines
from swgsim.studies.claims import (
    POSITIONS,
    RESOLUTION,
    eccentric_wave_generator,
    offsets_and_shape,
    reduced_stiffness,
    root_tooth_crack,
)
from swgsim.studies.examples import EXAMPLES, FIGURE_POINT, PAPER_POINTS, Subject
from swgsim.studies.finding import percent

# Its gauges are not quite alike, so healthy lines of s1 - s3 do not vanish.
GEARS = (Gear.load("gear1"),)
TURNED = (replace(GEARS[0], gauges=replace(GEARS[0].gauges, grid_angle=(0.087,) * 5)),)
CASES: Mapping[str, Subject] = {
    "as it is": Subject(GEARS),
    "load on the deepest teeth": Subject(GEARS, effects=(LoadSharing(-1.0),)),
    "load spread over more teeth": Subject(GEARS, effects=(LoadSharing(1.0),)),
    "cam of orders 2, 3 and 4": Subject(GEARS, effects=(CamForm(3, 20e-6, 0.3), CamForm(4, 20e-6, 0.3))),
    "cracks over five teeth": Subject(GEARS, crack_teeth=5),
    "cracks over ten teeth": Subject(GEARS, crack_teeth=10),
    "gauges turned by 5 degrees, which see normal strain": Subject(TURNED),
}
TIP_LOSSES = (0.5, 0.75, 1.0)  # of conf/grid/paper
# Part of the eccentricity [m] that turns with the wave generator, as the runout of a bearing does.
TURNING = 10e-6
# Load that the mesh carries without torque, as a torque [N m].
WITHOUT_TORQUE = 5.0


def turning_shape(subject: Subject) -> float:
    """Change of the shape of s1 and s3 (C3) where a part of the eccentricity turns, as a share of the amplitude."""
    fault = (EXAMPLES["eccentric_wave_generator"], RotatingEccentricity(TURNING, 0.0))
    runs = [Run(subject.gears[0], FIGURE_POINT, each) for each in ((), fault)]
    healthy, faulty = simulate(runs, subject.window, subject.sectors).signals
    return offsets_and_shape(healthy, faulty, subject.window)[2]


def seen_tips(subject: Subject, load: float) -> float:
    """Share of the tip cracks that are seen in the DFT of s1 - s3 or s2 - s4 at a load [N m] (C9)."""
    tips = [TipToothCrack(loss, float(position)) for loss in TIP_LOSSES for position in POSITIONS]
    faults = [(), *(widened(tip, subject.crack_teeth) for tip in tips)]
    seen = []
    for speed in {point.n_in_rpm for point in PAPER_POINTS}:
        runs = [Run(subject.gears[0], OperatingPoint(speed, load), (*subject.effects, *fault)) for fault in faults]
        s = simulate(runs, subject.window, subject.sectors).signals
        lines = np.abs(order_lines(s[:, 1:3] - s[:, 3:5], speed, subject.window.rate, 6))[:, :, 1:]
        seen.append(np.abs(lines[1:] - lines[0]).max(axis=(1, 2)) > RESOLUTION)
    return float(np.mean(seen))


def main() -> None:
    """Print the figures of each claim."""
    loads = sorted({point.T_out for point in PAPER_POINTS})
    for case, subject in CASES.items():
        for claim in (reduced_stiffness, eccentric_wave_generator, root_tooth_crack):
            finding = claim(subject)
            print(f"{case}: {finding.key} {'holds' if finding.holds else 'does not hold'}: {finding.figure}")
        shares = [seen_tips(subject, load) for load in loads]
        print(
            f"{case}: C9: {percent(float(np.mean(shares)))} of the tip cracks are seen, {percent(shares[0])} at 7 N m"
        )
    print(f"C3, a part of the eccentricity turns: shape {percent(turning_shape(CASES['as it is']))}")
    # Tooth forces are in proportion to load, so load without torque acts like more load.
    shares = [seen_tips(CASES["as it is"], load + WITHOUT_TORQUE) for load in loads]
    print(f"C9, load without torque: {percent(float(np.mean(shares)))}, {percent(shares[0])} at 7 N m")


if __name__ == "__main__":
    main()
