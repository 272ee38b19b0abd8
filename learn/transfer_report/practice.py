"""The section of the report that a practitioner reads: what the best method finds and how far it can be trusted."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from learn.evaluation.decisions import class_numbers, probabilities
from learn.evaluation.detection import detected, false_alarm_rate, recall_by_cell, worst_cell
from learn.evaluation.probability_calibration import (
    expected_calibration_error,
    negative_log_likelihood,
    reliability,
    tempered_by_others,
)
from learn.evaluation.selective import area_under_risk, coverage_at, risk_coverage
from learn.transfer_report import heat_figures
from learn.transfer_report import judging_figures as figures
from learn.transfer_report.carried import Carried, costliest, lines_said, physics_checked
from learn.transfer_report.judging import conformal, found_sizes
from learn.transfer_report.novelty import FEWEST_GEARS, Novelty
from learn.transfer_report.novelty_figure import novelty_beside_error
from learn.transfer_report.sentences import number
from learn.transfer_report.transfer_page import Listed, Section, Table
from swgsim.common.style import words

NOMINAL = 0.9


def section(
    best: str, predictions: Mapping[str, pd.DataFrame], novelty: Novelty | None, refitted: str, carried: Carried
) -> Section:
    """What a practitioner reads.

    Parameters
    ----------
    best : str
        The method to look at.
    predictions : mapping
        Method or oracle to its table of predictions; all are judged for calibration and selective decisions.
    novelty : Novelty or None
        Of the judged gears, with the errors of `best`; None with too few gears.
    refitted : str
        Method whose features were permuted.
    carried : Carried
    """
    chosen = predictions[best]
    alarms = false_alarm_rate(chosen)
    worst = worst_cell(chosen)
    curves = {name: _risk(table) for name, table in predictions.items()}
    bins = {name: reliability(probabilities(table), class_numbers(table)) for name, table in predictions.items()}
    return Section(
        "practice",
        "What a practitioner reads",
        [
            f"All of this is {best}, level Z1, on gears never seen.",
            Table(
                ["fault", "taken for any fault [%]", "a90", "a90/95", "where a size is not given"],
                found_sizes(chosen),
                "a90: size of which 90 % of recordings are found; a90/95: the same with 95 % confidence. Sizes as "
                "in the picture below, in SI units or as a share.",
                left=5,
            ),
            figures.pod_curves(chosen, detected(chosen)),
            f"False alarms: {number(alarms['rate'], alarms['low'], alarms['high'], unit=' %')} of healthy "
            f"recordings, in {alarms['alarming_gears']:.0f} of {alarms['gears']:.0f} gears. Worst cell: "
            f"{words(str(worst['label']))} at {worst['n_in_rpm']:g} rpm and {worst['T_out_nm']:g} N m, "
            f"{worst['recall']:.1f} % of {worst['recordings']} recordings recognised.",
            heat_figures.cell_recall(recall_by_cell(chosen)),
            _calibration(predictions, bins, curves),
            figures.reliability_diagram(bins),
            figures.risk_coverage_curves(curves),
            _sets(chosen),
            *_novelty(novelty, best),
            f"Which features carry which fault: {refitted}, trained anew, on the {carried.gears} gears of the first "
            "fold. One group of features at a time is exchanged between recordings of a fault and healthy ones at the "
            "same operating point. Named is what costs more than twice the standard error of these exchanges; other "
            "gears may differ by more.",
            heat_figures.importance_map(carried.groups),
            Listed(physics_checked(carried.groups)),
            heat_figures.line_map(costliest(carried.lines)),
            Listed(lines_said(carried.lines)),
        ],
    )


def _risk(predictions: pd.DataFrame) -> pd.DataFrame:
    said = probabilities(predictions)
    return risk_coverage(said.max(axis=1), said.argmax(axis=1) == class_numbers(predictions))


def _calibration(
    predictions: Mapping[str, pd.DataFrame], bins: Mapping[str, pd.DataFrame], curves: Mapping[str, pd.DataFrame]
) -> Table:
    """Calibration error and likelihood without and with a temperature, and what can be decided, per method."""
    rows = []
    for name, table in predictions.items():
        said, y = probabilities(table), class_numbers(table)
        rows.append([
            name,
            f"{expected_calibration_error(bins[name]):.1f}",
            f"{negative_log_likelihood(said, y):.2f}",
            *_tempered(said, y, table["gear"].to_numpy()),
            f"{100 * area_under_risk(curves[name]):.1f}",
            f"{100 * coverage_at(curves[name], 0.05):.0f}",
            f"{100 * coverage_at(curves[name], 0.01):.0f}",
        ])  # fmt: skip
    return Table(
        ["method", "calibration error [points]", "negative log-likelihood [nat]", "temperatures",
         "calibration error with temperature", "negative log-likelihood with temperature",
         "area under risk and coverage [%]", "decided at 5 % error [%]", "decided at 1 % error [%]"], rows,
        "Probabilities as each method gives them, and with one temperature per gear that was fitted (highest "
        "likelihood) to the predictions on all the other judged gears, none to its own; models of other folds have "
        "learnt from the gear, though. A temperature above 1 makes probabilities more even, decisions stay. The last "
        "three columns are without a temperature.",
    )  # fmt: skip


def _tempered(said: Float[np.ndarray, "row class"], y: Int[np.ndarray, " row"], gears: np.ndarray) -> list[str]:
    """The temperatures, and calibration error and likelihood with them; nothing for a single gear."""
    if len(np.unique(gears)) < 2:
        return ["-", "-", "-"]
    tempered, temperatures = tempered_by_others(said, y, gears)
    return [
        f"{temperatures.min():.2f} to {temperatures.max():.2f}",
        f"{expected_calibration_error(reliability(tempered, y)):.1f}",
        f"{negative_log_likelihood(tempered, y):.2f}",
    ]


def _novelty(novelty: Novelty | None, best: str) -> list:
    """Whether a gear shows that it is not known."""
    if novelty is None:
        return [f'Saying "I do not know this gear" takes {FEWEST_GEARS} gears at least, and there are fewer.']
    return [novelty.sentences(best), novelty_beside_error(novelty, best)]


def _sets(predictions: pd.DataFrame) -> str:
    """Coverage and size of conformal sets, in words."""
    sets = conformal(predictions, NOMINAL)
    if sets["mean_size"].min() >= len(predictions["label"].unique()):
        return f"Sets of classes: {len(sets)} gears are too few to aim at {100 * NOMINAL:.0f} %, every set holds all."
    spread = f"{100 * sets['coverage'].min():.0f} to {100 * sets['coverage'].max():.0f} %"
    return (
        f"Sets of classes that shall hold the truth in {100 * NOMINAL:.0f} % of recordings of a new gear, the "
        f"threshold of every gear from the other {len(sets) - 1} (cross-conformal: models of other folds have learnt "
        f"from the gear, so this is a target, not a promise): they hold it in {100 * sets['coverage'].mean():.1f} % "
        f"({spread} in single gears), with {sets['mean_size'].mean():.2f} classes on average and "
        f"{100 * np.mean(sets['empty']):.1f} % of sets without a class."
    )
