"""The main tables: errors with intervals on gears never seen, without and with adaptation.

Functions return numbers; those that end with ``_text`` return the text of a table of the page.
"""

from collections.abc import Mapping
from typing import Any, cast

import numpy as np
import pandas as pd

from learn.evaluation.bootstrap import (
    SPECIMEN,
    gear_bootstrap,
    mean_error,
    paired_comparison,
    ratio_to,
)
from learn.transfer_report.posteriors import FLOOR, ORACLE, ORACLE_OF_SESSION
from learn.transfer_report.seeds import spread_text
from swgsim.common.seeds import generator

FOREST = "random forest on Selection 1"  # the paper's best on Selection 1, depth 7
LIMITS = [FLOOR, ORACLE, ORACLE_OF_SESSION]  # they know the gear
SEEDS = "seeds: standard deviation [points]"
FROM_SCRATCH = ": from scratch"  # end of the name of a method that uses no source gear
REZERO = ": rezero, healthy recordings only"  # end of the name of a method that uses no recorded fault of the new gear


def number(value: float, low: float = np.nan, high: float = np.nan, digits: int = 1, unit: str = "") -> str:
    """A figure with its interval, if there is one.

    >>> number(12.34, 10.0, 15.0, unit=" %"), number(0.5, digits=2), number(float("nan"))
    ('12.3 % (10.0 to 15.0)', '0.50', '-')
    """
    if np.isnan(value):
        return "-"
    known = np.isfinite(low) and np.isfinite(high)
    return f"{value:.{digits}f}{unit}" + (f" ({low:.{digits}f} to {high:.{digits}f})" if known else "")


def finite(value: Any) -> float | None:
    """A number for JSON, None if it is not finite."""
    return round(float(value), 4) if np.isfinite(value) else None


def in_json(row: pd.Series, prefix: str = "") -> dict[str, Any]:
    """``value`` and ``ci95`` of a row with ``value``, ``low`` and ``high``, or the same with a prefix."""
    value, low, high = (finite(row[prefix + name]) for name in ("value", "low", "high"))
    return {"value": value, "ci95": [low, high]}


def both_in_json(row: pd.Series) -> dict[str, Any]:
    """:func:`in_json` of a row that has ``unit``, ``unit_low`` and ``unit_high`` as well."""
    of_unit = row[["unit", "unit_low", "unit_high"]].set_axis(["value", "low", "high"])
    return in_json(row) | {"unit": in_json(of_unit)}


def row_of(table: pd.DataFrame, name: str) -> pd.Series:
    """The row of a method."""
    return cast(pd.Series, table.loc[name])


def least(table: pd.DataFrame) -> pd.Series:
    """The row with the smallest ``value``."""
    return table.iloc[int(table["value"].to_numpy().argmin())]


def text_of(table: pd.DataFrame, prefix: str = "", digits: int = 1) -> list[str]:
    """``value``, ``low`` and ``high`` of every row as text; or ``ratio``, ``ratio_low`` and ``ratio_high``, ..."""
    columns = [prefix or "value", *(f"{prefix}_{end}".removeprefix("_") for end in ("low", "high"))]
    return [number(value, low, high, digits) for value, low, high in table[columns].to_numpy(dtype=float)]


