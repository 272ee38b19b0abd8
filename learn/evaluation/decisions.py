"""Decisions and true classes from a table of predictions.

A table of predictions has one row per judged recording: ``gear``, ``label``, ``variant``, ``severity`` (NaN if
healthy), ``n_in_rpm``, ``T_out_nm``, and one column per class with its predicted probability.
"""

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from swgsim.storage.labelled_signals import CLASSES


def probabilities(predictions: pd.DataFrame) -> Float[np.ndarray, "row class"]:
    """Predicted probabilities in the order of :data:`swgsim.storage.labelled_signals.CLASSES`.

    Raises
    ------
    ValueError
        If a probability is not finite.
    """
    values = predictions[list(CLASSES)].to_numpy(dtype=float)
    bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if len(bad):
        raise ValueError(f"row {bad[0]}: probabilities {values[bad[0]]}, every class needs a finite one")
    return values


def decisions(predictions: pd.DataFrame) -> np.ndarray:
    """Most probable class name of every row."""
    return np.array(CLASSES)[probabilities(predictions).argmax(axis=1)]


def truth(predictions: pd.DataFrame) -> np.ndarray:
    """True class name of every row."""
    return np.array(predictions["label"], dtype=str)


def class_numbers(predictions: pd.DataFrame) -> Int[np.ndarray, " row"]:
    """True class of every row as an index of :data:`swgsim.storage.labelled_signals.CLASSES`.

    Raises
    ------
    ValueError
        If a label is not one of the classes.
    """
    numbers = pd.Index(CLASSES).get_indexer(pd.Index(truth(predictions)))
    if (numbers < 0).any():
        unknown = truth(predictions)[numbers.argmin()]
        raise ValueError(f"unknown class {unknown!r}; choose from {', '.join(CLASSES)}")
    return numbers
