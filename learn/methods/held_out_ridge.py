"""Decisions of a ridge classifier on gears that its fit leaves out, for every strength at once."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float, Int

FOLDS = 5  # parts in which gears are left out


def held_out_decisions(
    X: Float[np.ndarray, "row feature"],
    y: np.ndarray,
    gears: Int[np.ndarray, " row"] | None,
    strengths: Float[np.ndarray, " strength"],
) -> Float[np.ndarray, "strength row class"]:
    """Decision values of ridge regressions on the classes as -1 and 1; each row by a fit without its gear.

    Recordings of a specimen are alike, and so are specimens of a gear. A fit that leaves single rows out has their
    likes in training, and would choose a regularisation for gears that it knows.

    Parameters
    ----------
    X, y : array (row, feature), array (row,)
        Rows and class names.
    gears : array (row,), optional
        Gear of every row. Without gears, or with one, classes are left out in equal parts instead.
    strengths : array (strength,)
    """
    targets = 2.0 * (y[:, None] == np.unique(y)) - 1
    found = np.empty((len(strengths), *targets.shape))
    for train, test in _left_out(X, y, gears):
        centre, level = X[train].mean(axis=0), targets[train].mean(axis=0)
        rows = X[train] - centre
        # In the axes of the covariance every strength is a division.
        size, axes = np.linalg.eigh(rows.T @ rows)
        along = axes.T @ (rows.T @ (targets[train] - level))
        turned = (X[test] - centre) @ axes
        for decisions, strength in zip(found, strengths, strict=True):
            decisions[test] = turned @ (along / (np.maximum(size, 0) + strength)[:, None]) + level
    return found


def _left_out(X: np.ndarray, y: np.ndarray, gears: np.ndarray | None) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    from sklearn.model_selection import GroupKFold, StratifiedKFold

    count = 0 if gears is None else len(np.unique(gears))
    if count > 1:
        yield from GroupKFold(min(count, FOLDS)).split(X, y, gears)
    else:
        yield from StratifiedKFold(min(FOLDS, np.unique(y, return_counts=True)[1].min())).split(X, y)
