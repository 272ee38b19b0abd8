"""Networks of the source gears trained further on the shots of the target gear (level Z3).

The number of steps is fixed, since there are no rows of the target gear to stop by.
Statistics of batch normalisation stay those of the source gears: the shots are too few to estimate them.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor, nn

from learn.adaptation.transfer import Labelled, copied_network, positions_in, require_rows
from learn.inputs.rows import as_tensor
from learn.methods.networks import Network
from learn.methods.neural import NeuralClassifier
from learn.methods.training import Recipe, train
from swgsim.common.checks import require, require_integer, require_positive
from swgsim.common.seeds import generator

Penalty = Callable[[Network], Tensor]


@dataclass(frozen=True)
class LinearProbe:
    """Only the head is trained.

    Attributes
    ----------
    steps, batch : int
        Number of steps, and rows of the shots in each, at most.
    rate : float
        Highest learning rate.
    strength : float
        Of the pull towards the head of the source model.
    """

    steps: int = 100
    batch: int = 64
    rate: float = 1e-2
    strength: float = 1e-3

    def __post_init__(self) -> None:
        require_integer("the linear probe", "steps", self.steps, 0, 1_000_000)
        require_integer("the linear probe", "batch", self.batch, 2, 1_000_000)
        require_positive("the linear probe", rate=self.rate)
        require("the linear probe", "strength", self.strength, low=0)

    def adapt(
        self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Float[np.ndarray, "row column"], seed: int
    ) -> NeuralClassifier:
        """The source model with another head."""
        require_rows(self, "shots", len(shots.X))
        network = copied_network(source)
        pull = distance(self.strength, network.head.parameters(), lambda changed: changed.head.parameters())
        numbers = positions_in(source.classes_, shots.y)
        _train(network, shots.X, numbers, self, seed, pull, network.head.parameters())
        return source.with_network(network)


@dataclass(frozen=True)
class FineTuning:
    """All parameters are trained.

    Attributes
    ----------
    steps, batch : int
        Number of steps, and rows of the shots in each, at most.
    rate : float
        Highest learning rate.
    """

    steps: int = 100
    batch: int = 64
    rate: float = 1e-3

    def __post_init__(self) -> None:
        require_integer("fine-tuning", "steps", self.steps, 0, 1_000_000)
        require_integer("fine-tuning", "batch", self.batch, 2, 1_000_000)
        require_positive("fine-tuning", rate=self.rate)

    def adapt(
        self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Float[np.ndarray, "row column"], seed: int
    ) -> NeuralClassifier:
        """The source model with other parameters."""
        require_rows(self, "shots", len(shots.X))
        network = copied_network(source)
        penalty = self._penalty(source, kept, seed)
        _train(network, shots.X, positions_in(source.classes_, shots.y), self, seed, penalty)
        return source.with_network(network)

    def _penalty(self, source: NeuralClassifier, kept: Labelled, seed: int) -> Penalty | None:
        """What each step adds to the loss."""
        return None


@dataclass(frozen=True)
class L2SP(FineTuning):
    """Fine-tuning with a pull towards the source model: L2-SP of Li et al., arXiv 1802.01483.

    Target and source have the same classes, so the head is pulled as well, where the paper's is new.

    Attributes
    ----------
    strength : float
        Half of it times the squared distance of all parameters to those of the source model is added to the loss.
    """

    strength: float = 0.1

    def __post_init__(self) -> None:
        super().__post_init__()
        require("L2-SP", "strength", self.strength, low=0)

    def _penalty(self, source: NeuralClassifier, kept: Labelled, seed: int) -> Penalty:
        return distance(self.strength, source.network_.parameters(), lambda changed: changed.parameters())


@dataclass(frozen=True)
class Replay(FineTuning):
    """Fine-tuning in which each step also takes ``batch`` random rows of the source gears."""

    def _penalty(self, source: NeuralClassifier, kept: Labelled, seed: int) -> Penalty:
        require_rows(self, "kept", len(kept.X))
        device = source.network_.centre.device
        rows = as_tensor(kept.X).to(device)
        truth = torch.from_numpy(positions_in(source.classes_, kept.y)).to(device)
        rng = generator("replay", seed)

        def penalty(network: Network) -> Tensor:
            drawn = torch.from_numpy(rng.integers(len(rows), size=self.batch)).to(device)
            return nn.functional.cross_entropy(network(rows[drawn]), truth[drawn])

        return penalty


@dataclass(frozen=True)
class ProbeThenFineTuning:
    """LP-FT of Kumar et al., arXiv 2202.10054: a head that already fits lets fine-tuning distort the features less."""

    probe: LinearProbe = field(default_factory=LinearProbe)
    tuning: FineTuning = field(default_factory=FineTuning)

    def adapt(
        self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Float[np.ndarray, "row column"], seed: int
    ) -> NeuralClassifier:
        """The source model with a probed head, all of it then trained further."""
        probed = self.probe.adapt(source, kept, shots, unlabelled, seed)
        return self.tuning.adapt(probed, kept, shots, unlabelled, seed)


def distance(
    strength: float, start: Iterable[nn.Parameter], chosen: Callable[[Network], Iterable[nn.Parameter]]
) -> Penalty:
    """A penalty of half the strength times the squared distance of the chosen parameters to where they start."""
    origin = [parameter.detach().clone() for parameter in start]

    def penalty(network: Network) -> Tensor:
        squares = [(now - before).square().sum() for now, before in zip(chosen(network), origin, strict=True)]
        return strength / 2 * torch.stack(squares).sum()

    return penalty


def _train(
    network: Network, X: np.ndarray, numbers: np.ndarray, method: LinearProbe | FineTuning, seed: int,
    penalty: Penalty | None, parameters: Iterable[nn.Parameter] | None = None,
) -> None:  # fmt: skip
    if method.steps == 0:
        return
    # Steps are counted, not passes through the shots: the shots are repeated to make up one pass of so many steps.
    batch = max(2, min(method.batch, len(X)))
    rows = np.resize(np.arange(len(X)), method.steps * batch)
    # Weights are held by a pull towards the source, if by anything, and not by decay towards zero.
    recipe = Recipe(epochs=1, batch=batch, rate=method.rate, decay=0.0)
    train(
        network, as_tensor(X[rows]), torch.from_numpy(numbers[rows]), recipe, seed,
        parameters=parameters, penalty=penalty, frozen_statistics=True,
    )  # fmt: skip
