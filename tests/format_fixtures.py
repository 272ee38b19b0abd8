"""Sound files of many formats, with the same numbers."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pyuff
from asammdf import MDF, Signal
from nptdms import ChannelObject, TdmsWriter

ROWS = 40
TORQUE = np.random.default_rng(0).normal(size=ROWS)
COUNTS = np.arange(ROWS, dtype="i4") + 2**30
STEP = 0.001


def save_tdms(path: Path) -> None:
    wave = {"wf_increment": STEP, "wf_start_offset": 0.5}
    stamps = np.datetime64("2024-02-29T12:00:00", "us") + np.arange(ROWS)
    with TdmsWriter(path) as writer:
        writer.write_segment([
            ChannelObject("bench", "torque [Nm]", TORQUE, {**wave, "unit_string": "Nm"}),
            ChannelObject("bench", "n", COUNTS, wave),
            ChannelObject("slow", "n", TORQUE[:20], {"wf_increment": 2 * STEP}),
            ChannelObject("slow", "stamp", stamps),
            ChannelObject("slow", "note", ["a"] * ROWS),
        ])  # fmt: skip


def save_mdf(path: Path, version: str = "4.10") -> None:
    time = 0.5 + STEP * np.arange(ROWS)
    status = {"val_0": 0, "text_0": b"off", "val_1": 1, "text_1": b"on", "default": b"?"}
    wave = [
        Signal(TORQUE, time, "Nm", "torque [Nm]"),
        Signal(COUNTS, time, "", "n"),
        Signal((COUNTS % 7).astype("u1"), time, "Nm", "scaled", conversion={"a": 0.5, "b": -1.0}),
    ]
    if version.startswith("4"):
        wave.append(Signal((COUNTS % 2).astype("u1"), time, "", "status", conversion=status))
        wave.append(Signal(COUNTS.astype("f8"), time, "", "computed", conversion={"formula": "X + 1"}))
        invalid = np.arange(ROWS) == 3
        wave.append(Signal(TORQUE, time, "", "gaps", invalidation_bits=invalid))
    with MDF(version=version) as file:
        file.append(wave, acq_name="bench")
        file.append([Signal(TORQUE[:20], time[:20] * 2, "", "n")], acq_name="slow")
        file.save(path, overwrite=True)


def function(name: str, values: np.ndarray, **changes: Any) -> dict:
    texts = dict.fromkeys(("rsp_ent_name", "ref_ent_name", "id2", "id3", "id4", "id5"), "NONE")
    return {
        "type": 58, "binary": 0, "func_type": 1, "rsp_node": 1, "rsp_dir": 3, "ref_node": 0, "ref_dir": 0,
        "ord_data_type": 4, "abscissa_spacing": 1, "abscissa_min": 0.5, "abscissa_inc": STEP, "num_pts": len(values),
        "abscissa_spec_data_type": 17, "ordinate_axis_units_lab": "Nm", "id1": name, **texts, "data": values,
        "x": 0.5 + STEP * np.arange(len(values)), "ver_num": 0, "load_case_id": 0, "z_axis_value": 0,
        "orddenom_spec_data_type": 0, "z_axis_axis_lab": "NONE", "ordinate_axis_lab": "NONE", **changes,
    }  # fmt: skip


def save_uff(path: Path) -> None:
    uneven = 0.5 + STEP * np.arange(ROWS) ** 2
    functions = [
        function("torque [Nm]", TORQUE),
        function("n", COUNTS.astype("f8"), binary=1),
        function("n", TORQUE, x=uneven, abscissa_spacing=0, rsp_dir=-1, binary=1),
        function("spectrum", TORQUE, abscissa_spec_data_type=18),
    ]
    pyuff.UFF(str(path)).write_sets(functions, "overwrite")


def save_xlsx(path: Path) -> None:
    book = openpyxl.Workbook()
    for row in (["t", "torque [Nm]"], *zip((STEP * np.arange(ROWS)).tolist(), TORQUE.tolist(), strict=True)):
        book.active.append(row)
    book.save(path)


SAVED: dict[str, Callable[[Path], None]] = {
    "a.tdms": save_tdms, "a.mf4": save_mdf, "a.mdf": lambda path: save_mdf(path, "3.30"), "a.uff": save_uff,
    "a.xlsx": save_xlsx,
}  # fmt: skip

# Torque and counts.
COLUMNS = {
    "a.tdms": ("torque [Nm]", "bench/n"), "a.mf4": ("torque*", "bench/n"), "a.mdf": ("torque [Nm]", "0/n"),
    "a.uff": ("torque*", 2),
}  # fmt: skip
