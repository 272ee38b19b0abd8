"""Transfer: adaptation of a model of source gears to a target gear that is not among them.

The target gear has either labelled shots (level Z3) or unlabelled recordings (level Z2). Every method receives both
arguments and uses one of them.
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


Features = Float[np.ndarray, "row column"]


class Labelled(NamedTuple):
    """Rows X, array (row, column), with their class names y, array (row,)."""

    X: Features
    y: np.ndarray


@runtime_checkable
class FittedClassifier(Protocol):
    """A trained classifier, the result of an adaptation."""

    @property
    def classes_(self) -> np.ndarray:
        """Sorted names of the classes."""
        ...

    def predict_proba(self, X: Features) -> Float[np.ndarray, "row class"]:
        """Probability of each class, in the order of ``classes_``."""
        ...

    def predict(self, X: Features) -> np.ndarray:
        """Class name of each row."""
        ...


@runtime_checkable
class Adaptation(Protocol):
    """A transfer method."""

    def adapt(self, source: Any, kept: Labelled, shots: Labelled, unlabelled: Features, seed: int) -> FittedClassifier:
        """A classifier for the target gear.

        Parameters
        ----------
        source : fitted classifier
            Trained on the source gears; must not be changed.
        kept : Labelled
            Rows of the source gears.
        shots : Labelled
            Labelled rows of the target gear; none for methods of level Z2.
        unlabelled : array (row, column)
            Unlabelled rows of the target gear; none for methods of level Z3.
        seed : int
            Seed of all random numbers.
        """
        ...


def positions_in(classes: Sequence[str] | np.ndarray, y: np.ndarray) -> Int[np.ndarray, " row"]:
    """Position of each class name in the sorted `classes` of the source model.

    Raises
    ------
    ValueError
        If the source model does not have a class.
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
    """Raise a ValueError if a method receives none of the rows that it needs."""
    if rows == 0:
        raise ValueError(f"{type(method).__name__} received 0 rows of {what} and needs at least 1")


def copied_network(source: Any) -> "Network":
    """A copy of the network of a trained neural classifier.

    Raises
    ------
    ValueError
        If the source model is another classifier.
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
