"""Predictions, adaptations, data sets and runs of the transfer study, made up by formula."""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
from fabricated import recordings
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf

from learn import tracking
from learn.protocols.levels import NewGears
from swgsim.common.seeds import generator
from swgsim.oracle.columns import KNOWN
from swgsim.storage import storage
from swgsim.storage.labelled_signals import CLASSES
from swgsim.twin.twin_study import CHOICES

ROOT = Path(__file__).parents[2]
POOLS = {"folds": 2, "development": 2, "labelled": 2, "unlabelled": 1, "kept_out": 1, "variants": None}
METHODS = (("rf", "selection_1", 0.4), ("logistic_regression", "harmonics", 0.15), ("perceptron", "harmonics", 0.2))
ATTRIBUTES = {"swgsim": "0.1.0", "configuration": "{grid: {references: 20}}"}
CASES = ("1_2_to_3", "2_3_to_1", "1_3_to_2")


@cache
def samples():
    """Facts of the samples of eight gears."""
    table = recordings(gears=8, variants=6, length=600).table
    return table[~table["reference"]].reset_index(drop=True)


def predictions(wrong, purpose):
    """Probabilities for the judged rows, of which the share `wrong` is random."""
    table, rng = samples(), generator("fabricated predictions", purpose)
    rows = np.concatenate([split.test for split in NewGears(**POOLS).split(None, table)])
    facts = table.loc[rows, ["gear", "label", "variant", "severity", "n_in_rpm", "T_out_nm"]].reset_index(names="row")
    true = pd.Index(CLASSES).get_indexer(facts["label"])
    decided = np.where(rng.random(len(true)) < wrong, rng.integers(len(CLASSES), size=len(true)), true)
    p = rng.dirichlet(np.ones(len(CLASSES)), len(true)) + 2 * np.eye(len(CLASSES))[decided]
    table = facts.assign(label=facts["label"].astype(str)).join(
        pd.DataFrame(p / p.sum(axis=1, keepdims=True), columns=list(CLASSES))
    )
    healthy = table["label"] == "healthy"
    return table.assign(severity=table["severity"].where(~healthy).clip(upper=0.9))


def adapted(after, before, shots):
    """Specimens and gears of an adaptation whose error falls as 1 / shots from `after` [-]."""
    every = predictions(0, "facts")[["gear", "label", "variant"]].drop_duplicates()
    parts = [every.assign(shots=k, error=100 * after / max(k, 1), unadapted=100.0 * before) for k in shots]
    specimens = pd.concat(parts, ignore_index=True)
    specimens["error"] += generator("fabricated adaptation", after).uniform(0, 5, len(specimens))
    specimens["unit"] = specimens["error"] / 2
    gears = specimens.groupby(["gear", "shots"])[["error", "unadapted"]].mean().reset_index()
    return specimens, gears.assign(forgotten=0.5 * gears["shots"])


def configured(name, *overrides):
    with initialize_config_dir(str(ROOT / "conf"), version_base="1.3"):
        return OmegaConf.to_container(compose(name, list(overrides)), resolve=True)


class Keeper:
    """Keeps made-up runs in a store."""

    def __init__(self, folder, digests):
        self.store, self.digests = tracking.local_store(str(folder)), digests

    def __call__(self, study, data="gears-bench", metrics=None, tables=None, config=None, code="1", **parameters):
        everything = {"study": study, "adaptation": "none", "draws": 2, "seed": 0, "shots": "[1, 2]"}
        everything |= {f"protocol.{name}": value for name, value in POOLS.items()} | parameters
        tags = {"data_digest": self.digests[data], "code_version": code}
        with tracking.job_run(self.store, "run", "key", everything, config or {}, tags) as run:
            kept = {f"tables/{name}.parquet": table for name, table in (tables or {}).items()}
            run.record({"test_score": 80.0, "fit_seconds": 1.0, **(metrics or {})}, {}, kept)


