"""Where the structural model itself is inaccurate: the shape of each gauge's signal over the angle.

A truss is not the flex spline. How far its influence maps s(psi, T) = A(psi) + T B(psi) may lie from those of the real
gear is declared as a share of the gauge's largest line, order by order; recordings of the healthy gear then tell how
far they do, and what is asked later is asked of the corrected maps.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from swgsim.gauges import GaugeSet
from swgsim.loop.features import ORDERS, Layout, basis
from swgsim.loop.model import POINTS, Situation
from swgsim.loop.own_lines import LAWS, Lines, laws
from swgsim.recordings import SENSORS

# How far lines may deviate, of maps and of lines that are learned, each an array (feature,).
Sizes = tuple[Float[np.ndarray, " feature"], Float[np.ndarray, " feature"]]


def largest_lines(predicted: Float[np.ndarray, "situation feature"], layout: Layout) -> dict[str, float]:
    """The largest line of every gauge, its mean aside."""
    lines = np.abs(layout.lines(predicted))[:, :, 1:].max(axis=(0, 2))
    return {name: float(line) for name, line in zip(layout.channels, lines, strict=True) if name in SENSORS}


def lines_anywhere(
    signature: Float[np.ndarray, "situation feature"], layout: Layout
) -> Float[np.ndarray, "situation feature column"]:
    """Lines of every gauge at every order, in every situation as large as the largest of an effect's signature there.

    So they follow the effect's own law over situations, which another structure does not change.
    """
    largest = np.abs(layout.lines(signature))[:, :, 1:].max(axis=2)
    of_feature = np.repeat(largest, len(layout) // len(layout.channels), axis=1)
    gauges = [i for i, name in enumerate(layout.channel) if name in SENSORS]
    return of_feature[:, :, None] * np.eye(len(layout))[:, gauges]


def form_columns(
    sizes: Sizes,
    situations: Sequence[Situation],
    powers: int,
    layout: Layout,
    torque: Float[np.ndarray, "situation one"],
) -> Float[np.ndarray, "situation feature column"]:
    """Deviations of lines, one standard deviation each.

    Parameters
    ----------
    sizes : pair of array (feature,)
        Of the maps, whose lines are the same at all operating points (A) or grow with the load up to full load (B),
        with three powers of the load also with its square; and of lines that the model has quite different, each by
        laws of load and speed that together pass nearly everywhere. There is no column where a size is 0.
    situations : sequence of Situation
    powers : int
        Of the load, by which the maps may deviate.
    layout : Layout
    torque : array (situation, one)
        Features of the output's torque, whose ripple the gauges feel as they do its mean.
    """
    of_maps, of_learned = sizes
    followed = np.array([_followed(s, each, layout) for s, each in zip(situations, torque, strict=True)])
    parts = [_columns(of_maps, followed[:, :, :powers]), _columns(of_learned, followed)]
    return np.concatenate(parts, axis=-1)


def _followed(
    situation: Situation, torque: Float[np.ndarray, " one"], layout: Layout
) -> Float[np.ndarray, "channel law one one"]:
    """What becomes of every line of a channel by each law: of a gauge by the torque over the turn, else by its mean."""
    turn = basis(2 * np.pi * np.arange(POINTS) / POINTS, ORDERS)
    mean = np.array(situation.point.T_out)
    over_turn = laws(mean + turn[:, 1:] @ torque[1:], situation.point.n_in_rpm)
    by_ripple = (turn / (turn**2).sum(axis=0)).T @ (over_turn[:, :, None] * turn)  # angles are passed evenly
    by_mean = laws(mean, situation.point.n_in_rpm)[:, None, None] * np.eye(turn.shape[1])
    return np.array([by_ripple if name in SENSORS else by_mean for name in layout.channels])


def _columns(
    size: Float[np.ndarray, " feature"], followed: Float[np.ndarray, "situation channel law one one"]
) -> Float[np.ndarray, "situation feature column"]:
    """Every feature that has a size, by each law."""
    situations, channels, followable, one, _ = followed.shape
    own = np.flatnonzero(size)
    columns = np.zeros((situations, channels, one, len(own), followable))
    for column, feature in enumerate(own):
        channel, line = divmod(int(feature), one)
        columns[:, channel, :, column] = size[feature] * followed[:, channel, :, :, line].swapaxes(1, 2)
    return columns.reshape(situations, len(size), -1)


def column_counts(sizes: Sizes, powers: int) -> tuple[int, int]:
    """How many columns of :func:`form_columns` deviations of the maps have, and of lines that are learned."""
    of_maps, of_learned = sizes
    return powers * int(np.count_nonzero(of_maps)), len(LAWS) * int(np.count_nonzero(of_learned))


def lines_of(sizes: Sizes, found: Float[np.ndarray, " column"], powers: int, layout: Layout, gauges: GaugeSet) -> Lines:
    """What the columns of :func:`form_columns` make together, each as large as it was found by these gauges."""
    by_law = np.zeros((len(LAWS), len(layout)))
    of_maps, _ = column_counts(sizes, powers)
    for size, share, followed in zip(sizes, np.split(found, [of_maps]), (powers, len(LAWS)), strict=True):
        own = np.flatnonzero(size)
        by_law[:followed, own] += share.reshape(len(own), followed).T * size[own]
    lines = layout.lines(by_law)
    lie_off = layout.channel[np.any(sizes, axis=0)]
    there = np.flatnonzero(np.isin(layout.channels, lie_off))
    return Lines(tuple(layout.channels[i] for i in there), lines[:, there], gauges)
