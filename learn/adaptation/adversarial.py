"""Domain-adversarial training without labels of the target gear (level Z2)."""

from dataclasses import dataclass
from math import ceil, exp
from typing import Any

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor, nn

from learn.adaptation.transfer import Features, Labelled, copied_network, positions_in, require_rows
from learn.inputs.rows import as_tensor
from learn.methods.networks import Network, seeded
from learn.methods.neural import NeuralClassifier
from learn.methods.training import Recipe, train
from swgsim.common.checks import require, require_integer, require_positive
from swgsim.common.seeds import generator, seed_hash


@dataclass(frozen=True)
class DomainAdversarial:
    """DANN of Ganin et al., arXiv 1505.07818: features that separate classes, but not source and target.

    Training continues on a copy of the source network with rows of the source gears. A second head, the discriminator,
    learns to separate source and target by the features. Its gradient enters the body with reversed sign. Batch
    normalisation keeps the statistics of the source gears.

    Attributes
    ----------
    epochs, batch : int
        Passes through the source rows, and rows of source and of target in each step.
    rate : float
        Highest learning rate.
    weight : float
        Final weight of the reversed gradient; it rises from 0 as in that paper.
    """

    epochs: int = 1
    batch: int = 256
    rate: float = 1e-3
    weight: float = 0.3

    def __post_init__(self) -> None:
        owner = "domain-adversarial training"
        require_integer(owner, "epochs", self.epochs, 1, 10_000)
        require_integer(owner, "batch", self.batch, 2, 1_000_000)
        require_positive(owner, rate=self.rate)
        require(owner, "weight", self.weight, low=0)

    def adapt(self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Features, seed: int) -> NeuralClassifier:
        """The source model with adapted parameters."""
        require_rows(self, "unlabelled", len(unlabelled))
        require_rows(self, "kept", len(kept.X))
        network = copied_network(source)
        device = network.centre.device
        with seeded(seed_hash("discriminator", seed)):
            width = network.head.in_features
            discriminator = nn.Sequential(nn.Linear(width, 64), nn.ReLU(), nn.Linear(64, 1)).to(device)
        rows = [as_tensor(side).to(device) for side in (kept.X, unlabelled)]
        rng = generator("rows of both domains", seed)
        domain = torch.arange(2.0, device=device).repeat_interleave(self.batch)
        steps = self.epochs * ceil(len(kept.X) / self.batch)
        progress = iter(np.linspace(0, 1, steps))

        def penalty(network: Network) -> Tensor:
            drawn = torch.cat([side[torch.from_numpy(rng.integers(len(side), size=self.batch))] for side in rows])
            factor = self.weight * (2 / (1 + exp(-10 * next(progress))) - 1)
            logits = discriminator(reverse_gradient(network.embed(drawn), factor))[:, 0]
            return nn.functional.binary_cross_entropy_with_logits(logits, domain)

        train(
            network, rows[0], torch.from_numpy(positions_in(source.classes_, kept.y)),
            Recipe(self.epochs, self.batch, self.rate, source.recipe.decay), seed,
            parameters=[*network.parameters(), *discriminator.parameters()], penalty=penalty, frozen_statistics=True,
        )  # fmt: skip
        return source.with_network(network)


def reverse_gradient(features: Float[Tensor, "row width"], factor: float) -> Float[Tensor, "row width"]:
    """The unchanged features, whose gradient is multiplied by ``-factor``."""
    return (1 + factor) * features.detach() - factor * features
