"""Forests of the source gears adapted to the target gear by its shots (level Z3)."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.special import entr

from learn.adaptation.transfer import Labelled, positions_in, require_rows, untrained
from learn.methods.flat_forest import FlatForest, as_trees_see, flatten
from swgsim.common.checks import require, require_integer, require_positive


@dataclass(frozen=True)
class LeafRelabelling:
    """Splits stay as they are; the class frequencies in the leaves are updated by the rows of the shots there.

    Attributes
    ----------
    strength : float
        Number of rows of the target gear that the source's frequencies in a leaf are worth. A shot gives one row at
        each operating point, so the shots weigh more against the source the more points there are.
    """

    strength: float = 3.0

    def __post_init__(self) -> None:
        require_positive("leaf relabelling", strength=self.strength)

    def adapt(
        self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Float[np.ndarray, "row column"], seed: int
    ) -> FlatForest:
        """Posterior mean of the frequencies in every leaf, the source's being the prior."""
        require_rows(self, "shots", len(shots.X))
        forest = flatten(source)
        counts = np.zeros_like(forest.probabilities)
        np.add.at(counts, (forest.leaves(shots.X), positions_in(forest.classes_, shots.y)[:, None]), 1)
        total = counts.sum(axis=1, keepdims=True)
        return replace(forest, probabilities=(self.strength * forest.probabilities + counts) / (self.strength + total))


@dataclass(frozen=True)
class AddedTrees:
    """Trees grown on the shots vote with those of the source.

    Attributes
    ----------
    count : int
        Number of trees that are added.
    share : float
        Their share in the vote.
    """

    count: int = 100
    share: float = 0.5

    def __post_init__(self) -> None:
        require_integer("added trees", "count", self.count, 1, 100_000)
        require("added trees", "share", self.share, 0, 1)

    def adapt(
        self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Float[np.ndarray, "row column"], seed: int
    ) -> FlatForest:
        """The source's trees followed by the new ones, which are of the same kind."""
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

    Every tree keeps which feature it looks at where. From the root down, each threshold is chosen anew on the shots
    that reach the node: among the local maxima of the information gain the one whose two sides look most like the
    source's in their class frequencies (largest divergence gain). If they look more like the source's with the sides
    exchanged, the subtrees are exchanged. The leaves hold the frequencies of the shots alone, and a node at which no
    threshold parts the shots, or at which all are of one class, becomes a leaf.
    """

    def adapt(
        self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Float[np.ndarray, "row column"], seed: int
    ) -> FlatForest:
        """The source forest with thresholds and leaves of the target gear."""
        require_rows(self, "shots", len(shots.X))
        forest = flatten(source)
        X = as_trees_see(shots.X)
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
    """The threshold of STRUT, and whether the source's two sides have to be exchanged.

    Parameters
    ----------
    x : array (row,)
        The feature, with at least two values.
    one_hot : array (row, class)
        The class of each row.
    sides : array (2, class)
        Class probabilities of the source below and above its own threshold.
    """
    order = np.argsort(x, kind="stable")
    x, one_hot = x[order].astype(np.float64), one_hot[order]
    last = np.flatnonzero(x[1:] > x[:-1])  # last row below each possible threshold
    counts = np.cumsum(one_hot, axis=0)
    counts = np.array([counts[last], counts[-1] - counts[last]])  # side, threshold, class
    sizes = counts.sum(axis=-1)
    target = counts / sizes[..., None]
    weights = sizes / len(x)
    remaining = (weights * entropy(target)).sum(axis=0)  # the information gain is a constant less this
    around = np.concatenate([[np.inf], remaining, [np.inf]])
    peaks = np.flatnonzero((remaining <= around[:-2]) & (remaining <= around[2:]))
    source = np.array([sides, sides[::-1]])[:, :, None]  # order of the sides, side, threshold, class
    divergence = (weights[:, peaks] * jensen_shannon(target[:, peaks], source)).sum(axis=1)
    exchange, best = divmod(int(np.argmin(divergence)), len(peaks))  # 1 - divergence is the divergence gain
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
