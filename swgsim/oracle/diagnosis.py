"""A diagnosis: probability of every class, with severity and position of the likeliest fault."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from jaxtyping import Float

from swgsim.oracle.cells import Partition
from swgsim.oracle.point import PointModel
from swgsim.oracle.severity import Severities, positions
from swgsim.storage.labelled_signals import CLASSES

# Ends of the interval of a severity: 95 %.
ENDS = (0.025, 0.975)
FOUND = ("severity", "severity_low", "severity_high", "position", "position_deviation")


def diagnosis(
    model: PointModel, partitions: Mapping[str, Partition], x: Float[np.ndarray, "sample feature"]
) -> pd.DataFrame:
    """What observations say, one row each.

    Returns
    -------
    DataFrame
        One column per class with its probability; ``severity``, the median, with the ends of its 95 % interval, and
        ``position`` [rad] with its circular standard deviation, of the likeliest class. They are NaN if that class is
        healthy, and the position where the class has none.
    """
    probabilities = np.exp(model.log_posterior(x))
    table = pd.DataFrame(probabilities, columns=list(CLASSES))
    likeliest = np.array(CLASSES)[probabilities.argmax(axis=1)]
    table[list(FOUND)] = np.nan
    for label, partition in partitions.items():
        rows = np.flatnonzero(likeliest == label)
        if len(rows):
            places = model.places(x[rows], label)
            severities = Severities.of(partition, places)
            found = [severities.quantile(each) for each in (0.5, *ENDS)]
            where = positions(partition, places) if partition.positions > 1 else (np.nan, np.nan)
            for name, values in zip(FOUND, [*found, *where], strict=True):
                table.loc[rows, name] = values
    return table
