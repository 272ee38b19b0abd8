"""The runs that the report of the transfer study rests on: found by study, named by method, paired by specimen."""

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import cast

import pandas as pd

from learn.inputs.inputs import OPERATING_POINT, SPECIMEN
from learn.jobs.identity import code_version
from learn.tracking import Store, finished_runs, table_of
from swgsim.common.style import words
from swgsim.oracle.columns import KNOWN
from swgsim.storage.labelled_signals import CLASSES

os.environ.setdefault("MLFLOW_ENABLE_ARTIFACTS_PROGRESS_BAR", "false")

# A study to the experiments that make it, and whether they run on the paper's grid.
EXPERIMENTS: Mapping[str, tuple[str, ...]] = {
    "zero_shot": ("zero_shot", "zero_shot_lines", "zero_shot_signals"),
    "zero_shot_disturbed": ("zero_shot_disturbed",),
    "inputs": ("inputs", "inputs_features"),
    "inputs_operating_point": ("inputs_operating_point",),
    "no_reference": ("no_reference",),
    "transfer": ("transfer_network", "transfer_forest", "transfer_extra_trees", "transfer_cnn"),
    "transfer_map": ("transfer_map", "transfer_map_foreign"),
    "harder_splits": ("harder_splits",),
    "forest_robustness": ("forest_robustness",),
    "network_robustness": ("network_robustness",),
}
PAPER_GRID = ("zero_shot_disturbed", "forest_robustness", "network_robustness")
CLASSIFIERS: Mapping[str, str] = {
    "rf": "random forest",
    "knn": "nearest neighbours",
    "nb": "naive Bayes",
    "svm": "SVM",
    "mlp": "MLP of the paper",
    "perceptron": "MLP",
    "cnn": "CNN",
    "minirocket": "MiniRocket",
}
FEATURES: Mapping[str, str] = {
    "selection_1": "Selection 1",
    "selection_2": "Selection 2",
    "selection_3": "Selection 3",
    "selection_all": "the paper's features",
    "raw": "raw signals",
    "differenced": "differenced signals",
    "residual": "residual signals",
    "lines": "residual lines",
}
ADAPTATIONS: Mapping[str, str] = {"l2_sp": "L2-SP", "coral": "CORAL", "structure_transfer": "STRUT"}
FACTS = ["row", *SPECIMEN, "severity", *OPERATING_POINT]


def command(study: str, grids: Mapping[str, str]) -> str:
    """The commands that make a study; `grids` names those of ``bench`` and ``disturbed``."""
    grid = grids["disturbed" if study in PAPER_GRID else "bench"]
    return " and ".join(f"'python scripts/train.py experiment={name} grid={grid}'" for name in EXPERIMENTS[study])


def present_runs(store: Store, digests: Iterable[str], foreign: Iterable[str] = ()) -> pd.DataFrame:
    """The finished runs on the present data sets, newest first; of every study those of the present code, if any.

    Parameters
    ----------
    store : Store
    digests, foreign : iterable of str
        Of the data sets that a run may be on, and of those that it may take further gears from.
    """
    runs = finished_runs(store)
    if runs.empty:
        return pd.DataFrame(columns=["study", "data_digest", "code_version", "run_id"])
    known, others = set(digests), set(foreign)
    each = runs["data_digest"].str.split("+")
    runs = runs[[first in known and others.issuperset(rest) for first, *rest in each]]
    present = runs["code_version"] == code_version()
    return runs[present | ~runs["study"].isin(runs.loc[present, "study"])].reset_index(drop=True)


def of_older_code(runs: pd.DataFrame) -> list[str]:
    """The studies of the report whose runs were made by older code."""
    older = set(runs.loc[runs["code_version"] != code_version(), "study"])
    return [study for study in EXPERIMENTS if study in older]


def of_study(runs: pd.DataFrame, study: str) -> pd.DataFrame:
    """The runs of one study, with the parameters and metrics that its runs have."""
    return runs[runs["study"] == study].dropna(axis="columns", how="all").reset_index(drop=True)


