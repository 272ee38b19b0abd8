"""Feature importance: groups of features on which decisions rest, compared with the physics of each fault."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

from learn.evaluation.evaluate import fit
from learn.evaluation.importance import grouped_permutation
from learn.inputs.inputs import OPERATING_POINT
from learn.jobs import settings
from learn.jobs.train_job import learning_set_of
from learn.protocols.levels import NewGears
from learn.transfer_report.runs import Runs
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
REPEATS = 5  # permutations of each group
# Patterns of feature names; the first match is the group. The common part of s1 to s4 is the torque ripple.
GROUPS: Mapping[str, str] = {
    EFFICIENCY: r"eta|viscous",
    OFFSETS: r"^s\d\[0\]$|^\|s1\.\.s4\[0\]",
    RIPPLE: r"\b(s0|mean)\[|^\|s1\.\.s4\[[24]\]\| wave 0$",
    SHAPE: r"^\|s1\.\.s4\[",
    POINT: r".*",
}
# Groups of features that a fault changes according to its physics (docs/chain.md).
PHYSICS: Mapping[str, tuple[str, ...]] = {
    "reduced_damping": (EFFICIENCY,),
    "reduced_stiffness": (RIPPLE,),
    "eccentric_wave_generator": (OFFSETS, SHAPE),
    "root_tooth_crack": (OFFSETS, SHAPE),
    "tip_tooth_crack": (OFFSETS, SHAPE),
}


def groups_of(names: tuple[str, ...]) -> dict[str, list[int]]:
    """Columns of every group of features.

    >>> groups_of(("s0[0]", "|s1..s4[2]| wave 1", "Re s0[2]", "log eta_rel", "speed"))["torque ripple"]
    [2]
    """
    found: dict[str, list[int]] = {}
    for column, name in enumerate(names):
        group = next(group for group, pattern in GROUPS.items() if re.search(pattern, name))
        found.setdefault(group, []).append(column)
    return {group: found[group] for group in GROUPS if group in found}


def importance(runs: Runs, run: pd.Series, data: Path) -> tuple[pd.DataFrame, int]:
    """Loss of every fault's recall without a group of features, on the gears of the first fold.

    The method is trained again on the source gears of the first fold, with the options that the run chose. Features are
    exchanged between recordings of a fault and healthy ones only. Values of other faults would make the fault look like
    another fault, and every group would seem important.

    Parameters
    ----------
    runs : Runs
    run : Series
        Run of the method, with ``run_id`` and ``chosen/1``.
    data : Path
        The data set.

    Returns
    -------
    DataFrame
        Result of :func:`learn.evaluation.importance.grouped_permutation`.
    int
        Number of judged gears.
    """
    config = runs.configuration(str(run["run_id"]))
    chosen = learning_set_of(data, storage.digest(data), settings.representation(config["features"]))
    protocol = settings.protocol(config["protocol"])
    split = next(iter(protocol.split(chosen.features, chosen.table)))
    y = chosen.table["label"].astype(str).to_numpy()
    model = settings.classifier(config["classifier"], chosen.layout)(**options_of(config, run, protocol))
    judged, X, truth = chosen.table.iloc[split.test], np.asarray(chosen.features[split.test]), y[split.test]
    points = judged.groupby(list(OPERATING_POINT)).ngroup().to_numpy()
    groups, parts = groups_of(chosen.names), []
    with threadpool_limits(1):  # many small predictions, for which threads would only wait
        fit(model, chosen.features[split.train], y[split.train], chosen.table["gear"].to_numpy()[split.train])
        for label in PHYSICS:
            pair = np.isin(truth, [label, "healthy"])
            rng = generator("report", "importance", label)
            found = grouped_permutation(model, X[pair], truth[pair], groups, points[pair], rng, repeats=REPEATS)
            parts.append(found[found["label"] == label])
    return pd.concat(parts, ignore_index=True), judged["gear"].nunique()


def options_of(config: Mapping[str, Any], run: pd.Series, protocol: object) -> Mapping[str, Any]:
    """The options that the job chose for its first fold."""
    trials, chosen = settings.trials(config["classifier"]), run.get("chosen/1", np.nan)
    if np.isfinite(chosen):
        return trials[int(chosen) - 1]
    return trials[0] if isinstance(protocol, NewGears) and protocol.development else {}


def importance_text(drops: pd.DataFrame) -> pd.DataFrame:
    """Recall that every fault (rows) loses without a group of features (columns), if the loss exceeds its doubt.

    A star marks the groups that the physics of the fault names.
    """
    clear = drops["drop"] > drops["doubt"]
    stars = [" *" if group in PHYSICS[label] else "" for group, label in drops[["group", "label"]].to_numpy()]
    text = drops["drop"].map("{:.1f}".format).where(clear, "not clear") + pd.Series(stars, drops.index)
    wide = drops.assign(text=text).pivot(index="label", columns="group", values="text")
    return wide.loc[list(PHYSICS), drops["group"].unique()].rename(index=words).rename_axis("fault")
