"""Error of the influence maps: the structural model is a truss, not the real flex spline.

The prior deviation of the maps s(psi, T) = A(psi) + T B(psi) is a share of the gauge's largest line, order by order.
Recordings of the healthy gear determine the deviation. Later fits use the corrected maps.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from swgsim.flexspline.gauges import GaugeSet
from swgsim.identification.data.features import ORDERS, Layout, basis
from swgsim.identification.data.model import SAMPLES_PER_TURN, Situation
from swgsim.identification.data.unit_lines import LAWS, Lines, laws
from swgsim.storage.labelled_signals import SENSORS

# How far lines may deviate by each law (standard deviation).
Sizes = Float[np.ndarray, "law feature"]


def sizes_of(of_maps: Float[np.ndarray, " feature"], powers: int, of_learned: Float[np.ndarray, " feature"]) -> Sizes:
    """How far lines may deviate.

    Parameters
    ----------
    of_maps : array (feature,)
        By the maps, whose lines are the same at all operating points (A) or grow with the load up to full load (B),
        with three powers of the load also with its square.
    powers : int
        Of the load, by which the maps may deviate.
    of_learned : array (feature,)
        Of lines that the model has quite different: by laws of load and speed that together pass nearly everywhere.
    """
    found = np.tile(of_learned, (len(LAWS), 1))
    found[:powers] = np.hypot(found[:powers], of_maps)
    return found


def largest_lines(predicted: Float[np.ndarray, "situation feature"], layout: Layout) -> dict[str, float]:
    """The largest line of every gauge, its mean aside."""
    lines = np.abs(layout.lines(predicted))[:, :, 1:].max(axis=(0, 2))
    return {name: float(line) for name, line in zip(layout.channels, lines, strict=True) if name in SENSORS}


def form_columns(
    sizes: Sizes, situations: Sequence[Situation], layout: Layout, torque: Float[np.ndarray, "situation one"]
) -> Float[np.ndarray, "situation feature column"]:
    """Deviations of lines, one standard deviation each, law by law; none where a size is 0.

    Parameters
    ----------
    sizes : array (law, feature)
        By :func:`sizes_of`.
    situations : sequence of Situation
    layout : Layout
    torque : array (situation, one)
        Features of the output's torque, whose ripple the gauges feel as they do its mean.
    """
    followed = np.array([_followed(s, each, layout) for s, each in zip(situations, torque, strict=True)])
    channels, one = followed.shape[1], followed.shape[-1]
    law, feature = np.nonzero(sizes)
    channel, line = np.divmod(feature, one)
    columns = np.zeros((len(situations), channels, one, len(law)))
    # Shape (column, situation, one).
    of_columns = followed[:, channel, law, :, line] * sizes[law, feature][:, None, None]
    columns[:, channel, :, np.arange(len(law))] = of_columns
    return columns.reshape(len(situations), len(layout), -1)


def _followed(
    situation: Situation, torque: Float[np.ndarray, " one"], layout: Layout
) -> Float[np.ndarray, "channel law one one"]:
    """What becomes of every line of a channel by each law: of a gauge by the torque over the turn, else by its mean."""
    turn = basis(2 * np.pi * np.arange(SAMPLES_PER_TURN) / SAMPLES_PER_TURN, ORDERS)
    mean = np.array(situation.point.T_out, dtype=float)
    over_turn = laws(mean + turn[:, 1:] @ torque[1:], situation.point.n_in_rpm)
    by_ripple = (turn / (turn**2).sum(axis=0)).T @ (over_turn[:, :, None] * turn)  # angles are passed evenly
    by_mean = laws(mean, situation.point.n_in_rpm)[:, None, None] * np.eye(turn.shape[1])
    return np.array([by_ripple if name in SENSORS else by_mean for name in layout.channels])


def lines_of(sizes: Sizes, found: Float[np.ndarray, " column"], layout: Layout, gauges: GaugeSet) -> Lines:
    """Sum of the columns of :func:`form_columns` with the sizes that were found by these gauges."""
    by_law = np.zeros_like(sizes)
    own = sizes != 0
    by_law[own] = sizes[own] * found
    lines = layout.lines(by_law)
    lie_off = layout.channel[np.any(sizes, axis=0)]
    there = np.flatnonzero(np.isin(layout.channels, lie_off))
    return Lines(tuple(layout.channels[i] for i in there), lines[:, there], gauges)
