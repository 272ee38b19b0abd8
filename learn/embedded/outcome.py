"""Results of one method: accuracy of its code, and its flash, RAM and instructions on microcontrollers."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pandas as pd

from learn.embedded.fold import Fold, folds, judged
from learn.embedded.machines import CORTEX_M4, CORTEX_M7, HOST_SANITIZED, Machine, build, missing
from learn.embedded.proof import agreement, combined, operations
from learn.embedded.running import Decisions, decide
from learn.embedded.sizes import sizes
from learn.inputs.inputs import SPECIMEN, Layout
from learn.jobs import settings
from learn.protocols.levels import NewGears
from learn.protocols.splits import LeaveOneGearOut

MICROCONTROLLERS = (CORTEX_M4, CORTEX_M7)


def outcome(config: Mapping[str, Any], name: str) -> list[dict[str, Any]]:
    """One entry for each kind of numbers in which a method is exported.

    Parameters
    ----------
    config : mapping
        Resolved configuration ``conf/embedded.yaml``.
    name : str
        Of one of its methods.
    """
    method = config["methods"][name]
    representation = settings.representation(config["inputs"][method["features"]])

    def make(layout: Layout) -> Any:
        return settings.classifier(config["classifiers"][method["classifier"]], layout)(**method["options"])

    unseen, disturbed = (Path(config["data"]) / f"{config[each]}.h5" for each in ("unseen", "disturbed"))
    every_variant = NewGears(judged=config["judged"], development=0, labelled=0, unlabelled=0, kept_out=0)
    (new,) = folds(unseen, every_variant, representation, make)
    others = list(folds(disturbed, LeaveOneGearOut(), representation, make))
    return [
        {"method": name, "numbers": numbers, **_accuracy(new, others, numbers), **_cost(new, numbers, config)}
        for numbers in method["numbers"]
    ]


def _accuracy(new: Fold, others: list[Fold], numbers: str) -> dict[str, Any]:
    errors, equal = judged(new, numbers)
    tables, agreements = zip(*(judged(fold, numbers) for fold in others), strict=True)
    specimens = errors.groupby(list(SPECIMEN), observed=True)["error"].mean().reset_index()
    return {
        "specimens": specimens.astype({"label": str}).to_dict("list"),
        "disturbed": 100 - float(np.mean([table["error"].mean() for table in tables])),
        "host": {"unseen": asdict(equal), "disturbed": asdict(combined(agreements))},
    }


def _cost(fold: Fold, numbers: str, config: Mapping[str, Any]) -> dict[str, Any]:
    """Costs of the first gear's code on the microcontrollers whose tools are installed; first a run with sanitizers."""
    installed = [machine for machine in MICROCONTROLLERS if not missing(machine)]
    part = fold.of_gear(fold.gears[0])
    with TemporaryDirectory(prefix="swg-") as folder:
        code = Path(folder) / "c"
        part.export(code, numbers)
        checked = build(code, HOST_SANITIZED, Path(folder) / "checked")
        memory = sizes(code, CORTEX_M4) if CORTEX_M4 in installed else None
        return {
            "sanitized": _decided(checked, HOST_SANITIZED, part, config["proof"])[1],
            "flash": dict(memory.flash) if memory else {},
            "ram": memory.ram if memory else None,
            "machines": {machine.name: _on(machine, part, Path(folder), config) for machine in installed},
        }


def _on(machine: Machine, part: Fold, folder: Path, config: Mapping[str, Any]) -> dict[str, Any]:
    program = build(folder / "c", machine, folder / machine.name)
    counts, _ = _decided(program, machine, part, config["counted"], counted=True)
    parts = pd.DataFrame(counts.instructions)
    return {
        "agreement": _decided(program, machine, part, config["proof"])[1],
        "instructions": parts.mean().to_dict(),
        "most_instructions": int((parts["window"] + parts["decide"]).max()),
        "longest_push": int(parts["push"].max()),
        "stack": counts.stack,
    }


def _decided(
    program: Path, machine: Machine, part: Fold, count: int, *, counted: bool = False
) -> tuple[Decisions, dict[str, Any]]:
    """Decisions of a program on some of a gear's recordings, evenly chosen, and its agreement with the original."""
    rows = np.linspace(0, len(part.features) - 1, min(count, len(part.features))).round().astype(int)
    chosen = part.recordings.samples.where(rows)
    decisions = decide(program, machine, chosen.signals, operations(chosen.table), counted=counted)
    return decisions, asdict(agreement(decisions, part.model.predict_proba(part.features[rows])))
