"""The data sets and finished runs of the report, as pandas frames: found by study, named by method."""

import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import pandas as pd
import yaml

from learn.evaluation.bootstrap import specimens
from learn.jobs import settings
from learn.jobs.identity import code_version
from learn.tracking import Store, finished_runs, table_of
from learn.transfer_report.seeds import averaged, mean_of
from swgsim.common.style import words
from swgsim.storage import storage

# A study and the experiments that make it: on the gears never seen, and on the paper's grid.
EXPERIMENTS: Mapping[str, tuple[str, ...]] = {
    "zero_shot": ("zero_shot", "zero_shot_forest", "fast_twin"),
    "inputs_gears": ("inputs_gears", "inputs_gears_rocket"),
    "no_reference": ("no_reference",),
    "transfer": ("transfer_network", "transfer_rezero"),
    "units": ("units", "units_rezero"),
}
PAPER_EXPERIMENTS: Mapping[str, tuple[str, ...]] = {"zero_shot_disturbed": ("zero_shot_disturbed",)}
CLASSIFIERS: Mapping[str, str] = {
    "rf": "random forest",
    "knn": "nearest neighbours",
    "nb": "naive Bayes",
    "svm": "SVM",
    "mlp": "MLP of the paper",
    "perceptron": "MLP",
    "cnn": "CNN",
    "resnet": "ResNet",
    "minirocket": "MiniRocket",
    "set_network": "set network",
}
FEATURES: Mapping[str, str] = {
    "selection_1": "Selection 1",
    "selection_2": "Selection 2",
    "selection_3": "Selection 3",
    "selection_all": "the paper's features",
    "raw": "raw signals",
    "template": "signals minus the healthy reference",
    "differenced": "differenced signals",
    "residual": "residual signals",
    "residual_with_reference": "residual and reference signals",
    "lines": "residual lines",
    "referenced": "references",
}
ADAPTATIONS: Mapping[str, str] = {
    "l2_sp": "L2-SP",
    "coral": "CORAL",
    "structure_transfer": "STRUT",
    "rezero": "rezero, healthy recordings only",
}
JOINT = ", joint rows"  # after the inputs, of a method that has all recordings of a unit in one row


@dataclass(frozen=True)
class Runs:
    """The data sets of the report and the finished runs on them.

    Attributes
    ----------
    grids, paths, digests : mapping
        ``bench`` and ``disturbed`` to the grid, the file and the digest of the data set.
    mistaken : mapping
        Case of a twin with mistaken beliefs to the file of ``swg twin``, which need not exist.
    other_authors : Path
        The twin on gears of other authors, which need not exist.
    store : Store
    frame : DataFrame
        One row per configuration, newest first: parameters, metrics (means over its seeds, :func:`.seeds.averaged`) and
        ``method``, see :func:`method_of`.
    """

    grids: Mapping[str, str]
    paths: Mapping[str, Path]
    digests: Mapping[str, str]
    mistaken: Mapping[str, Path]
    other_authors: Path
    store: Store
    frame: pd.DataFrame

    def of_study(self, study: str) -> pd.DataFrame:
        """The runs of one study, with the parameters and metrics that its runs have; empty if it was not run.

        Rows of units are compared in the study ``units`` only, as they are no recordings.
        """
        runs = self.frame[self.frame["study"] == study]
        if "rows" in runs:
            runs = runs[(runs["rows"] == "unit") == (study == "units")]
        unknown = runs.columns[runs.isna().all()].drop("spread", errors="ignore")
        return runs.drop(columns=unknown).reset_index(drop=True)

    def required(self, study: str) -> pd.DataFrame:
        """The runs of one study.

        Raises
        ------
        ValueError
            If there is none; the message names the commands that make them.
        """
        found = self.of_study(study)
        if found.empty:
            raise ValueError(
                f"no finished run of the study {study} on the present data sets: run {self.command(study)}"
            )
        return found

    def command(self, study: str) -> str:
        """The commands that make a study."""
        grid = self.grids["disturbed" if study in PAPER_EXPERIMENTS else "bench"]
        names = {**EXPERIMENTS, **PAPER_EXPERIMENTS}[study]
        return " and ".join(f"'swg train experiment={name} grid={grid}'" for name in names)

    def tables(self, runs: pd.DataFrame, name: str) -> dict[str, pd.DataFrame]:
        """The table ``specimens`` or ``gears`` of every run, the mean over its seeds, by the runs' index."""
        return {str(key): mean_of(list(map(self._table(name), ids))) for key, ids in runs["run_ids"].items()}

    def predictions(self, runs: pd.DataFrame) -> dict[str, pd.DataFrame]:
        """Predictions of every run without adaptation, of its newest seed, by the runs' index."""
        return {str(key): self._table("predictions")(run_id) for key, run_id in runs["run_id"].items()}

    def errors(self, runs: pd.DataFrame) -> dict[str, pd.DataFrame]:
        """Error of every specimen [%] of every run without adaptation, the mean over its seeds, by the runs' index."""
        read = self._table("predictions")
        return {str(key): mean_of([specimens(read(each)) for each in ids]) for key, ids in runs["run_ids"].items()}

    def _table(self, name: str) -> Callable[[str], pd.DataFrame]:
        return lambda run_id: table_of(self.store, run_id, f"tables/{name}.parquet")

    def configuration(self, run_id: str) -> dict[str, Any]:
        """The resolved configuration of a run."""
        import tempfile

        with tempfile.TemporaryDirectory() as folder:
            path = self.store.client.download_artifacts(run_id, "config.yaml", folder)
            return cast(dict[str, Any], yaml.safe_load(Path(path).read_text(encoding="utf-8")))

    def seconds(self) -> float:
        """Time to generate the data sets and to fit all methods, as far as runs count it."""
        made = {name: json.loads(path.with_suffix(".json").read_text()) for name, path in self.paths.items()}
        generating = sum(each["seconds"] for each in made.values())
        fitting = (self.frame["fit_seconds"] * self.frame["seeds"]).sum()
        return float(generating + fitting / made["bench"]["cores"])

    def older_code(self) -> list[str]:
        """Studies of the report with runs of older code."""
        older = set(self.frame.loc[self.frame["code_version"] != code_version(), "study"])
        return [study for study in {**EXPERIMENTS, **PAPER_EXPERIMENTS} if study in older]


