"""MiniRocket of aeon: thousands of fixed convolutions of the signal, pooled, and a ridge classifier."""

import warnings
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from jaxtyping import Float

from learn.inputs.rows import Inputs
from learn.methods.held_out_ridge import held_out_decisions
from learn.methods.strong import compression
from swgsim.common.checks import require_integer

SHORTEST = 9  # points: the length of MiniRocket's kernels
STRENGTHS = np.logspace(-1, 5, 7)  # of the ridge; chosen on source gears that are left out in turn


@dataclass
class MiniRocket:
    """MiniRocket on the signal of each row, joined with the auxiliary inputs.

    Attributes
    ----------
    channels, points, periodic : int, int, bool
        :class:`learn.inputs.inputs.Layout` of the signal; all points of a periodic channel share a scale.
    kernels : int
        Number of features from convolutions.
    seed : int

    Raises
    ------
    ValueError
        If the signal is missing or shorter than a kernel, or aeon is not installed.
    """

    channels: int
    points: int
    periodic: bool = True
    kernels: int = 1008
    seed: int = 0
    classes_: np.ndarray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        require_integer("MiniRocket", "kernels", self.kernels, low=84, high=1_000_000)
        if self.channels < 1 or self.points < SHORTEST:
            raise ValueError(
                f"MiniRocket needs a signal of at least {SHORTEST} points, found {self.channels} channels of "
                f"{self.points}: take features=raw, differenced or residual"
            )

    def fit(self, X: Inputs, y: np.ndarray, gears: np.ndarray | None = None) -> "MiniRocket":
        """Train on rows and class names.

        The strength of the ridge has the most right decisions on gears left out. Its probabilities are fitted to the
        same decisions, as those on rows of the training are surer than those on a new gear.

        Parameters
        ----------
        X, y : array (row, column), array (row,)
        gears : array (row,), optional
            Gear of every row; see :func:`learn.methods.held_out_ridge.held_out_decisions`.
        """
        from sklearn.linear_model import LogisticRegression, RidgeClassifier
        from sklearn.preprocessing import StandardScaler

        signal, side = self._split(X)
        # One scale for all rows keeps the differences between windows.
        axes = (0, 2) if self.periodic else 0
        self._centre = signal.mean(axis=axes, keepdims=True)
        self._scale = signal.std(axis=axes, keepdims=True) + np.finfo(np.float32).tiny
        self._rocket = _transformer(self.kernels, self.seed)
        convolved = self._convolved(signal, fit=True)
        self._of_rocket = StandardScaler().fit(convolved)
        self._of_side = compression().fit(side) if side.size else None
        features = self._joined(convolved, side)
        decisions = held_out_decisions(features, y, gears, STRENGTHS)
        right = (np.unique(y)[decisions.argmax(axis=2)] == y).mean(axis=1)
        best = int(right.argmax())
        self._ridge = RidgeClassifier(STRENGTHS[best]).fit(features, y)
        self._probability = LogisticRegression().fit(decisions[best], y)
        self.classes_ = self._probability.classes_
        return self

    def predict_proba(self, X: Inputs) -> Float[np.ndarray, "row class"]:
        """Probability of each class: a logistic regression on the ridge's decision values."""
        signal, side = self._split(X)
        features = self._joined(self._convolved(signal), side)
        decisions = self._ridge.decision_function(features)
        if decisions.ndim == 1:  # of two classes
            decisions = np.column_stack([-decisions, decisions])
        return self._probability.predict_proba(decisions)

    def predict(self, X: Inputs) -> np.ndarray:
        """Most probable class of each row."""
        return self.classes_[self.predict_proba(X).argmax(axis=1)]

    def _split(self, X: Inputs) -> tuple[np.ndarray, np.ndarray]:
        X = np.asarray(X)
        columns = self.channels * self.points
        signal = X[:, :columns].reshape(len(X), self.channels, self.points)
        return signal.astype(np.float32), X[:, columns:]

    def _convolved(self, signal: np.ndarray, fit: bool = False) -> np.ndarray:
        scaled = (signal - self._centre) / self._scale
        with warnings.catch_warnings():
            # The residual of a recording that equals its reference is zero.
            warnings.filterwarnings(
                "ignore", message="Data seen by instance of MiniRocket has one or more case/channel"
            )
            return self._rocket.fit_transform(scaled) if fit else self._rocket.transform(scaled)

    def _joined(self, convolved: np.ndarray, side: np.ndarray) -> np.ndarray:
        parts = [self._of_rocket.transform(convolved)]
        return np.hstack([*parts, self._of_side.transform(side)] if self._of_side else parts)


def _transformer(kernels: int, seed: int) -> Any:
    try:
        from aeon.transformations.collection.convolution_based import MiniRocket as Transformer
    except ImportError as error:
        raise ValueError("classifier=minirocket needs the library aeon: pip install 'swg-workbench[rocket]'") from error
    return Transformer(n_kernels=kernels, random_state=seed, n_jobs=1)
