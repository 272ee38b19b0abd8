"""The first lines of the report of the transfer study: sentences made of the numbers, whichever way they fall."""

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd

from learn.transfer_report.results import (
    FOREST,
    FROM_SCRATCH,
    ORACLE,
    ORACLE_OF_SESSION,
    ZeroShot,
    best_adapted,
    clear,
    figure,
    highest,
    least,
    row_of,
)
from learn.transfer_report.studies import PAPER_FOREST, best_disturbed

DISTURBED_GOAL = 99.5  # %
FOREST_GOAL, ORACLE_GOAL, SHOTS_GOAL = 1 / 3, 1.5, 1 / 5
GOAL_SHOTS = 5
FORGETTING_GOAL = 2.0  # points
SIMPLE = "logistic regression on harmonics"
NETWORK = "MLP on harmonics"


class Goal(NamedTuple):
    """A goal of the study: whether it was reached, and the sentence with its numbers."""

    reached: bool
    sentence: str


def number(value: float, low: float = np.nan, high: float = np.nan, digits: int = 1, unit: str = "") -> str:
    """A figure with its interval, which is left out where there is none.

    >>> number(12.34, 10.0, 15.0, unit=" %"), number(0.5, digits=2)
    ('12.3 % (10.0 to 15.0)', '0.50')
    """
    if np.isnan(value):
        return "-"
    known = np.isfinite(low) and np.isfinite(high)
    return f"{value:.{digits}f}{unit}" + (f" ({low:.{digits}f} to {high:.{digits}f})" if known else "")


def listed(names: Iterable[str]) -> str:
    """Names in one line.

    >>> listed(["a", "b", "c"]), listed([])
    ('a, b and c', 'none')
    """
    *first, last = list(names) or ["none"]
    return f"{', '.join(first)} and {last}" if first else last


def of_row(row: Mapping[str, float] | pd.Series, prefix: str = "", digits: int = 1, unit: str = "") -> str:
    """The figure and interval of a row of a table of results."""
    value = row[prefix.removesuffix("_") or "value"]
    return number(value, row[f"{prefix}low"], row[f"{prefix}high"], digits, unit)


def goals(cases: pd.DataFrame, zero: ZeroShot, few: pd.DataFrame, forgotten: pd.DataFrame) -> list[Goal]:
    """All goals of the study with what was reached."""
    found = [disturbed(cases), against_forest(zero), against_oracle(zero)]
    with_shots = with_few_shots(zero, few)
    lost = forgetting(few, forgotten)
    return [*found, *([with_shots] if with_shots else []), *([lost] if lost else [])]


def disturbed(cases: pd.DataFrame) -> Goal:
    """Z1 on the paper's disturbed data."""
    best = best_disturbed(cases)

    def accuracies(name: str) -> str:
        return " / ".join(f"{value:.1f}" for value in cases.loc[name])

    return Goal(
        bool((cases.loc[best] >= DISTURBED_GOAL).all()),
        f"The paper's disturbed data, healthy reference known (Z1): {best} recognises {accuracies(best)} % on the "
        f"gear left out; the paper's forest {accuracies(cases.index[0])} % in the paper and "
        f"{accuracies(PAPER_FOREST)} % here. Goal: {DISTURBED_GOAL:g} % in all three cases.",
    )


def against_forest(zero: ZeroShot) -> Goal:
    """Z1 on the bench beside the paper's forest."""
    best, forest = row_of(zero.table, zero.best), row_of(zero.table, FOREST)
    return Goal(
        bool(best["ratio"] <= FOREST_GOAL) if zero.best != FOREST else False,
        f"New gears on the bench, healthy reference known (Z1): {zero.best} errs in {of_row(best, unit=' %')} of the "
        f"recordings of {zero.gears} gears, the paper's forest in {of_row(forest, unit=' %')}: "
        f"{of_row(best, 'ratio_', 2)} of its error. Goal: at most one third.{_oracle_above(zero, FOREST_GOAL, ORACLE)}",
    )


def against_oracle(zero: ZeroShot) -> Goal:
    """Z1 on the bench beside the oracle."""
    best, oracle = row_of(zero.table, zero.best), row_of(zero.table, ORACLE)
    return Goal(
        bool(best["oracle"] <= ORACLE_GOAL),
        "The oracle, which knows the gear, the faults and the statistics of the bench, errs in "
        f"{of_row(oracle, unit=' %')}; {zero.best} makes {of_row(best, 'oracle_', 2)} times its errors. Goal: at "
        f"most {ORACLE_GOAL:g} times.",
    )


def with_few_shots(zero: ZeroShot, few: pd.DataFrame) -> Goal | None:
    """Z3 with five shots beside the forest without transfer; None if none was run with so many."""
    best = best_adapted(few, GOAL_SHOTS)
    if best is None:
        return None
    return Goal(
        bool(best["ratio"] <= SHOTS_GOAL),
        f"With {GOAL_SHOTS} labelled specimens per class (Z3), {best['method']} errs in {of_row(best, unit=' %')}, "
        f"{of_row(best, 'ratio_', 2)} of the error of the paper's forest without transfer. Goal: at most one "
        f"fifth.{_oracle_above(zero, SHOTS_GOAL, ORACLE_OF_SESSION)}",
    )


def _oracle_above(zero: ZeroShot, goal: float, oracle: str) -> str:
    """Why a ratio to the forest is out of reach, where it is so for the oracle that knows what the method may know."""
    floor = figure(zero.table, oracle, "ratio")
    if floor <= goal:
        return ""
    return f" The {oracle} is at {floor:.2f}: what the goal asks for is not in the signals of single recordings."


