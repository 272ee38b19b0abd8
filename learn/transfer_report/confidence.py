"""Detection of every fault, calibration and abstention of methods, and novelty of gears."""

from collections.abc import Mapping
from pathlib import Path
from typing import cast

import numpy as np
import pandas as pd

from learn.evaluation.decisions import class_numbers, probabilities
from learn.evaluation.detection import detection_table, false_alarm_rate, worst_cell
from learn.evaluation.probability_calibration import (
    expected_calibration_error,
    negative_log_likelihood,
    reliability,
    tempered_by_others,
)
from learn.evaluation.selective import (
    area_under_risk,
    conformal_threshold,
    coverage_at,
    gear_novelty,
    novelty_auroc,
    novelty_left_out,
    prediction_sets,
    risk_coverage,
    set_figures,
)
from learn.inputs.references import HEALTHY
from learn.protocols.fault_size import UNITS
from learn.transfer_report.tables import number
from swgsim.common.style import words
from swgsim.storage import storage
from swgsim.storage.orders import lines_of

NOMINAL = 0.9  # coverage at which prediction sets aim
BLOCK = 1024  # recordings in memory at a time
COMPARED_ORDERS = 4  # orders of the kinematic error and of the ellipse's deflection, which differ between gears
FEWEST_GEARS = 4  # one left out of three


def detection_text(predictions: pd.DataFrame) -> pd.DataFrame:
    """Share of every fault that is taken for any fault, and the sizes found in 90 % of recordings."""
    table = detection_table(predictions)
    units = [UNITS.get(label, "") for label in table["label"]]
    sizes = {
        name.replace("_", "/"): [
            "-" if np.isnan(size) else f"{size:.3g}{unit}" for size, unit in zip(table[name], units, strict=True)
        ]
        for name in ("a90", "a90_95")
    }
    reasons = [text.replace("a90_95", "a90/95") for text in table["reason"]]
    columns = {"detected [%]": [number(hits) for hits in table["hits"]], **sizes, "reason without a size": reasons}
    return pd.DataFrame(columns, index=pd.Index([words(label) for label in table["label"]], name="fault"))


def alarms_text(predictions: pd.DataFrame) -> str:
    """False alarms, and the operating point and class with the smallest share of right decisions."""
    alarms, worst = false_alarm_rate(predictions), worst_cell(predictions)
    return (
        f"False alarms: {number(alarms['rate'], alarms['low'], alarms['high'], unit=' %')} of healthy recordings, in "
        f"{alarms['alarming_gears']:.0f} of {alarms['gears']:.0f} gears. The worst combination of class and operating "
        f"point is {words(str(worst['label']))} at {worst['n_in_rpm']:g} rpm and {worst['T_out_nm']:g} N m: "
        f"{worst['recall']:.1f} % of {worst['recordings']} recordings are recognised."
    )


def reliabilities(predictions: Mapping[str, pd.DataFrame]) -> dict[str, pd.DataFrame]:
    """Confidence and accuracy in bins, of every method."""
    return {name: reliability(probabilities(table), class_numbers(table)) for name, table in predictions.items()}


def risk_curves(predictions: Mapping[str, pd.DataFrame]) -> dict[str, pd.DataFrame]:
    """Error among the most confident recordings against their share, of every method."""
    curves = {}
    for name, table in predictions.items():
        p = probabilities(table)
        curves[name] = risk_coverage(p.max(axis=1), p.argmax(axis=1) == class_numbers(table))
    return curves


