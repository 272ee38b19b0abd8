"""Which groups of features carry which fault: recall that is lost when a group says nothing any more."""

from collections.abc import Mapping, Sequence
from typing import Protocol, runtime_checkable

import numpy as np
import pandas as pd
from jaxtyping import Float, Int


@runtime_checkable
class Predictor(Protocol):
    """A fitted classifier."""

    def predict(self, X: Float[np.ndarray, "row feature"]) -> np.ndarray:
        """The class name of each row."""
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
    """Drop of every class's recall when the columns of a group are permuted together among rows of a block.

    The columns of a group stay with each other, so features that repeat one another within it do not hide its worth;
    what a second group knows as well counts for neither. Within a block (one operating point) the permuted values
    remain possible ones. A small negative drop is chance.

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
        Permutations per group, 2 at least for a doubt.

    Returns
    -------
    DataFrame
        ``group``, ``label``, mean ``drop`` of recall and its ``doubt``, twice the standard error over the repeats
        [points].

    Raises
    ------
    ValueError
        If a group names a column that does not exist.
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
    """Share recognised of every class (column) in every copy (row) [%].

    All copies are predicted at once: many methods take most of their time to begin.
    """
    correct = model.predict(X.reshape(-1, X.shape[-1])).reshape(X.shape[:2]) == y
    return 100 * pd.DataFrame(correct.T).groupby(y).mean().T
