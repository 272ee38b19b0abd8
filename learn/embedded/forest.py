"""Forests as C: tables of splits and leaves, which ``c/forest.c`` walks.

The tables are our own, because emlearn 0.23.2 keeps neither labels nor flash: a forest of 30 trees with 5378 nodes took
it 77 kB on a Cortex-M4 and gave 99.8 % of scikit-learn's labels, against 36 kB and all of them. Its ``inline`` trees
print thresholds with six decimals, whatever the unit of a feature, and round leaves to 8 bits; its ``loadable`` trees
take no floats and 127 features at most, and keep two references at every split.
"""

from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float, Int, Int16

from learn.embedded.source import Macros, array
from learn.methods.flat_forest import FlatForest, flatten
from swgsim.common.checks import require_known

# How thresholds are kept, and the vote of a leaf that is sure.
KINDS = {"float": ("float", 2**16 - 1), "int16": ("int16_t", 2**8 - 1)}

HIGHEST = np.iinfo(np.int16).max
# A scale is linear over this part of the range of its thresholds at least; beyond, it is logarithmic.
LINEAR = 2.0**-16
NEAREST = 1e-30  # distance of thresholds that are all equal: any other value is far away
ONE = np.float32(1)


def is_forest(model: Any) -> bool:
    """Whether :func:`write` takes a classifier."""
    from sklearn.ensemble import ExtraTreesClassifier, RandomForestClassifier

    return isinstance(model, (RandomForestClassifier, ExtraTreesClassifier))


def write(model: Any, folder: Path, numbers: str) -> tuple[tuple[str, ...], Macros]:
    """Write ``forest_tables.h`` of a trained forest.

    Parameters
    ----------
    model : RandomForestClassifier or ExtraTreesClassifier
    folder : Path
    numbers : {"float", "int16"}
        With ``float``, comparisons are exactly those of scikit-learn and leaves have 16 bits. With ``int16``, a column
        and its thresholds are put on a scale of 16 bits, and leaves have 8.

    Returns
    -------
    tuple of str
        Names of the C files that go with it.
    Macros
        Their macros.

    Raises
    ------
    ValueError
        If the model is not a forest, no tree splits, or forests do not have such numbers.
    """
    require_known("numbers of a forest", [numbers], KINDS)
    forest = flatten(model)
    order = _left_first(forest)
    is_leaf = forest.left[order] == order
    splits, ends = order[~is_leaf], order[is_leaf]
    if not len(splits):
        raise ValueError("no tree of this forest splits: train it on more rows")
    before = np.empty_like(order)  # leaves that come before a node
    before[order] = np.cumsum(is_leaf) - is_leaf
    kind, sure = KINDS[numbers]
    rounded = np.rint(sure * forest.probabilities[ends]).astype(np.uint16)
    vote, ballot = np.unique(rounded, axis=0, return_inverse=True)
    column, threshold = forest.feature[splits], _single(forest.threshold[splits])
    text = ["#include <stdint.h>\n"]
    if numbers == "int16":
        scales = _scales(model.n_features_in_, column, threshold)
        threshold = coded(threshold, *(each[column] for each in scales))
        names = ("centre", "steepness", "gain")
        text += [array(name, each, storage="static const") for name, each in zip(names, scales, strict=True)]
    text += [
        _table("leaves", np.diff(before[forest.roots], append=len(ends))),
        _table("left_leaves", before[forest.right[splits]] - before[splits]),
        _table("column", column),
        array("threshold", threshold, kind, "static const"),
        _table("ballot", ballot.ravel()),
        _table("vote", vote),
    ]
    (folder / "forest_tables.h").write_text("\n".join(text))
    sizes: Macros = {"TREES": len(forest.roots), "VALUE": kind, "CODED": int(numbers == "int16")}
    return ("forest.c",), sizes


def _left_first(forest: FlatForest) -> Int[np.ndarray, " node"]:
    """The nodes of one tree after the other, each before those on its left and these before those on its right."""
    left, right, waiting = forest.left.tolist(), forest.right.tolist(), forest.roots[::-1].tolist()
    order = []
    while waiting:
        node = waiting.pop()
        order.append(node)
        if left[node] != node:
            waiting += [right[node], left[node]]
    return np.array(order)


def _single(threshold: Float[np.ndarray, " split"]) -> Float[np.ndarray, " split"]:
    """The greatest numbers in single precision that are not above the thresholds: they split rows in the same way."""
    nearest = threshold.astype(np.float32)
    return np.where(nearest > threshold, np.nextafter(nearest, np.float32(-np.inf)), nearest)


def _scales(
    columns: int, column: Int[np.ndarray, " split"], threshold: Float[np.ndarray, " split"]
) -> tuple[Float[np.ndarray, " column"], Float[np.ndarray, " column"], Float[np.ndarray, " column"]]:
    """Centre, steepness and gain of the scale of each column.

    Its thresholds use the whole range except the last step, which is for all values beyond them.
    """
    centre, steepness, gain = np.zeros(columns, np.float32), np.ones(columns, np.float32), np.ones(columns, np.float32)
    for each in np.unique(column):
        own = threshold[column == each]
        centre[each] = np.median(own)
        distance = np.abs(own - centre[each])
        furthest = max(distance.max(), NEAREST)
        steepness[each] = 1 / max(np.median(distance), LINEAR * furthest)
        gain[each] = (HIGHEST - 1) / _logarithm(furthest * steepness[each])
    return centre, steepness, gain


def coded(
    value: Float[np.ndarray, " value"],
    centre: Float[np.ndarray, " value"],
    steepness: Float[np.ndarray, " value"],
    gain: Float[np.ndarray, " value"],
) -> Int16[np.ndarray, " value"]:
    """Values on the scale of their columns, all in single precision; ``c/forest.c`` does the same."""
    distance = (value - centre) * steepness
    code = np.minimum(_logarithm(np.abs(distance)) * gain, HIGHEST)
    return np.where(distance < 0, -code, code).astype(np.int16)


def _logarithm(distance: Any) -> Any:
    """Like that of 1 + distance, as the bits of a float are, in steps of its last bit."""
    return ((ONE + np.float32(distance)).view(np.int32) - ONE.view(np.int32)).astype(np.float32)


def _table(name: str, values: np.ndarray) -> str:
    """An array of the smallest type that holds its values."""
    return array(name, values, f"{np.min_scalar_type(values.max(initial=0))}_t", "static const")