def calibration_text(predictions: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Calibration without and with a temperature, and the shares of recordings that can be decided, per method."""
    curves, rows = risk_curves(predictions), {}
    for name, table in predictions.items():
        p, y, gears = probabilities(table), class_numbers(table), table["gear"].to_numpy()
        tempered, temperatures = tempered_by_others(p, y, gears) if len(np.unique(gears)) > 1 else (None, None)
        rows[name] = {
            "calibration error [points]": number(expected_calibration_error(reliability(p, y))),
            "negative log-likelihood [nat]": number(negative_log_likelihood(p, y), digits=2),
            "temperatures": "-" if temperatures is None else f"{temperatures.min():.2f} to {temperatures.max():.2f}",
            "calibration error with temperature [points]": (
                "-" if tempered is None else number(expected_calibration_error(reliability(tempered, y)))
            ),
            "negative log-likelihood with temperature [nat]": (
                "-" if tempered is None else number(negative_log_likelihood(tempered, y), digits=2)
            ),
            "area under risk and coverage [%]": number(100 * area_under_risk(curves[name])),
            "decided at 5 % error [%]": number(100 * coverage_at(curves[name], 0.05), digits=0),
            "decided at 1 % error [%]": number(100 * coverage_at(curves[name], 0.01), digits=0),
        }
    return pd.DataFrame(rows).T.rename_axis("method")


def conformal(predictions: pd.DataFrame) -> pd.DataFrame:
    """Coverage and size of the prediction sets of every gear, with the threshold of all the other gears.

    Models of other folds may have been trained on the gear, so :data:`NOMINAL` is a target without guarantee.
    """
    p, y, gears = probabilities(predictions), class_numbers(predictions), predictions["gear"].to_numpy()
    parts = []
    for gear in np.unique(gears):
        here = gears == gear
        threshold = conformal_threshold(p[~here], y[~here], gears[~here], NOMINAL)
        parts.append(set_figures(prediction_sets(p[here], threshold), y[here], gears[here]))
    return pd.concat(parts)


def sets_text(predictions: pd.DataFrame) -> str:
    """Coverage and size of the prediction sets."""
    sets = conformal(predictions)
    if sets["mean_size"].min() >= len(predictions["label"].unique()):
        return f"Prediction sets: {len(sets)} gears are too few for a coverage of {100 * NOMINAL:.0f} %."
    coverage = 100 * sets["coverage"]
    return (
        f"Prediction sets with a target coverage of {100 * NOMINAL:.0f} %: the threshold of every gear comes from the "
        f"other {len(sets) - 1} gears. The sets contain the true class in {coverage.mean():.1f} % of recordings "
        f"({coverage.min():.0f} to {coverage.max():.0f} % in single gears). They have {sets['mean_size'].mean():.2f} "
        f"classes on average; {100 * np.mean(sets['empty']):.1f} % are empty."
    )


def healthy_means(path: Path) -> pd.DataFrame:
    """Means of the reference acquisitions of every gear (rows), the operating points next to each other (columns).

    Values are real and imaginary parts of the order lines of all gauges [mV/V], and the efficiency [-].
    """
    lines, facts = [], []
    for block in storage.blocks(path, BLOCK):
        references = block.where(block.table["reference"])
        if len(references):
            lines.append(lines_of(references, COMPARED_ORDERS).reshape(len(references), -1))
            facts.append(references.table)
    table, every = pd.concat(facts, ignore_index=True), np.concatenate(lines)
    values = np.column_stack([every.real, every.imag, table["efficiency"]])
    means = pd.DataFrame(values).groupby([table[name] for name in HEALTHY]).mean()
    return cast(pd.DataFrame, means.unstack([1, 2]))


def novelty(bench: Path, far: Path, errors: pd.Series) -> tuple[pd.DataFrame, pd.Series | None] | None:
    """Novelty of the judged gears and of gears of another population.

    Parameters
    ----------
    bench, far : Path
        Data sets; `far` need not exist.
    errors : Series
        Error of every judged gear [%], by its number.

    Returns
    -------
    DataFrame
        ``novelty`` of every judged gear against all other gears, and its ``error`` [%].
    Series or None
        Novelty of far gears; None without far gears at the same operating points.

    The result is None if there are too few gears to leave one out.
    """
    known = healthy_means(bench)
    if len(known) < FEWEST_GEARS:
        return None
    usual = pd.Series(novelty_left_out(known.to_numpy()), known.index, name="novelty")
    table = pd.DataFrame({"novelty": usual, "error": errors}).loc[errors.index]
    other = healthy_means(far) if far.is_file() else None
    if other is None or not other.columns.equals(known.columns):
        return table, None
    return table, pd.Series(gear_novelty(known.to_numpy(), other.to_numpy()), other.index)


def novelty_text(found: tuple[pd.DataFrame, pd.Series | None] | None, method: str) -> str:
    """Result of :func:`novelty`, with the rank correlation of novelty and the error of a method."""
    from scipy.stats import spearmanr

    if found is None:
        return f"Novelty needs at least {FEWEST_GEARS} gears; this data set has fewer."
    usual, foreign = found
    largest = usual["novelty"].max()
    text = f"Novelty of the {len(usual)} judged gears: {usual['novelty'].min():.2f} to {largest:.2f}. "
    if foreign is None:
        text += "Far gears (far-bench) at the same operating points are missing, so there is no comparison. "
    else:
        auroc = novelty_auroc(usual["novelty"].to_numpy(), foreign.to_numpy())
        text += (
            f"Novelty of the {len(foreign)} gears of grid=far: {foreign.min():.2f} to {foreign.max():.2f}; "
            f"{(foreign > largest).sum()} of them exceed all judged gears. A far gear scores above a judged gear with "
            f"a probability (AUROC) of {auroc:.2f}. "
        )
    if (usual.nunique() < 2).any():
        return f"{text}All gears are equal, so there is no correlation with the error of {method}."
    rank, p = spearmanr(usual["novelty"], usual["error"])
    verb = "correlates" if rank > 0 and p < 0.05 else "does not clearly correlate"
    return f"{text}Novelty {verb} with the error of {method} (Spearman's rank correlation {rank:+.2f}, p = {p:.2f})."