def paired(specimens: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Errors of all methods on the same specimens: ``gear``, ``label``, ``variant`` and one column per method [%].

    Raises
    ------
    ValueError
        If a method was judged on other specimens than the first one.
    """
    columns = {name: rows.set_index(list(SPECIMEN))["error"] for name, rows in specimens.items()}
    first, expected = next(iter(columns.items()))
    for name, errors in columns.items():
        if len(expected.index.symmetric_difference(errors.index)):
            raise ValueError(
                f"{name} was judged on {len(errors)} specimens that are not the {len(expected)} of {first}: run both "
                "with the same protocol"
            )
    return pd.DataFrame(columns).reset_index()


def with_intervals(specimens: Mapping[str, pd.DataFrame], purpose: str) -> pd.DataFrame:
    """Mean error of each method: ``value``, ``low``, ``high`` [%]."""
    return gear_bootstrap(paired(specimens), mean_error, generator("report", purpose))


def named(prefix: str, table: pd.DataFrame) -> pd.DataFrame:
    """A table with ``value``, ``low`` and ``high`` under other names."""
    return table.rename(columns={"value": prefix, "low": f"{prefix}_low", "high": f"{prefix}_high"})


def zero_shot(errors: pd.DataFrame, development: pd.Series, fit_seconds: pd.Series) -> pd.DataFrame:
    """Methods without adaptation, and :data:`LIMITS`, on gears never seen.

    Parameters
    ----------
    errors : DataFrame
        Result of :func:`paired`, with the columns :data:`FOREST` and :data:`ORACLE`.
    development : Series
        Score of each method on development gears [%].
    fit_seconds : Series
        Time to fit all folds of each method [s].

    Returns
    -------
    DataFrame
        Per method and oracle ``value``, ``low``, ``high`` [%]; ``ratio`` to the forest and ``oracle``, the ratio to the
        oracle, with ``_low`` and ``_high``; ``development`` and ``fit_seconds``.

    Raises
    ------
    ValueError
        If the forest is not among the methods.
    """
    if FOREST not in errors:
        raise ValueError(f"no run of the {FOREST}, the reference of all ratios: add classifier=rf features=selection_1")
    rng = generator("report", "zero-shot")
    table = gear_bootstrap(errors, mean_error, rng)
    table = table.join(named("ratio", gear_bootstrap(errors, ratio_to(FOREST), rng)))
    table = table.join(named("oracle", gear_bootstrap(errors, ratio_to(ORACLE), rng)))
    return table.assign(development=development, fit_seconds=fit_seconds)


def best_of(table: pd.DataFrame) -> str:
    """The method of :func:`zero_shot` with the smallest error on the judged gears."""
    return str(table["value"].drop(LIMITS, errors="ignore").idxmin())


def highest(scores: pd.Series) -> str | None:
    """Name of the highest score, None without a score."""
    known = scores.dropna()
    return str(known.idxmax()) if len(known) else None


def methods_text(table: pd.DataFrame, errors: pd.DataFrame, of_units: pd.DataFrame) -> pd.DataFrame:
    """Every method in comparison with the paper's forest and with the oracle, and its error of units."""
    compared = paired_comparison(
        errors.drop(columns=LIMITS, errors="ignore"), FOREST, generator("report", "against the forest")
    )
    rows = table.join(named("change", compared)).sort_values("value")
    gears = [f"{b:.0f} of {g:.0f}" if g > 0 else "-" for b, g in rows[["better_gears", "gears"]].to_numpy()]
    return pd.DataFrame(
        {
            "error [%]": text_of(rows),
            "error of units [%]": text_of(of_units.loc[rows.index]),
            "ratio to the paper's forest": text_of(rows, "ratio", 2),
            "ratio to the oracle": text_of(rows, "oracle", 2),
            "change to the paper's forest [points]": text_of(rows, "change"),
            "p (Holm)": [number(p, digits=4) for p in rows["p_holm"]],
            "better in gears": gears,
            "error on development gears [%]": [number(100 - score) for score in rows["development"]],
            "fit, all folds [s]": [number(seconds, digits=0) for seconds in rows["fit_seconds"]],
            SEEDS: ["-" if name in LIMITS else text for name, text in zip(rows.index, spread_text(rows), strict=True)],
        },
        index=rows.index.rename("method"),
    )


def few_shot(errors: pd.DataFrame, adapted: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Adapted methods at every number of shots.

    Parameters
    ----------
    errors : DataFrame
        As of :func:`zero_shot`, for the forest.
    adapted : mapping
        Method to its table of specimens, with ``shots``, ``error``, ``unit`` and ``unadapted`` [%].

    Returns
    -------
    DataFrame
        One row per ``method`` and ``shots`` (0: without labels, level Z2): ``value``, ``low``, ``high`` [%]; ``ratio``
        to the forest without transfer, ``gain``, the change of the source model by adapting [points], and ``unit``, the
        error of units [%], with ``_low`` and ``_high``; ``unadapted`` [%].
    """
    forest = errors[[*SPECIMEN, FOREST]].rename(columns={FOREST: "error"})
    rows = []
    for shots in sorted({int(k) for table in adapted.values() for k in table["shots"].unique()}):
        here = {name: part for name, table in adapted.items() if len(part := table[table["shots"] == shots])}
        both = paired({FOREST: forest, **here})
        changes = {name: part.assign(error=part["error"] - part["unadapted"]) for name, part in here.items()}
        rng = generator("report", "few-shot", shots)
        table = gear_bootstrap(both, mean_error, rng).drop(index=FOREST)
        table = table.join(named("ratio", gear_bootstrap(both, ratio_to(FOREST), rng)))
        table = table.join(named("gain", gear_bootstrap(paired(changes), mean_error, rng)))
        of_units = {name: part.assign(error=part["unit"]) for name, part in here.items()}
        table = table.join(named("unit", gear_bootstrap(paired(of_units), mean_error, rng)))
        unadapted = pd.Series({name: part["unadapted"].mean() for name, part in here.items()})
        rows.append(table.assign(shots=shots, unadapted=unadapted).rename_axis("method").reset_index())
    return pd.concat(rows, ignore_index=True)


def best_adapted(few: pd.DataFrame, shots: int) -> pd.Series | None:
    """The row of :func:`few_shot` of the best method with source gears and shots of all classes, None without one."""
    here = few[(few["shots"] == shots) & ~few["method"].str.endswith((FROM_SCRATCH, REZERO))]
    return None if here.empty else least(here)


def best_rezeroed(few: pd.DataFrame) -> dict[int, pd.Series]:
    """The row of :func:`few_shot` of the best method with each number of healthy recordings and no recorded fault."""
    return {int(str(k)): least(rows) for k, rows in few[few["method"].str.endswith(REZERO)].groupby("shots")}


def shots_text(
    few: pd.DataFrame, prefix: str, labelled: int, marks: Mapping[str, str], runs: pd.DataFrame | None = None
) -> pd.DataFrame:
    """A figure of :func:`few_shot`, ``gain`` or '' for the error, of every method (rows) and number of shots (columns).

    `labelled` shots are all labels of the gear; `marks` are appended to names of methods; `runs` has the
    seeds of each method.
    """
    wide = few.assign(text=text_of(few, prefix)).pivot(index="method", columns="shots", values="text").fillna("-")
    wide = wide.loc[few.groupby("method")["value"].min().sort_values().index]
    wide.insert(
        0, "source model [%]", [number(error) for error in few.groupby("method")["unadapted"].first()[wide.index]]
    )
    if runs is not None:
        wide.insert(1, SEEDS, spread_text(runs.loc[wide.index]))
    names = {k: "Z2, no label" if k == 0 else f"K = {k}{' (Z4)' if k == labelled else ''}" for k in few["shots"]}
    wide.index = pd.Index([f"{name}{marks.get(str(name), '')}" for name in wide.index], name="method")
    return wide.rename(columns=names).rename_axis(None, axis="columns")


def forgetting_text(gears: Mapping[str, pd.DataFrame]) -> pd.DataFrame | None:
    """Accuracy on the source gears lost by adapting [points] by number of shots, and of the worst gear.

    Parameters
    ----------
    gears : mapping
        Method to its table of gears, with ``shots`` and ``forgotten``; a method from scratch uses no source gear.

    Returns
    -------
    DataFrame or None
        None if it was not measured.
    """
    rows = pd.concat(gears, names=["method"]).reset_index("method")
    rows = rows[~rows["method"].str.endswith(FROM_SCRATCH)].dropna(subset=["forgotten"])
    if rows.empty:
        return None
    means = rows.groupby(["method", "shots"])["forgotten"].mean().unstack("shots")
    means.columns = pd.Index(["Z2" if k == 0 else f"K = {k}" for k in means])
    means["worst gear"] = rows.groupby("method")["forgotten"].max()
    return means.map(lambda value: "-" if np.isnan(value) else f"{value:+.1f}")
