"""Healthy reference of every gear at every operating point, by which eq. (7) divides."""

import numpy as np
import pandas as pd
from jaxtyping import Float

from learn.inputs.inputs import OPERATING_POINT

HEALTHY = ["gear", *OPERATING_POINT]  # identify a reference


def healthy_reference(
    values: Float[np.ndarray, "reference feature"], references: pd.DataFrame, samples: pd.DataFrame
) -> Float[np.ndarray, "sample feature"]:
    """Mean of the reference acquisitions of each sample's gear and operating point.

    References are separate acquisitions that are neither used for training nor for tests. The target gear has them too,
    as eq. (7) of the paper assumes: they are its commissioning.

    Parameters
    ----------
    values : array (reference, feature)
        Features of the reference acquisitions.
    references, samples : DataFrame
        Facts of the references and of the samples.

    Returns
    -------
    array (sample, feature)
        The mean is taken about the first acquisition, so equal acquisitions give exactly their common value. The
        fourth root of eq. (9) would turn a rounding error of 1e-16 into 1e-4.

    Raises
    ------
    ValueError
        If a gear has no reference at an operating point of its samples.
    """
    operating_point = pd.MultiIndex.from_frame(references[HEALTHY])
    known = operating_point.unique()
    group = known.get_indexer(operating_point)
    wanted = known.get_indexer(pd.MultiIndex.from_frame(samples[HEALTHY]))
    if (wanted < 0).any():
        gear, speed, load = samples.iloc[int(np.argmin(wanted))][HEALTHY]
        raise ValueError(
            f"gear {gear:g} has no healthy reference at {speed:g} rpm and {load:g} N m: record at least one "
            "acquisition with reference = 1 for every gear and operating point"
        )
    _, first, count = np.unique(group, return_index=True, return_counts=True)
    deviation = np.zeros((len(known), values.shape[1]))
    np.add.at(deviation, group, values - values[first][group])
    return (values[first] + deviation / count[:, None])[wanted]
