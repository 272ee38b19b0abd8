"""The report of the transfer study: finds the runs, computes the tables and writes both files."""

import json
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd
import yaml

from learn.evaluation.bootstrap import specimens
from learn.paper.paper_page import versions
from learn.transfer_report import (
    confidence,
    detections,
    figures,
    inputs_over_gears,
    joint_units,
    sentences,
    studies,
    tables,
    transfer_json,
    twins,
)
from learn.transfer_report.importance import importance, importance_text
from learn.transfer_report.posteriors import (
    OF_ORACLE,
    OF_SESSION,
    OF_TWIN,
    OF_UNITS,
    UNITS_OF_SESSION,
    mismatch,
    posteriors,
)
from learn.transfer_report.runs import Runs, by_method, collected, development_scores, trials
from learn.transfer_report.tables import FOREST, ORACLE, ORACLE_OF_SESSION, best_of, row_of
from swgsim.common.files import write_json, write_text
from swgsim.common.html import environment
from swgsim.storage import storage
from swgsim.twin.twin_study import CHOICES

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
    print(f"{folder / 'transfer.html'}: {page['claim'] or page['headline']} ({seconds:.1f} s)")
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
    judged = next(iter(predictions.values()))
    oracles, joint = not_learned(runs, judged)
    errors = tables.paired({**runs.errors(methods), **{name: specimens(table) for name, table in oracles.items()}})
    zero = tables.zero_shot(errors, development_scores(methods), methods["fit_seconds"].astype(float))
    zero = zero.join(methods[["seeds", "spread"]]).fillna({"seeds": 1})
    predictions |= oracles
    session = of_session(runs, judged)
    units = twins.of_units(predictions, joint)
    of_units = twins.errors(units)
    few, of_gears = tables.few_shot(errors, runs.tables(adapting, "specimens")), runs.tables(adapting, "gears")
    cases, nothing = studies.disturbed_cases(runs.required("zero_shot_disturbed")), without_references(runs)
    trained = runs.of_study("inputs_gears")
    over_gears = inputs_over_gears.over_gears(trained, runs.errors(trained)) if len(trained) else None
    joint_rows = joint_units.joint_units(runs)
    best, gears = best_of(zero), int(errors["gear"].nunique())
    found = pd.concat(
        detections.detections(of, {name: each[name] for name in compared(best, each)})
        for of, each in (("recordings", predictions), ("units", units))
    )
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
        "claim": None,
        "lead": [
            *sentences.in_session(session, twins.HEALTHY),
            *sentences.fast_twin(zero, methods),
            *sentences.lead(zero, few, of_gears, development_scores(adapting), cases),
        ],
        "best": best,
        "errors": figures.errors(zero),
        "methods": tables.methods_text(zero, errors, of_units),
        "joint": None if joint_rows.empty else joint_units.joint_units_text(joint_rows, of_units, few),
        "known": figures.known(twins.known(zero, of_units, few, nothing, session)),
        "nothing": len(nothing),
        "shots": figures.shots(few, levels) if (few["shots"] > 0).any() else None,
        "few": tables.shots_text(few, "", labelled, marks, adapting),
        "few_units": tables.shots_text(few, "unit", labelled, marks),
        "draws": adapting["draws"].iloc[0],
        "forgotten": tables.forgetting_text(of_gears),
        "detection": None if found.empty else detections.detections_text(found),
        "worst": detections.worst_text(predictions[best]),
        **practice(runs, methods, predictions, units, best),
        "disturbed": cases.map("{:.1f}".format),
        "over_gears": None if over_gears is None else inputs_over_gears.over_gears_text(over_gears),
        "over_gears_figure": None if over_gears is None else inputs_over_gears.over_gears_figure(over_gears),
        "command": runs.command,
        "facts": facts(runs, adapting.iloc[0], [*trials(methods), *trials(adapting)], f"{seconds:.0f} ({kind})"),
    }
    content = transfer_json.content(zero, of_units, few, cases, gears, seconds)
    content["unit"] |= joint_units.joint_units_json(joint_rows)
    content["detection"] = detections.detections_json(found)
    content["inputs"] = inputs_over_gears.over_gears_json(over_gears)
    content["fast_twin"] = twins.fast_twin_json(zero, methods)
    if twins.TWIN in predictions:
        cases = twins.mismatches(every_twin(runs, judged))
        ratio = twins.ratio_to_floor(errors)
        page["claim"] = sentences.claim(zero, of_units, ratio, gears, references(runs))
        page["twins"] = twins.mismatches_text(cases)
        others = twins.other_authors(runs.other_authors)
        page["other_authors"] = None if others is None else twins.other_authors_text(others)
        content["twin"] = twins.twin_json(zero, ratio, cases, others, session)
    return page, content


