"""Noise in narrow bands, which gauges share: a resonance that something random excites, or the hum of the mains.

The smooth noise of :mod:`swgsim.identification.data.noise` does not contain it. Where a line of some order has the
frequency of such a band, it differs between repeats by more than the noise, and in all gauges together.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.stats import chi2, false_discovery_control

from swgsim.gear.gear import OperatingPoint
from swgsim.identification.data.features import ORDERS, Layout
from swgsim.storage.labelled_signals import SENSORS

# False discovery rate of lines that scatter by more than the noise, or have lack of fit.
FALSE_DISCOVERIES = 0.05


@dataclass(frozen=True, eq=False)
class NarrowBand:
    """Noise beyond the smooth one at one frequency.

    Attributes
    ----------
    frequency : float
        [Hz].
    channels : tuple of str
        Those that share it.
    root : array (channel, source)
        Errors of independent sources, one standard deviation each, in standard deviations of the smooth noise. They
        are the same for the cosine and for the sine of a line.
    """

    frequency: float
    channels: tuple[str, ...]
    root: Float[np.ndarray, "channel source"]

    def directions(self, speed: float, layout: Layout) -> Float[np.ndarray, "feature column"]:
        """Errors of a recording at a speed [rpm], in standard deviations of the smooth noise; no columns if none of its
        lines has this frequency.
        """
        order = int(np.round(60 * self.frequency / speed))
        if not 1 <= order <= ORDERS or not np.isclose(order * speed, 60 * self.frequency):
            return np.zeros((len(layout), 0))
        shared = [number for number, name in enumerate(self.channels) if name in layout.channels]
        lines = np.array([layout.channels.index(self.channels[number]) for number in shared], dtype=int)
        found = np.zeros((len(layout.channels), 2 * ORDERS + 1, 2, self.root.shape[1]))
        for part, row in enumerate((order, ORDERS + order)):
            found[lines, row, part] = self.root[shared]
        return found.reshape(len(layout), -1)


def columns(
    bands: Sequence[NarrowBand],
    points: Sequence[OperatingPoint],
    layout: Layout,
    variance: Float[np.ndarray, "recording feature"],
) -> Float[np.ndarray, "recording feature column"]:
    """Errors of single recordings by narrow bands, one standard deviation each; some are nothing at some speeds.

    Parameters
    ----------
    bands : sequence of NarrowBand
    points : sequence of OperatingPoint
        Of each recording.
    layout : Layout
    variance : array (recording, feature)
        Of the smooth noise.
    """
    of_speed = {
        speed: np.hstack([np.zeros((len(layout), 0)), *(band.directions(speed, layout) for band in bands)])
        for speed in {point.n_in_rpm for point in points}
    }
    most = max(each.shape[1] for each in of_speed.values())
    padded = {speed: np.pad(each, ((0, 0), (0, most - each.shape[1]))) for speed, each in of_speed.items()}
    return np.sqrt(variance)[..., None] * np.array([padded[point.n_in_rpm] for point in points])


def narrow_bands(
    missed: Float[np.ndarray, "recording feature"],
    freedom: Float[np.ndarray, " recording"],
    points: Sequence[OperatingPoint],
    layout: Layout,
) -> tuple[NarrowBand, ...]:
    """The narrow bands in which repeats differ by more than the smooth noise makes them.

    The covariance V of the channels at a frequency has an inverse Wishart prior with the mean 1, of as few degrees of
    freedom as have a mean. So the smooth noise counts as much as one repeat: with n of them, the posterior mean is
    V = (1 + sum z z') / (1 + n). It serves where the sum of all z² is larger than chance makes it, and nowhere is the
    noise taken to be less than the smooth one.

    Parameters
    ----------
    missed : array (recording, feature)
        By how much each repeat differs from the mean of all, in standard deviations of the smooth noise.
    freedom : array (recording,)
        Degrees of freedom that each repeat adds to those of its group; 0 where nothing was repeated.
    points : sequence of OperatingPoint
    layout : Layout
    """
    lines = missed.reshape(len(points), -1, 2 * ORDERS + 1)[..., 1:].reshape(len(points), -1, 2, ORDERS)
    speeds = np.array([point.n_in_rpm for point in points])
    frequency = np.round(np.outer(speeds, np.arange(1, ORDERS + 1)) / 60, 6)
    found, chances = [], []
    for names in _sharing(layout):
        own = [layout.channels.index(name) for name in names]
        for at in np.unique(frequency):
            recordings, orders = np.nonzero((frequency == at) & (freedom[:, None] > 0))
            repeats = 2 * float(freedom[recordings].sum())
            if not repeats:
                continue
            z = lines[recordings[:, None], own, :, orders[:, None]].swapaxes(0, 1).reshape(len(own), -1)
            square = z @ z.T
            chances.append(chi2.sf(np.trace(square), repeats * len(own)))
            values, vectors = np.linalg.eigh((np.eye(len(own)) + square) / (1 + repeats))
            more = values > 1
            found.append(NarrowBand(float(at), names, vectors[:, more] * np.sqrt(values[more] - 1)))
    significant = false_discovery_control(chances) < FALSE_DISCOVERIES if chances else []
    return tuple(band for band, more in zip(found, significant, strict=True) if more)


def _sharing(layout: Layout) -> Iterator[tuple[str, ...]]:
    """Channels that share noise: all gauges, while speed and torques come from instruments of their own."""
    gauges = tuple(name for name in layout.channels if name in SENSORS)
    if gauges:
        yield gauges
    yield from ((name,) for name in layout.channels if name not in SENSORS)
