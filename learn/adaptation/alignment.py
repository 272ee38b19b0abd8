"""Adaptation to the statistics of unlabelled recordings of the target gear (level Z2).

Both methods assume equal class frequencies in these recordings and in the source rows. They fail if the target gear is
recorded only in its healthy state.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from learn.adaptation.feature_space import Space, feature_space
from learn.adaptation.transfer import Features, FittedClassifier, Labelled, copied_network, require_rows, untrained
from learn.inputs.rows import as_tensor
from learn.methods.neural import NeuralClassifier
from swgsim.common.checks import require


@dataclass(frozen=True)
class InSpace:
    """A classifier of features of the rows."""

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
        """Class name of each row."""
        return np.asarray(self.classifier.predict(self.space(X)))


@dataclass(frozen=True)
class Coral:
    """CORAL of Sun et al., arXiv 1511.05547: source rows receive the covariance of the target, and here its mean too.

    A network keeps its body and receives a new head, a logistic regression on aligned features. Another model is
    trained anew on aligned, standardised inputs.

    Attributes
    ----------
    shrinkage : float
        Shrinkage of both covariances, from 0 (none) to 1 (equal variances without correlation).
    """

    shrinkage: float = 0.1

    def __post_init__(self) -> None:
        require("CORAL", "shrinkage", self.shrinkage, 1e-9, 1)

    def adapt(self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Features, seed: int) -> FittedClassifier:
        """A classifier of unaligned features of the target gear."""
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
    """Source rows, whitened by their covariance and coloured by that of the target, around the mean of the target."""
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
    """AdaBN of Li et al., arXiv 1603.04779: batch normalisation with statistics of the target gear.

    Attributes
    ----------
    mixing : float
        Weight of the mean and variance of the target, from 0 to 1; the rest is that of the source.
    """

    mixing: float = 1.0

    def __post_init__(self) -> None:
        require("batch norm adaptation", "mixing", self.mixing, 0, 1)

    def adapt(self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Features, seed: int) -> NeuralClassifier:
        """The source model with adapted statistics.

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
        rows = as_tensor(unlabelled).to(network.centre.device)
        with torch.no_grad(), one_thread():
            # Layer by layer, as each one is fed by the adapted statistics of those before it.
            for layer in layers:
                before, layer.momentum = layer.momentum, self.mixing  # in one pass, the weight of the statistics
                layer.train()
                network.embed(rows)
                layer.eval()
                layer.momentum = before
        return source.with_network(network)
