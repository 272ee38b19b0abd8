"""Where the structural model itself is inaccurate: the shape of each gauge's signal over the angle.

A truss is not the flex spline. How far its influence maps s(psi, T) = A(psi) + T B(psi) may lie from those of the real
gear is declared as a share of the gauge's largest line, order by order; recordings of the healthy gear then tell how
far they do, and what is asked later is asked of the corrected maps.
"""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from swgsim.effects.frozen import FULL_LOAD
from swgsim.effects.regularity import FULL_SPEED
from swgsim.loop.features import Layout
from swgsim.loop.model import Situation


def largest_lines(predicted: Float[np.ndarray, "situation feature"], layout: Layout) -> dict[str, float]:
    """The largest line of every gauge, its mean aside."""
    lines = np.abs(layout.lines(predicted))[:, :, 1:].max(axis=(0, 2))
    return {name: float(line) for name, line in zip(layout.channels, lines, strict=True) if name.startswith("s")}


def lines_anywhere(
    signature: Float[np.ndarray, "situation feature"], layout: Layout
) -> Float[np.ndarray, "situation feature column"]:
    """Lines of every gauge at every order, in every situation as large as the largest of an effect's signature there.

    So they follow the effect's own law over situations, which another structure does not change.
    """
    largest = np.abs(layout.lines(signature))[:, :, 1:].max(axis=2)
    of_feature = np.repeat(largest, len(layout) // len(layout.channels), axis=1)
    gauges = [i for i, name in enumerate(layout.channel) if name.startswith("s")]
    return of_feature[:, :, None] * np.eye(len(layout))[:, gauges]


def form_columns(
    largest: Mapping[str, float], situations: Sequence[Situation], layout: Layout, powers: int
) -> Float[np.ndarray, "situation feature column"]:
    """Deviations of the maps A and B of every gauge at every order, each as large as the gauge's largest line.

    A column is the cosine or sine part of one order of one gauge, the same at all operating points (A) or growing with
    the load up to full load (B); with three powers of the load also with its square.
    """
    load = np.array([s.point.T_out for s in situations]) / FULL_LOAD
    columns = []
    for channel, size in largest.items():
        for feature in np.flatnonzero(layout.channel == channel):
            one = np.zeros((len(situations), len(layout)))
            one[:, feature] = size
            columns += [one * load[:, None] ** power for power in range(powers)]
    return np.stack(columns, axis=-1) if columns else np.zeros((len(situations), len(layout), 0))


def learned_columns(
    learned: Float[np.ndarray, " feature"], situations: Sequence[Situation], layout: Layout
) -> Float[np.ndarray, "situation feature column"]:
    """Deviations of lines that the model has quite different, each by laws of load and speed that together pass nearly
    everywhere; none where ``learned``, one standard deviation, is 0.
    """
    load = np.array([s.point.T_out for s in situations]) / FULL_LOAD
    speed = np.array([s.point.n_in_rpm for s in situations]) / FULL_SPEED
    laws = np.stack([np.ones(len(load)), load, load**2, speed, load * speed], axis=1)
    lines = learned[:, None] * np.eye(len(layout))[:, np.flatnonzero(learned)]
    return (lines[:, :, None] * laws[:, None, None, :]).reshape(len(situations), len(layout), -1)
