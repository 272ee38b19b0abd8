"""Decisions on a unit, which has several recordings: the product of their posteriors."""

import pandas as pd

from learn.evaluation.decisions import probabilities, truth
from learn.inputs.inputs import SPECIMEN
from learn.methods.product import product
from swgsim.storage.labelled_signals import CLASSES


def units(predictions: pd.DataFrame) -> pd.DataFrame:
    """A table of predictions with one row per specimen, from the recordings of each.

    Parameters
    ----------
    predictions : DataFrame
        As :mod:`learn.evaluation.decisions` has it.
    """
    table = predictions[[*SPECIMEN, "severity"]].assign(label=truth(predictions))
    number = table.groupby(list(SPECIMEN)).ngroup().to_numpy()
    posterior = pd.DataFrame(product(probabilities(predictions), number), table.index, list(CLASSES))
    return table.join(posterior).drop_duplicates(list(SPECIMEN), ignore_index=True)
