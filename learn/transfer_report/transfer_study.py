"""The report of the transfer study: finds the runs, computes the tables and writes both files."""

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from learn.evaluation.bootstrap import gear_errors, specimens
from learn.paper.paper_page import versions
from learn.transfer_report import confidence, figures, sentences, studies, tables
from learn.transfer_report.importance import importance, importance_text
from learn.transfer_report.runs import Runs, by_method, collected, development_scores, oracle, trials
from learn.transfer_report.tables import (
    FOREST,
    ORACLE,
    ORACLE_OF_SESSION,
    best_adapted,
    best_of,
    best_rezeroed,
    highest,
    row_of,
)
from swgsim.common.files import write_json, write_text
from swgsim.common.html import environment
from swgsim.storage import storage

SHOTS = (1, 2, 5, 10)  # of transfer.json
COMPARED = (FOREST, "logistic regression on harmonics", "MLP on harmonics", ORACLE)  # with the best, for calibration


def run(config: Mapping[str, Any]) -> dict[str, float]:
    """Write ``transfer.html`` and ``transfer.json`` as a resolved ``conf/transfer_report.yaml`` says.

    Returns
    -------
    dict
        ``seconds`` that the report took.

    Raises
    ------
    ValueError
        If a data set, the oracle or a required study is missing, with the command to make it.
    """
    began, folder = time.time(), Path(config["out"])
    page, content = report(collected(config), began, config["started"])
    html = environment("learn").get_template("transfer_report/transfer_page.html.jinja").render(page)
    folder.mkdir(parents=True, exist_ok=True)
    write_json(folder / "transfer.json", content)
    write_text(folder / "transfer.html", html)
    seconds = time.time() - began
    print(f"{folder / 'transfer.html'}: {page['headline']} ({seconds:.1f} s)")
    return {"seconds": seconds}


def report(runs: Runs, began: float, started: float | None) -> tuple[dict[str, Any], dict[str, Any]]:
    """Variables of the template, and the content of ``transfer.json``.

    Parameters
    ----------
    runs : Runs
    began, started : float
        Unix times at which the report and the whole study began; without `started`, seconds of the steps are added.
    """
    methods, adapting = by_method(runs.required("zero_shot")), by_method(runs.required("transfer"))
    predictions = runs.predictions(methods)
    bench = runs.paths["bench"]
    oracle_path = bench.with_name(f"{bench.stem}-oracle.parquet")
    both = oracle(oracle_path, runs.digests["bench"], next(iter(predictions.values())))
    oracles = dict(zip(tables.ORACLES, both, strict=True))
    errors = tables.paired({**runs.errors(methods), **{name: specimens(table) for name, table in oracles.items()}})
    zero = tables.zero_shot(errors, development_scores(methods), methods["fit_seconds"].astype(float))
    zero = zero.join(methods[["seeds", "spread"]])
    few = tables.few_shot(errors, runs.tables(adapting, "specimens"))
    inputs, cases = runs.required("inputs"), studies.disturbed_cases(runs.required("zero_shot_disturbed"))
    input_errors = runs.errors(inputs)
    of_inputs = studies.inputs(inputs, input_errors)
    best, gears = best_of(zero), int(errors["gear"].nunique())
    seconds = time.time() - (started or began) + (0 if started else runs.seconds())
    kind = "measured" if started else "sum of the steps"

    labelled = int(adapting["protocol.labelled"].iloc[0])
    variants = adapting["protocol.variants"]
    marks = {str(name): f" (trained on {count} variants)" for name, count in variants[variants != "None"].items()}
    levels = {
        "paper's forest": row_of(zero, FOREST)["value"],
        "best without adaptation": row_of(zero, best)["value"],
        ORACLE_OF_SESSION: row_of(zero, ORACLE_OF_SESSION)["value"],
    }
    page = {
        "grid": runs.grids["bench"],
        "headline": sentences.headline(zero, gears),
        "lead": sentences.lead(zero, few, development_scores(adapting), cases),
        "best": best,
        "errors": figures.errors(zero),
        "representations": tables.representations_text(zero),
        "methods": tables.methods_text(zero, errors),
        "inputs": studies.inputs_text(of_inputs),
        "shots": figures.shots(few, levels) if (few["shots"] > 0).any() else None,
        "few": tables.shots_text(few, "", labelled, marks, adapting),
        "gains": tables.shots_text(few, "gain", labelled, marks),
        "draws": adapting["draws"].iloc[0],
        "forgotten": tables.forgetting_text(runs.tables(adapting, "gears")),
        **practice(runs, methods, {**predictions, **oracles}, errors, best),
        "disturbed": cases.map("{:.1f}".format),
        "studies": studies_of(runs, inputs, input_errors),
        "command": runs.command,
        "facts": facts(runs, adapting.iloc[0], [*trials(methods), *trials(adapting)], f"{seconds:.0f} ({kind})"),
    }
    return page, content_of(zero, few, of_inputs, cases, gears, seconds)


