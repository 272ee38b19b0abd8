"""Where the structural model itself is inaccurate: the shape of each gauge's signal over the angle.

A truss is not the flex spline. How far its influence maps s(psi, T) = A(psi) + T B(psi) may lie from those of the real
gear is declared as a share of the gauge's largest line, order by order; recordings of the healthy gear then tell how
far they do, and what is asked later is asked of the corrected maps.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from swgsim.effects.frozen import FULL_LOAD
from swgsim.loop.features import ORDERS, Layout
from swgsim.loop.model import Situation


def form_columns(
    predicted: Float[np.ndarray, "situation feature"], situations: Sequence[Situation], layout: Layout
) -> Float[np.ndarray, "situation feature column"]:
    """Deviations of the maps A and B of every gauge at every order, each as large as the gauge's largest line.

    A column is the cosine or sine part of one order of one gauge, the same at all operating points (A) or growing with
    the load up to full load (B).
    """
    lines = np.abs(layout.lines(predicted))
    load = np.array([s.point.T_out for s in situations]) / FULL_LOAD
    columns = []
    for number, channel in enumerate(layout.channels):
        if not channel.startswith("s"):
            continue
        size = float(lines[:, number, 1:].max())
        for feature in np.flatnonzero(layout.channel == channel):
            one = np.zeros((len(situations), len(layout)))
            one[:, feature] = size
            columns += [one, one * load[:, None]]
    return np.stack(columns, axis=-1) if columns else np.zeros((*predicted.shape, 0))


def widest(layout: Layout) -> int:
    """Columns that there are."""
    return 2 * (2 * ORDERS + 1) * sum(channel.startswith("s") for channel in layout.channels)
