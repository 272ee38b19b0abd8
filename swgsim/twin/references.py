"""What the healthy references of a gear say: the mean observation at every operating point."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from swgsim.gear.gear import OperatingPoint
from swgsim.oracle.model import observations
from swgsim.storage.labelled_signals import LabelledSignals


@dataclass(frozen=True, eq=False)
class References:
    """Means of the reference acquisitions of one gear.

    Attributes
    ----------
    points : tuple of OperatingPoint
    mean : array (point, feature)
        Mean observation (:func:`swgsim.oracle.model.observations`).
    count : array (point,)
        Number of acquisitions at each operating point.
    """

    points: tuple[OperatingPoint, ...]
    mean: Float[np.ndarray, "point feature"]
    count: Float[np.ndarray, " point"]

    @classmethod
    def of(cls, recordings: LabelledSignals) -> "References":
        """The references among recordings of one gear; all other recordings are ignored.

        Raises
        ------
        ValueError
            If there is none, or they are of several gears.
        """
        references = recordings.references
        gears = references.table["gear"].unique().tolist()
        if len(gears) != 1:
            raise ValueError(
                f"references of {len(gears)} gears {gears}, a twin has those of one: give the recordings of one gear, "
                "with reference = 1 where it is healthy"
            )
        return cls.of_observations(observations(references), references.table)

    @classmethod
    def of_observations(cls, x: Float[np.ndarray, "reference feature"], table: pd.DataFrame) -> "References":
        """The references of one gear, given their observations and facts."""
        points, of_row, count = np.unique(
            table[["n_in_rpm", "T_out_nm"]].to_numpy(), axis=0, return_inverse=True, return_counts=True
        )
        mean = np.array([x[of_row.ravel() == number].mean(axis=0) for number in range(len(points))])
        return cls(tuple(OperatingPoint(*point) for point in points.tolist()), mean, count.astype(float))
