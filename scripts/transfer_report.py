"""Write the report of the transfer study from its runs: python scripts/transfer_report.py [grid=gears]"""

import json
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import hydra
import pandas as pd
import yaml
from misspelt import answered
from omegaconf import DictConfig, OmegaConf

from learn import settings
from learn.bootstrap import specimens
from learn.report import versions
from learn.transfer_report import adapted as transfer_adapted
from learn.transfer_report import practice as transfer_practice
from learn.transfer_report import results, sentences
from learn.transfer_report import runs as runs_of
from learn.transfer_report import sections as transfer_sections
from learn.transfer_report import studies as transfer_studies
from learn.transfer_report.content import cnn_fit, content, how_made
from learn.transfer_report.judging import importance
from learn.transfer_report.page import Section, TransferReport
from learn.transfer_report.spectrum import disturbance_beside_faults
from swgsim import storage


def run(config: Mapping[str, Any]) -> dict[str, float]:
    """Write ``transfer.html`` and ``transfer.json``.

    Returns
    -------
    dict
        Number of goals that were reached, and the seconds that the report took.

    Raises
    ------
    ValueError
        If a data set, the oracle or a study is missing, with the command to make it.
    """
    began = time.time()
    grids = {"bench": config["grid"]["name"], "disturbed": config["paper_grid"]}
    paths = {
        name: settings.data_set({"data": config["data"], "grid": grids[name], "condition": condition})
        for name, condition in (("bench", config["condition"]), ("disturbed", "disturbed"))
    }
    digests = {name: storage.digest(path) for name, path in paths.items()}
    store = settings.store(config["tracking"])
    runs = runs_of.present_runs(store, digests.values())

    unadapted = runs_of.by_method(runs_of.required(runs, "zero_shot", grids))
    predictions = runs_of.tables(store, unadapted, "predictions")
    said = runs_of.oracle(
        paths["bench"].with_name(f"{paths['bench'].stem}-oracle.parquet"),
        digests["bench"],
        next(iter(predictions.values())),
    )
    oracles = dict(zip(results.ORACLES, said, strict=True))
    errors = runs_of.paired({name: specimens(table) for name, table in {**predictions, **oracles}.items()})
    zero = results.zero_shot(errors, runs_of.development_scores(unadapted), unadapted["fit_seconds"].astype(float))

    adapted = runs_of.by_method(runs_of.required(runs, "transfer", grids))
    few = results.few_shot(errors, runs_of.tables(store, adapted, "specimens"))
    forgotten = results.forgetting(runs_of.tables(store, adapted, "gears"))

    of_inputs = runs_of.required(runs, "inputs", grids)
    signals = runs_of.tables(store, of_inputs, "predictions")
    inputs = transfer_studies.inputs(of_inputs, signals)
    networks = transfer_studies.networks_compared(of_inputs, signals)
    cases = transfer_studies.disturbed_cases(runs_of.required(runs, "zero_shot_disturbed", grids))

    shown = dict.fromkeys(
        [zero.best, results.FOREST, *(m for m in (sentences.SIMPLE, sentences.NETWORK) if m in predictions)]
    )
    judged = {name: predictions[name] for name in shown} | {results.ORACLE: oracles[results.ORACLE]}
    on_harmonics = zero.methods[zero.methods.index.str.endswith(" on harmonics")]["value"]
    refitted = str(on_harmonics.idxmin()) if len(on_harmonics) else zero.best
    drops = importance(store, unadapted.loc[refitted], paths["bench"])

    clean = paths["disturbed"].with_name(f"{grids['disturbed']}-clean.h5")
    spectrum, change = disturbance_beside_faults(clean, paths["disturbed"]) if clean.is_file() else (None, None)
    labelled = int(adapted["protocol.labelled"].iloc[0])
    draws = str(adapted["draws"].iloc[0])
    sections = [
        transfer_sections.disturbed(cases, spectrum, change),
        transfer_sections.new_gears(zero, no_reference(store, runs, of_inputs, signals)),
        transfer_sections.inputs(inputs),
        transfer_adapted.transfer(zero, few, forgotten, draws, labelled),
        where_it_pays(store, runs, grids),
        transfer_practice.section(zero.best, judged, refitted, drops),
        harder(runs, grids),
        size(runs, grids),
    ]
    fit = cnn_fit(Path(config["out"]) / "benchmark.json")
    seconds = time.time() - config["started"] if config["started"] else spent(paths, runs) + time.time() - began
    facts = how_made(
        yaml.safe_load(storage.attributes(paths["bench"])["configuration"]),
        adapted.iloc[0],
        zero.gears,
        [*runs_of.trials(unadapted), *runs_of.trials(adapted)],
        fit,
        seconds,
        "on the clock" if config["started"] else "the steps added up",
        versions(storage.attributes(paths["bench"])["swgsim"], digests),
    )
    report = TransferReport(
        grid=grids["bench"],
        content=content(zero, few, inputs, cases, fit, seconds),
        goals=sentences.goals(cases, zero, few, forgotten),
        plain=[
            *sentences.chosen_by(zero, runs_of.development_scores(adapted), few),
            *sentences.fancy_against_simple(zero, networks, few),
        ],
        levels=transfer_sections.levels(labelled),
        sections=[*sections, transfer_sections.made(facts)],
    )
    folder = Path(config["out"])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "transfer.json").write_text(report.json())
    (folder / "transfer.html").write_text(report.html())
    reached = sum(goal.reached for goal in report.goals)
    print(f"{folder / 'transfer.html'}: {reached} of {len(report.goals)} goals reached; {time.time() - began:.1f} s")
    return {"goals_reached": reached, "seconds": time.time() - began}


