"""Prototypes: a row belongs to the class whose mean is nearest (level Z3)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from learn.adaptation.feature_space import Space, feature_space
from learn.adaptation.transfer import Labelled, positions_in, require_rows
from swgsim.common.checks import require_positive


@dataclass(frozen=True)
class NearestPrototype:
    """Probabilities by distance to one point per class.

    Attributes
    ----------
    classes_ : array (class,)
        Names of the classes.
    space : callable
        Maps rows (row, column) to features (row, feature).
    prototypes : array (class, feature)
    scale : array (feature,)
        Unit in which distances along each feature are measured.
    temperature : float
        Mean squared distance per feature that makes a class less probable by a factor of e.
    """

    classes_: np.ndarray
    space: Space
    prototypes: Float[np.ndarray, "class feature"]
    scale: Float[np.ndarray, " feature"]
    temperature: float

    def predict_proba(self, X: Float[np.ndarray, "row column"]) -> Float[np.ndarray, "row class"]:
        """Softmax of the negative mean squared distance over the temperature."""
        from scipy.special import softmax

        deviation = (self.space(X)[:, None] - self.prototypes) / self.scale
        return softmax(-np.square(deviation).mean(axis=2) / self.temperature, axis=1)

    def predict(self, X: Float[np.ndarray, "row column"]) -> np.ndarray:
        """The class with the nearest prototype."""
        return self.classes_[np.argmax(self.predict_proba(X), axis=1)]


@dataclass(frozen=True)
class Prototypes:
    """Class means of the source gears moved towards those of the shots.

    Attributes
    ----------
    strength : float
        Number of rows of the target gear that the mean of the source gears is worth. A shot gives one row at each
        operating point, so the shots weigh more against the source the more points there are.
    temperature : float
        Of :class:`NearestPrototype`.
    """

    strength: float = 1.0
    temperature: float = 0.1

    def __post_init__(self) -> None:
        require_positive("prototypes", strength=self.strength, temperature=self.temperature)

    def adapt(
        self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Float[np.ndarray, "row column"], seed: int
    ) -> NearestPrototype:
        """Distances are in standard deviations within the classes of the source gears.

        Raises
        ------
        ValueError
            If there are no shots, or a class of the source model has no kept row.
        """
        require_rows(self, "shots", len(shots.X))
        space = feature_space(source, kept.X)
        numbers = positions_in(source.classes_, kept.y)
        features = space(kept.X)
        total, count = _sums(features, numbers, len(source.classes_))
        if not count.all():
            missing = source.classes_[np.argmin(count)]
            raise ValueError(f"class {str(missing)!r} has 0 kept rows, its prototype needs at least 1: keep some")
        means = total / count
        within = np.sqrt(np.square(features - means[numbers]).mean(axis=0))
        total, count = _sums(space(shots.X), positions_in(source.classes_, shots.y), len(means))
        prototypes = (self.strength * means + total) / (self.strength + count)
        scale = np.where(within > 0, within, 1.0)  # a unit of the network that never answers
        return NearestPrototype(source.classes_, space, prototypes, scale, self.temperature)


def _sums(features: np.ndarray, numbers: np.ndarray, classes: int) -> tuple[np.ndarray, np.ndarray]:
    """Sum of the features (class, feature) and number of rows (class, 1)."""
    one_hot = np.eye(classes)[numbers]
    return one_hot.T @ features, one_hot.sum(axis=0)[:, None]
