"""Structs, struct arrays, cells and matrices as MATLAB saves them, in versions 5 and 7.3, and what references mean."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
from scipy.io import savemat

TIME = np.arange(20.0)
Q = np.arange(60.0).reshape(20, 3)  # 20 samples of 3 joints


def save_v5(path: Path) -> None:
    runs = np.zeros((1, 3), [("q", object), ("load", object)])
    for i in range(3):
        runs[0, i] = ({"deg": Q[:, i]}, float(i))
    cells = np.empty((2, 2), object)
    cells[:] = [[TIME, "a text"], [Q, {"x": TIME + 1}]]
    table = {"t": TIME[:, None], "tau": Q[:, :1], "ok": TIME[:, None] > 3}
    records = np.zeros(20, [("t", object), ("n", object)])
    for i in range(20):
        records[i] = (float(i), np.int32(10 * i))
    content = {
        "time": TIME, "Joint_state": {"q": Q.T, "note": "text"}, "runs": runs, "c": cells, "table": table,
        "records": records, "square": np.ones((20, 20)), "stamp": np.arange(20, dtype="i8") + 2**62, "flag": TIME > 3,
    }  # fmt: skip
    savemat(path, content, do_compression=True)


def save_v73(path: Path) -> None:
    """The same as MATLAB writes it: reversed order, classes as attributes, and references for elements."""
    with h5py.File(path, "w", userblock_size=512) as file:
        store = file.create_group("#refs#")

        def put(group: h5py.Group, name: str, values: Any, kind: str = "double") -> h5py.Dataset:
            made = group.create_dataset(name, data=np.atleast_2d(values).T if np.ndim(values) < 2 else values.T)
            made.attrs["MATLAB_class"] = np.bytes_(kind)
            return made

        def struct_of(group: h5py.Group, name: str, **fields: Any) -> h5py.Group:
            made = group.create_group(name)
            made.attrs["MATLAB_class"] = np.bytes_("struct")
            for key, values in fields.items():
                put(made, key, values, "logical" if key == "ok" else "double")
            return made

        def references(
            group: h5py.Group, name: str, shape: tuple[int, ...], items: list[h5py.HLObject]
        ) -> h5py.Dataset:
            made = group.create_dataset(name, shape[::-1], h5py.ref_dtype)
            made[...] = np.array([item.ref for item in items], h5py.ref_dtype).reshape(shape[::-1])
            return made

        put(file, "time", TIME)
        struct_of(file, "Joint_state", q=Q.T)
        put(file["Joint_state"], "note", np.frombuffer("text".encode("utf-16le"), "u2"), "char")
        runs = struct_of(file, "runs")
        references(runs, "q", (1, 3), [struct_of(store, f"q{i}", deg=Q[:, i]) for i in range(3)])
        references(runs, "load", (1, 3), [put(store, f"load{i}", float(i)) for i in range(3)])
        elements = [put(store, "c1", TIME), put(store, "c2", Q), put(store, "c3", np.array([97], "u2"), "char")]
        cells = references(file, "c", (2, 2), [*elements, struct_of(store, "c4", x=TIME + 1)])
        cells.attrs["MATLAB_class"] = np.bytes_("cell")
        struct_of(file, "table", t=TIME, tau=Q[:, 0], ok=(TIME > 3).astype("u1"))
        records = struct_of(file, "records")
        references(records, "t", (20, 1), [put(store, f"t{i}", float(i)) for i in range(20)])
        references(records, "n", (20, 1), [put(store, f"n{i}", np.int32(10 * i), "int32") for i in range(20)])
        put(file, "square", np.ones((20, 20)))
        put(file, "stamp", np.arange(20, dtype="i8") + 2**62, "int64")
        put(file, "flag", (TIME > 3).astype("u1"), "logical")


MEANT = {
    "time": TIME, "Joint_state.q[2]": Q[:, 1], "Joint*.q[3]": Q[:, 2], "Joint_state/q[1]": Q[:, 0],
    "runs[3].q.deg": Q[:, 2], "runs[2].q.d*": Q[:, 1], "c[1]": TIME, "c[2][3]": Q[:, 2], "c[4].x": TIME + 1,
    "table.tau": Q[:, 0], "t*.t": TIME, "table.ok": TIME > 3, "flag": TIME > 3, "records.n": 10 * TIME,
    "stamp": np.arange(20) + 2**62,
}  # fmt: skip
