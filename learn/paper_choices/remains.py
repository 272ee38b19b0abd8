"""What the fitted values leave of the differences to the paper, and how near any set of choices comes."""

import pandas as pd

from learn.paper.paper_page import ROMAN
from learn.paper.published_tables import CELL
from learn.paper_choices.evaluation import Tables
from learn.paper_choices.outcome import Outcome, rank_correlation

GROUP = ["table", "features", "classifier"]


def rests(outcome: Outcome) -> pd.DataFrame:
    """The mean difference of each classifier on each selection.

    Returns
    -------
    DataFrame
        Of each ``table``, ``features`` and ``classifier``, the largest first. ``difference``: mean of ours - paper;
        ``adds``: to the mean absolute difference of the table; ``nearest``: the mean difference that is nearest to zero
        among all trials (all in points).
    """
    now = _differences(outcome.after)
    tried = pd.concat({
        number: _differences(trial.tables).groupby(GROUP).mean() for number, trial in enumerate(outcome.trials)
    }, axis=1)  # fmt: skip
    number_of_cells = now.groupby("table").transform("size")
    found = pd.DataFrame({
        "difference": now.groupby(GROUP).mean(),
        "adds": (now.abs() / number_of_cells).groupby(GROUP).sum(),
        "nearest": tried.apply(lambda row: min(row.dropna(), key=abs), axis=1),
    })  # fmt: skip
    return found.sort_values("difference", key=lambda column: -column.abs()).reset_index()


def _differences(tables: Tables) -> pd.Series:
    """Ours less the paper's of every cell [points]."""
    cells = pd.concat({name: table.figures.set_index(CELL) for name, table in tables.items()}, names=["table"])
    return cells["ours"] - cells["paper"]


def sentences(outcome: Outcome, found: pd.DataFrame) -> list[str]:
    """By what Tables IX and X and the order of the classifiers stay away from the paper's."""
    rows = pd.Series({
        f"Table {ROMAN[name]}, {row.capitalize()}": rho
        for name, table in outcome.after.items()
        for row, rho in table.rank_correlation.items()
    })  # fmt: skip
    least = ", ".join(f"{row} ({rho:.1f})" for row, rho in rows.sort_values().head(3).items())
    drawn = max((trial.tables for trial in outcome.trials if trial.sampled), key=rank_correlation)
    return [
        _of_table("table9", outcome, found),
        _of_table("table10", outcome, found),
        f"The order of the classifiers agrees by {rank_correlation(outcome.after):.2f}, least in {least}. Of the drawn "
        f"sets the best agrees by {rank_correlation(drawn):.2f}, with {_errors(drawn)} points off.",
    ]


def _of_table(table: str, outcome: Outcome, found: pd.DataFrame) -> str:
    """Where its error is, and what the nearest of all sets of choices does to the other tables."""
    own = found[found["table"] == table]
    adds = own.groupby("features")["adds"].sum()
    there = own[own["features"] == adds.idxmax()].to_dict("records")
    ours = ", ".join(f"{each['classifier'].upper()} {each['difference']:+.0f}" for each in there)
    known = [trial.tables for trial in outcome.trials if table in trial.scores]
    nearest = min(known, key=lambda tables: tables[table].mean_absolute_difference)
    first, off = there[0], outcome.after[table].mean_absolute_difference
    return (
        f"Table {ROMAN[table]} stays {off:.1f} points off, {adds.max():.1f} of them on "
        f"{first['features'].replace('_', ' ').capitalize()}: {ours} points. Of {len(known)} sets of choices, the "
        f"best leaves {round(first['nearest']) + 0:+} of the first of these; the one nearest to the whole table has "
        f"{_errors(nearest)} points off."
    )


def _errors(tables: Tables) -> str:
    return ", ".join(f"{ROMAN[name]} {table.mean_absolute_difference:.1f}" for name, table in tables.items())
