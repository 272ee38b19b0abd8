"""Hostile files: each is refused with its name, at once and in little memory (docs/reliability.md)."""

import io
import os
import pickle
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pytest
import recording_fixtures as sound
from recording_fixtures import ROWS, SAVERS, columns, mapped, sealed
from scipy.io import savemat

from swgsim.recordings.files import facts
from swgsim.recordings.files.folder import read_folder
from swgsim.recordings.files.recording_file import read_file
from swgsim.recordings.files.source_map import read_map
from swgsim.recordings.files.sources import read_mapped
from swgsim.storage import storage
from swgsim.storage.storage import SEAL_SIZE, SEAL_START
from swgsim.tables import limits
from swgsim.tables.file_defect import FileDefect, shown
from swgsim.tables.layout import Layout
from swgsim.tables.measured_column import MeasuredColumn
from swgsim.tables.measured_table import read_measured

MANY = 40_000_000  # numbers; 320 MB


def refused(read: Callable[[], object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        read()


# A manifest that leads out of its folder.


def link_in_a_circle(bench: Path) -> str:
    (bench / "loop.csv").symlink_to("loop.csv")
    return "loop.csv"


def link_outside(bench: Path) -> str:
    (bench.parent / "secret.csv").write_text("t_s\n1\n")
    (bench / "link.csv").symlink_to(bench.parent / "secret.csv")
    return "link.csv"


LEADS: dict[str, Callable[[Path], str]] = {
    "parent": lambda bench: "../secret.csv",
    "hidden parent": lambda bench: "a/../../secret.csv",
    "absolute": lambda bench: "/etc/passwd",
    "drive": lambda bench: "C:\\secret.csv",
    "relative to a drive": lambda bench: "C:secret.csv",
    "link": link_outside,
    "link in a circle": link_in_a_circle,
    "long name": lambda bench: "x" * 300 + ".csv",
    "null": lambda bench: "a\x00.csv",
    "folder": lambda bench: ".",
}


@pytest.mark.parametrize("name", list(LEADS))
def test_a_manifest_stays_in_its_folder(tmp_path: Path, name: str) -> None:
    sound.bench_folder(tmp_path)
    manifest = tmp_path / "bench" / "manifest.csv"
    lead = LEADS[name](tmp_path / "bench")
    manifest.write_text(manifest.read_text().replace("recording_0001.csv", lead))
    refused(lambda: read_folder(tmp_path / "bench"), "manifest.*column file")


def test_an_unnamed_link_in_a_circle_and_an_endless_line_are_refused(tmp_path: Path) -> None:
    sound.bench_folder(tmp_path)
    with (tmp_path / "bench" / "recording_0001.csv").open("a") as raw:
        raw.write("1," * 100_000)
    message = f"recording_0001.csv, row {ROWS + 2}: found a line of more than 100000"
    refused(lambda: read_folder(tmp_path / "bench"), message)
    link_in_a_circle(tmp_path / "bench")
    refused(lambda: read_folder(tmp_path / "bench"), r"loop\.csv")


def test_long_numbers_and_nested_values_take_linear_time() -> None:
    assert not facts.NUMBER.fullmatch("1" * 100_000 + "x")
    assert all(facts.NUMBER.fullmatch(number) for number in ("1", "1.", ".5", "1.5e-3", " -2E+4 ", "1e5"))
    refused(lambda: facts.parse({**facts.of(sound.SHORT[0]), "n_in_rpm": 10**400}, "a.csv"), r"a\.csv, column n_in_rpm")
    nested: list = ["x"]
    for _ in range(60):
        nested = [nested, nested]
    assert len(shown(nested)) < 200


# Files of other formats: small files with many numbers, and data that are not numbers.


def matlab_of(**changes: object) -> Callable[[Path], None]:
    return lambda path: savemat(path, {**columns(), **changes}, do_compression=True)


def matlab_73_with(change: Callable[[h5py.File], object]) -> Callable[[Path], None]:
    def write(path: Path) -> None:
        SAVERS["v73.mat"](path, {name: values for name, values in columns().items() if name != "Speed"})
        with h5py.File(path, "r+") as file:
            change(file)

    return write


def in_another_file(file: h5py.File) -> None:
    layout = h5py.VirtualLayout((24,), "f8")
    layout[:] = h5py.VirtualSource("/etc/passwd", "x", (24,))
    file.create_virtual_dataset("Speed", layout)


def parquet_with(speed: object, rows: int = 24) -> Callable[[Path], None]:
    table = {**{name: np.zeros(rows) for name in columns()}, "Speed": speed}
    return lambda path: pd.DataFrame(table).to_parquet(path)


def two_of_a_name(path: Path) -> None:
    savemat(path, columns())
    other = io.BytesIO()
    savemat(other, {"Speed": np.zeros(1000)})
    path.write_bytes(path.read_bytes() + other.getvalue()[128:])


FOREIGN: dict[str, tuple[str, Callable[[Path], object], str]] = {
    "zeros": ("mat", matlab_of(**{name: np.zeros(200_000) for name in columns()}), "numbers in"),
    "one name twice": ("mat", two_of_a_name, "found 2 variables of this name"),
    "HDF5, never written": (
        "mat", matlab_73_with(lambda f: f.create_dataset("Speed", (MANY,), "f8", compression="gzip")), "numbers in",
    ),
    "HDF5, link to a file": (
        "mat", matlab_73_with(lambda f: f.__setitem__("Speed", h5py.ExternalLink("/etc/passwd", "/"))), "found 'link'",
    ),
    "HDF5, virtual": ("mat", matlab_73_with(in_another_file), "data in another file"),
    "HDF5, raw data of a file": (
        "mat", matlab_73_with(lambda f: f.create_dataset("Speed", (24,), "u1", external="/etc/passwd")),
        "data in another file",
    ),
    "HDF5, references": (
        "mat", matlab_73_with(lambda f: f.create_dataset("Speed", (24,), h5py.ref_dtype)), "real numbers",
    ),
    "one number for all rows": ("parquet", parquet_with(0.0, 400_000), "numbers in"),
    "long text": ("parquet", parquet_with("x" * 100_000), "string' of shape .*expected real numbers"),
    "lists of texts": ("parquet", parquet_with([["x"]] * 24), "expected real numbers"),
    **{f"pickle as {ending}": (ending, lambda path: path.write_bytes(pickle.dumps(columns())), "found")
       for ending in ("mat", "h5", "parquet", "tdms", "mf4", "uff", "xlsx", "csv", "csv.gz")},  # one of each reader
}  # fmt: skip


@pytest.mark.parametrize("name", list(FOREIGN))
def test_files_of_other_formats_hold_plain_numbers(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "ALWAYS_EXPANDED", 2**23)  # so that small bombs are large enough
    ending, write, message = FOREIGN[name]
    folder, path = mapped(tmp_path, "x.csv")
    path.write_text(path.read_text().replace("run1.csv", f"run1.{ending}"))
    (folder / "run1.csv").unlink()
    write(folder / f"run1.{ending}")
    refused(lambda: read_mapped(folder, read_map(path)), f"run1.*{message}")


def test_a_folder_or_a_pipe_is_no_file(tmp_path: Path) -> None:
    (tmp_path / "a.csv").mkdir()
    os.mkfifo(tmp_path / "b.csv")
    for name in ("a.csv", "b.csv"):
        with pytest.raises(FileDefect, match=name):
            read_measured(tmp_path, {"": name}, [MeasuredColumn("s1", "a", "V/V")], None, 1.0, Layout())


# Files with a seal, which anybody can compute.


def never_written(place: str) -> Callable[[h5py.File], None]:
    def change(file: h5py.File) -> None:
        old = file[place]
        shape, dtype = (MANY,) if old.ndim == 1 else (MANY // 160, *old.shape[1:]), old.dtype
        del file[place]
        file.create_dataset(place, shape, dtype, chunks=True).attrs["units"] = "mV/V"

    return change


def under_many_names(file: h5py.File) -> None:
    for number in range(3, 200):
        file[f"recording_{number:04d}"] = file["recording_0001"]


def replaced(name: str, put: Callable[[h5py.File], object]) -> Callable[[h5py.File], None]:
    def change(file: h5py.File) -> None:
        del file[name]
        put(file)

    return change


ROOM = "more numbers than the file has room for"
SEALED: dict[str, tuple[str, Callable[[h5py.File], object], str]] = {
    "never written": ("bench.h5", never_written("recording_0001/s1"), ROOM),
    "many names": ("bench.h5", under_many_names, ROOM),
    "link": (
        "bench.h5", lambda f: f["recording_0001"].__setitem__("x", h5py.ExternalLink("/etc/passwd", "/")), "is a link",
    ),
    "variable text": ("bench.h5", lambda f: f["recording_0001"].attrs.__setitem__("gear", "A"), "gear is obj"),
    "data set, never written": ("set.h5", never_written("signals"), ""),
    "data set, link to a file": (
        "set.h5", replaced("signals", lambda f: f.__setitem__("signals", h5py.ExternalLink("/etc/passwd", "/"))), "",
    ),
    "data set, link to another name": (
        "set.h5", replaced("seed", lambda f: f.__setitem__("seed", h5py.SoftLink("/severity"))), "",
    ),
    "data set, raw data of a file": (
        "set.h5", replaced("label", lambda f: f.create_dataset("label", (2,), "i1", external="/etc/passwd")), "",
    ),
    "data set, missing column": ("set.h5", replaced("gear", lambda f: None), ""),
    "data set, text": ("set.h5", replaced("gear", lambda f: f.create_dataset("gear", data=["a", "b"])), ""),
    "data set, unknown class": ("set.h5", lambda f: f["label"].__setitem__(0, 77), ""),
    "data set, infinite rate": ("set.h5", lambda f: f.attrs.__setitem__("sampling_rate_hz", np.inf), ""),
    "data set, variable text": ("set.h5", lambda f: f.attrs.__setitem__("configuration", "a: 1"), ""),
}  # fmt: skip


@pytest.mark.parametrize("name", list(SEALED))
def test_a_sealed_file_of_another_layout_is_refused(tmp_path: Path, name: str) -> None:
    file, change, message = SEALED[name]
    write, read = {"bench.h5": (sound.bench_file, read_file), "set.h5": (sound.data_set, storage.read)}[file]
    write(tmp_path)
    path = tmp_path / file
    with h5py.File(path, "r+") as content:
        change(content)
    path.write_bytes(sealed(path.read_bytes()[SEAL_SIZE:]))
    refused(lambda: read(path), message or r"set\.h5")


@pytest.mark.parametrize("content", [sealed(b""), sealed(b"no HDF5" * 100), SEAL_START.ljust(600)])
def test_a_seal_on_something_else(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "set.h5"
    path.write_bytes(content)
    for read in (storage.read, storage.shape, read_file):
        refused(lambda read=read: read(path), r"set\.h5")
