"""Importance of groups of features: loss of recall when a group is permuted."""

from collections.abc import Mapping, Sequence
from typing import Protocol, runtime_checkable

import numpy as np
import pandas as pd
from jaxtyping import Float, Int


@runtime_checkable
class Predictor(Protocol):
    """A fitted classifier."""

    def predict(self, X: Float[np.ndarray, "row feature"]) -> np.ndarray:
        """Class name of each row."""
        ...


def grouped_permutation(
    model: Predictor,
    X: Float[np.ndarray, "row feature"],
    y: np.ndarray,
    groups: Mapping[str, Sequence[int]],
    blocks: Int[np.ndarray, " row"],
    rng: np.random.Generator,
    *,
    repeats: int = 10,
) -> pd.DataFrame:
    """Drop of the recall of every class when the columns of a group are permuted together within blocks.

    Redundant features within a group do not hide its importance, as they are permuted together. Information that two
    groups share counts for neither. Permuted values remain possible within a block, which is one operating point. Small
    negative drops are chance.

    Parameters
    ----------
    model : Predictor
        Fitted on other rows.
    X : array (row, feature)
    y : array (row,)
        Class names.
    groups : mapping
        Name of a group, such as a gauge or an order, to its columns.
    blocks : array (row,)
        Number of the operating point of each row.
    rng : Generator
    repeats : int
        Permutations per group; at least 2 for a standard error.

    Returns
    -------
    DataFrame
        ``group``, ``label``, mean ``drop`` of recall [points], and ``doubt``, twice its standard error [points].

    Raises
    ------
    ValueError
        If a group has a column that does not exist.
    """
    for name, columns in groups.items():
        outside = [column for column in columns if not 0 <= column < X.shape[1]]
        if outside:
            raise ValueError(f"group {name!r}: column {outside[0]}, the features have 0 to {X.shape[1] - 1}")
    full = _recalls(model, X[None], y).loc[0]
    rows_of_blocks = [np.flatnonzero(blocks == block) for block in np.unique(blocks)]
    parts = []
    for name, columns in groups.items():
        chosen = np.array(columns, dtype=int)
        permuted = np.repeat(X[None], repeats, axis=0)
        for rows in rows_of_blocks:
            for copy in permuted:
                copy[np.ix_(rows, chosen)] = X[np.ix_(rng.permutation(rows), chosen)]
        drop = full - _recalls(model, permuted, y)
        parts.append(pd.DataFrame({"group": name, "drop": drop.mean(), "doubt": 2 * drop.sem()}))
    return pd.concat(parts).rename_axis("label").reset_index()[["group", "label", "drop", "doubt"]]


def _recalls(model: Predictor, X: Float[np.ndarray, "copy row feature"], y: np.ndarray) -> pd.DataFrame:
    """Recall of every class (column) in every copy (row) [%], with one call of predict, which saves time."""
    correct = model.predict(X.reshape(-1, X.shape[-1])).reshape(X.shape[:2]) == y
    return 100 * pd.DataFrame(correct.T).groupby(y).mean().T