def keep_required(keep, data):
    """The runs without which there is no report, and those of two further studies."""
    for classifier, features, wrong in METHODS:
        config = configured("train", f"classifier={classifier}", f"features={features}", f"data={data}")
        config["protocol"] = {"name": "new_gears", **POOLS}
        trials = {} if classifier == "rf" else {"trial/1": 80.0, "trial/2": 100 * (1 - wrong)}
        keep("zero_shot", metrics=trials, tables={"predictions": predictions(wrong, classifier)}, config=config,
             classifier=classifier, features=features)  # fmt: skip
    keep("zero_shot", metrics={"milliseconds": 0.25}, tables={"predictions": predictions(0.07, "fast twin")},
         classifier="fast_twin", features="referenced")  # fmt: skip
    for features, score in (("selection_3", 88.0), ("lines", 99.7)):
        scores = {f"test/{case}": score + i / 10 for i, case in enumerate(CASES)}
        keep("zero_shot_disturbed", "paper-disturbed", scores, classifier="rf", features=features)
    for sources, wrong in ((20, 0.4), (100, 0.2), (500, 0.1)):
        keep("inputs_gears", "joined", {"train_score": 90.0}, {"predictions": predictions(wrong, sources)},
             classifier="perceptron", features="residual", **{"protocol.sources": sources})  # fmt: skip
    keep("no_reference", tables={"predictions": predictions(0.7, "Z0")}, classifier="cnn", features="raw")
    for adaptation, after, shots in (
        ("replay", 0.1, (1, 2, 5)),
        ("from_scratch", 0.6, (1, 2, 5)),
        ("coral", 0.3, (0,)),
    ):
        specimens, gears = adapted(after, 0.2, shots)
        few = {"protocol.variants": 5} if adaptation == "coral" else {}
        keep("transfer", metrics={"trial/1": 90.0 - 10 * after}, tables={"specimens": specimens, "gears": gears},
             classifier="perceptron", features="harmonics", adaptation=adaptation, **few)  # fmt: skip
    units = predictions(0.1, "units").drop_duplicates(["gear", "label", "variant"])
    keep("units", tables={"predictions": units}, classifier="logistic_regression", features="harmonics", rows="unit")
    specimens, gears = adapted(0.04, 0.1, (0, 2))
    keep("units", tables={"specimens": specimens, "gears": gears}, classifier="logistic_regression",
         features="harmonics", rows="unit", adaptation="rezero")  # fmt: skip
    specimens, gears = adapted(0.05, 0.15, (0, 1, 2, 5))
    keep("transfer", tables={"specimens": specimens, "gears": gears}, classifier="logistic_regression",
         features="harmonics", adaptation="rezero")  # fmt: skip


def twin_table(wrong):
    """A table of swg twin: prefix to the share of decisions that are random."""
    facts = predictions(0, "facts").drop(columns=list(CLASSES))
    said = [predictions(share, prefix)[list(CLASSES)].add_prefix(prefix) for prefix, share in wrong.items()]
    table = pd.concat([facts.add_prefix("true:").rename(columns={"true:row": "row"}), *said], axis=1)
    table["misfit"], table.attrs = 1.1, {"data": "another"}
    return table


def write_data(folder):
    """The data sets, the oracle and the twin; returns the digests."""
    digests = {}
    for name, gears in (("gears-bench", 8), ("far-bench", 3), ("paper-disturbed", 3)):
        made = replace(recordings(gears=gears, variants=6, disturbance=1e-3), attributes=ATTRIBUTES)
        storage.write(folder / f"{name}.h5", [made], len(made))
        (folder / f"{name}.json").write_text(json.dumps({"seconds": 1.0, "cores": 2, "recordings": len(made)}))
        digests[name] = storage.digest(folder / f"{name}.h5")
    digests["joined"] = f"{digests['gears-bench']}+{digests['far-bench']}"
    p = predictions(0.05, "oracle")
    oracle = p[["row", *CLASSES]].join(p[list(CLASSES)].add_prefix(KNOWN))
    oracle.attrs = {"data": digests["gears-bench"]}
    oracle.to_parquet(folder / "gears-bench-oracle.parquet")
    twin = twin_table(
        {"": 0.06, "unit:": 0.02, "session:": 0.05, "session unit:": 0.01, "floor:": 0.06, "floor unit:": 0.02}
    )
    twin.attrs = {"data": digests["gears-bench"], "choices": json.dumps([{"healthy": 2}.get(each) for each in CHOICES])}
    twin.to_parquet(folder / "gears-bench-twin.parquet")
    twin_table({"": 0.08, "unit:": 0.03}).to_parquet(folder / "coning-bench-twin-after.parquet")
    return digests
