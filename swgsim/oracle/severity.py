"""Severity and position of a fault from the cells in which an observation may lie."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float
from scipy.special import ndtr

from swgsim.oracle.cells import TURNING, UNIFORM, Partition
from swgsim.oracle.point import Places

# Halvings of the range in which a quantile is sought: to a ten thousandth of it.
HALVINGS = 14


@dataclass(frozen=True)
class Severities:
    """Posterior of the severity of one class: a mixture of Gaussians between the extremes of the class.

    Attributes
    ----------
    partition : Partition
    weight, mean : array (sample, cell)
    deviation : array (cell,)
    """

    partition: Partition
    weight: Float[np.ndarray, "sample cell"]
    mean: Float[np.ndarray, "sample cell"]
    deviation: Float[np.ndarray, " cell"]

    @classmethod
    def of(cls, partition: Partition, places: Places) -> "Severities":
        """The severities of the cells of a class."""
        unit = UNIFORM * partition.widths[0]
        mean = partition.middles[:, 0] + unit * places.mean[:, :, 0]
        return cls(partition, places.weight, mean, unit * places.deviation[:, 0])

    def below(self, severity: Float[np.ndarray, " sample"]) -> Float[np.ndarray, " sample"]:
        """Probability that the severity is below a value."""
        low, high = self._ends
        return np.clip((self._mixture(severity) - low) / np.maximum(high - low, np.finfo(float).tiny), 0, 1)

    def quantile(self, probability: float) -> Float[np.ndarray, " sample"]:
        """Severity below which the true one lies with a probability."""
        low = np.full(len(self.weight), self.partition.low)
        high = np.full(len(self.weight), self.partition.high)
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            under = self.below(middle) < probability
            low, high = np.where(under, middle, low), np.where(under, high, middle)
        return (low + high) / 2

    @cached_property
    def _ends(self) -> tuple[Float[np.ndarray, " sample"], Float[np.ndarray, " sample"]]:
        """The mixture's distribution function at the extremes of the class."""
        return self._mixture(self.partition.low), self._mixture(self.partition.high)

    def _mixture(self, severity: float | Float[np.ndarray, " sample"]) -> Float[np.ndarray, " sample"]:
        """The mixture's distribution function, which may reach beyond the extremes."""
        z = (np.broadcast_to(severity, len(self.weight))[:, None] - self.mean) / self.deviation
        return (self.weight * ndtr(z)).sum(axis=1)


def positions(
    partition: Partition, places: Places
) -> tuple[Float[np.ndarray, " sample"], Float[np.ndarray, " sample"]]:
    """Circular mean of the position of a fault, and its circular standard deviation [rad].

    The deviation is that of a normal angle with the same mean resultant length R, sqrt(-2 ln R): large where several
    positions are possible.
    """
    unit = UNIFORM * partition.widths[1]
    middle = partition.middles[:, 1]
    turning = partition.label in TURNING
    off = unit * places.mean[:, :, 1] if turning else 0.0
    spread = unit * (places.deviation[:, 1] if turning else 1.0)
    phasor = (places.weight * np.exp(1j * (middle + off) - spread**2 / 2)).sum(axis=1)
    return np.angle(phasor) % (2 * np.pi), np.sqrt(-2 * np.log(np.minimum(np.abs(phasor), 1.0)))
