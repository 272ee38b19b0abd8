"""The paper's tables as printed, and the comparison with ours."""

import json

import pandas as pd
import pytest

from learn.evaluation.evaluate import metric_key
from learn.paper import published_tables as paper
from swgsim.storage.labelled_signals import CLASSES


def runs_like_the_paper(table, shift=0.0):
    cells = paper.paper_table(table)
    runs = {}
    for features, row, classifier, score in cells[[*paper.CELL, "paper"]].itertuples(index=False):
        metric = f"{row}_score" if row in ("train", "test") else f"test/{metric_key(row)}"
        runs.setdefault((features, classifier), {})[metric] = score + shift
    facts = {"study": table, "protocol": paper.PROTOCOLS[table]}
    return pd.DataFrame([{"features": f, "classifier": c, **facts, **scores} for (f, c), scores in runs.items()])


@pytest.mark.parametrize(
    ("table", "cells", "cell", "score"),
    [
        ("table7", 30, ("selection_3", "test", "mlp"), 98.30),
        ("table9", 45, ("selection_1", "2,3->1", "rf"), 99.91),
        ("table10", 24, ("selection_3", "1,3->2", "nb"), 74.26),
        ("table8", 13, ("selection_1", "test", "nb"), 73.72),
    ],
)
def test_tables_are_as_printed(table, cells, cell, score):
    data = paper.paper_table(table)
    assert len(data) == cells
    assert data.set_index(paper.CELL)["paper"][cell] == score


@pytest.mark.parametrize("table", paper.PROTOCOLS)
def test_the_papers_own_figures_differ_by_nothing_and_rank_alike(table):
    comparison = paper.compare(table, runs_like_the_paper(table))
    assert comparison.mean_absolute_difference == pytest.approx(0, abs=1e-12)
    assert all(rho == pytest.approx(1) for rho in comparison.rank_correlation.values())
    assert len(comparison.rank_correlation) == {"table7": 6, "table8": 1, "table9": 9, "table10": 6}[table]


def test_difference_is_in_points_and_bounds_do_not_count():
    comparison = paper.compare("table8", runs_like_the_paper("table8", shift=-2.5))
    assert comparison.mean_absolute_difference == pytest.approx(2.5)
    assert len(comparison.figures) == 4


def test_runs_that_are_missing_leave_gaps():
    runs = runs_like_the_paper("table9").query("classifier == 'rf'")
    comparison = paper.compare("table9", runs)
    assert comparison.cells["ours"].notna().sum() == 9
    assert comparison.rank_correlation == {}
    assert comparison.summary()["ours"]["selection 1, 1,2->3"] == {
        "mlp": None,
        "svm": None,
        "rf": 92.50,
        "knn": None,
        "nb": None,
    }
    assert json.loads(json.dumps(comparison.summary(), allow_nan=False)) == comparison.summary()


def test_random_and_grouped_folds():
    """On the classes that grouped folds test: healthy, which they never test here, does not count for either."""
    cell = {"study": "table7", "features": "selection_1", "classifier": "rf"}
    faults = [f"recall/{label}" for label in CLASSES[1:]]
    both = [
        cell | {"protocol": "random_folds", "recall/healthy": 100.0} | dict.fromkeys(faults, 98.0),
        cell | {"protocol": "grouped_folds"} | dict.fromkeys(faults, 95.5),
    ]
    row = paper.random_and_grouped("table7", pd.DataFrame(both)).loc[("selection_1", "rf")]
    assert row.tolist() == [98.0, 95.5, 2.5]


def test_unknown_table_is_answered_with_the_tables():
    with pytest.raises(ValueError, match="unknown table 'table6'; choose from table7, table8, table9, table10"):
        paper.paper_table("table6")