def required(runs: pd.DataFrame, study: str, grids: Mapping[str, str]) -> pd.DataFrame:
    """The runs of one study.

    Raises
    ------
    ValueError
        If there is none; it names the commands that make them.
    """
    found = of_study(runs, study)
    if found.empty:
        raise ValueError(f"no finished run of the study {study} on the present data sets: run {command(study, grids)}")
    return found


def method_of(run: Mapping[str, object]) -> str:
    """Name of a run's method: the classifier with what it sees, or with its adaptation.

    >>> method_of({"classifier": "rf", "features": "selection_1", "adaptation": "none"})
    'random forest on Selection 1'
    >>> method_of({"classifier": "perceptron", "features": "harmonics", "adaptation": "l2_sp"})
    'MLP: L2-SP'
    """
    classifier, features = str(run["classifier"]), str(run["features"])
    model, seen = CLASSIFIERS.get(classifier, words(classifier)), FEATURES.get(features, words(features))
    adaptation = str(run.get("adaptation", "none"))
    if adaptation == "none":
        return f"{model} on {seen}"
    # Adaptations are compared on one representation; another one has to be said.
    model = model if features == "harmonics" else f"{model} on {seen}"
    return f"{model}: {ADAPTATIONS.get(adaptation, words(adaptation))}"


def by_method(runs: pd.DataFrame) -> pd.DataFrame:
    """The newest run of every method, with the method's name as index."""
    names = [method_of(cast(dict[str, object], run)) for run in runs.to_dict("records")]
    named = runs.assign(method=names)
    return named.drop_duplicates("method").set_index("method")


def development_scores(runs: pd.DataFrame) -> pd.Series:
    """The score of the options chosen on development gears [%], NaN for methods with nothing to choose."""
    return runs.filter(regex=r"^trial/").max(axis="columns").astype(float)


def few_variants(runs: pd.DataFrame) -> dict[str, str]:
    """Variants of each class and source gear that runs were trained on, where not on all, by the runs' index."""
    variants = runs["protocol.variants"]
    return {str(key): str(number) for key, number in variants[variants != "None"].items()}


def trials(runs: pd.DataFrame) -> list[int]:
    """How many options were tried, of every run that has options."""
    counts = runs.filter(regex=r"^trial/").notna().sum(axis="columns")
    return [int(count) for count in counts if count]


def tables(store: Store, runs: pd.DataFrame, name: str) -> dict[str, pd.DataFrame]:
    """A table, such as ``predictions``, of every run, by the runs' index."""
    return {str(key): table_of(store, run_id, f"tables/{name}.parquet") for key, run_id in runs["run_id"].items()}


def paired(specimens: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
    """Errors of methods side by side: :data:`learn.evaluation.bootstrap.SPECIMEN` and one column per method [%].

    Parameters
    ----------
    specimens : mapping
        Method to its table with ``gear``, ``label``, ``variant`` and ``error``.

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


def oracle(path: Path, digest: str, predictions: pd.DataFrame) -> tuple[pd.DataFrame, pd.DataFrame]:
    """What the oracle, and the oracle that knows the session, say of the recordings that methods were judged on.

    Parameters
    ----------
    path : Path
        ``<grid>-<condition>-oracle.parquet``.
    digest : str
        Of the data set.
    predictions : DataFrame
        Of any method, for the judged rows and their facts.

    Raises
    ------
    ValueError
        If there is no oracle of this data set, or it has not said anything of some judged gear; with the command.
    """
    grid, condition = path.stem.removesuffix("-oracle").rsplit("-", 1)
    remedy = f"run 'python scripts/oracle.py grid={grid} condition={condition}'"
    if not path.is_file():
        raise ValueError(f"no oracle {path}: {remedy}")
    said = pd.read_parquet(path)
    if said.attrs.get("data") != digest:
        raise ValueError(f"{path} is of another data set than the present {grid}-{condition}.h5: {remedy}")
    joined = predictions[FACTS].merge(said, on="row", how="left")
    silent = joined[joined[CLASSES[0]].isna()]
    if len(silent):
        raise ValueError(f"{path} says nothing of gear {silent.iloc[0]['gear']}, which is judged: {remedy}")
    known = joined[FACTS].join(joined[[KNOWN + label for label in CLASSES]].set_axis(list(CLASSES), axis="columns"))
    return joined[[*FACTS, *CLASSES]], known
