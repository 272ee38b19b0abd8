"""Check whether opposite gauges were exchanged since the commissioning.

The two lobes pass opposite gauges at the same time, so a model cannot distinguish them. The gauges of a unit differ a
little in gain and position. With exchanged cables, this difference changes its sign.
"""

from collections.abc import Sequence
from dataclasses import astuple

import numpy as np
from jaxtyping import Complex

from swgsim.gear.gear import OperatingPoint
from swgsim.identification.data.features import Layout, features
from swgsim.recordings.checks.defect import Defect
from swgsim.recordings.recording import Recording

OPPOSITE = (("s1", "s3"), ("s2", "s4"))
# A difference is turned if it and that of the commissioning cancel to this share. Of 292 pairs of blind cases the least
# leaves 1.5 as it is, and 278 leave less than this once their columns are exchanged.
LEFT_WHEN_TURNED = 0.2


def order_defects(recordings: Sequence[Recording], healthy: Sequence[Recording]) -> list[Defect]:
    """The pairs of gauges that are exchanged against recordings of the healthy gear.

    Parameters
    ----------
    recordings, healthy : sequence of Recording
        With the same channels. Only common operating points are compared; without any, the result is empty.
    """
    common = {each.point for each in recordings} & {each.point for each in healthy}
    there = [pair for pair in OPPOSITE if common and set(pair) <= set(recordings[0].channels)]
    return [
        Defect(
            "gauges_exchanged", "refuse", recordings[0].name, f"{one} {other}",
            f"what {one} shows beyond {other} at even orders as what {other} showed beyond {one} in the commissioning",
            "the same difference between opposite gauges of one gear",
            "swap their columns, in the files or in a column map of these recordings alone",
        )
        for one, other in there
        if exchanged(*(_differences(each, (one, other), common) for each in (recordings, healthy)))
    ]  # fmt: skip


def exchanged(now: Complex[np.ndarray, "point order"], before: Complex[np.ndarray, "point order"]) -> bool:
    """Whether the difference between two gauges has turned its sign at even orders.

    The mean drifts, and odd orders are those of an eccentricity, which may move.

    >>> unlike = np.array([[0, 3e-4, 2e-3, 1e-4 + 0j]])
    >>> exchanged(-unlike, unlike), exchanged(unlike, unlike)
    (True, False)
    """
    left, was = (float(np.linalg.norm(each[:, 2::2])) for each in (now + before, before))
    return left < LEFT_WHEN_TURNED * was


def _differences(
    recordings: Sequence[Recording], pair: tuple[str, str], points: set[OperatingPoint]
) -> Complex[np.ndarray, "point order"]:
    """Order lines of the first gauge less those of the second, the mean of all recordings of each operating point."""
    layout = Layout(pair)
    lines = [
        layout.lines(np.mean([features(each, layout) for each in recordings if each.point == point], axis=0))
        for point in sorted(points, key=astuple)
    ]
    return np.array([one - other for one, other in lines])
