"""Decisions on a unit, which has several recordings: the product of their posteriors."""

import numpy as np
import pandas as pd
from scipy.special import softmax

from learn.evaluation.decisions import probabilities
from learn.evaluation.probability_calibration import SMALLEST
from learn.inputs.inputs import SPECIMEN
from swgsim.storage.labelled_signals import CLASSES


def units(predictions: pd.DataFrame) -> pd.DataFrame:
    """A table of predictions with one row per specimen, from the recordings of each.

    Classes are equally frequent, so that the posterior of independent recordings is the product of theirs. Recordings
    of a session share the bias of the torque flanges, which this ignores: the product is too sure of itself.

    Parameters
    ----------
    predictions : DataFrame
        As :mod:`learn.evaluation.decisions` has it; probabilities below 1e-6 count as 1e-6, since a forest may give a
        class no vote.
    """
    logarithm = np.log(np.maximum(probabilities(predictions), SMALLEST))
    of_unit = predictions[[*SPECIMEN, "severity"]].assign(**dict(zip(CLASSES, logarithm.T, strict=True)))
    of_unit["label"] = of_unit["label"].astype(str)
    grouped = of_unit.groupby(list(SPECIMEN), sort=False)
    together = grouped[list(CLASSES)].sum()
    posterior = together.apply(softmax, axis=1, raw=True)
    return posterior.assign(severity=grouped["severity"].first()).reset_index()