def no_reference(
    store: Any, runs: pd.DataFrame, of_inputs: pd.DataFrame, signals: Mapping[str, pd.DataFrame]
) -> dict[str, str]:
    """Error of networks on raw signals without and with the healthy reference, as text; empty without the study."""
    bare = runs_of.of_study(runs, "no_reference")
    if bare.empty:
        return {}
    bare = runs_of.by_method(bare)
    known = of_inputs[(of_inputs["features"] == "raw") & (of_inputs["features.efficiency"] == "True")]
    known = runs_of.by_method(known.rename(index=str).rename_axis("key").reset_index())
    tables = {f"{name}, Z0": table for name, table in runs_of.tables(store, bare, "predictions").items()}
    tables |= {f"{name}, Z1": signals[key] for name, key in known["key"].items() if name in bare.index}
    found = results.with_intervals({name: specimens(table) for name, table in tables.items()}, "no reference")
    return {str(name): sentences.of_row(row) for name, row in found.sort_index().iterrows()}


def where_it_pays(store: Any, runs: pd.DataFrame, grids: Mapping[str, str]) -> Section:
    """The map, or how to make it."""
    found = runs_of.of_study(runs, "transfer_map")
    if found.empty:
        return transfer_sections.left_out("map", "Where transfer pays", runs_of.command("transfer_map", grids))
    return transfer_adapted.where_it_pays(
        transfer_studies.transfer_map(found, runs_of.tables(store, found, "specimens"))
    )


def harder(runs: pd.DataFrame, grids: Mapping[str, str]) -> Section:
    """Harder splits, or how to make them."""
    found = runs_of.of_study(runs, "harder_splits")
    if found.empty:
        return transfer_sections.left_out("harder", "Harder splits", runs_of.command("harder_splits", grids))
    return transfer_sections.harder(transfer_studies.harder_splits(found))


def size(runs: pd.DataFrame, grids: Mapping[str, str]) -> Section:
    """Size and robustness of what was run, or how to make it."""
    studies = ("forest_robustness", "network_robustness")
    found = [part for study in studies if len(part := runs_of.of_study(runs, study))]
    if not found:
        commands = " and ".join(runs_of.command(study, grids) for study in studies)
        return transfer_sections.left_out("size", "Size and robustness", commands)
    return transfer_sections.size(pd.concat([transfer_studies.robustness(part) for part in found], ignore_index=True))


def spent(paths: Mapping[str, Path], runs: pd.DataFrame) -> float:
    """Seconds of generating the data sets and of fitting, as far as runs count them."""
    made = [json.loads(path.with_suffix(".json").read_text()) for path in paths.values()]
    return sum(each["seconds"] for each in made) + float(runs["fit_seconds"].sum()) / made[0]["cores"]


@hydra.main(version_base="1.3", config_path="../conf", config_name="transfer_report")
def main(config: DictConfig) -> None:
    """Resolve the configuration and write the report."""
    run(OmegaConf.to_container(config, resolve=True))  # type: ignore[arg-type]


if __name__ == "__main__":
    answered(main, "transfer_report")
