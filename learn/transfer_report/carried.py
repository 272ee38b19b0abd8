"""What the decisions of a method rest on: groups of features and single lines, beside each fault's physics."""

import re
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml
from jaxtyping import Float, Int
from threadpoolctl import threadpool_limits

from learn.evaluation.importance import Predictor, grouped_permutation
from learn.inputs.inputs import OPERATING_POINT
from learn.jobs import settings
from learn.jobs.train_job import learning_set_of
from learn.protocols.levels import NewGears
from learn.tracking import Store
from learn.transfer_report.sentences import listed
from swgsim.common.seeds import generator
from swgsim.common.style import words
from swgsim.storage import storage

EFFICIENCY, RIPPLE, OFFSETS, SHAPE, POINT = (
    "efficiency",
    "torque ripple",
    "gauge offsets",
    "even orders around the circumference",
    "operating point",
)
REPEATS, LINE_REPEATS = 5, 3  # permutations of each group, and of each of the many lines
SHOWN, NAMED = 12, 3  # lines of the finer map, and those named for each fault
# Names of features to their group, the first that fits. What s1 to s4 have in common is the torque ripple.
COMMON = r"^\|s1\.\.s4\[([24])\]\| wave 0$"
GROUPS: Mapping[str, str] = {
    EFFICIENCY: r"eta|viscous",
    OFFSETS: r"^s\d\[0\]$|^\|s1\.\.s4\[0\]",
    RIPPLE: rf"\b(s0|mean)\[|{COMMON}",
    SHAPE: r"^\|s1\.\.s4\[",
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


def lines_of(names: tuple[str, ...]) -> dict[str, list[int]]:
    """Columns of every pattern of gauges and order: parts of a line, also relative to the healthy one, are one group.

    >>> lines_of(("Re s0[2]", "Im s0[2]", "Re s0[2] / healthy", "|s1..s4[2]| wave 1", "log eta_rel"))
    {'efficiency': [4], 's0[2]': [0, 1, 2], '|s1..s4[2]| wave 1': [3]}
    """
    found: dict[str, list[int]] = {}
    for whole, columns in groups_of(names).items():
        for column in columns:
            line = re.sub(COMMON, r"mean[\1]", re.sub(r"^(Re|Im) | / healthy$", "", names[column]))
            found.setdefault(whole if whole in (EFFICIENCY, POINT) else line, []).append(column)
    return found


@dataclass(frozen=True)
class Refitted:
    """A method fitted anew, and the judged recordings of the first fold.

    Attributes
    ----------
    model : Predictor
    features : array (row, feature)
    truth : array (row,)
        Class names.
    points : array (row,)
        Number of the operating point.
    names : tuple of str
        One per feature.
    gears : int
        Judged gears, of which the recordings are.
    """

    model: Predictor
    features: Float[np.ndarray, "row feature"]
    truth: np.ndarray
    points: Int[np.ndarray, " row"]
    names: tuple[str, ...]
    gears: int


@dataclass(frozen=True)
class Carried:
    """Drop of every fault's recall on some gears, by groups of features and by single lines: :func:`importance`."""

    groups: pd.DataFrame
    lines: pd.DataFrame
    gears: int


def carried(refitted: Refitted) -> Carried:
    """Both maps of one fitted method."""
    with threadpool_limits(1):  # many small predictions, for which threads would only wait
        return Carried(
            importance(refitted, groups_of(refitted.names), REPEATS),
            importance(refitted, lines_of(refitted.names), LINE_REPEATS),
            refitted.gears,
        )


def refit(store: Store, run: pd.Series, data: Path) -> Refitted:
    """A method of the main comparison, fitted on the source gears of the first fold with the options it chose.

    Parameters
    ----------
    store : Store
    run : Series
        Of the method, with ``run_id`` and ``trial/...``.
    data : Path
        The data set.
    """
    config = configuration(store, str(run["run_id"]))
    chosen = learning_set_of(data, storage.digest(data), settings.representation(config["features"]))
    protocol = settings.protocol(config["protocol"])
    split = next(iter(protocol.split(chosen.features, chosen.table)))
    y = chosen.table["label"].astype(str).to_numpy()
    model = settings.classifier(config["classifier"], chosen.layout)(**options_of(config, run, protocol))
    with threadpool_limits(1):  # only now, as it limits no library that is loaded later
        model.fit(chosen.features[split.train], y[split.train])
    judged = chosen.table.iloc[split.test]
    points = judged.groupby(list(OPERATING_POINT)).ngroup().to_numpy()
    X = np.asarray(chosen.features[split.test])
    return Refitted(model, X, y[split.test], points, chosen.names, judged["gear"].nunique())


def importance(refitted: Refitted, groups: Mapping[str, Sequence[int]], repeats: int) -> pd.DataFrame:
    """Drop of every fault's recall when a group of features says nothing.

    Features are exchanged between a fault's recordings and healthy ones only: those of other faults would make it look
    like another fault, and every group would seem to matter.

    Returns
    -------
    DataFrame
        Of :func:`learn.evaluation.importance.grouped_permutation`.
    """
    parts = []
    for label in PHYSICS:
        pair = np.isin(refitted.truth, [label, "healthy"])
        rng = generator("report", "importance", label)
        drops = grouped_permutation(
            refitted.model, refitted.features[pair], refitted.truth[pair], groups, refitted.points[pair], rng,
            repeats=repeats,
        )  # fmt: skip
        parts.append(drops[drops["label"] == label])
    return pd.concat(parts, ignore_index=True)


def costliest(drops: pd.DataFrame, count: int = SHOWN) -> pd.DataFrame:
    """The groups that cost some fault most, the costliest first."""
    largest = drops.groupby("group")["drop"].max().nlargest(count)
    return drops.set_index("group").loc[largest.index].rename_axis("group").reset_index()


def configuration(store: Store, run_id: str) -> dict[str, Any]:
    """The resolved configuration that a run keeps."""
    with tempfile.TemporaryDirectory() as folder:
        text = Path(store.client.download_artifacts(run_id, "config.yaml", folder)).read_text(encoding="utf-8")
    result: dict[str, Any] = yaml.safe_load(text)
    return result


def options_of(config: Mapping[str, Any], run: pd.Series, protocol: object) -> Mapping[str, Any]:
    """The options that the job chose: those of the trial with the highest score."""
    trials = settings.trials(config["classifier"])
    scores = [run.get(f"trial/{number}", np.nan) for number in range(1, len(trials) + 1)]
    if np.isfinite(scores).any():
        return trials[int(np.nanargmax(scores))]
    return trials[0] if isinstance(protocol, NewGears) and protocol.development else {}


def costly(drops: pd.DataFrame, label: str) -> pd.DataFrame:
    """Groups that cost a fault recall beyond doubt, the costliest first; ``tied`` ones cost as much within theirs."""
    found = drops[(drops["label"] == label) & (drops["drop"] > drops["doubt"])].sort_values("drop", ascending=False)
    return found.assign(tied=found["drop"] + found["doubt"] >= found["drop"].max())


def physics_checked(drops: pd.DataFrame) -> list[str]:
    """One sentence per fault: which group of features carries it, and whether its physics says so."""
    sentences = []
    for label, (expected, why) in PHYSICS.items():
        here = drops[drops["label"] == label].set_index("group")["drop"]
        if here.empty:
            continue
        found = costly(drops, label)
        first, *others = found.loc[found["tied"], "group"] if len(found) else [""]
        most = f"most recall is lost with {first}" + (f", as much as with {listed(others)}" if others else "")
        if found.empty:
            said = "no single group costs recall beyond chance, several know the same or none is used"
        elif {first, *others} & set(expected):
            said = f"{most} ({here[first]:.1f} points), as its physics says: {why}"
        else:
            beside = ", ".join(f"{name} {here[name]:.1f}" for name in expected if name in here.index)
            said = (
                f"{most} ({here[first]:.1f} points); its physics names {' or '.join(expected)} "
                f"({beside or 'not among the features'}), as {why}"
            )
        sentences.append(f"{words(label)}: {said}.")
    return sentences


def lines_said(drops: pd.DataFrame) -> list[str]:
    """One sentence per fault: the lines that cost most recall, and how many cost as much as the first."""
    sentences = []
    for label in PHYSICS:
        found = costly(drops, label)
        named = listed(f"{row['group']} ({row['drop']:.1f})" for row in found[:NAMED].to_dict("records"))
        more = int(found["tied"][NAMED:].sum())
        tied = f"; {more} more cost as much as the first, within the doubt" if more else ""
        sentences.append(f"{words(label)}, lines that cost most [points of recall]: {named}{tied}.")
    return sentences
