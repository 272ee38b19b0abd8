"""Training anew for the target gear: the lines between which transfer has to show what it is worth."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from learn.transfer import FittedClassifier, Labelled, class_numbers, require_rows, untrained
from swgsim.checks import require_integer


@dataclass(frozen=True)
class FromScratch:
    """The same kind of model trained on the shots alone: what the target gear gives without any transfer.

    With few shots this is the lower line; with all labels of the target gear it is the upper one.
    """

    def adapt(
        self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Float[np.ndarray, "row column"], seed: int
    ) -> FittedClassifier:
        """A new model, which knows the classes of the shots only."""
        require_rows(self, "shots", len(shots.X))
        return untrained(source, seed).fit(*shots)


@dataclass(frozen=True)
class PooledRetraining:
    """The same kind of model trained on the rows of the source gears and the shots together.

    Attributes
    ----------
    repeats : int
        How often each shot is given, to count among the many rows of the source gears.
    """

    repeats: int = 10

    def __post_init__(self) -> None:
        require_integer("pooled retraining", "repeats", self.repeats, 1, 10_000)

    def adapt(
        self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Float[np.ndarray, "row column"], seed: int
    ) -> FittedClassifier:
        """A new model."""
        require_rows(self, "shots", len(shots.X))
        class_numbers(source.classes_, shots.y)
        X = np.concatenate([kept.X, np.repeat(shots.X, self.repeats, axis=0)])
        y = np.concatenate([kept.y, np.repeat(shots.y, self.repeats)])
        return untrained(source, seed).fit(X, y)
