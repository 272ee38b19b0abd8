"""Model discrepancy: by how much lines differ from the model at an operating point, in all of its recordings.

After Kennedy and O'Hagan, Bayesian calibration of computer models, J. R. Statist. Soc. B 63 (2001). Near a resonance a
small error of the model changes lines of one operating point, and hardly those of another one. So each line has a
complex factor 1 + z at each operating point. Recordings of the healthy gear determine z where they show the line. The
z of all other lines and operating points are open: an effect may make a line there that is to be seen.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Complex, Float

from swgsim.gear.gear import OperatingPoint
from swgsim.identification.data.features import Layout
from swgsim.identification.data.model import Situation

# A discrepancy that changes a line by fewer standard deviations of the noise is not seen.
LEAST_SEEN = 0.1


@dataclass(frozen=True, eq=False)
class Discrepancy:
    """The prior of z, and where healthy recordings determine it.

    Attributes
    ----------
    sd : array (channel,)
        Standard deviation of the real and of the imaginary part of z; 0 for channels that have none.
    noise : array (channel, order)
        Standard deviation of the noise of a line.
    points : tuple of OperatingPoint
        Those of the healthy recordings.
    determined : array (point, channel, order)
        The lines that these show.
    """

    sd: Float[np.ndarray, " channel"]
    noise: Float[np.ndarray, "channel order"]
    points: tuple[OperatingPoint, ...]
    determined: Bool[np.ndarray, "point channel order"]

    def columns(
        self, situations: Sequence[Situation], predicted: Float[np.ndarray, "situation feature"], layout: Layout
    ) -> Float[np.ndarray, "situation feature column"]:
        """Change of the lines by one standard deviation of each z that healthy recordings determine."""
        return self._columns(self.determined, self.points, situations, predicted, layout)

    def undetermined(
        self, situations: Sequence[Situation], predicted: Float[np.ndarray, "situation feature"], layout: Layout
    ) -> Float[np.ndarray, "situation feature column"]:
        """The same of all other z that are seen."""
        points = tuple(dict.fromkeys(each.point for each in situations))
        chosen = seen(self.sd, self.noise, points, situations, layout.lines(predicted))
        for number, point in enumerate(points):
            if point in self.points:
                chosen[number] &= ~self.determined[self.points.index(point)]
        return self._columns(chosen, points, situations, predicted, layout)

    def _columns(
        self,
        chosen: Bool[np.ndarray, "point channel order"],
        points: Sequence[OperatingPoint],
        situations: Sequence[Situation],
        predicted: Float[np.ndarray, "situation feature"],
        layout: Layout,
    ) -> Float[np.ndarray, "situation feature column"]:
        """Real and imaginary part of each z of some lines."""
        point, channel, order = np.nonzero(chosen)
        there = np.array([[each.point == points[number] for number in point] for each in situations], dtype=float)
        of_line = (layout.channel[:, None] == np.array(layout.channels)[channel]) & (layout.order[:, None] == order)
        by = there[:, None] * (of_line * self.sd[channel])
        turned = layout.vector(1j * layout.lines(predicted))
        both = np.stack([by * predicted[..., None], by * turned[..., None]], axis=-1)
        return both.reshape(*predicted.shape, 2 * len(point))


def seen(
    sd: Float[np.ndarray, " channel"],
    noise: Float[np.ndarray, "channel order"],
    points: Sequence[OperatingPoint],
    situations: Sequence[Situation],
    lines: Complex[np.ndarray, "situation channel order"],
) -> Bool[np.ndarray, "point channel order"]:
    """The lines at each operating point whose z is seen beside the noise; means have none, as they follow friction,
    load and zeros.
    """
    at_points = [np.abs(lines[[each.point == point for each in situations]]).max(axis=0) for point in points]
    found = sd[:, None] * np.array(at_points) > LEAST_SEEN * noise
    found[..., 0] = False
    return found
