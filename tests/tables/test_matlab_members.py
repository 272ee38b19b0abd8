"""Structs, struct arrays, cells and matrices of MATLAB, of versions 5 and 7.3: a reference means one column."""

import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from scipy.io import savemat

from swgsim.tables.binary import listed, read_columns
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.limited import LimitedReader

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


@pytest.fixture(scope="module", params=[save_v5, save_v73])
def saved(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("matlab") / "run1.mat"
    request.param(path)
    return path


@pytest.fixture(scope="module")
def reader() -> Iterator[LimitedReader]:
    with LimitedReader() as process:
        yield process


MEANT = {
    "time": TIME, "Joint_state.q[2]": Q[:, 1], "Joint*.q[3]": Q[:, 2], "Joint_state/q[1]": Q[:, 0],
    "runs[3].q.deg": Q[:, 2], "runs[2].q.d*": Q[:, 1], "c[1]": TIME, "c[2][3]": Q[:, 2], "c[4].x": TIME + 1,
    "table.tau": Q[:, 0], "t*.t": TIME, "table.ok": TIME > 3, "flag": TIME > 3, "records.n": 10 * TIME,
    "stamp": np.arange(20) + 2**62,
}  # fmt: skip


def test_every_reference_means_its_column(saved: Path, reader: LimitedReader) -> None:
    found = read_columns(saved, saved.name, list(MEANT), reader)
    assert list(found) == list(MEANT)
    for name, values in MEANT.items():
        assert found[name].tolist() == values.tolist(), name
    assert found["stamp"].dtype == "i8"  # no digit is lost


NOT_MEANT = {
    "Joint_state": r"found a struct with .*'Joint_state.q' \(3 x 20\).*name one of these, such as Joint_state.q",
    "Joint_state.q": r"column Joint_state.q: found a matrix 3 x 20 with 3 signals, expected .*Joint_state.q\[1\]",
    "Joint_state.q[4]": "with 3 signals, but no 4",
    "Joint_state.note": "column Joint_state.note: found 'char'",
    "c": r"found a cell with 'c\[1\]'",
    "square[1]": "a square matrix 20 x 20, expected a matrix with a longer side",
    "time[1]": "the name alone, time, means a vector",
    "Joint_state.w": "expected 'Joint_state.w', as the map says",
    "tim": "is 'time' meant",
    "table.t*": r"found 'table.t' .*, 'table.tau' .*write more of its name",
    "runs.load": "found 3 samples",
}


def test_what_is_no_column_is_named_with_a_remedy(saved: Path, reader: LimitedReader) -> None:
    for name, message in NOT_MEANT.items():
        with pytest.raises(FileDefect, match=rf"^run1\.mat.*{message}"):
            read_columns(saved, saved.name, [name], reader)
    with pytest.raises(FileDefect, match="a name: they have no order"):
        read_columns(saved, saved.name, [1], reader)


def test_what_a_file_holds_is_listed(saved: Path, reader: LimitedReader) -> None:
    found = {each.name: each for each in listed(saved, saved.name, reader)}
    assert found["Joint_state.q"].shape == (3, 20)
    assert found["runs[2].q.deg"].kind == "double"
    assert found["records.n"].shape[-1] == 20 or found["records.n"].shape == (20,)
    assert {found[name].kind for name in ("Joint_state", "runs", "c")} == {"struct", "cell"}


def test_a_number_means_a_column_of_the_only_matrix(tmp_path: Path, reader: LimitedReader) -> None:
    savemat(tmp_path / "a.mat", {"data": Q})
    assert read_columns(tmp_path / "a.mat", "a.mat", [2, 3], reader)[3].tolist() == Q[:, 2].tolist()


def opaque(path: Path) -> None:
    """A table as MATLAB saves it in version 5: an element of class 17, without dimensions."""

    def element(kind: int, content: bytes) -> bytes:
        return struct.pack("<2I", kind, len(content)) + content + bytes(-len(content) % 8)

    parts = element(6, struct.pack("<2I", 17, 0)) + element(1, b"t") + element(1, b"MCOS") + element(1, b"table")
    savemat(path, {"time": TIME})
    path.write_bytes(path.read_bytes() + element(14, parts + element(14, b"")))


def table_73(path: Path) -> None:
    with h5py.File(path, "w", userblock_size=512) as file:
        made = file.create_dataset("t", data=np.ones((1, 6), "u4"))
        made.attrs["MATLAB_class"] = np.bytes_("table")
        made.attrs["MATLAB_object_decode"] = np.int32(3)


@pytest.mark.parametrize("write", [opaque, table_73])
def test_the_remedy_for_a_table_of_matlab_is_said(tmp_path: Path, write: Callable, reader: LimitedReader) -> None:
    write(tmp_path / "a.mat")
    for name in ("t", "t.time"):
        with pytest.raises(FileDefect, match=r"a\.mat.*table2struct\(t, 'ToScalar', true\)"):
            read_columns(tmp_path / "a.mat", "a.mat", [name], reader)
    if write is opaque:  # what else is in the file is read
        assert read_columns(tmp_path / "a.mat", "a.mat", ["time"], reader)["time"].tolist() == TIME.tolist()


def test_plain_hdf5_has_groups_and_records(tmp_path: Path) -> None:
    path = tmp_path / "run1.h5"
    with h5py.File(path, "w") as file:
        file["bench/torque [Nm]"] = TIME
        file["bench/torque [Nm]"].attrs["units"] = np.bytes_("Nm")
        file["log"] = np.rec.fromarrays([TIME, np.arange(20)], dtype=[("t", "f8"), ("n", "i4")])
        file["q"] = Q
    wanted = ["bench/torque [Nm]", "bench.torque [Nm]", "*torque*", "log.n", "q[2]"]
    found = read_columns(path, path.name, wanted)
    for name, values in zip(wanted, [TIME, TIME, TIME, np.arange(20), Q[:, 1]], strict=True):
        assert found[name].tolist() == values.tolist()
    assert {each.unit for each in listed(path, path.name)} == {"", "Nm"}


def circle(file: h5py.File) -> None:
    file.create_group("a")
    file["a/b"] = file["a"]


def cell_in_itself(file: h5py.File) -> None:
    made = file.create_dataset("time", (4,), h5py.ref_dtype)
    made.attrs["MATLAB_class"] = np.bytes_("cell")
    made[...] = np.array([made.ref] * 4, h5py.ref_dtype)


def null_references(file: h5py.File) -> None:
    file.create_dataset("time", (24,), h5py.ref_dtype).attrs["MATLAB_class"] = np.bytes_("cell")


@pytest.mark.parametrize("change", [circle, cell_in_itself, null_references])
def test_circles_and_references_to_nothing_are_refused(tmp_path: Path, change: Callable) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        change(file)
    with pytest.raises(FileDefect, match=r"^a\.h5"):
        read_columns(tmp_path / "a.h5", "a.h5", ["time[1]"])
