"""Write the report from the data sets and the runs of the experiments: python scripts/report.py [grid=paper]"""

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

from learn import figures as learning_figures
from learn import report, settings
from learn.choices import choices
from learn.claims import table_claims
from learn.feature_claims import SPECTRUM, feature_claims, features_of
from learn.paper import PROTOCOLS, compare, random_beside_grouped
from swgsim import figures as chain_figures
from swgsim import settings as chain_settings
from swgsim import storage
from swgsim.claims import chain_claims
from swgsim.examples import FIGURE_POINT, Subject
from swgsim.files import write_text

BLOCK = 1024  # recordings in memory at a time
CONFUSIONS = (
    ("table7", "selection_3"),
    ("table8", "selection_1"),
    ("table8", "selection_3"),
    ("table10", "selection_3"),
)


def run(config: Mapping[str, Any]) -> dict[str, float]:
    """Write ``index.html`` and ``report.json``.

    Returns
    -------
    dict
        Number of claims that hold, and the seconds that the report took.

    Raises
    ------
    ValueError
        If a data set or the run of a cell of the tables is missing, with the command to make it.
    """
    began = time.time()
    grid = config["grid"]["name"]
    paths = {
        condition: settings.data_set({"data": config["data"], "grid": grid, "condition": condition})
        for condition in ("clean", "disturbed")
    }
    codes = {condition: storage.attributes(path)["swgsim"] for condition, path in paths.items()}
    report.require_same_code(codes, grid)
    digests = {condition: storage.digest(path) for condition, path in paths.items()}
    made = {condition: json.loads(path.with_suffix(".json").read_text()) for condition, path in paths.items()}
    said = {c: yaml.safe_load(storage.attributes(path)["configuration"]) for c, path in paths.items()}
    eq10 = said["disturbed"]["condition"]["disturbance"]

    store = settings.store(config["tracking"])
    runs = report.runs_of_tables(store, grid, digests)
    tables = {name: report.complete(compare(name, runs), name, grid) for name in PROTOCOLS}

    subject = subject_of(said["clean"])
    blocks = list(storage.blocks(paths["clean"], BLOCK))
    features = features_of(blocks)
    findings = [
        *chain_claims(subject),
        *feature_claims(features),
        *table_claims(tables, features, eq10["amplitude"]),
    ]
    healthy = example_rows(blocks[0].table)
    disturbed = next(storage.blocks(paths["disturbed"], BLOCK)).where(healthy)
    pictures = [
        *chain_figures.pictures(subject),
        *learning_figures.pictures(
            subject.examples, FIGURE_POINT.n_in_rpm, blocks[0].where(healthy), disturbed, runs
        ),
    ]  # fmt: skip
    steps = {
        "generation": sum(each["seconds"] for each in made.values()),
        "fitting of the classifiers, on all cores": runs["fit_seconds"].sum() / made["clean"]["cores"],
        "report": time.time() - began,
    }
    written = report.Report(
        grid=grid,
        dataset={key: made["clean"][key] for key in report.DATASET},
        tables=tables,
        folds={name: random_beside_grouped(name, runs) for name in ("table7", "table8")},
        findings=findings,
        choices=choices(
            said["clean"], eq10, chain_figures.catalogue_comparison(subject), SPECTRUM.orders, SPECTRUM.floor
        ),
        statistics=report.statistics(blocks),
        pictures=pictures,
        confusions=[report.confusion(store, digests, study, features) for study, features in CONFUSIONS],
        seconds=time.time() - config["started"] if config["started"] else sum(steps.values()),
        seconds_are="on the clock, from the start of make paper" if config["started"] else "the steps added up",
        steps=steps,
        versions=report.versions(codes["clean"], digests),
    )
    folder = Path(config["out"])
    folder.mkdir(parents=True, exist_ok=True)
    write_text(folder / "report.json", written.json())
    write_text(folder / "index.html", written.html())
    held = sum(finding.holds for finding in findings)
    print(f"{folder / 'index.html'}: {held} of {len(findings)} claims hold; {time.time() - began:.1f} s")
    return {"claims_that_hold": held, "seconds": time.time() - began}


def subject_of(config: Mapping[str, Any]) -> Subject:
    """The gears, window and mesh of a data set, at the paper's operating points."""
    plan = chain_settings.plan(config)
    return Subject(plan.gears, window=plan.window, sectors=plan.sectors)


def example_rows(table: pd.DataFrame) -> pd.Series:
    """Which healthy recordings are at the figures' operating point."""
    at_point = (table["n_in_rpm"] == FIGURE_POINT.n_in_rpm) & (table["T_out_nm"] == FIGURE_POINT.T_out)
    return at_point & (table["label"] == "healthy")


@hydra.main(version_base="1.3", config_path="../conf", config_name="report")
def main(config: DictConfig) -> None:
    """Resolve the configuration and write the report."""
    run(OmegaConf.to_container(config, resolve=True))  # type: ignore[arg-type]


if __name__ == "__main__":
    answered(main, "report")