def practice(
    runs: Runs, methods: pd.DataFrame, predictions: Mapping[str, pd.DataFrame], errors: pd.DataFrame, best: str
) -> dict[str, Any]:
    """Detection, confidence and feature importance of the best method.

    Parameters
    ----------
    runs : Runs
    methods : DataFrame
        Run of every method without adaptation, by name.
    predictions : mapping
        Method or oracle to its predictions.
    errors : DataFrame
        Errors of specimens of the same methods and oracles [%].
    best : str
    """
    bench, means = runs.paths["bench"], gear_errors(errors)
    shown = {name: predictions[name] for name in dict.fromkeys([best, *COMPARED]) if name in predictions}
    on_harmonics = [name for name in methods.index if name.endswith(" on harmonics")]
    refitted = str(means[on_harmonics].mean().idxmin()) if on_harmonics else best
    drops, fold_gears = importance(runs, row_of(methods, refitted), bench)
    return {
        "detection": confidence.detection_text(predictions[best]),
        "alarms": confidence.alarms_text(predictions[best]),
        "calibration": confidence.calibration_text(shown),
        "confidence": figures.confidence(confidence.reliabilities(shown), confidence.risk_curves(shown)),
        "sets": confidence.sets_text(predictions[best]),
        "novelty": confidence.novelty_text(
            confidence.novelty(bench, bench.with_name("far-bench.h5"), means[best]), best
        ),
        "refitted": refitted,
        "fold_gears": fold_gears,
        "importance": importance_text(drops),
    }


def studies_of(runs: Runs, inputs: pd.DataFrame, input_errors: Mapping[str, pd.DataFrame]) -> dict[str, Any]:
    """Tables and figures of the studies that need not be run, by study; a study without runs is missing."""
    found: dict[str, Any] = {}
    bare = runs.of_study("no_reference").rename(index="no reference {}".format)
    if len(bare):
        known = inputs[(inputs["features"] == "raw") & studies.with_efficiency(inputs)]
        found["no_reference"] = studies.without_text(known, bare, {**input_errors, **runs.errors(bare)})
    points = runs.of_study("inputs_operating_point")
    if len(points):
        given = points["features.operating_point"] == "True"
        found["inputs_operating_point"] = studies.without_text(points[given], points[~given], runs.errors(points))
    scenarios = runs.of_study("transfer_map")
    adapts = scenarios[scenarios["adaptation"] != "none"] if len(scenarios) else scenarios
    if len(adapts):
        plain = scenarios.drop(index=adapts.index)
        unadapted = studies.best_unadapted(plain, runs.errors(plain))
        table = studies.transfer_map(adapts, runs.tables(adapts, "specimens"), unadapted)
        found["transfer_map"] = {
            "figure": figures.benefit(table),
            "table": studies.map_text(table),
            "sentence": studies.map_sentence(table),
        }
    return found


def facts(runs: Runs, adapting: pd.Series, tried: list[int], seconds: str) -> dict[str, str]:
    """How the study was made.

    Parameters
    ----------
    runs : Runs
    adapting : Series
        A run with adaptation, for the options of ``conf`` that all runs share.
    tried : list of int
        Number of options that were tried, of every method with options.
    seconds : str
    """
    options = " or ".join(map(str, sorted(set(tried)))) or "none"
    code = storage.attributes(runs.paths["bench"])["swgsim"]
    shared = [name for name in adapting.index if name.startswith("protocol.")]
    return {
        **{name: str(adapting[name]) for name in [*shared, "shots", "draws", "seed"]},
        "options": f"{options} tried on development gears for each of {len(tried)} methods with options",
        "seconds": seconds,
        "versions": ", ".join(f"{name} {text}" for name, text in versions(code, runs.digests).items()),
        "studies with runs of older code": sentences.listed(runs.older_code()),
    }


def content_of(
    zero: pd.DataFrame, few: pd.DataFrame, inputs: pd.DataFrame, cases: pd.DataFrame, gears: int, seconds: float
) -> dict[str, Any]:
    """Content of ``transfer.json``: errors and accuracies [%]; None for an unknown number."""
    best, chosen, solved = best_of(zero), highest(zero["development"]), studies.best_disturbed(cases)
    adapted = {shots: row for shots in SHOTS if (row := best_adapted(few, shots)) is not None}
    return {
        "z1": {
            "forest_error": finite(row_of(zero, FOREST)["value"]),
            "best_method": best,
            "best_error": finite(row_of(zero, best)["value"]),
            "ratio": finite(row_of(zero, best)["ratio"]),
            "ci95": [finite(row_of(zero, best)["ratio_low"]), finite(row_of(zero, best)["ratio_high"])],
            "ratio_to_oracle": finite(row_of(zero, best)["oracle"]),
            "seeds": int(row_of(zero, best)["seeds"]),
            "spread_over_seeds": finite(row_of(zero, best)["spread"]),
            "chosen_on_development_gears": chosen,
            "chosen_error": finite(row_of(zero, chosen)["value"]) if chosen else None,
        },
        "z3": {
            str(shots): {
                "best_method": row["method"],
                "best_error": finite(row["value"]),
                "ratio_to_forest": finite(row["ratio"]),
                "ci95": [finite(row["ratio_low"]), finite(row["ratio_high"])],
            }
            for shots, row in adapted.items()
        },
        "rezero": {
            str(shots): {"value": finite(row["value"]), "ci95": [finite(row["low"]), finite(row["high"])]}
            for shots, row in best_rezeroed(few).items()
        },
        "oracle_error": finite(row_of(zero, ORACLE)["value"]),
        "oracle_session_error": finite(row_of(zero, ORACLE_OF_SESSION)["value"]),
        "gears": gears,
        "inputs": studies.nested_inputs(inputs, efficiency=True),
        "inputs_without_efficiency": studies.nested_inputs(inputs, efficiency=False),
        "disturbed": {
            "z1": row_of(cases, solved).round(3).tolist(),
            "z1_method": solved,
            "forest_paper": row_of(cases, studies.DISTURBED_FOREST).round(3).tolist(),
            "forest_in_the_paper": cases.iloc[0].round(3).tolist(),
        },
        "seconds": round(seconds, 1),
    }


def finite(value: Any) -> float | None:
    """A number for JSON, None if it is not finite."""
    return round(float(value), 4) if np.isfinite(value) else None