def forgetting(few: pd.DataFrame, forgotten: pd.DataFrame) -> Goal | None:
    """What the best method with five shots forgets; None if none was run with so many, or it was not measured."""
    best = best_adapted(few, GOAL_SHOTS)
    if best is None:
        return None
    lost = forgotten[(forgotten["method"] == best["method"]) & (forgotten["shots"] > 0)]["forgotten"].dropna()
    if lost.empty:
        return None
    every = forgotten[forgotten["shots"] == GOAL_SHOTS].set_index("method")["forgotten"]
    over = list(every.index[every > FORGETTING_GOAL])
    return Goal(
        bool(lost.max() <= FORGETTING_GOAL),
        f"Adapted to a new gear, {best['method']} loses at most {lost.max():.1f} points on the source gears (mean "
        f"over the gears, at any number of shots). Goal: {FORGETTING_GOAL:g} points. With {GOAL_SHOTS} shots these "
        f"methods lose more: {listed(over)}.",
    )


def chosen_by(zero: ZeroShot, development: pd.Series, few: pd.DataFrame) -> list[str]:
    """What the choice of the best method costs, and what the development gears would have chosen."""
    best = figure(zero.table, zero.best)
    sentences = [
        "The best methods above are named by the judged gears themselves; to be the smallest of several errors "
        "flatters them a little."
    ]
    if zero.chosen:
        error = figure(zero.table, zero.chosen)
        same = "the same one" if zero.chosen == zero.best else f"{error - best:.1f} points more than the best"
        sentences.append(
            f"The development gears, which are never judged, choose {zero.chosen} without adaptation: {error:.1f} %, "
            f"{same}."
        )
    with_shots = few[few["shots"] == GOAL_SHOTS]
    adapted = highest(development[development.index.isin(with_shots["method"])])
    here = with_shots[with_shots["method"] == adapted]
    if len(here):
        sentences.append(
            f"Among the adapted methods they choose {adapted}: {of_row(here.iloc[0], unit=' %')} with {GOAL_SHOTS} "
            "shots."
        )
    return sentences


def fancy_against_simple(zero: ZeroShot, networks: pd.DataFrame, few: pd.DataFrame) -> list[str]:
    """Where a fancy method does not beat the simple one."""
    sentences = []
    if SIMPLE in zero.methods.index:
        others = [m for m in zero.methods.index if m.endswith(" on harmonics") and m != SIMPLE]
        if others:
            beside = pd.DataFrame({m: zero.difference(m, SIMPLE) for m in others}).T
            sentences.append(_sorted_out(beside, f"Beside {SIMPLE}"))
    classical = [m for m in zero.methods.index if m not in (NETWORK, FOREST)]
    if NETWORK in zero.methods.index and classical:
        simple = str(zero.methods.loc[classical, "value"].idxmin())
        row = zero.difference(NETWORK, simple)
        verb = "clearly beats" if row["high"] < 0 else "does not clearly beat"
        sentences.append(f"{NETWORK} {verb} {simple}: {of_row(row)} points of difference.")
    if len(networks):
        sentences.append(_sorted_out(networks, "Beside the MLP on the same input, with efficiency"))
    for shots, name in ((0, "unlabelled recordings (Z2)"), (GOAL_SHOTS, f"{GOAL_SHOTS} labelled specimens (Z3)")):
        here = few[(few["shots"] == shots) & ~few["method"].str.endswith(FROM_SCRATCH)].set_index("method")
        if len(here):
            gains = here[["gain", "gain_low", "gain_high"]].set_axis(["value", "low", "high"], axis="columns")
            sentences.append(_sorted_out(gains, f"Beside its own source model, with {name}"))
    sentences.extend(_beside_no_transfer(zero, few))
    return sentences


def _beside_no_transfer(zero: ZeroShot, few: pd.DataFrame) -> list[str]:
    """The best transfer beside the best method without it, and beside training on the shots alone."""
    best = best_adapted(few, GOAL_SHOTS)
    if best is None:
        return []
    plain = figure(zero.table, zero.best)
    below = "below" if best["value"] < plain else "not below"
    sentences = [
        f"With {GOAL_SHOTS} shots the best transfer, {best['method']}, is at {best['value']:.1f} %, {below} the "
        f"{plain:.1f} % that {zero.best} reaches with no label of the gear at all."
    ]
    scratch = few[few["method"].str.endswith(FROM_SCRATCH)]
    for shots, here in scratch[scratch["shots"] > 0].groupby("shots"):
        transfer = best_adapted(few, int(str(shots)))
        alone = least(here, "value")
        if transfer is not None and alone["value"] <= transfer["value"]:
            sentences.append(
                f"From {shots} shots on, {alone['method']} ({alone['value']:.1f} %) needs no source gear to be as "
                f"good as the best transfer ({transfer['value']:.1f} %)."
            )
            break
    return sentences


def _sorted_out(table: pd.DataFrame, beside: str) -> str:
    """Which methods make clearly fewer errors and which do not."""
    better, others = (_with_value(table, names) for names in clear(table))
    return (
        f"{beside}, fewer errors (points; the whole 95 % interval, each comparison by itself, below 0): "
        f"{listed(better)}; not clearly: {listed(others)}."
    )


def _with_value(table: pd.DataFrame, names: Sequence[str]) -> list[str]:
    """Names with their difference."""
    return [f"{name} ({figure(table, name):+.1f})" for name in names]
