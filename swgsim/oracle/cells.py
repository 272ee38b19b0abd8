"""Fault classes of the oracle as even mixtures of cells in severity and position."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import product
from math import log, sqrt

import numpy as np
from jaxtyping import Float
from scipy.interpolate import KroghInterpolator

from swgsim.common.checks import require_integer
from swgsim.dataset.faults import FAULTS, WITHOUT_POSITION, Variant

# A uniform distribution of width 1 has this standard deviation.
UNIFORM = 1 / sqrt(12)

# Classes whose signals change steadily with the position.
TURNING = ("eccentric_wave_generator", "tip_tooth_crack")

# Classes that are interpolated over the logarithm of the severity, as a crack opens with the inverse of its remaining
# stiffness. The largest change is about 400 standard deviations of the noise. The error with three nodes is then at
# most 2 of them, instead of 20.
RELATIVE = ("root_tooth_crack",)


@dataclass(frozen=True)
class Resolution:
    """Resolution of the oracle's model.

    Attributes
    ----------
    draws : int
        Number of healthy runs for mean and covariance of a gear at an operating point.
    nodes : int
        Number of simulated severities of each class; a polynomial interpolates between them.
    severities : mapping
        Number of cells of each fault class between the extremes of the severity.
    positions : mapping
        Number of cells around the flex spline for the classes of TURNING. The root tooth crack has one for each gap of
        the mesh, within which its position has no influence.
    finer : int
        Cells for each simulated position of the classes of TURNING; a Fourier series interpolates between positions.
    """

    draws: int = 200
    nodes: int = 3
    severities: Mapping[str, int] = field(
        default_factory=lambda: {
            "reduced_damping": 24,
            "reduced_stiffness": 24,
            "eccentric_wave_generator": 6,
            "root_tooth_crack": 6,
            "tip_tooth_crack": 6,
        }
    )
    positions: Mapping[str, int] = field(
        default_factory=lambda: {"eccentric_wave_generator": 24, "tip_tooth_crack": 48}
    )
    finer: int = 1

    def __post_init__(self) -> None:
        require_integer("the oracle", "draws", self.draws, low=20, high=100_000)
        require_integer("the oracle", "nodes", self.nodes, low=2, high=10)
        require_integer("the oracle", "finer", self.finer, low=1, high=100)
        for name, low, expected in (("severities", 1, tuple(FAULTS)), ("positions", 3, TURNING)):
            counts: Mapping[str, int] = getattr(self, name)
            if set(counts) != set(expected):
                raise ValueError(f"{name} of the oracle for {sorted(counts)}, expected one for each of {expected}")
            for label, count in counts.items():
                require_integer("the oracle", f"{name} of {label}", count, low=low, high=10_000)


@dataclass(frozen=True)
class Cells:
    """A fault class of one gear at one operating point.

    Attributes
    ----------
    shift : array (cell, feature)
        Change of the observation by the fault in the middle of each cell.
    spread : array (cell, direction, feature)
        Standard deviation of the change within a cell along severity and, where it matters, position.
    """

    shift: Float[np.ndarray, "cell feature"]
    spread: Float[np.ndarray, "cell direction feature"]


@dataclass(frozen=True)
class Partition:
    """The cells of a fault class, and the faults to simulate for them.

    Attributes
    ----------
    label : str
    low, high : float
        Extremes of the severity.
    severities, positions, nodes : int
        Cells along the severity, simulated positions, and simulated severities.
    finer : int
        Cells for each simulated position.
    """

    label: str
    low: float
    high: float
    severities: int
    positions: int
    nodes: int
    finer: int = 1

    @classmethod
    def of(cls, label: str, levels: tuple[float, ...], resolution: Resolution, sectors: int) -> "Partition":
        """Partition of a class with given severities on a mesh of ``sectors``."""
        positions = dict.fromkeys(WITHOUT_POSITION, 1) | {"root_tooth_crack": sectors} | dict(resolution.positions)
        finer = resolution.finer if label in TURNING else 1
        extremes = min(levels), max(levels)
        return cls(label, *extremes, resolution.severities[label], positions[label], resolution.nodes, finer)

    @property
    def middles(self) -> Float[np.ndarray, "cell 2"]:
        """Severity, and position from gauge s1 [rad], in the middle of every cell."""
        severity = self.low + (self.high - self.low) * (np.arange(self.severities) + 0.5) / self.severities
        return np.array(list(product(severity, self._angles(self.positions * self.finer))))

    @property
    def widths(self) -> tuple[float, float]:
        """Sides of a cell along severity and position [rad]."""
        return (self.high - self.low) / self.severities, 2 * np.pi / (self.positions * self.finer)

    @staticmethod
    def _angles(count: int) -> Float[np.ndarray, " cell"]:
        """Middles of so many equal cells around the flex spline [rad]."""
        return 2 * np.pi * (np.arange(count) + 0.5) / count

    def variants(self) -> list[Variant]:
        """The faults to simulate: at every node of the severity, in the middle of each cell of the position."""
        severity = np.exp(self._nodes) if self.label in RELATIVE else self._nodes
        position = self._angles(self.positions)
        return [
            Variant(self.label, number, s, p, (FAULTS[self.label](s, p),))
            for number, (s, p) in enumerate(product(severity.tolist(), position.tolist()))
        ]

    def cells(self, change: Float[np.ndarray, "variant feature"]) -> Cells:
        """The cells from the change of the observation by each simulated fault.

        Within a cell the change is linear: along the severity it follows the ends of the cell, along the position the
        neighbours, which close around the flex spline.
        """
        change = self._between_positions @ change.reshape(len(self._nodes), self.positions, -1)
        polynomial = KroghInterpolator(self._nodes, change)
        bounds = np.linspace(self.low, self.high, 2 * self.severities + 1)  # ends and middles of the cells in turn
        values = polynomial(np.log(bounds) if self.label in RELATIVE else bounds)
        shift = values[1::2]
        directions = [np.diff(values[::2], axis=0)]
        if self.label in TURNING:
            directions.append((np.roll(shift, -1, axis=1) - np.roll(shift, 1, axis=1)) / 2)
        spread = UNIFORM * np.stack(directions, axis=2)
        return Cells(shift.reshape(-1, shift.shape[2]), spread.reshape(-1, *spread.shape[2:]))

    @property
    def _between_positions(self) -> Float[np.ndarray, "cell position"]:
        """What the Fourier series through the simulated positions has in the cells."""
        if self.finer == 1:
            return np.eye(self.positions)
        turned = self._angles(self.positions * self.finer) - self._angles(self.positions)[0]
        wave = self.positions * np.fft.fftfreq(self.positions)
        return (np.exp(1j * np.outer(turned, wave)) @ np.fft.fft(np.eye(self.positions)) / self.positions).real

    @property
    def _nodes(self) -> Float[np.ndarray, " node"]:
        """Chebyshev nodes between the extremes of the severity, or of its logarithm; one if the extremes are equal."""
        low, high = (log(self.low), log(self.high)) if self.label in RELATIVE else (self.low, self.high)
        inside = np.cos(np.pi * (np.arange(self.nodes) + 0.5) / self.nodes)
        return np.unique((low + high + (high - low) * inside) / 2)
