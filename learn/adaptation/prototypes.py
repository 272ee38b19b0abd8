"""Classification by the nearest class mean, the prototype (level Z3)."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from learn.adaptation.feature_space import Space, feature_space
from learn.adaptation.transfer import Features, Labelled, positions_in, require_rows
from swgsim.common.checks import require_positive


@dataclass(frozen=True)
class NearestPrototype:
    """Class probabilities by the distance to one prototype per class.

    Attributes
    ----------
    classes_ : array (class,)
        Names of the classes.
    space : callable
        Maps rows (row, column) to features (row, feature).
    prototypes : array (class, feature)
    scale : array (feature,)
        Unit of the distance along each feature.
    temperature : float
        Mean squared distance per feature that divides the probability of a class by e.
    """

    classes_: np.ndarray
    space: Space
    prototypes: Float[np.ndarray, "class feature"]
    scale: Float[np.ndarray, " feature"]
    temperature: float

    def predict_proba(self, X: Float[np.ndarray, "row column"]) -> Float[np.ndarray, "row class"]:
        """Softmax of the negative mean squared distance, divided by the temperature."""
        from scipy.special import softmax

        deviation = (self.space(X)[:, None] - self.prototypes) / self.scale
        return softmax(-np.square(deviation).mean(axis=2) / self.temperature, axis=1)

    def predict(self, X: Float[np.ndarray, "row column"]) -> np.ndarray:
        """Class with the nearest prototype."""
        return self.classes_[np.argmax(self.predict_proba(X), axis=1)]


@dataclass(frozen=True)
class Prototypes:
    """Class means of the source gears, moved towards those of the shots.

    Attributes
    ----------
    strength : float
        Weight of the source mean, in rows of the target gear. A shot has one row at each operating point.
    temperature : float
        As in :class:`NearestPrototype`.
    """

    strength: float = 1.0
    temperature: float = 0.1

    def __post_init__(self) -> None:
        require_positive("prototypes", strength=self.strength, temperature=self.temperature)

    def adapt(self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Features, seed: int) -> NearestPrototype:
        """A classifier with distances in standard deviations within the classes of the source gears.

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
        scale = np.where(within > 0, within, 1.0)  # 0 for a unit of the network that is always inactive
        return NearestPrototype(source.classes_, space, prototypes, scale, self.temperature)


def _sums(features: np.ndarray, numbers: np.ndarray, classes: int) -> tuple[np.ndarray, np.ndarray]:
    """Sums of the features (class, feature) and numbers of rows (class, 1)."""
    one_hot = np.eye(classes)[numbers]
    return one_hot.T @ features, one_hot.sum(axis=0)[:, None]
