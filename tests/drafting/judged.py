"""Judge a draft: the reading must give the numbers of the truth."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from layouts import Case

from swgsim.joint.intake.read import read_joints
from swgsim.recordings.read import inspect_recordings

# Largest deviation as a share of a signal's range: encoder counts and eight digits of text stay below.
EXACT = 2e-3


def mistake(case: Case, folder: Path, text: str, file: Path) -> str:
    """What is wrong with a map; empty if the numbers are those of the truth.

    Parameters
    ----------
    case : Case
    folder : Path
        Its files.
    text : str
        The map.
    file : Path
        Where it is written.
    """
    file.write_text(text, encoding="utf-8")
    try:
        found = _gauges(folder, file) if case.kind == "gauges" else _joints(folder, file)
    except ValueError as error:
        return str(error)
    for name, signals in case.truth.items():
        if set(found.get(name, {})) != set(signals):
            return f"{name}: {sorted(found.get(name, {}))} for {sorted(signals)}"
        for signal, values in signals.items():
            if reason := _differs(signal, found[name][signal], values):
                return f"{name}: {reason}"
    return ""


def _gauges(folder: Path, file: Path) -> dict[str, Mapping[str, np.ndarray]]:
    return {each.name: {"t": each.time, **each.channels} for each in inspect_recordings(folder, file)}


def _joints(folder: Path, file: Path) -> dict[str, Mapping[str, np.ndarray]]:
    """By the joint, and by run and joint."""
    read = read_joints(folder, file).recordings
    return {
        name: {"t": each.time, **each.signals} for each in read for name in (each.joint, f"{each.name} {each.joint}")
    }


def _differs(signal: str, found: np.ndarray, truth: np.ndarray) -> str:
    if len(found) != len(truth):
        return f"{len(found)} samples of {signal} for {len(truth)}"
    if signal == "t":
        found, truth = found - found[0], truth - truth[0]
    if signal in ("q", "phi_in"):  # a wrapped angle begins at any turn
        found = found - 2 * np.pi * np.round((found - truth).mean() / (2 * np.pi))
    worst = float(np.abs(found - truth).max() / np.ptp(truth))
    return f"{signal} is off by {worst:.2g} of its range" if worst > EXACT else ""
