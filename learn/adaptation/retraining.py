"""Training from scratch on the target gear, the baseline of transfer."""

from dataclasses import dataclass, replace
from math import ceil
from typing import TYPE_CHECKING, Any

from learn.adaptation.transfer import Features, FittedClassifier, Labelled, require_rows, untrained
from learn.methods.neural import NeuralClassifier
from swgsim.common.checks import require_integer

if TYPE_CHECKING:
    from learn.methods.training import Recipe

BATCH = 64


@dataclass(frozen=True)
class FromScratch:
    """The same kind of model, trained on the shots alone, without transfer.

    Attributes
    ----------
    steps : int
        Least number of optimiser steps of a network, in batches of 64. Its recipe counts epochs, which have too few
        steps if rows are few.
    """

    steps: int = 400

    def __post_init__(self) -> None:
        require_integer("training from scratch", "steps", self.steps, low=1, high=100_000)

    def adapt(self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Features, seed: int) -> FittedClassifier:
        """A new model with the classes of the shots."""
        require_rows(self, "shots", len(shots.X))
        fresh = untrained(source, seed)
        if isinstance(fresh, NeuralClassifier) and _steps(fresh.recipe, len(shots.X)) < self.steps:
            epochs = ceil(self.steps / ceil(len(shots.X) / BATCH))
            fresh = replace(fresh, recipe=replace(fresh.recipe, epochs=epochs, batch=BATCH))
        return fresh.fit(*shots)


def _steps(recipe: "Recipe", rows: int) -> int:
    return recipe.epochs * ceil(rows / recipe.batch)
