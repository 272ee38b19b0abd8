"""Bayes' rule on a commissioned unit: what some of its recordings say of class, size and position of a fault.

The unit is the twin: identification has fitted it to the healthy recordings, and knows how far everything may still
lie off. The classes, their cells and Bayes' rule are those of the oracle.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float
from scipy.special import logsumexp
from scipy.stats import chi2

from swgsim.identification.covariance.low_rank_covariance import HIDDEN
from swgsim.identification.data.model import predict
from swgsim.identification.fit.fitted import Fitted
from swgsim.oracle.cells import Cells, Partition
from swgsim.oracle.point import PointModel
from swgsim.storage.labelled_signals import CLASSES

HEALTHY = CLASSES.index("healthy")
# Simulated healthy gears, by which a rate of false alarms of 1 % is known to a third of it; and so many at a time.
DRAWS, AT_ONCE = 1000, 100


@dataclass(frozen=True, eq=False)
class Suspected:
    """Recordings beside the model of their unit without a fault, and what each fault would change in them.

    Attributes
    ----------
    fitted : Fitted
    partitions : mapping
        The cells of each fault class.
    prior : mapping
        Probability of each of CLASSES before the recordings.
    changes : array (row, variant)
        By all variants of the first class, then of the next one.
    """

    fitted: Fitted
    partitions: Mapping[str, Partition]
    prior: Mapping[str, float]
    changes: Float[np.ndarray, "row variant"]

    @classmethod
    def of(cls, fitted: Fitted, partitions: Mapping[str, Partition], prior: Mapping[str, float]) -> "Suspected":
        """Simulate all variants in the situations of the recordings."""
        model, measured = fitted.model, fitted.measured
        faulty = [model.plus(*variant.effects) for each in partitions.values() for variant in each.variants()]
        predicted = predict([model, *faulty], measured.situations, measured.layout)
        return cls(fitted, partitions, prior, measured.rows(np.moveaxis(predicted[1:] - predicted[0], 0, -1)))

    def posterior_of(
        self, chosen: Bool[np.ndarray, " recording"], residuals: Float[np.ndarray, "row sample"] | None = None
    ) -> "FaultPosterior":
        """What some of the recordings say together; all that they do not show is open within its spread.

        Parameters
        ----------
        chosen : array (recording,)
        residuals : array (row, sample), optional
            Others than those of these recordings, such as simulated ones.
        """
        rows = np.repeat(chosen, len(self.fitted.measured.layout))
        given = self.fitted.from_start[rows][:, None] if residuals is None else residuals
        white = self.fitted.whole.recordings(chosen).whiten(np.hstack([given, self.changes[rows]]))
        residual, changes = np.split(white, [given.shape[1]], axis=1)
        # The classes differ only along the changes, of which noise hides most.
        square, V = np.linalg.eigh(changes.T @ changes)
        V, size = V[:, square > HIDDEN], np.sqrt(square[square > HIDDEN])
        ends = np.cumsum([len(each.variants()) for each in self.partitions.values()])
        pieces = zip(self.partitions.items(), np.split(V * size, ends[:-1]), strict=True)
        faults = {label: self._uncertain(each.cells(piece)) for (label, each), piece in pieces}
        model = PointModel(np.zeros(len(size)), np.eye(len(size)), faults)
        log_prior = np.log([self.prior[label] for label in CLASSES])
        return FaultPosterior(
            model, residual.T @ changes @ V / size, log_prior, (residual**2).sum(axis=0), len(residual)
        )

    def _uncertain(self, cells: Cells) -> Cells:
        """Cells whose change is known to the spread of the structure only: 1 % by the mesh, more in foreign gears."""
        scaled = self.fitted.unit.structure * cells.shift[:, None]
        return Cells(cells.shift, np.concatenate([cells.spread, scaled], axis=1))


@dataclass(frozen=True, eq=False)
class FaultPosterior:
    """What samples of recordings say of the classes.

    Attributes
    ----------
    model : PointModel
        Densities along the changes by faults, in standard deviations of a healthy gear.
    x : array (sample, direction)
        The recordings.
    log_prior : array (class,)
    square : array (sample,)
        Sum of squares of the residual without a fault, in standard deviations.
    rows : int
        Its expectation, the number of features.
    """

    model: PointModel
    x: Float[np.ndarray, "sample direction"]
    log_prior: Float[np.ndarray, " class"]
    square: Float[np.ndarray, " sample"]
    rows: int

    @cached_property
    def posterior(self) -> Float[np.ndarray, "sample class"]:
        """Probability of every class."""
        log = self._likelihood + self.log_prior
        return np.exp(log - logsumexp(log, axis=1, keepdims=True))

    def chance(self, rng: np.random.Generator) -> Float[np.ndarray, " sample"]:
        """How often a healthy gear would look at least as faulty: the rate of false alarms."""
        blocks = (rng.standard_normal((AT_ONCE, self.x.shape[1])) for _ in range(DRAWS // AT_ONCE))
        drawn = np.concatenate([self._odds(self.model.log_likelihood(each)) for each in blocks])
        return (1 + (drawn >= self._odds(self._likelihood)[:, None]).sum(axis=1)) / (1 + DRAWS)

    @cached_property
    def lack_of_fit(self) -> Float[np.ndarray, " sample"]:
        """Sum of squares that the most probable class leaves, over its expectation: 1 where the model is right."""
        best = np.take_along_axis(self._likelihood, self.posterior.argmax(axis=1)[:, None], axis=1)[:, 0]
        return (self.square - 2 * (best - self._likelihood[:, HEALTHY])) / self.rows

    @property
    def chance_of_lack(self) -> Float[np.ndarray, " sample"]:
        """How often the right class would leave as much."""
        return chi2.sf(self.lack_of_fit * self.rows, self.rows)

    @cached_property
    def _likelihood(self) -> Float[np.ndarray, "sample class"]:
        return self.model.log_likelihood(self.x)

    def _odds(self, likelihood: Float[np.ndarray, "sample class"]) -> Float[np.ndarray, " sample"]:
        """Logarithm of the odds of any fault."""
        log = likelihood + self.log_prior
        return logsumexp(np.delete(log, HEALTHY, axis=1), axis=1) - log[:, HEALTHY]


def lack_of_fit(fitted: Fitted) -> tuple[float, float]:
    """Sum of squares of a residual over its expectation, and how often the right model would leave as much."""
    white = fitted.whole.whiten(fitted.from_start)
    square = float(white @ white)
    return square / len(white), float(chi2.sf(square, len(white)))
