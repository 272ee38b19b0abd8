"""Transfer: a model trained on source gears is adapted to a gear that it has never seen.

The target gear gives either labelled shots (level Z3) or recordings without labels (level Z2); every method takes both
and uses the one that it is made for.
"""

from collections.abc import Sequence
from copy import deepcopy
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float, Int

from learn.methods.neural import NeuralClassifier
from learn.methods.rocket import MiniRocket

if TYPE_CHECKING:
    from learn.methods.networks import Network


class Labelled(NamedTuple):
    """Rows with their class names.

    Attributes
    ----------
    X : array (row, column)
    y : array (row,)
        Class names.
    """

    X: Float[np.ndarray, "row column"]
    y: np.ndarray


@runtime_checkable
class FittedClassifier(Protocol):
    """What an adaptation returns: a classifier that has learnt and is only asked."""

    @property
    def classes_(self) -> np.ndarray:
        """Names of the classes."""
        ...

    def predict_proba(self, X: Float[np.ndarray, "row column"]) -> Float[np.ndarray, "row class"]:
        """Probability of each class, in the order of ``classes_``."""
        ...

    def predict(self, X: Float[np.ndarray, "row column"]) -> np.ndarray:
        """The class name of each row."""
        ...


@runtime_checkable
class Adaptation(Protocol):
    """A transfer method."""

    def adapt(
        self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Float[np.ndarray, "row column"], seed: int
    ) -> FittedClassifier:
        """A classifier for the target gear.

        Parameters
        ----------
        source : fitted classifier
            Trained on the source gears; it is never changed.
        kept : Labelled
            Rows of the source gears that may be replayed or aligned.
        shots : Labelled
            Labelled rows of the target gear; without rows for methods of level Z2.
        unlabelled : array (row, column)
            Recordings of the target gear without labels; without rows for methods of level Z3.
        seed : int
            Of all that is random.
        """
        ...


def positions_in(classes: Sequence[str] | np.ndarray, y: np.ndarray) -> Int[np.ndarray, " row"]:
    """Position of each class name in the sorted `classes` of the source model.

    Raises
    ------
    ValueError
        If a class is not among them.
    """
    classes = np.asarray(classes)
    unknown = np.setdiff1d(y, classes)
    if len(unknown):
        raise ValueError(
            f"class {str(unknown[0])!r} of the target gear is unknown to the source model, which knows "
            f"{', '.join(map(str, classes))}: train the source model on it too, or leave its rows out"
        )
    return np.searchsorted(classes, y)


def require_rows(method: object, what: str, rows: int) -> None:
    """Raise a ValueError if a method is given no row of what it learns from."""
    if rows == 0:
        raise ValueError(f"{type(method).__name__} was given 0 rows of {what} and needs at least 1")


def copied_network(source: Any) -> "Network":
    """A copy of the network of a trained neural classifier, which may be changed.

    Raises
    ------
    ValueError
        If the source model is no neural classifier.
    """
    if not isinstance(source, NeuralClassifier):
        raise ValueError(f"{type(source).__name__} has no network to adapt: give a trained NeuralClassifier")
    return deepcopy(source.network_)


def untrained(source: Any, seed: int) -> Any:
    """An untrained model like the source model, with another seed.

    Raises
    ------
    ValueError
        If the model is a classifier of one's own that scikit-learn cannot copy.
    """
    from sklearn.base import clone

    if isinstance(source, NeuralClassifier | MiniRocket):
        return replace(source, seed=seed)
    if not hasattr(source, "get_params"):
        raise ValueError(f"{type(source).__name__} cannot be trained anew: derive it from sklearn.base.BaseEstimator")
    fresh = clone(source)
    random = [name for name in fresh.get_params() if name.split("__")[-1] == "random_state"]
    return fresh.set_params(**dict.fromkeys(random, seed))