def not_learned(runs: Runs, judged: pd.DataFrame) -> tuple[dict[str, pd.DataFrame], dict[str, pd.DataFrame]]:
    """Predictions of oracles, twin and floor, of recordings, and of units by those that take one as a whole.

    ``swg twin`` has all of them; without it, or without its comparison, the oracles are those of ``swg oracle``.
    `judged` are predictions of any method.
    """
    bench, digest = runs.paths["bench"], runs.digests["bench"]
    oracle, twin = (bench.with_name(f"{bench.stem}-{name}.parquet") for name in ("oracle", "twin"))
    found, joint = (posteriors(twin, digest, judged, of) if twin.is_file() else {} for of in (OF_TWIN, OF_UNITS))
    if ORACLE not in found:
        found |= posteriors(oracle, digest, judged, OF_ORACLE)
    return found, joint


def of_session(runs: Runs, judged: pd.DataFrame) -> pd.Series | None:
    """Errors of the twin that knows healthy specimens of the session; None if ``swg twin`` was not asked with as many
    of them as the other methods.
    """
    bench, digest = runs.paths["bench"], runs.digests["bench"]
    path = bench.with_name(f"{bench.stem}-twin.parquet")
    if not path.is_file():
        return None
    chosen = dict(zip(CHOICES, json.loads(pd.read_parquet(path).attrs["choices"]), strict=True))
    if chosen["healthy"] != twins.HEALTHY:
        return None
    return twins.in_session(*(posteriors(path, digest, judged, of) for of in (OF_SESSION, UNITS_OF_SESSION)))


def every_twin(runs: Runs, judged: pd.DataFrame) -> dict[str, tuple[pd.DataFrame, pd.DataFrame]]:
    """Predictions of twins with true and with mistaken beliefs, by case, as far as ``swg twin`` was run."""
    bench = runs.paths["bench"]
    files = {"matched": bench.with_name(f"{bench.stem}-twin.parquet"), **runs.mistaken}
    found = {case: mismatch(path, judged, runs.digests["bench"]) for case, path in files.items()}
    return {case: each for case, each in found.items() if each}


def without_references(runs: Runs) -> pd.DataFrame:
    """Errors of the methods of level Z0 as :func:`.twins.known` wants them; empty if none was run."""
    bare = runs.of_study("no_reference")
    if bare.empty:
        return bare
    each = runs.predictions(bare)
    return twins.errors(each).join(tables.named("unit", twins.errors(twins.of_units(each, {}))))


def references(runs: Runs) -> int:
    """Healthy recordings of every gear at every operating point."""
    configuration = yaml.safe_load(storage.attributes(runs.paths["bench"])["configuration"])
    return int(configuration["grid"]["references"])


def practice(
    runs: Runs,
    methods: pd.DataFrame,
    predictions: Mapping[str, pd.DataFrame],
    units: Mapping[str, pd.DataFrame],
    best: str,
) -> dict[str, Any]:
    """Calibration, prediction sets and feature importance.

    Parameters
    ----------
    runs : Runs
    methods : DataFrame
        Run of every method without adaptation, by name.
    predictions, units : mapping
        Method to its predictions of recordings and of units.
    best : str
    """
    shown = {name: predictions[name] for name in compared(best, predictions)}
    on_harmonics = methods[methods.index.str.endswith(" on harmonics")]
    refitted = str(on_harmonics["test_score"].idxmax()) if len(on_harmonics) else str(methods["test_score"].idxmax())
    drops, fold_gears = importance(runs, row_of(methods, refitted), runs.paths["bench"])
    return {
        "calibration": confidence.calibration_text(shown),
        "confidence": figures.confidence(confidence.reliabilities(shown), confidence.risk_curves(shown)),
        "sets": [confidence.sets_text(predictions[best], "recordings"), confidence.sets_text(units[best], "units")],
        "refitted": refitted,
        "fold_gears": fold_gears,
        "importance": importance_text(drops),
    }


def compared(best: str, predictions: Mapping[str, pd.DataFrame]) -> list[str]:
    """The methods that are compared in detail."""
    return [name for name in dict.fromkeys([best, *COMPARED]) if name in predictions]


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
