"""Trained methods, and their exported C without a program around it: its functions called from Python."""

import ctypes
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from fabricated import recordings

from learn.evaluation.evaluate import fit
from learn.inputs.features import Selection
from swgsim.storage.labelled_signals import CLASSES, LabelledSignals

needs_compiler = pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc on this machine")
SELECTION = Selection(
    "all", statistics=True, spectrum="both", efficiency="both", orders=4, floor=1e-4, operating_point=True
)
OPERATION = ["n_in_rpm", "T_out_nm", "efficiency", "temperature_c"]
DRIVER = """
#include <string.h>
#include "swg.h"
void drive(const swg_operation *operation, const float *sample, int count, int samples, float *row, float *p, int *said)
{
    for (int r = 0; r < count; r++) {
        swg_window window;
        memset(&window, 0, sizeof window);
        for (int t = 0; t < samples; t++)
            if (swg_push(&window, &operation[r], sample + ((long)r * samples + t) * SWG_GAUGES))
                break;
        said[r] = swg_decide(&window, &operation[r], p + r * SWG_CLASSES);
        if (said[r] >= 0)
            swg_features(&window, &operation[r], row + r * SWG_COLUMNS);
    }
}
"""


def noisy() -> LabelledSignals:
    """Recordings of three gears with noise, without which rounding would be all that some features hold."""
    clean = recordings(gears=3, variants=6)
    noise = 1e-3 * np.random.default_rng(7).standard_normal(clean.signals.shape)
    table = clean.table.assign(temperature_c=25.0 + clean.table["variant"])
    return replace(clean, signals=(clean.signals + noise).astype(np.float32), table=table)


def of_gear(data: LabelledSignals, gear: int = 2) -> LabelledSignals:
    return data.where((data.table["gear"] == gear).to_numpy())


def trained(data: LabelledSignals, representation: Any, model: Any) -> tuple[Any, np.ndarray]:
    """A model that has seen all gears but the second, and the features of that one."""
    made = representation.learning_set([data])
    y = made.table["label"].astype(str).to_numpy()
    others = made.table["gear"].to_numpy() != 2
    fit(model, made.features[others], y[others])
    return model, made.features[~others]


def compiled(folder: Path) -> ctypes.CDLL:
    """The C of a folder, with warnings as errors."""
    driver, library = folder.parent / "driver.c", folder.parent / f"{folder.name}.so"
    driver.write_text(DRIVER)
    warnings = ["-Wall", "-Wextra", "-Wconversion", "-Wdouble-promotion", "-Werror"]
    sources = [str(driver), *map(str, folder.glob("*.c"))]
    command = ["gcc", "-std=c11", "-O1", *warnings, "-shared", "-fPIC", f"-I{folder}", *sources, "-lm", "-o", library]
    subprocess.run(command, check=True)
    return ctypes.CDLL(str(library))


def driven(
    library: ctypes.CDLL, recordings: LabelledSignals, columns: int, **facts: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rows of features, probabilities and answers; facts in place of those that were recorded."""
    return driven_signals(library, recordings.signals, recordings.table.assign(**facts), columns)


def driven_signals(
    library: ctypes.CDLL, signals: np.ndarray, table: pd.DataFrame, columns: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """As :func:`driven`, of signals that a data set would refuse."""
    count, _, samples = signals.shape
    given = [table[OPERATION].to_numpy(np.float32), signals.transpose(0, 2, 1).astype(np.float32)]
    rows, p = np.zeros((count, columns), np.float32), np.ones((count, len(CLASSES)), np.float32)
    said = np.zeros(count, np.int32)
    operation, sample, *results = (
        np.ascontiguousarray(each).ctypes.data_as(ctypes.c_void_p) for each in (*given, rows, p, said)
    )
    library.drive(operation, sample, count, samples, *results)
    return rows, p, said
