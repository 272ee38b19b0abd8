"""Recordings with the healthy references of their gear: rows that say all that a twin needs."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from learn.inputs.inputs import OPERATING_POINT, LearningSet
from swgsim.storage.labelled_signals import LabelledSignals

if TYPE_CHECKING:
    from swgsim.twin import References


@dataclass(frozen=True)
class Referenced:
    """Operating point and observation of a recording, then the mean observation of every reference of its gear.

    An observation has the order lines 0 to 12 of the five gauges, the logarithm of the efficiency and the temperature
    (:func:`swgsim.oracle.model.observations`). A row has no value of any other gear, nor of another judged recording.

    Attributes
    ----------
    name : str
    """

    name: str

    def learning_set(self, blocks: Iterable[LabelledSignals]) -> LearningSet:
        """Rows of all samples.

        Raises
        ------
        ValueError
            If gears have references at different numbers of operating points.
        """
        from swgsim.oracle.model import observations  # with the loop, which takes seconds
        from swgsim.twin import References

        whole = [(observations(block), block.table) for block in blocks]
        x, table = np.concatenate([each for each, _ in whole]), pd.concat([each for _, each in whole])
        table = table.reset_index(drop=True)
        is_reference = table["reference"].to_numpy()
        samples = np.flatnonzero(~is_reference)
        gear = table["gear"].to_numpy()
        rows = np.empty((len(samples), 0))
        for number in np.unique(gear):
            of_gear = is_reference & (gear == number)
            said = _flat(References.of_observations(x[of_gear], table[of_gear]))
            if not rows.shape[1]:
                rows = np.empty((len(samples), len(OPERATING_POINT) + x.shape[1] + len(said)))
            here = gear[samples] == number
            if rows.shape[1] != len(OPERATING_POINT) + x.shape[1] + len(said):
                raise ValueError(
                    f"gear {number} has references at other operating points than the gears before: a row has the "
                    "references of its gear in the same columns as all others; record the same operating points"
                )
            points = table.loc[samples[here], list(OPERATING_POINT)].to_numpy()
            rows[here] = np.hstack([points, x[samples[here]], np.tile(said, (len(points), 1))])
        names = tuple(f"column {number}" for number in range(rows.shape[1]))
        return LearningSet(rows, table.iloc[samples].reset_index(drop=True), names)


def _flat(references: "References") -> Float[np.ndarray, " column"]:
    """References as one row: speed [rpm], load [N m], number and mean observation of every operating point."""
    points = np.array([[point.n_in_rpm, point.T_out] for point in references.points])
    return np.column_stack([points, references.count, references.mean]).ravel()
