"""What a practitioner asks of the best method: what it finds, how sure it is, and what its decisions rest on."""

import re
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from learn import settings
from learn.decisions import class_numbers, probabilities
from learn.detection import detected as taken_for_a_fault
from learn.detection import detection_table
from learn.fault_size import UNITS
from learn.importance import grouped_permutation
from learn.inputs import OPERATING_POINT
from learn.job import learning_set_of
from learn.levels import NewGears
from learn.selective import conformal_threshold, prediction_sets, set_figures
from learn.tracking import Store
from learn.transfer_report.results import row_of
from swgsim import storage
from swgsim.seeds import generator
from swgsim.style import words

EFFICIENCY, RIPPLE, OFFSETS, SHAPE, POINT = (
    "efficiency",
    "torque ripple",
    "gauge offsets",
    "even orders around the circumference",
    "operating point",
)
REPEATS = 5  # permutations of each group
# Names of features to their group, the first that fits.
GROUPS: Mapping[str, str] = {
    EFFICIENCY: r"eta|viscous",
    OFFSETS: r"^s\d\[0\]$|^\|s1\.\.s4\[0\]",
    SHAPE: r"^\|s1\.\.s4\[",
    RIPPLE: r"\b(s0|mean)\[",
    POINT: r".*",
}
# A fault to the groups of features in which its physics (docs/chain.md) lets it show, and why.
PHYSICS: Mapping[str, tuple[tuple[str, ...], str]] = {
    "reduced_damping": ((EFFICIENCY,), "b1 is viscous loss and leaves the gauges almost alone"),
    "reduced_stiffness": ((RIPPLE,), "k1 scales the torque ripple that the kinematic error makes"),
    "eccentric_wave_generator": ((OFFSETS, SHAPE), "an imposed displacement shows in offsets and even orders"),
    "root_tooth_crack": ((OFFSETS, SHAPE), "a softer rim shows in offsets and even orders"),
    "tip_tooth_crack": ((OFFSETS, SHAPE), "lost tooth force shows in offsets and even orders"),
}


def groups_of(names: tuple[str, ...]) -> dict[str, list[int]]:
    """Columns of every group of features that there is.

    >>> groups_of(("s0[0]", "|s1..s4[2]| wave 1", "Re s0[2]", "log eta_rel", "speed"))["torque ripple"]
    [2]
    """
    found: dict[str, list[int]] = {}
    for column, name in enumerate(names):
        group = next(group for group, pattern in GROUPS.items() if re.search(pattern, name))
        found.setdefault(group, []).append(column)
    return {group: found[group] for group in GROUPS if group in found}


def found_sizes(predictions: pd.DataFrame) -> list[tuple[str, ...]]:
    """Per fault: share taken for any fault, and the sizes found in 90 % of recordings, without and with confidence."""
    rows = []
    for row in detection_table(predictions, taken_for_a_fault(predictions), by=()).to_dict("records"):
        unit = UNITS.get(row["label"], "")
        sizes = ["-" if np.isnan(row[name]) else f"{row[name]:.3g}{unit}" for name in ("a90", "a90_95")]
        why = [text.replace("_", "/") for text in str(row["reason"]).split("; ") if not text.startswith("a50")]
        rows.append((words(row["label"]), f"{row['hits']:.1f}", *sizes, "; ".join(why)))
    return rows


def conformal(predictions: pd.DataFrame, nominal: float = 0.9) -> pd.DataFrame:
    """Figures of the prediction sets of every gear, each with the threshold that all the other gears give."""
    said, y, gears = probabilities(predictions), class_numbers(predictions), predictions["gear"].to_numpy()
    parts = []
    for gear in np.unique(gears):
        here = gears == gear
        threshold = conformal_threshold(said[~here], y[~here], gears[~here], nominal)
        parts.append(set_figures(prediction_sets(said[here], threshold), y[here], gears[here]))
    return pd.concat(parts)


def importance(store: Store, run: pd.Series, data: Path) -> pd.DataFrame:
    """Drop of every fault's recall when a group of features says nothing, of a method refitted on the first fold.

    Features are exchanged between a fault's recordings and healthy ones only: those of other faults would make it look
    like another fault, and every group would seem to matter.

    Parameters
    ----------
    store : Store
    run : Series
        Of the method, with ``run_id`` and ``trial/...``.
    data : Path
        The data set.

    Returns
    -------
    DataFrame
        Of :func:`learn.importance.grouped_permutation`.
    """
    config = configuration(store, str(run["run_id"]))
    chosen = learning_set_of(data, storage.digest(data), settings.representation(config["features"]))
    protocol = settings.protocol(config["protocol"])
    split = next(iter(protocol.split(chosen.features, chosen.table)))
    y = chosen.table["label"].astype(str).to_numpy()
    model = settings.classifier(config["classifier"], chosen.layout)(**options_of(config, run, protocol))
    model.fit(chosen.features[split.train], y[split.train])
    X, truth = chosen.features[split.test], y[split.test]
    blocks = chosen.table.iloc[split.test].groupby(list(OPERATING_POINT)).ngroup().to_numpy()
    parts = []
    for label in PHYSICS:
        pair = np.isin(truth, [label, "healthy"])
        rng = generator("report", "importance", label)
        drops = grouped_permutation(
            model, X[pair], truth[pair], groups_of(chosen.names), blocks[pair], rng, repeats=REPEATS
        )
        parts.append(drops[drops["label"] == label])
    return pd.concat(parts, ignore_index=True)


def configuration(store: Store, run_id: str) -> dict[str, Any]:
    """The resolved configuration that a run keeps."""
    with tempfile.TemporaryDirectory() as folder:
        text = Path(store.client.download_artifacts(run_id, "config.yaml", folder)).read_text()
    result: dict[str, Any] = yaml.safe_load(text)
    return result


def options_of(config: Mapping[str, Any], run: pd.Series, protocol: object) -> Mapping[str, Any]:
    """The options that the job chose: those of the trial with the highest score."""
    trials = settings.trials(config["classifier"])
    scores = [run.get(f"trial/{number}", np.nan) for number in range(1, len(trials) + 1)]
    if np.isfinite(scores).any():
        return trials[int(np.nanargmax(scores))]
    return trials[0] if isinstance(protocol, NewGears) and protocol.development else {}


def physics_checked(drops: pd.DataFrame) -> list[str]:
    """One sentence per fault: which group of features carries it, and whether its physics says so."""
    table = drops.pivot(index="label", columns="group", values="drop")
    sentences = []
    for label, (expected, why) in PHYSICS.items():
        if label not in table.index:
            continue
        largest = row_of(table, label).astype(float)
        group, drop = str(largest.idxmax()), float(largest.max())
        if drop < 1:
            found = f"no single group costs more than {max(drop, 0):.1f} points, several know the same"
        elif group in expected:
            found = f"most recall is lost with {group} ({drop:.1f} points), as its physics says: {why}"
        else:
            there = {name: f"{largest[name]:.1f}" for name in expected if name in largest.index}
            beside = ", ".join(f"{name} {value}" for name, value in there.items()) or "not among the features"
            named = " or ".join(expected)
            found = (
                f"most recall is lost with {group} ({drop:.1f} points); its physics names {named} ({beside}), as {why}"
            )
        sentences.append(f"{words(label)}: {found}.")
    return sentences
