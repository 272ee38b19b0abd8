"""The paper's Tables VII to X as data, compared with our scores."""

from dataclasses import dataclass
from importlib.resources import files

import numpy as np
import pandas as pd

from learn.evaluation.evaluate import metric_key
from swgsim.storage.labelled_signals import CLASSES

PROTOCOLS = {
    "table7": "random_folds",
    "table8": "random_folds",
    "table9": "leave_one_gear_out",
    "table10": "leave_one_gear_out",
}
CELL = ["features", "row", "classifier"]


def paper_table(table: str) -> pd.DataFrame:
    """The cells of a table of the paper.

    Parameters
    ----------
    table : {"table7", "table8", "table9", "table10"}

    Returns
    -------
    DataFrame
        One row per cell: ``features`` (``selection_1`` ...), ``row`` (``train``, ``test`` or ``1,2->3``),
        ``classifier`` (``mlp`` ...), ``relation`` (``about``, or ``above`` and ``at most`` where Table VIII is known by
        a bound only) and ``paper``, the score [%].

    Raises
    ------
    ValueError
        If there is no such table.
    """
    if table not in PROTOCOLS:
        raise ValueError(f"unknown table {table!r}; choose from {', '.join(PROTOCOLS)}")
    with (files("learn.paper") / "tables" / f"{table}.csv").open(encoding="utf-8") as file:
        cells = pd.read_csv(file, comment="#")
    if "split" not in cells:
        cells.insert(1, "split", cells.pop("train_gears") + "->" + cells.pop("test_gear").astype(str))
    if "classifier" not in cells:
        cells = cells.melt(["selection", "split"], var_name="classifier", value_name="score").assign(relation="about")
    return pd.DataFrame(
        {
            "features": "selection_" + cells["selection"].astype(str),
            "row": cells["split"],
            "classifier": cells["classifier"].str.lower(),
            "relation": cells["relation"],
            "paper": cells["score"].astype(float),
        }
    )


@dataclass(frozen=True)
class Comparison:
    """A table of the paper with our scores.

    Attributes
    ----------
    cells : DataFrame
        The columns of :func:`paper_table` and ``ours``, the score [%]; NaN where there is no run.
    """

    cells: pd.DataFrame

    @property
    def figures(self) -> pd.DataFrame:
        """The cells with a figure in the paper and a score of ours."""
        return self.cells[(self.cells["relation"] == "about") & self.cells["ours"].notna()]

    @property
    def mean_absolute_difference(self) -> float:
        """Mean of |ours - paper| over :attr:`figures` [points]; NaN without any."""
        return float((self.figures["ours"] - self.figures["paper"]).abs().mean())

    @property
    def rank_correlation(self) -> dict[str, float]:
        """Spearman's rank correlation over the classifiers for each row of at least three; NaN where all are equal."""
        label = [
            row_label(features, row)
            for features, row in zip(self.figures["features"], self.figures["row"], strict=True)
        ]
        return {
            str(row): _spearman(cells["ours"].to_numpy(), cells["paper"].to_numpy())
            for row, cells in self.figures.groupby(label, sort=False)
            if len(cells) >= 3
        }

    def summary(self) -> dict[str, object]:
        """Content for ``report.json``: scores by row and classifier, None for a missing one.

        ``relation`` of the paper's figure is "about", "above" or "at most"; only the first are compared.
        """
        return {
            "ours": _nested(self.cells, "ours"),
            "paper": _nested(self.cells, "paper"),
            "relation": _nested(self.cells, "relation"),
            "cells_compared": len(self.figures),
            "mean_absolute_difference": _number(self.mean_absolute_difference),
            "rank_correlation": {row: _number(value) for row, value in self.rank_correlation.items()},
        }


def row_label(features: str, row: str) -> str:
    """A row of a table in words.

    >>> row_label("selection_1", "1,2->3")
    'selection 1, 1,2->3'
    """
    return f"{features.replace('_', ' ')}, {row}"


def compare(table: str, runs: pd.DataFrame) -> Comparison:
    """A table of the paper with our scores.

    Parameters
    ----------
    table : {"table7", "table8", "table9", "table10"}
    runs : DataFrame
        Of one data set, newest first, as :func:`learn.tracking.finished_runs` gives them; the newest run of a cell
        counts.
    """
    cells = paper_table(table)
    runs = _scores(runs, table, PROTOCOLS[table])
    metric = {row: _metric(row) for row in cells["row"].unique()}
    known = {row: runs[name] for row, name in metric.items() if name in runs}
    ours = [
        known[row].get((features, classifier), np.nan) if row in known else np.nan
        for features, row, classifier in cells[CELL].itertuples(index=False)
    ]
    return Comparison(cells.assign(ours=np.array(ours, dtype=float)))


def random_and_grouped(table: str, runs: pd.DataFrame) -> pd.DataFrame:
    """Test scores [%] of the paper's random folds and of grouped folds, and the optimism of random folds [points].

    Both are means of the recall over the classes that the grouped folds test: of clean data the five faults, as all
    healthy rows are one and stay in training.

    Parameters
    ----------
    table : {"table7", "table8"}
    runs : DataFrame
        As for :func:`compare`.

    Returns
    -------
    DataFrame
        Indexed by ``features`` and ``classifier``, with the columns ``random``, ``grouped`` and ``difference``.
    """
    recalls = [f"recall/{label}" for label in CLASSES]
    grouped = _scores(runs, table, "grouped_folds").reindex(columns=recalls)
    random = _scores(runs, table, "random_folds").reindex(columns=recalls).where(grouped.notna())
    means = pd.DataFrame({"random": random.mean(axis=1), "grouped": grouped.mean(axis=1)})
    return means.assign(difference=means["random"] - means["grouped"]).sort_index()


def _metric(row: str) -> str:
    return f"{row}_score" if row in ("train", "test") else f"test/{metric_key(row)}"


def _scores(runs: pd.DataFrame, study: str, protocol: str) -> pd.DataFrame:
    """The newest run of each (features, classifier) of a study under a protocol."""
    chosen = runs[(runs["study"] == study) & (runs["protocol"] == protocol)]
    return chosen.drop_duplicates(["features", "classifier"]).set_index(["features", "classifier"])


def _nested(cells: pd.DataFrame, column: str) -> dict[str, dict[str, float | str | None]]:
    result: dict[str, dict[str, float | str | None]] = {}
    for features, row, classifier, score in cells[[*CELL, column]].itertuples(index=False):
        value = score if isinstance(score, str) else _number(score)
        result.setdefault(row_label(features, row), {})[classifier] = value
    return result


def _number(value: float) -> float | None:
    return None if np.isnan(value) else float(value)


def _spearman(ours: np.ndarray, paper: np.ndarray) -> float:
    from scipy.stats import spearmanr

    if np.ptp(ours) == 0 or np.ptp(paper) == 0:
        return float("nan")
    return float(spearmanr(ours, paper).statistic)
