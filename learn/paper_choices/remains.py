"""What the fitted values leave of the differences to the paper, and why no choice takes it away."""

import numpy as np
import pandas as pd

from learn.paper.paper_page import ROMAN
from learn.paper.published_tables import CELL
from learn.paper_choices.choice import Choice
from learn.paper_choices.evaluation import FITTED, Tables
from learn.paper_choices.outcome import Outcome, rank_correlation

GROUP = ["table", "features", "classifier"]


def rests(outcome: Outcome, prior_weight: float) -> pd.DataFrame:
    """The mean difference of each classifier on each selection, and the choice that takes most of it.

    Returns
    -------
    DataFrame
        Of each ``table``, ``features`` and ``classifier``, the largest first. ``difference``: mean of ours - paper;
        ``adds``: to the mean absolute difference of the table (both in points). ``choice``: what takes most at an end
        of its range, by its slopes over the draws; ``why``: how much, and why it does not.
    """
    cells = pd.concat({name: table.figures.set_index(CELL) for name, table in outcome.after.items()}, names=["table"])
    difference, slopes = cells["ours"] - cells["paper"], outcome.effects.reindex(cells.index)
    now = outcome.fit.values
    ways = {
        (each, end): each.deviation(end) - each.deviation(now[each.name])
        for each in outcome.choices
        for end in (each.low, each.high)
    }
    rows = []
    for group, own in difference.groupby(GROUP):
        slope = slopes.loc[own.index].mean()
        left = {key: abs(own.mean() + way * slope[key[0].name]) for key, way in ways.items()}
        choice, end = min(left, key=lambda key: left[key])
        moved = (difference + ways[choice, end] * slopes[choice.name]).abs() - difference.abs()
        cost = prior_weight * (choice.cost(end) - choice.cost(now[choice.name]))
        cost += float(np.mean([moved.loc[table].mean() for table in FITTED]))
        adds = own.abs().sum() / len(difference.loc[own.index[0][0]])
        why = _why(choice, abs(own.mean()) - left[choice, end], cost)
        rows.append((*group, own.mean(), adds, choice.meaning, why))
    found = pd.DataFrame(rows, columns=[*GROUP, "difference", "adds", "choice", "why"])
    return found.sort_values("difference", key=lambda column: -column.abs())


def _why(choice: Choice, taken: float, cost: float) -> str:
    if not choice.fitted:
        return "is not fitted: Tables VIII and X alone depend on it, and they judge"
    worse = f"{abs(cost):.1f} points {'worse' if cost > 0 else 'better'}"
    return f"takes {taken:.0f} points at an end of its range, and makes the fit {worse}"


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
    """Where its error is, what could take it, and what the nearest of all sets of choices does to the other tables."""
    own = found[found["table"] == table]
    adds = own.groupby("features")["adds"].sum()
    there = own[own["features"] == adds.idxmax()].to_dict("records")
    ours = ", ".join(f"{each['classifier'].upper()} {each['difference']:+.0f}" for each in there)
    known = [trial.tables for trial in outcome.trials if table in trial.scores]
    nearest = min(known, key=lambda tables: tables[table].mean_absolute_difference)
    first, off = there[0], outcome.after[table].mean_absolute_difference
    return (
        f"Table {ROMAN[table]} is {off:.1f} points off, {adds.max():.1f} of them on "
        f"{first['features'].replace('_', ' ').capitalize()}: {ours} points. The choice that moves the first of these "
        f"most, {first['choice']}, {first['why']}. The nearest of {len(known)} sets of choices has {_errors(nearest)} "
        "points off."
    )


def _errors(tables: Tables) -> str:
    return ", ".join(f"{ROMAN[name]} {table.mean_absolute_difference:.1f}" for name, table in tables.items())
