"""Training anew for the target gear: the lines between which transfer has to show what it is worth."""

from dataclasses import dataclass, replace
from math import ceil
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from learn.adaptation.transfer import FittedClassifier, Labelled, require_rows, untrained
from learn.methods.neural import NeuralClassifier
from swgsim.common.checks import require_integer

if TYPE_CHECKING:
    from learn.methods.training import Recipe

BATCH = 64


@dataclass(frozen=True)
class FromScratch:
    """The same kind of model trained on the shots alone: what the target gear gives without any transfer.

    With few shots this is the lower line; with all labels of the target gear it shows what they are worth alone.

    Attributes
    ----------
    steps : int
        Least number of steps of a network's optimiser, in batches of 64: its own recipe counts epochs, of which a
        handful of rows make too few.
    """

    steps: int = 400

    def __post_init__(self) -> None:
        require_integer("training from scratch", "steps", self.steps, low=1, high=100_000)

    def adapt(
        self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Float[np.ndarray, "row column"], seed: int
    ) -> FittedClassifier:
        """A new model, which knows the classes of the shots only."""
        require_rows(self, "shots", len(shots.X))
        fresh = untrained(source, seed)
        if isinstance(fresh, NeuralClassifier) and _steps(fresh.recipe, len(shots.X)) < self.steps:
            epochs = ceil(self.steps / ceil(len(shots.X) / BATCH))
            fresh = replace(fresh, recipe=replace(fresh.recipe, epochs=epochs, batch=BATCH))
        return fresh.fit(*shots)


def _steps(recipe: "Recipe", rows: int) -> int:
    return recipe.epochs * ceil(rows / recipe.batch)
