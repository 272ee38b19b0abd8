"""Figures of the transfer study: errors with intervals, ratios to the forest and to the oracle, gains by adapting."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
import pandas as pd

from learn.evaluation.bootstrap import (
    SPECIMEN,
    difference_to,
    gear_errors,
    hierarchical_bootstrap,
    mean_error,
    paired_comparison,
    ratio_to,
)
from learn.transfer_report.runs import paired
from swgsim.common.seeds import generator

FOREST = "random forest on Selection 1"  # the paper's best on Selection 1, depth 7
ORACLE, ORACLE_OF_SESSION = "oracle", "oracle that knows the session"
ORACLES = (ORACLE, ORACLE_OF_SESSION)
FROM_SCRATCH = ": from scratch"  # ends the name of a method that is given nothing of the source gears
SHOTS = (1, 2, 5, 10)


@dataclass(frozen=True)
class ZeroShot:
    """Methods without adaptation on gears never seen.

    Attributes
    ----------
    errors : DataFrame
        One row per specimen, one column per method and oracle [%].
    table : DataFrame
        Per method and oracle: ``value``, ``low``, ``high`` [%]; the same with ``ratio_`` before, to the forest, and
        with ``oracle_``, to the oracle; ``development``, the score on development gears [%]; ``fit_seconds``.
    """

    errors: pd.DataFrame
    table: pd.DataFrame

    @property
    def methods(self) -> pd.DataFrame:
        """The table without the oracles."""
        return self.table.drop(index=[name for name in ORACLES if name in self.table.index])

    @property
    def best(self) -> str:
        """The method with the smallest error on the judged gears."""
        return str(self.methods["value"].idxmin())

    @property
    def chosen(self) -> str | None:
        """The method with the highest score on development gears, None if no method has one."""
        return highest(self.methods["development"])

    @property
    def gears(self) -> int:
        """Judged gears."""
        return int(self.errors["gear"].nunique())

    def comparison(self) -> tuple[pd.DataFrame, pd.DataFrame]:
        """Every method against the forest with Holm-corrected p values, and the differences of every gear [points]."""
        errors = self.errors.drop(columns=[name for name in ORACLES if name in self.errors])
        compared = paired_comparison(errors, FOREST, generator("report", "against the forest"))
        return compared, difference_to(FOREST)(gear_errors(errors))

    def difference(self, method: str, reference: str) -> pd.Series:
        """``value``, ``low``, ``high`` of a method's error minus that of another [points]."""
        return difference(self.errors, method, reference)


def row_of(table: pd.DataFrame, name: str) -> pd.Series:
    """The row of a method."""
    return cast(pd.Series, table.loc[name])


def figure(table: pd.DataFrame, name: str, column: str = "value") -> float:
    """One figure of a method."""
    return float(cast(float, table.at[name, column]))


def highest(scores: pd.Series) -> str | None:
    """Where the highest score is, None if there is no score."""
    known = scores.dropna()
    return str(known.idxmax()) if len(known) else None


def difference(errors: pd.DataFrame, method: str, reference: str) -> pd.Series:
    """``value``, ``low``, ``high`` of a method's error minus that of another on the same specimens [points]."""
    rng = generator("report", "difference", method, reference)
    both = errors[[*SPECIMEN, method, reference]]
    return row_of(hierarchical_bootstrap(both, difference_to(reference), rng), method)


def zero_shot(errors: pd.DataFrame, development: pd.Series, fit_seconds: pd.Series) -> ZeroShot:
    """The table of methods without adaptation.

    Parameters
    ----------
    errors : DataFrame
        Of :func:`learn.transfer_report.runs.paired`, with the columns :data:`FOREST` and :data:`ORACLE`.
    development : Series
        Score on development gears of each method [%].
    fit_seconds : Series
        Of all folds of each method.

    Raises
    ------
    ValueError
        If the forest is not among the methods.
    """
    if FOREST not in errors:
        raise ValueError(f"no run of the {FOREST}, to which all is compared: add classifier=rf features=selection_1")
    rng = generator("report", "zero-shot")
    table = hierarchical_bootstrap(errors, mean_error, rng)
    table = table.join(_with_prefix("ratio", hierarchical_bootstrap(errors, ratio_to(FOREST), rng)))
    table = table.join(_with_prefix("oracle", hierarchical_bootstrap(errors, ratio_to(ORACLE), rng)))
    return ZeroShot(errors, table.assign(development=development, fit_seconds=fit_seconds))


