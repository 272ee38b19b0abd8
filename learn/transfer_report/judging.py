"""What a practitioner asks of the best method: what it finds, and sets of classes that hold the truth."""

import numpy as np
import pandas as pd

from learn.evaluation.decisions import class_numbers, probabilities
from learn.evaluation.detection import detected as taken_for_a_fault
from learn.evaluation.detection import detection_table
from learn.evaluation.selective import conformal_threshold, prediction_sets, set_figures
from learn.protocols.fault_size import UNITS
from swgsim.common.style import words


def found_sizes(predictions: pd.DataFrame) -> list[tuple[str, ...]]:
    """Per fault: share taken for any fault, and the sizes found in 90 % of recordings, without and with confidence."""
    rows = []
    for row in detection_table(predictions, taken_for_a_fault(predictions), by=()).to_dict("records"):
        unit = UNITS.get(row["label"], "")
        sizes = ["-" if np.isnan(row[name]) else f"{row[name]:.3g}{unit}" for name in ("a90", "a90_95")]
        why = [text.replace("_", "/") for text in str(row["reason"]).split("; ") if not text.startswith("a50")]
        rows.append((words(row["label"]), f"{row['hits']:.1f}", *sizes, "; ".join(why)))
    return rows


def conformal(predictions: pd.DataFrame, nominal: float) -> pd.DataFrame:
    """Figures of the prediction sets of every gear, each with the threshold that all the other gears give.

    The models that judge the others may have learnt from the gear, so `nominal` is aimed at and not promised.
    """
    said, y, gears = probabilities(predictions), class_numbers(predictions), predictions["gear"].to_numpy()
    parts = []
    for gear in np.unique(gears):
        here = gears == gear
        threshold = conformal_threshold(said[~here], y[~here], gears[~here], nominal)
        parts.append(set_figures(prediction_sets(said[here], threshold), y[here], gears[here]))
    return pd.concat(parts)
