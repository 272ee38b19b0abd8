"""The report of the paper's tables: reads data sets and runs, writes ``index.html`` and ``report.json``."""

import json
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from learn.jobs import settings
from learn.paper import figures as learning_figures
from learn.paper import paper_page as report
from learn.paper.choices import choices
from learn.paper.claims import table_claims
from learn.paper.feature_claims import SPECTRUM, feature_claims, features_of
from learn.paper.fitted import fitted
from learn.paper.published_tables import PROTOCOLS, compare, random_and_grouped
from swgsim.common.files import write_text
from swgsim.jobs import settings as chain_settings
from swgsim.storage import storage
from swgsim.studies import figures as chain_figures
from swgsim.studies.claims import chain_claims
from swgsim.studies.examples import FIGURE_POINT, Subject

BLOCK = 1024  # recordings in memory at a time


@dataclass(frozen=True)
class DataSets:
    """The clean and the disturbed data set of a grid.

    Attributes
    ----------
    paths, digests : mapping
        By condition.
    code : str
        Version of the code that made both.
    made : mapping
        Facts of the generation of each.
    configurations : mapping
        The configuration of each.
    """

    paths: Mapping[str, Path]
    digests: Mapping[str, str]
    code: str
    made: Mapping[str, Mapping[str, Any]]
    configurations: Mapping[str, Mapping[str, Any]]

    @property
    def disturbance(self) -> Mapping[str, Any]:
        """Parameters of eq. (10)."""
        return self.configurations["disturbed"]["condition"]["disturbance"]


def run(config: Mapping[str, Any]) -> dict[str, float]:
    """Write ``index.html`` and ``report.json``, as a resolved ``conf/report.yaml`` says.

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
    written = report_of(config, began)
    folder = Path(config["out"] or ("report" if written.grid == "paper" else f"report/{written.grid}"))
    write_text(folder / "report.json", written.json())
    write_text(folder / "index.html", written.html(beyond=(folder / "transfer.html").is_file()))
    held = sum(finding.holds for finding in written.findings)
    print(f"{folder / 'index.html'}: {held} of {len(written.findings)} claims hold; {time.time() - began:.1f} s")
    return {"claims_that_hold": held, "seconds": time.time() - began}


def report_of(config: Mapping[str, Any], began: float) -> report.Report:
    """Content of the report; raises like :func:`run`.

    Parameters
    ----------
    config : mapping
    began : float
        Unix time at which the report began.
    """
    grid = config["grid"]["name"]
    sets = data_sets(config["data"], grid)
    store = settings.store(config["tracking"])
    command = settings.train_command(config)
    runs = report.runs_of_tables(store, grid, sets.digests, command)
    tables = {name: report.complete(compare(name, runs), name, command) for name in PROTOCOLS}
    configuration, made = sets.configurations["clean"], sets.made["clean"]
    plan = chain_settings.plan(configuration)
    subject = Subject.of(plan)
    blocks = list(storage.blocks(sets.paths["clean"], BLOCK))
    features = features_of(blocks)
    findings = [
        *chain_claims(subject),
        *feature_claims(features),
        *table_claims(tables, features, sets.disturbance["amplitude"]),
    ]
    clean, disturbed = blocks[0], next(storage.blocks(sets.paths["disturbed"], BLOCK))
    at_point = (clean.table["n_in_rpm"] == FIGURE_POINT.n_in_rpm) & (clean.table["T_out_nm"] == FIGURE_POINT.T_out)
    healthy = at_point & (clean.table["label"] == "healthy")
    pictures = [
        *chain_figures.pictures(subject),
        *learning_figures.pictures(
            subject.examples, FIGURE_POINT.n_in_rpm, clean.where(healthy), disturbed.where(healthy), runs
        ),
    ]
    catalogue = chain_figures.catalogue_comparison(subject)
    steps = {
        "generation": sum(each["seconds"] for each in sets.made.values()),
        "fitting of the classifiers, on all cores": runs["fit_seconds"].sum() / made["cores"],
        "report": time.time() - began,
    }
    started = config["started"]
    return report.Report(
        grid=grid,
        dataset={key: made[key] for key in report.DATASET},
        tables=tables,
        folds={name: random_and_grouped(name, runs) for name in ("table7", "table8")},
        findings=findings,
        choices=choices(configuration, sets.disturbance, catalogue, SPECTRUM.orders, SPECTRUM.floor),
        fitted=fitted() if grid == "paper" else None,
        statistics=report.statistics(blocks),
        pictures=pictures,
        seconds=time.time() - started if started else sum(steps.values()),
        seconds_are="on the clock, from the start of make paper" if started else "the steps added up",
        steps=steps,
        versions=report.versions(sets.code, sets.digests),
    )


def data_sets(data: str, grid: str) -> DataSets:
    """Both data sets of a grid in a folder.

    Raises
    ------
    ValueError
        If one is missing, with the command to make it, or if they are of different code.
    """
    paths = {
        condition: settings.data_set({"data": data, "grid": grid, "condition": condition})
        for condition in ("clean", "disturbed")
    }
    codes = {condition: storage.attributes(path)["swgsim"] for condition, path in paths.items()}
    report.require_same_code(codes, grid, data)
    return DataSets(
        paths=paths,
        digests={condition: storage.digest(path) for condition, path in paths.items()},
        code=codes["clean"],
        made={c: json.loads(path.with_suffix(".json").read_text()) for c, path in paths.items()},
        configurations={c: yaml.safe_load(storage.attributes(path)["configuration"]) for c, path in paths.items()},
    )
