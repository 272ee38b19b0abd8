"""The study of where transfer pays as a table: what adapting gives with few or many gears, references and labels."""

from collections import defaultdict
from collections.abc import Mapping

import numpy as np
import pandas as pd

from learn.evaluation.bootstrap import specimens
from learn.transfer_report.results import difference, row_of, with_intervals
from learn.transfer_report.runs import method_of, paired

TARGETS: Mapping[str, str] = {
    "None": "other gears of the sources' population",
    "few-bench": "other gears of the sources' population",
    "far-bench": "gears far outside the sources",
    "few-noisy": "another noise",
    "few-other_day": "a reference from another day",
}
SCENARIO = ["target", "protocol.sources", "features.acquisitions"]


def scenario_of(run: Mapping[str, object]) -> str:
    """Where a run of the map adapts to and with what, as text.

    >>> scenario_of({"target": "far-bench", "protocol.sources": "26", "features.acquisitions": "1"})
    'gears far outside the sources: 26 source gears, 1 reference acquisition'
    """
    sources, acquisitions = (str(run.get(name, "None")) for name in SCENARIO[1:])
    gears = "all source gears" if sources == "None" else f"{sources} source gears"
    if acquisitions == "None":
        known = "all reference acquisitions"
    else:
        known = f"{acquisitions} reference acquisition{'' if acquisitions == '1' else 's'}"
    target = str(run.get("target", "None"))
    return f"{TARGETS.get(target, target)}: {gears}, {known}"


def best_unadapted(runs: pd.DataFrame, predictions: Mapping[str, pd.DataFrame]) -> dict[str, tuple[str, pd.DataFrame]]:
    """The method without adaptation that errs least in each scenario, of how many, with its table of specimens.

    It is chosen on the judged gears, which flatters it, and so never the adapted methods beside it.

    Parameters
    ----------
    runs : DataFrame
        Of the study ``transfer_map``, those with ``adaptation=none``, newest first.
    predictions : mapping
        Index of a run to its table of predictions.
    """
    tables: dict[str, dict[str, pd.DataFrame]] = defaultdict(dict)
    for key, run in runs.rename(index=str).iterrows():
        facts = _facts(run)
        tables[scenario_of(facts)].setdefault(method_of(facts), specimens(predictions[str(key)]))
    best = {}
    for scenario, methods in tables.items():
        name = min(methods, key=lambda method: methods[method]["error"].mean())
        best[scenario] = (f"{name} (of {len(methods)})", methods[name])
    return best


def transfer_map(
    runs: pd.DataFrame,
    adapted: Mapping[str, pd.DataFrame],
    unadapted: Mapping[str, tuple[str, pd.DataFrame]],
) -> pd.DataFrame:
    """What adapting gives in every scenario.

    Parameters
    ----------
    runs : DataFrame
        Of the study ``transfer_map``, those that adapt.
    adapted : mapping
        Index of a run to its table of specimens.
    unadapted : mapping
        Of :func:`best_unadapted`.

    Returns
    -------
    DataFrame
        ``scenario``, ``method``, ``shots``, ``unadapted`` and ``error`` [%], and the change that the method makes to
        the source model, ``gain``, ``low``, ``high`` [points]. And what it makes to the best method without adaptation
        in the same scenario, ``best``: ``best_gain``, ``best_low``, ``best_high`` [points]; without one the name is
        empty and the numbers are NaN.
    """
    rows = []
    for key, run in runs.rename(index=str).iterrows():
        facts = _facts(run)
        order = [facts.get(name, "None") for name in SCENARIO]
        numbers = [float("inf") if text == "None" else float(str(text)) for text in order[1:]]
        for shots, part in adapted[str(key)].groupby("shots"):
            changed = part.assign(error=part["error"] - part["unadapted"])
            change = row_of(with_intervals({"gain": changed}, "map"), "gain")
            best, beside = _beside(part, unadapted.get(scenario_of(facts)))
            rows.append({
                "scenario": scenario_of(facts), "method": method_of(facts), "shots": int(str(shots)),
                "unadapted": float(part["unadapted"].mean()), "error": float(part["error"].mean()),
                "gain": change["value"], "low": change["low"], "high": change["high"],
                "best": best, "best_gain": beside["value"], "best_low": beside["low"], "best_high": beside["high"],
                "order": (str(order[0]), *numbers),
            })  # fmt: skip
    table = pd.DataFrame(rows).drop_duplicates(["scenario", "method", "shots"])
    return table.sort_values(["order", "shots", "method"], ignore_index=True).drop(columns="order")


def _facts(run: pd.Series) -> dict[str, object]:
    """The parameters that a run has."""
    return {str(name): value for name, value in run.dropna().items()}


def _beside(adapted: pd.DataFrame, best: tuple[str, pd.DataFrame] | None) -> tuple[str, pd.Series]:
    """Name of the best method without adaptation, and the adapted one's error minus its [points]."""
    if best is None:
        return "", pd.Series({"value": np.nan, "low": np.nan, "high": np.nan})
    name, errors = best
    return name, difference(paired({"adapted": adapted, name: errors}), "adapted", name)
