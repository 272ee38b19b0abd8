"""Model discrepancy: by how much lines differ from the model at an operating point, in all of its recordings.

After Kennedy and O'Hagan, Bayesian calibration of computer models, J. R. Statist. Soc. B 63 (2001). Near a resonance a
small error of the model changes lines of one operating point, and hardly those of another one. So each line has a
complex factor 1 + z at each operating point. Recordings of the healthy gear determine z. At an operating point without
such recordings, it is as uncertain as before them.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from swgsim.gear.gear import OperatingPoint
from swgsim.identification.data.features import Layout
from swgsim.identification.data.model import Situation

# Standard deviation of z by operating point and line; 0 where it is nothing beside the noise.
Shares = Float[np.ndarray, "point channel order"]


def discrepancies(
    shares: Shares,
    points: Sequence[OperatingPoint],
    situations: Sequence[Situation],
    predicted: Float[np.ndarray, "situation feature"],
    layout: Layout,
) -> Float[np.ndarray, "situation feature column"]:
    """Change of the lines by one standard deviation of the real and the imaginary part of each z."""
    point, channel, order = np.nonzero(shares)
    there = np.equal.outer([points.index(each.point) if each.point in points else -1 for each in situations], point)
    of_line = (layout.channel[:, None] == np.array(layout.channels)[channel]) & (layout.order[:, None] == order)
    by = (there * shares[point, channel, order])[:, None] * of_line
    a_quarter_later = layout.vector(1j * layout.lines(predicted))
    return np.concatenate([by * predicted[..., None], by * a_quarter_later[..., None]], axis=-1)
