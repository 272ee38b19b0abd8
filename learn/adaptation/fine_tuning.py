"""Networks of the source gears, trained further on the shots of the target gear (level Z3).

The number of steps is fixed, as the target gear has no rows for early stopping. Batch normalisation keeps the
statistics of the source gears, which few shots cannot estimate.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
import torch
from torch import Tensor, nn

from learn.adaptation.transfer import Features, Labelled, copied_network, positions_in, require_rows
from learn.inputs.rows import as_tensor
from learn.methods.networks import Network
from learn.methods.neural import NeuralClassifier
from learn.methods.training import Recipe, train
from swgsim.common.checks import require, require_integer, require_positive
from swgsim.common.seeds import generator

Penalty = Callable[[Network], Tensor]


@dataclass(frozen=True)
class FineTuning:
    """Training of all parameters on the shots.

    Attributes
    ----------
    steps, batch : int
        Number of steps, and largest number of shot rows in each.
    rate : float
        Highest learning rate.
    """

    steps: int = 100
    batch: int = 64
    rate: float = 1e-3
    owner: ClassVar[str] = "fine-tuning"  # in messages

    def __post_init__(self) -> None:
        require_integer(self.owner, "steps", self.steps, 0, 1_000_000)
        require_integer(self.owner, "batch", self.batch, 2, 1_000_000)
        require_positive(self.owner, rate=self.rate)

    def adapt(self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Features, seed: int) -> NeuralClassifier:
        """The source model with adapted parameters."""
        require_rows(self, "shots", len(shots.X))
        network = copied_network(source)
        penalty, numbers = self._penalty(source, kept, seed), positions_in(source.classes_, shots.y)
        if self.steps:
            # The shots are repeated so that one epoch has the given number of steps.
            batch = max(2, min(self.batch, len(shots.X)))
            rows = np.resize(np.arange(len(shots.X)), self.steps * batch)
            # Only penalties hold the weights, and no decay towards zero.
            recipe = Recipe(epochs=1, batch=batch, rate=self.rate, decay=0.0)
            train(
                network, as_tensor(shots.X[rows]), torch.from_numpy(numbers[rows]), recipe, seed,
                parameters=self._trained(network), penalty=penalty, frozen_statistics=True,
            )  # fmt: skip
        return source.with_network(network)

    def _trained(self, network: Network) -> Iterable[nn.Parameter]:
        """Parameters to train."""
        return network.parameters()

    def _penalty(self, source: NeuralClassifier, kept: Labelled, seed: int) -> Penalty | None:
        """Term that is added to the loss in each step."""
        return None


@dataclass(frozen=True)
class L2SP(FineTuning):
    """Fine-tuning with a penalty of the distance to the source model: L2-SP of Li et al., arXiv 1802.01483.

    Target and source have the same classes, so the head is penalised too; in that paper it is new.

    Attributes
    ----------
    strength : float
        Half of it, times the squared distance of all parameters to those of the source model, is added to the loss.
    """

    strength: float = 0.1
    owner: ClassVar[str] = "L2-SP"

    def __post_init__(self) -> None:
        super().__post_init__()
        require(self.owner, "strength", self.strength, low=0)

    def _penalty(self, source: NeuralClassifier, kept: Labelled, seed: int) -> Penalty:
        start = [parameter.detach().clone() for parameter in self._trained(source.network_)]

        def penalty(network: Network) -> Tensor:
            pairs = zip(self._trained(network), start, strict=True)
            return self.strength / 2 * torch.stack([(now - before).square().sum() for now, before in pairs]).sum()

        return penalty


@dataclass(frozen=True)
class LinearProbe(L2SP):
    """Training of the head alone, with a penalty of its distance to the head of the source model."""

    rate: float = 1e-2
    strength: float = 1e-3
    owner: ClassVar[str] = "the linear probe"

    def _trained(self, network: Network) -> Iterable[nn.Parameter]:
        return network.head.parameters()


@dataclass(frozen=True)
class Replay(FineTuning):
    """Fine-tuning in which each step also has ``batch`` random rows of the source gears."""

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
    """LP-FT of Kumar et al., arXiv 2202.10054: linear probe, then fine-tuning, which then distorts features less."""

    probe: LinearProbe = field(default_factory=LinearProbe)
    tuning: FineTuning = field(default_factory=FineTuning)

    def adapt(self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Features, seed: int) -> NeuralClassifier:
        """The source model, adapted by both stages."""
        probed = self.probe.adapt(source, kept, shots, unlabelled, seed)
        return self.tuning.adapt(probed, kept, shots, unlabelled, seed)
