"""What ``transfer.json`` holds, and how the study was made."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from learn.transfer_report.input_studies import nested_inputs
from learn.transfer_report.results import (
    FOREST,
    ORACLE,
    ORACLE_OF_SESSION,
    SHOTS,
    ZeroShot,
    best_adapted,
    figure,
    finite,
    interval,
    row_of,
)
from learn.transfer_report.studies import PAPER_FOREST, best_disturbed

CNN_FIT = ("seconds", "recordings", "samples_per_second", "over_bare_step", "dataloader_loop_over_ours")
RECORDINGS = 4320  # of the timed fit, at most: two of the paper's gears


def content(
    zero: ZeroShot,
    few: pd.DataFrame,
    inputs: pd.DataFrame,
    cases: pd.DataFrame,
    fit: Mapping[str, float],
    seconds: float,
) -> dict[str, Any]:
    """All of ``transfer.json``; errors in points, accuracies in per cent, None for an interval that is unknown."""
    best = row_of(zero.table, zero.best)
    solved = best_disturbed(cases)
    adapted = {shots: row for shots in SHOTS if (row := best_adapted(few, shots)) is not None}
    return {
        "z1": {
            "forest_error": finite(figure(zero.table, FOREST)),
            "best_method": zero.best,
            "best_error": finite(best["value"]),
            "ratio": finite(best["ratio"]),
            "ci95": interval(best, "ratio_"),
            "ratio_to_oracle": finite(best["oracle"]),
            "chosen_on_development_gears": zero.chosen,
            "chosen_error": finite(figure(zero.table, zero.chosen)) if zero.chosen else None,
        },
        "z3": {
            str(shots): {
                "best_method": row["method"],
                "best_error": finite(row["value"]),
                "ratio_to_forest": finite(row["ratio"]),
                "ci95": interval(row, "ratio_"),
            }
            for shots, row in adapted.items()
        },
        "oracle_error": finite(figure(zero.table, ORACLE)),
        "oracle_session_error": finite(figure(zero.table, ORACLE_OF_SESSION)),
        "gears": zero.gears,
        "inputs": nested_inputs(inputs, efficiency=True),
        "inputs_without_efficiency": nested_inputs(inputs, efficiency=False),
        "cnn_fit": {name: fit[name] for name in CNN_FIT},
        "disturbed": {
            "z1": row_of(cases, solved).round(3).tolist(),
            "z1_method": solved,
            "forest_paper": row_of(cases, PAPER_FOREST).round(3).tolist(),
            "forest_in_the_paper": cases.iloc[0].round(3).tolist(),
        },
        "seconds": round(seconds, 1),
    }


def cnn_fit(benchmark: Path, recordings: int) -> dict[str, Any]:
    """The timed training of the CNN, from the file of the benchmark, or measured now if it is not there.

    Parameters
    ----------
    benchmark : Path
    recordings : int
        Of the data set: a small one is not kept waiting for a fit larger than any of its own.
    """
    kept = json.loads(benchmark.read_text()) if benchmark.is_file() else {}
    if "training" in kept:
        found: dict[str, Any] = kept["training"]
    else:
        from learn.methods.training_benchmark import measure

        found = measure(recordings=min(recordings, RECORDINGS))
    return found


def how_made(
    data: Mapping[str, Any],
    run: pd.Series,
    judged: int,
    trials: Sequence[int],
    fit: Mapping[str, Any],
    seconds: float,
    seconds_are: str,
    versions: Mapping[str, str],
) -> list[tuple[str, str]]:
    """Facts about the study, as pairs of what and how.

    Parameters
    ----------
    data : mapping
        Configuration of the data set.
    run : Series
        Parameters of a run with adaptation.
    judged : int
        Judged gears.
    trials : sequence of int
        How many options were tried, of every method that has options.
    fit : mapping
        Of :func:`cnn_fit`.
    seconds : float
    seconds_are : str
        How they are counted.
    versions : mapping
    """
    grid = data["grid"]
    tried = " or ".join(map(str, sorted(set(trials)))) or "none"
    gears = grid["population"]["count"] if grid.get("population") else len(data["gears"])
    points = f"{len(grid['speeds_rpm'])} speeds and {len(grid['loads_nm'])} loads" if "loads_nm" in grid else "grid"
    return [
        (
            "gears",
            f"{gears}: {judged} judged in {run['protocol.folds']} folds, {run['protocol.development']} for development",
        ),
        ("specimens", f"{grid['variants']} of each class and gear; operating points: {points}"),
        (
            "pools of a judged gear",
            f"of each class {run['protocol.labelled']} labelled, {run['protocol.unlabelled']} unlabelled, the others "
            f"judged; {run['protocol.kept_out']} of each source gear are never trained on",
        ),
        ("options", f"{tried} tried on development gears for every one of {len(trials)} methods that has options"),
        ("shots", f"{run['shots']}, {run['draws']} nested draws, the same for all methods"),
        ("seed", str(run["seed"])),
        (
            "CNN, one fit",
            f"{fit['recordings']} recordings in {fit['seconds']:.1f} s; an epoch takes {fit['over_bare_step']:.2f} "
            f"times the bare steps, the usual loop {fit['dataloader_loop_over_ours']:.2f} times ours",
        ),
        ("seconds", f"{seconds:.0f} ({seconds_are})"),
        ("versions", ", ".join(f"{name} {text}" for name, text in versions.items())),
    ]
