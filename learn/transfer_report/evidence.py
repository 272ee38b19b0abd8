"""What the report rests on: the data sets, and the finished runs on them."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import pandas as pd
import yaml

from learn.jobs import settings
from learn.tracking import Store
from learn.transfer_report import runs as runs_of
from swgsim.storage import storage


@dataclass(frozen=True)
class Evidence:
    """Data sets and the finished runs on them.

    Attributes
    ----------
    grids : mapping
        ``bench`` and ``disturbed`` to the name of the grid.
    paths : mapping
        The same to the data set.
    digests : mapping
        The same to the digest of the data set.
    store : Store
    runs : DataFrame
        The finished runs on these data sets, newest first.
    """

    grids: Mapping[str, str]
    paths: Mapping[str, Path]
    digests: Mapping[str, str]
    store: Store
    runs: pd.DataFrame

    @cached_property
    def configuration(self) -> Mapping[str, Any]:
        """What the bench data set was generated from."""
        said: Mapping[str, Any] = yaml.safe_load(storage.attributes(self.paths["bench"])["configuration"])
        return said

    @cached_property
    def made(self) -> Mapping[str, Mapping[str, Any]]:
        """``bench`` and ``disturbed`` to what generating the data set took."""
        return {name: json.loads(path.with_suffix(".json").read_text()) for name, path in self.paths.items()}

    @property
    def seconds(self) -> float:
        """Of generating the data sets and of fitting, as far as runs count them."""
        generating = sum(each["seconds"] for each in self.made.values())
        return generating + float(self.runs["fit_seconds"].sum()) / self.made["bench"]["cores"]

    def of_study(self, study: str) -> pd.DataFrame:
        """The runs of a study; none where it was not run."""
        return runs_of.of_study(self.runs, study)

    def required(self, study: str) -> pd.DataFrame:
        """The runs of a study.

        Raises
        ------
        ValueError
            If there is none, with the commands that make them.
        """
        return runs_of.required(self.runs, study, self.grids)

    def tables(self, runs: pd.DataFrame, name: str) -> dict[str, pd.DataFrame]:
        """A table, such as ``predictions``, of every run, by the runs' index."""
        return runs_of.tables(self.store, runs, name)

    def command(self, study: str) -> str:
        """The commands that make a study."""
        return runs_of.command(study, self.grids)

    def beside(self, name: str) -> Path | None:
        """Another data set in the folder of the bench one, such as ``far-bench``; None if it is not there."""
        path = self.paths["bench"].with_name(f"{name}.h5")
        return path if path.is_file() else None


def gathered(config: Mapping[str, Any]) -> Evidence:
    """The evidence that a resolved ``conf/transfer_report.yaml`` names.

    Raises
    ------
    ValueError
        If a data set is missing, with the command to make it.
    """
    grids = {"bench": config["grid"]["name"], "disturbed": config["paper_grid"]}
    paths = {
        name: settings.data_set({"data": config["data"], "grid": grids[name], "condition": condition})
        for name, condition in (("bench", config["condition"]), ("disturbed", "disturbed"))
    }
    digests = {name: storage.digest(path) for name, path in paths.items()}
    foreign = [storage.digest(path) for path in Path(config["data"]).glob("*-*.h5")]
    store = settings.store(config["tracking"])
    return Evidence(grids, paths, digests, store, runs_of.present_runs(store, digests.values(), foreign))