def collected(config: Mapping[str, Any]) -> Runs:
    """The data sets and runs that a resolved ``conf/transfer_report.yaml`` names.

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
    mistaken = {case: Path(config["data"]) / f"{name}.parquet" for case, name in config["mistaken"].items()}
    others = Path(config["other_authors"])
    return Runs(grids, paths, digests, mistaken, others, store, present_runs(store, digests.values(), foreign))


def present_runs(store: Store, digests: Iterable[str], foreign: Iterable[str] = ()) -> pd.DataFrame:
    """The finished runs on the present data sets, newest first, with their ``method``; seeds are averaged.

    If a study has runs of the present code, its runs of older code are left out.

    Parameters
    ----------
    store : Store
    digests, foreign : iterable of str
        Digests of the data sets of the report, and of those from which a run may take further gears.
    """
    runs = finished_runs(store)
    if runs.empty:
        return pd.DataFrame(columns=["study", "data_digest", "code_version", "run_id", "method"])
    known, others = set(digests), set(foreign)
    each = runs["data_digest"].str.split("+")
    runs = runs[[first in known and others.issuperset(rest) for first, *rest in each]]
    present = runs["code_version"] == code_version()
    runs = runs[present | ~runs["study"].isin(runs.loc[present, "study"])].reset_index(drop=True)
    runs = averaged(runs)
    return runs.assign(method=[method_of(cast(dict[str, object], run)) for run in runs.to_dict("records")])


def method_of(run: Mapping[str, object]) -> str:
    """Name of a run's method: the classifier with its representation, or with its adaptation.

    >>> method_of({"classifier": "rf", "features": "selection_1", "adaptation": "none"})
    'random forest on Selection 1'
    >>> method_of({"classifier": "perceptron", "features": "harmonics", "adaptation": "l2_sp"})
    'MLP: L2-SP'
    >>> method_of({"classifier": "rf", "features": "harmonics", "rows": "unit"})
    'random forest on harmonics, joint rows'
    """
    classifier, features, adaptation = (str(run.get(key, "none")) for key in ("classifier", "features", "adaptation"))
    model, inputs = CLASSIFIERS.get(classifier, words(classifier)), FEATURES.get(features, words(features))
    inputs += JOINT if run.get("rows") == "unit" else ""
    if adaptation == "none":
        return f"{model} on {inputs}"
    # Adaptations are compared on harmonics; only another representation is named.
    model = model if inputs == "harmonics" else f"{model} on {inputs}"
    return f"{model}: {ADAPTATIONS.get(adaptation, words(adaptation))}"


def by_method(runs: pd.DataFrame) -> pd.DataFrame:
    """The newest configuration of every method, with the method's name as index and the run's own index as ``key``."""
    return runs.rename(index=str).rename_axis("key").reset_index().drop_duplicates("method").set_index("method")


def development_scores(runs: pd.DataFrame) -> pd.Series:
    """Score on development gears of the options that were chosen on them [%]; NaN for methods without options."""
    return runs.filter(regex=r"^trial/").max(axis="columns").astype(float)


def trials(runs: pd.DataFrame) -> list[int]:
    """Number of options that were tried, of every run with options."""
    counts = runs.filter(regex=r"^trial/").notna().sum(axis="columns")
    return [int(count) for count in counts if count]
