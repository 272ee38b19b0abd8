"""Noise in narrow bands, which gauges share: a resonance that something random excites, or the hum of the mains.

The smooth noise of :mod:`swgsim.identification.data.noise` does not contain it. Where a line of some order has the
frequency of such a band, it differs between repeats by more than the noise, and in all gauges together.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float
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

    @property
    def largest(self) -> float:
        """Variance of the strongest source with the smooth noise, in units of this noise."""
        return 1 + float((self.root**2).sum(axis=0).max(initial=0.0))

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


def frequencies(points: Sequence[OperatingPoint], lowest: int, highest: int) -> Float[np.ndarray, "recording order"]:
    """Frequencies of orders at operating points [Hz], equal where they differ by rounding alone."""
    speeds = np.array([point.n_in_rpm for point in points])
    return np.round(np.outer(speeds, np.arange(lowest, highest + 1)) / 60, 6)


def narrow_bands(
    lines: Complex[np.ndarray, "recording channel order"],
    frequency: Float[np.ndarray, "recording order"],
    freedom: Float[np.ndarray, " recording"],
    channels: Sequence[str],
) -> tuple[NarrowBand, ...]:
    """The narrow bands in which repeats differ by more than the smooth noise makes them.

    The covariance V of the channels at a frequency has an inverse Wishart prior with the mean 1, of as few degrees of
    freedom as have a mean. So the smooth noise counts as much as one repeat: with n of them, the posterior mean is
    V = (1 + sum z z') / (1 + n). It serves where the sum of all z² is larger than chance makes it, and nowhere is the
    noise taken to be less than the smooth one.

    Parameters
    ----------
    lines : array (recording, channel, order)
        By how much each repeat differs from the mean of all, in standard deviations of the smooth noise.
    frequency : array (recording, order)
        As of :func:`frequencies`.
    freedom : array (recording,)
        Degrees of freedom that each repeat adds; 0 where nothing was repeated.
    channels : sequence of str
    """
    found, chances = [], []
    for names in _sharing(channels):
        own = [channels.index(name) for name in names]
        for at in np.unique(frequency[freedom > 0]):
            recordings, orders = np.nonzero((frequency == at) & (freedom[:, None] > 0))
            parts = lines[recordings[:, None], own, orders[:, None]]
            z, repeats = np.concatenate([parts.real, parts.imag]).T, 2 * float(freedom[recordings].sum())
            chances.append(chi2.sf((z**2).sum(), repeats * len(own)))
            values, vectors = np.linalg.eigh((np.eye(len(own)) + z @ z.T) / (1 + repeats))
            more = values > 1
            found.append(NarrowBand(float(at), names, vectors[:, more] * np.sqrt(values[more] - 1)))
    significant = false_discovery_control(chances) < FALSE_DISCOVERIES if chances else []
    return tuple(band for band, more in zip(found, significant, strict=True) if more)


def _sharing(channels: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """Channels that share noise: all gauges, while speed and torques come from instruments of their own."""
    gauges = tuple(name for name in channels if name in SENSORS)
    if gauges:
        yield gauges
    yield from ((name,) for name in channels if name not in SENSORS)
