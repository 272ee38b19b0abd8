"""A forest of decision trees as plain arrays, which can be changed, unlike the trees of scikit-learn."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Int


@dataclass(frozen=True)
class FlatForest:
    """The nodes of all trees, tree by tree.

    Attributes
    ----------
    classes_ : array (class,)
        Names of the classes.
    roots : array (tree,)
        First node of each tree.
    weights : array (tree,)
        Weight of each tree in the vote; the sum is 1.
    left, right : array (node,)
        Next node if the feature is at most the threshold, and if it is above. In a leaf: the leaf itself.
    feature : array (node,)
        Column that a node compares; 0 in a leaf.
    threshold : array (node,)
        In the unit of the column.
    probabilities : array (node, class)
        Class frequencies of the training rows that reach a node.
    """

    classes_: np.ndarray
    roots: Int[np.ndarray, " tree"]
    weights: Float[np.ndarray, " tree"]
    left: Int[np.ndarray, " node"]
    right: Int[np.ndarray, " node"]
    feature: Int[np.ndarray, " node"]
    threshold: Float[np.ndarray, " node"]
    probabilities: Float[np.ndarray, "node class"]

    def leaves(self, X: Float[np.ndarray, "row column"]) -> Int[np.ndarray, "row tree"]:
        """Leaf of each row in every tree."""
        X = single_precision(X)
        rows = np.arange(len(X))[:, None]
        node = np.tile(self.roots, (len(X), 1))
        while True:
            below = X[rows, self.feature[node]] <= self.threshold[node]
            following = np.where(below, self.left[node], self.right[node])
            if np.array_equal(following, node):
                return node
            node = following

    def predict_proba(self, X: Float[np.ndarray, "row column"]) -> Float[np.ndarray, "row class"]:
        """Class probabilities of the leaves, weighted mean over the trees."""
        return np.einsum("t,rtc->rc", self.weights, self.probabilities[self.leaves(X)])

    def predict(self, X: Float[np.ndarray, "row column"]) -> np.ndarray:
        """Most probable class of each row."""
        return self.classes_[np.argmax(self.predict_proba(X), axis=1)]


def single_precision(X: Float[np.ndarray, "row column"]) -> Float[np.ndarray, "row column"]:
    """Rows in single precision, as scikit-learn's trees compare them."""
    return X.astype(np.float32)


def flatten(forest: Any) -> FlatForest:
    """Arrays of a fitted random forest or of fitted extremely randomised trees.

    Raises
    ------
    ValueError
        If the model is another one.
    """
    from sklearn.ensemble import ExtraTreesClassifier, RandomForestClassifier

    if not isinstance(forest, (RandomForestClassifier, ExtraTreesClassifier)):
        raise ValueError(
            f"{type(forest).__name__} is no forest: give a fitted RandomForestClassifier or ExtraTreesClassifier"
        )
    trees = [estimator.tree_ for estimator in forest.estimators_]
    sizes = np.array([tree.node_count for tree in trees])
    roots = np.cumsum(sizes) - sizes
    offset = np.repeat(roots, sizes)
    left, right, feature = (
        np.concatenate([getattr(tree, name) for tree in trees]).astype(np.int64)
        for name in ("children_left", "children_right", "feature")
    )
    is_leaf = left < 0
    itself = np.arange(len(left))
    return FlatForest(
        forest.classes_,
        roots,
        np.full(len(trees), 1 / len(trees)),
        np.where(is_leaf, itself, left + offset),
        np.where(is_leaf, itself, right + offset),
        np.where(is_leaf, 0, feature),
        np.concatenate([tree.threshold for tree in trees]),
        np.concatenate([tree.value[:, 0] for tree in trees]),
    )
