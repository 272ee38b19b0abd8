"""Repetitions of a job with other seeds, as one row: means, and how far the seeds lie apart."""

from collections.abc import Sequence
from functools import cache
from re import fullmatch

import pandas as pd
from pandas.api.types import is_numeric_dtype

MEASURED = ("error", "unit", "unadapted", "forgotten")  # columns of tables of runs; the others say of what


def averaged(runs: pd.DataFrame) -> pd.DataFrame:
    """One row per configuration, whatever its seed.

    Parameters
    ----------
    runs : DataFrame
        The newest run of every configuration, newest first: parameters as text, metrics as numbers.

    Returns
    -------
    DataFrame
        In the order of the newest runs. Metrics are means over the seeds. ``seeds`` counts them, ``spread`` is the
        standard deviation of their ``test_score`` [points], NaN for one seed. ``run_ids`` are all runs, ``run_id`` the
        newest, ``seed`` names them.
    """
    numbers = [name for name in runs if is_numeric_dtype(runs[name])]
    same = [name for name in runs if name not in numbers and name != "run_id" and not _of_seed(name)]
    groups = runs.groupby(same, dropna=False, sort=False)
    score = groups["test_score"]
    return pd.concat(
        [
            groups[numbers].mean(),
            score.size().rename("seeds"),
            score.std().rename("spread"),
            groups["run_id"].agg(tuple).rename("run_ids"),
            groups["run_id"].first(),
            groups["seed"].agg(", ".join),
        ],
        axis="columns",
    ).reset_index()


@cache
def _of_seed(name: str) -> bool:
    return fullmatch(r"(.*\.)?seed", name) is not None


def mean_of(tables: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """Mean of tables of the same specimens or gears, one of each seed."""
    values = [name for name in tables[0] if name in MEASURED]
    facts = list(tables[0].columns.drop(values))
    return pd.concat(tables).groupby(facts, sort=False)[values].mean().reset_index()


def spread_text(runs: pd.DataFrame) -> list[str]:
    """How many seeds every run stands for, with their standard deviation [points]."""
    return [
        f"{seeds}: {spread:.1f}" if seeds > 1 else "1: -"
        for seeds, spread in zip(runs["seeds"], runs["spread"], strict=True)
    ]