def few_shot(errors: pd.DataFrame, adapted: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Adapted methods at every number of shots.

    Parameters
    ----------
    errors : DataFrame
        As of :func:`zero_shot`, for the forest.
    adapted : mapping
        Method to its table of specimens, with ``shots``, ``error`` and ``unadapted`` [%].

    Returns
    -------
    DataFrame
        One row per ``method`` and ``shots`` (0: without labels, level Z2): ``value``, ``low``, ``high`` [%], the same
        with ``ratio_`` before, to the forest without transfer, and with ``gain_``, the change that adapting makes
        [points]; ``unadapted`` [%].
    """
    forest = errors[[*SPECIMEN, FOREST]].rename(columns={FOREST: "error"})
    rows = []
    for shots in sorted({int(k) for table in adapted.values() for k in table["shots"].unique()}):
        here = {name: part for name, table in adapted.items() if len(part := table[table["shots"] == shots])}
        both = paired({FOREST: forest, **here})
        changes = {name: part.assign(error=part["error"] - part["unadapted"]) for name, part in here.items()}
        rng = generator("report", "few-shot", shots)
        table = hierarchical_bootstrap(both, mean_error, rng).drop(index=FOREST)
        table = table.join(_with_prefix("ratio", hierarchical_bootstrap(both, ratio_to(FOREST), rng)))
        table = table.join(_with_prefix("gain", hierarchical_bootstrap(paired(changes), mean_error, rng)))
        unadapted = pd.Series({name: part["unadapted"].mean() for name, part in here.items()})
        rows.append(table.assign(shots=shots, unadapted=unadapted).rename_axis("method").reset_index())
    return pd.concat(rows, ignore_index=True)


def least(table: pd.DataFrame, column: str) -> pd.Series:
    """The row with the smallest value."""
    return table.iloc[int(table[column].to_numpy().argmin())]


def best_adapted(table: pd.DataFrame, shots: int) -> pd.Series | None:
    """The row of the best method that transfers, at a number of shots; None if none was run with so many."""
    here = table[(table["shots"] == shots) & ~table["method"].str.endswith(FROM_SCRATCH)]
    return None if here.empty else least(here, "value")


def forgetting(gears: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Accuracy on the source gears lost by adapting [points]: ``method``, ``shots``, ``forgotten``, ``worst`` gear."""
    rows = [
        (name, int(str(shots)), float(part.mean()), float(part.max()))
        for name, table in gears.items()
        if not name.endswith(FROM_SCRATCH)  # it has never learnt the source gears
        for shots, part in table.groupby("shots")["forgotten"]
    ]
    return pd.DataFrame(rows, columns=["method", "shots", "forgotten", "worst"])


def with_intervals(specimens: Mapping[str, pd.DataFrame], purpose: str) -> pd.DataFrame:
    """Mean error of each method with its interval [%]: ``value``, ``low``, ``high``."""
    return hierarchical_bootstrap(paired(specimens), mean_error, generator("report", purpose))


def clear(table: pd.DataFrame, high: str = "high") -> tuple[list[str], list[str]]:
    """Methods whose whole interval lies below 0, and the others."""
    below = table[high] < 0
    return list(table.index[below]), list(table.index[~below])


def finite(value: float, digits: int = 4) -> float | None:
    """A number for JSON, None if it is not finite."""
    return round(float(value), digits) if np.isfinite(value) else None


def interval(row: Mapping[str, float] | pd.Series, prefix: str = "") -> Sequence[float | None]:
    """Both ends of an interval for JSON."""
    return [finite(row[f"{prefix}low"]), finite(row[f"{prefix}high"])]


def _with_prefix(prefix: str, table: pd.DataFrame) -> pd.DataFrame:
    names = {"value": prefix, "low": f"{prefix}_low", "high": f"{prefix}_high"}
    return table.rename(columns=names)
