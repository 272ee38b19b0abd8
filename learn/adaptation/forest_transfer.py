"""Adaptation of forests by shots of the target gear (level Z3)."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.special import entr

from learn.adaptation.transfer import Features, Labelled, positions_in, require_rows, untrained
from learn.methods.flat_forest import FlatForest, flatten, single_precision
from swgsim.common.checks import require, require_integer, require_positive


@dataclass(frozen=True)
class LeafRelabelling:
    """Update of the class frequencies in the leaves by the shots; the splits stay.

    Attributes
    ----------
    strength : float
        Weight of the source frequencies in a leaf, in rows of the target gear. A shot has one row at each operating
        point, so the weight of the shots grows with the number of points.
    """

    strength: float = 3.0

    def __post_init__(self) -> None:
        require_positive("leaf relabelling", strength=self.strength)

    def adapt(self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Features, seed: int) -> FlatForest:
        """A forest with the posterior mean of the frequencies, with those of the source as the prior."""
        require_rows(self, "shots", len(shots.X))
        forest = flatten(source)
        counts = np.zeros_like(forest.probabilities)
        np.add.at(counts, (forest.leaves(shots.X), positions_in(forest.classes_, shots.y)[:, None]), 1)
        total = counts.sum(axis=1, keepdims=True)
        return replace(forest, probabilities=(self.strength * forest.probabilities + counts) / (self.strength + total))


@dataclass(frozen=True)
class AddedTrees:
    """Trees grown on the shots vote together with those of the source.

    Attributes
    ----------
    count : int
        Number of added trees.
    share : float
        Their share of the vote.
    """

    count: int = 100
    share: float = 0.5

    def __post_init__(self) -> None:
        require_integer("added trees", "count", self.count, 1, 100_000)
        require("added trees", "share", self.share, 0, 1)

    def adapt(self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Features, seed: int) -> FlatForest:
        """The source trees followed by new ones of the same kind."""
        require_rows(self, "shots", len(shots.X))
        old = flatten(source)
        fresh = untrained(source, seed).set_params(n_estimators=self.count)
        new = flatten(fresh.fit(shots.X, shots.y))
        probabilities = np.zeros((len(new.left), len(old.classes_)))
        probabilities[:, positions_in(old.classes_, new.classes_)] = new.probabilities  # shots may lack classes
        nodes = len(old.left)
        return FlatForest(
            old.classes_,
            np.append(old.roots, new.roots + nodes),
            np.append((1 - self.share) * old.weights, self.share * new.weights),
            np.append(old.left, new.left + nodes),
            np.append(old.right, new.right + nodes),
            np.append(old.feature, new.feature),
            np.append(old.threshold, new.threshold),
            np.concatenate([old.probabilities, probabilities]),
        )


@dataclass(frozen=True)
class StructureTransfer:
    """STRUT of Segev et al., "Learn on source, refine on target", IEEE TPAMI 39 (2017).

    The features of all nodes stay. From the root down, each threshold is chosen anew by the shots that reach the node.
    Candidates are the local maxima of the information gain. The one with the largest divergence gain wins: the class
    frequencies on its two sides are most similar to those of the source. If they are more similar with exchanged sides,
    the subtrees are exchanged. Leaves hold the frequencies of the shots. A node becomes a leaf if no threshold
    separates its shots or all are of one class.
    """

    def adapt(self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Features, seed: int) -> FlatForest:
        """The source forest with thresholds and leaves of the target gear."""
        require_rows(self, "shots", len(shots.X))
        forest = flatten(source)
        X = single_precision(shots.X)
        one_hot = np.eye(len(forest.classes_))[positions_in(forest.classes_, shots.y)]
        left, right, threshold = forest.left.copy(), forest.right.copy(), forest.threshold.copy()
        probabilities = forest.probabilities.copy()
        open_nodes = [(root, np.arange(len(X))) for root in forest.roots]
        while open_nodes:
            node, rows = open_nodes.pop()
            sides = forest.probabilities[[left[node], right[node]]]
            probabilities[node] = one_hot[rows].mean(axis=0)
            x = X[rows, forest.feature[node]]
            if left[node] == node or probabilities[node].max() == 1 or x.min() == x.max():
                left[node] = right[node] = node
                continue
            threshold[node], exchange = choose_threshold(x, one_hot[rows], sides)
            if exchange:
                left[node], right[node] = right[node], left[node]
            below = x <= threshold[node]
            open_nodes += [(left[node], rows[below]), (right[node], rows[~below])]
        return replace(forest, left=left, right=right, threshold=threshold, probabilities=probabilities)


def choose_threshold(
    x: Float[np.ndarray, " row"], one_hot: Float[np.ndarray, "row class"], sides: Float[np.ndarray, "2 class"]
) -> tuple[float, bool]:
    """Threshold of STRUT, and whether the two sides of the source are exchanged.

    Parameters
    ----------
    x : array (row,)
        Feature with at least two values.
    one_hot : array (row, class)
        Class of each row.
    sides : array (2, class)
        Class probabilities of the source below and above its threshold.
    """
    order = np.argsort(x, kind="stable")
    x, one_hot = x[order].astype(np.float64), one_hot[order]
    last = np.flatnonzero(x[1:] > x[:-1])  # last row below each possible threshold
    counts = np.cumsum(one_hot, axis=0)
    counts = np.array([counts[last], counts[-1] - counts[last]])  # side, threshold, class
    sizes = counts.sum(axis=-1)
    target = counts / sizes[..., None]
    weights = sizes / len(x)
    remaining = (weights * entropy(target)).sum(axis=0)  # information gain = constant - remaining
    around = np.concatenate([[np.inf], remaining, [np.inf]])
    peaks = np.flatnonzero((remaining <= around[:-2]) & (remaining <= around[2:]))
    source = np.array([sides, sides[::-1]])[:, :, None]  # order of the sides, side, threshold, class
    divergence = (weights[:, peaks] * jensen_shannon(target[:, peaks], source)).sum(axis=1)
    exchange, best = divmod(int(np.argmin(divergence)), len(peaks))  # divergence gain = 1 - divergence
    row = last[peaks[best]]
    return float(x[row] + x[row + 1]) / 2, bool(exchange)


def entropy(probabilities: Float[np.ndarray, "*shape class"]) -> Float[np.ndarray, "*shape"]:
    """Entropy of distributions over classes [bit]."""
    return entr(probabilities).sum(axis=-1) / np.log(2)


def jensen_shannon(
    first: Float[np.ndarray, "*#shape class"], second: Float[np.ndarray, "*#shape class"]
) -> Float[np.ndarray, "*shape"]:
    """Jensen-Shannon divergence of distributions over classes [bit]."""
    return entropy((first + second) / 2) - (entropy(first) + entropy(second)) / 2
