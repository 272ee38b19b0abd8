"""Structs, struct arrays, cells and matrices of MATLAB, of versions 5 and 7.3: a reference means one column."""

import struct
from collections.abc import Callable, Iterator
from pathlib import Path

import h5py
import numpy as np
import pytest
from member_fixtures import MEANT, TIME, Q, save_v5, save_v73
from scipy.io import savemat

from swgsim.tables.binary import listed, read_columns
from swgsim.tables.file_defect import FileDefect
from swgsim.tables.formats.limited import LimitedReader


@pytest.fixture(scope="module", params=[save_v5, save_v73])
def saved(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("matlab") / "run1.mat"
    request.param(path)
    return path


@pytest.fixture(scope="module")
def reader() -> Iterator[LimitedReader]:
    with LimitedReader() as process:
        yield process


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


def test_what_a_file_holds_is_listed(saved: Path, reader: LimitedReader) -> None:
    found = {each.name: each for each in listed(saved, saved.name, reader)}
    assert found["Joint_state.q"].shape == (3, 20)
    assert found["runs[2].q.deg"].kind == "double"
    assert found["records.n"].shape[-1] == 20 or found["records.n"].shape == (20,)
    assert {found[name].kind for name in ("Joint_state", "runs", "c")} == {"struct", "cell"}


def test_a_number_means_a_column_of_the_only_matrix(tmp_path: Path, reader: LimitedReader) -> None:
    savemat(tmp_path / "a.mat", {"data": Q, "rate_hz": 1000.0, "info": {"q": Q}})
    assert read_columns(tmp_path / "a.mat", "a.mat", [2, 3], reader)[3].tolist() == Q[:, 2].tolist()
    savemat(tmp_path / "a.mat", {"data": Q, "more": Q})
    with pytest.raises(FileDefect, match="found the number 1 and 2 matrices, expected a name"):
        read_columns(tmp_path / "a.mat", "a.mat", [1], reader)


def test_a_reader_that_ends_is_started_again(saved: Path) -> None:
    savemat(saved.parent / "a.mat", {"time": TIME})
    with LimitedReader() as reader:
        contents = reader.contents(saved.parent / "a.mat", "a.mat", "matlab5", None)
        assert reader._child
        reader._child.kill()
        with pytest.raises(FileDefect, match=r"a\.mat: found .* its reader ended with status -9"):
            contents.read(0)
        assert read_columns(saved.parent / "a.mat", "a.mat", ["time"], reader)["time"].tolist() == TIME.tolist()


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
