"""Source models adapted to the statistics of recordings of the target gear without labels (level Z2).

Both methods take it that the classes are as frequent among these recordings as among the rows of the source gears: a
target gear recorded healthy only would spoil them.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from learn.adaptation.feature_space import Space, feature_space
from learn.adaptation.transfer import FittedClassifier, Labelled, copied_network, require_rows, untrained
from learn.inputs.rows import as_tensor
from learn.methods.neural import NeuralClassifier
from swgsim.common.checks import require


@dataclass(frozen=True)
class InSpace:
    """A classifier on features of the rows."""

    space: Space
    classifier: Any

    @property
    def classes_(self) -> np.ndarray:
        """Names of the classes."""
        return np.asarray(self.classifier.classes_)

    def predict_proba(self, X: Float[np.ndarray, "row column"]) -> Float[np.ndarray, "row class"]:
        """Probability of each class."""
        return np.asarray(self.classifier.predict_proba(self.space(X)))

    def predict(self, X: Float[np.ndarray, "row column"]) -> np.ndarray:
        """The class name of each row."""
        return np.asarray(self.classifier.predict(self.space(X)))


@dataclass(frozen=True)
class Coral:
    """CORAL of Sun et al., arXiv 1511.05547, with the mean: source rows get mean and covariance of the target's.

    A network keeps its body and gets a new head, a logistic regression on aligned features. Any other model is trained
    anew on aligned, standardised input.

    Attributes
    ----------
    shrinkage : float
        Of both covariances, from 0 for none to 1 for equal variances without correlation.
    """

    shrinkage: float = 0.1

    def __post_init__(self) -> None:
        require("CORAL", "shrinkage", self.shrinkage, 1e-9, 1)

    def adapt(
        self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Float[np.ndarray, "row column"], seed: int
    ) -> FittedClassifier:
        """A classifier on the features of the target gear as they are."""
        from sklearn.linear_model import LogisticRegression

        require_rows(self, "unlabelled", len(unlabelled))
        require_rows(self, "kept", len(kept.X))
        space = feature_space(source, kept.X)
        aligned = align(space(kept.X), space(unlabelled), self.shrinkage)
        is_network = isinstance(source, NeuralClassifier)
        classifier = LogisticRegression(max_iter=5000) if is_network else untrained(source, seed)
        return InSpace(space, classifier.fit(aligned, kept.y))


def align(
    source: Float[np.ndarray, "row feature"], target: Float[np.ndarray, "other feature"], shrinkage: float
) -> Float[np.ndarray, "row feature"]:
    """Source rows whitened by their own covariance and coloured by the target's, around the target's mean."""
    whiten = _power(_covariance(source, shrinkage), -0.5)
    colour = _power(_covariance(target, shrinkage), 0.5)
    return (source - source.mean(axis=0)) @ whiten @ colour + target.mean(axis=0)


def _covariance(features: np.ndarray, shrinkage: float) -> np.ndarray:
    deviation = features - features.mean(axis=0)
    covariance = deviation.T @ deviation / len(features)
    sphere = np.trace(covariance) / len(covariance) * np.eye(len(covariance))
    return np.asarray((1 - shrinkage) * covariance + shrinkage * sphere)


def _power(covariance: np.ndarray, exponent: float) -> np.ndarray:
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray((vectors * values**exponent) @ vectors.T)


@dataclass(frozen=True)
class BatchNormAdaptation:
    """AdaBN of Li et al., arXiv 1603.04779: batch normalisation takes its statistics from the target gear.

    Attributes
    ----------
    mixing : float
        Weight of the target's mean and variance against the source's, from 0 to 1.
    """

    mixing: float = 1.0

    def __post_init__(self) -> None:
        require("batch norm adaptation", "mixing", self.mixing, 0, 1)

    def adapt(
        self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Float[np.ndarray, "row column"], seed: int
    ) -> NeuralClassifier:
        """The source model with other statistics.

        Raises
        ------
        ValueError
            If the network has no batch normalisation, or there are no recordings.
        """
        import torch

        from learn.methods.training import one_thread

        require_rows(self, "unlabelled", len(unlabelled))
        network = copied_network(source).eval()
        layers = [module for module in network.modules() if isinstance(module, torch.nn.BatchNorm1d)]
        if not layers:
            raise ValueError(
                f"the {source.architecture.kind} network has no batch normalisation to adapt: "
                "take a convolutional network, or CORAL"
            )
        momenta = [layer.momentum for layer in layers]
        for layer in layers:
            layer.train()
            layer.momentum = self.mixing  # all rows pass once, so this is the weight of their statistics
        with torch.no_grad(), one_thread():
            network.embed(as_tensor(unlabelled).to(network.centre.device))
        for layer, momentum in zip(layers, momenta, strict=True):
            layer.momentum = momentum
        network.eval()
        return source.with_network(network)
