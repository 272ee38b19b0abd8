"""Files made to harm: each is refused with its name, at once and in little memory (docs/reliability.md)."""

import io
import json
import os
import pickle
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pytest
import torch
from fuzzing import seeds
from fuzzing.wrapping import sealed
from scipy.io import savemat

from learn.evaluation import models
from learn.methods import neural
from swgsim.bench import truth
from swgsim.effects import text
from swgsim.recordings.files import facts, foreign, limits
from swgsim.recordings.files.file_defect import FileDefect, shown
from swgsim.recordings.files.folder import read_folder
from swgsim.recordings.files.recording_file import read_file
from swgsim.recordings.files.source_map import read_map
from swgsim.recordings.files.sources import read_mapped
from swgsim.storage import storage
from swgsim.storage.storage import SEAL_SIZE, SEAL_START

ROOT = Path(__file__).parents[2]
MANY = 40_000_000  # numbers; 320 MB
BOMB = "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{b}: &{b} [{', '.join(['*' + a] * 9)}]\n" for a, b in zip("abcdefghi", "bcdefghij", strict=True)
)


def refused(read: Callable[[], object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        read()


# A folder whose manifest leads elsewhere.


def loop_of_links(bench: Path) -> str:
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
    "link": link_outside,
    "links in a circle": loop_of_links,
    "name too long": lambda bench: "x" * 300 + ".csv",
    "null": lambda bench: "a\x00.csv",
    "folder": lambda bench: ".",
}


@pytest.mark.parametrize("name", list(LEADS))
def test_a_manifest_leads_nowhere_else(tmp_path: Path, name: str) -> None:
    seeds.folder(tmp_path)
    manifest = tmp_path / "bench" / "manifest.csv"
    lead = LEADS[name](tmp_path / "bench")
    manifest.write_text(manifest.read_text().replace("recording_0001.csv", lead))
    refused(lambda: read_folder(tmp_path / "bench"), "manifest")


def test_a_link_in_a_circle_that_nobody_named_is_told(tmp_path: Path) -> None:
    seeds.folder(tmp_path)
    loop_of_links(tmp_path / "bench")
    refused(lambda: read_folder(tmp_path / "bench"), r"loop\.csv")


def test_a_line_without_end_is_not_read(tmp_path: Path) -> None:
    seeds.folder(tmp_path)
    with (tmp_path / "bench" / "recording_0001.csv").open("a") as raw:
        raw.write("1," * 100_000)
    refused(lambda: read_folder(tmp_path / "bench"), "recording_0001.csv, row 26: found a line of more than 100000")


def test_a_cell_of_many_digits_takes_a_time_in_proportion() -> None:
    """With digits that can be split in many ways, the square of their number: minutes."""
    assert not facts.NUMBER.fullmatch("1" * 100_000 + "x")
    assert all(facts.NUMBER.fullmatch(sound) for sound in ("1", "1.", ".5", "1.5e-3", " -2E+4 ", "1e5"))


def test_numbers_without_limit_are_refused() -> None:
    refused(lambda: facts.parse({**facts.of(seeds.GOOD[0]), "n_in_rpm": 10**400}, "a.csv"), r"a\.csv, column n_in_rpm")


def test_what_is_nested_is_not_written_out() -> None:
    nested: list = ["x"]
    for _ in range(60):
        nested = [nested, nested]
    assert len(shown(nested)) < 200


# Files of others that are small and hold much.


def matlab_of(columns: dict[str, object]) -> Callable[[Path], None]:
    def write(place: Path) -> None:
        savemat(seeds.mapped(place, "mat"), {**seeds.columns(1), **columns}, do_compression=True)

    return write


def matlab_73_with(change: Callable[[h5py.File], object]) -> Callable[[Path], None]:
    def write(place: Path) -> None:
        seeds.matlab_73(place)
        with h5py.File(place / "files" / "run1.mat", "r+") as file:
            del file["Speed"]
            change(file)

    return write


def elsewhere(file: h5py.File) -> None:
    layout = h5py.VirtualLayout((24,), "f8")
    layout[:] = h5py.VirtualSource("/etc/passwd", "x", (24,))
    file.create_virtual_dataset("Speed", layout)


def parquet_with(speed: object, rows: int = 24) -> Callable[[Path], None]:
    def write(place: Path) -> None:
        path = seeds.mapped(place, "parquet")
        pd.DataFrame({**{name: np.zeros(rows) for name in seeds.columns(1)}, "Speed": speed}).to_parquet(path)

    return write


def two_of_a_name(place: Path) -> None:
    path = seeds.mapped(place, "mat")
    savemat(path, seeds.columns(1))
    other = io.BytesIO()
    savemat(other, {"Speed": np.zeros(1000)})
    path.write_bytes(path.read_bytes() + other.getvalue()[128:])


FOREIGN: dict[str, tuple[Callable[[Path], None], str]] = {
    "MATLAB, compressed zeros": (matlab_of({name: np.zeros(200_000) for name in seeds.columns(1)}), "numbers in"),
    "MATLAB, cells": (matlab_of({"Speed": np.array([1, "a"] * 12, object)}), "found 'cell'"),
    "MATLAB, struct": (matlab_of({"Speed": {"a": 1.0}}), "found 'struct'"),
    "MATLAB, one name twice": (two_of_a_name, "found 2 variables of this name"),
    "HDF5, never written": (
        matlab_73_with(lambda f: f.create_dataset("Speed", (MANY,), "f8", compression="gzip")), "numbers in",
    ),
    "HDF5, link to a file": (
        matlab_73_with(lambda f: f.__setitem__("Speed", h5py.ExternalLink("/etc/passwd", "/"))), "a link",
    ),
    "HDF5, virtual": (matlab_73_with(elsewhere), "data that lie in another file"),
    "HDF5, raw data of a file": (
        matlab_73_with(lambda f: f.create_dataset("Speed", (24,), "u1", external="/etc/passwd")),
        "data that lie in another file",
    ),
    "HDF5, references": (matlab_73_with(lambda f: f.create_dataset("Speed", (24,), h5py.ref_dtype)), "real numbers"),
    "Parquet, one number for all rows": (parquet_with(0.0, 400_000), "numbers in"),
    "Parquet, long text": (parquet_with("x" * 100_000), "string', expected real numbers"),
    "Parquet, lists": (parquet_with([[1.0]] * 24), "expected real numbers"),
}  # fmt: skip


@pytest.mark.parametrize("name", list(FOREIGN))
def test_files_of_others_stay_within_their_size(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "ALWAYS_EXPANDED", 2**23)  # so that the bombs need no memory to be made
    write, message = FOREIGN[name]
    write(tmp_path)
    refused(lambda: read_mapped(tmp_path / "files", read_map(tmp_path / "map.yaml")), f"run1.*{message}")


def test_a_pickle_is_no_file_of_numbers(tmp_path: Path) -> None:
    for ending in foreign.READERS:
        path = tmp_path / f"a{ending}"
        path.write_bytes(pickle.dumps({"Speed": np.zeros(24)}))
        refused(lambda path=path: foreign.read_columns(path, path.name, ["Speed"]), rf"a\{ending}")


# Files with a seal, which anybody can put on.


def sealed_anew(path: Path, change: Callable[[h5py.File], object]) -> None:
    with h5py.File(path, "r+") as file:
        change(file)
    path.write_bytes(sealed(path.read_bytes()[SEAL_SIZE:]))


def never_written(place: str) -> Callable[[h5py.File], None]:
    def change(file: h5py.File) -> None:
        old = file[place]
        shape = (MANY,) if old.ndim == 1 else (MANY // 160, *old.shape[1:])
        dtype = old.dtype
        del file[place]
        file.create_dataset(place, shape, dtype, chunks=True).attrs["units"] = "mV/V"

    return change


def under_many_names(file: h5py.File) -> None:
    for number in range(3, 500):
        file[f"recording_{number:04d}"] = file["recording_0001"]


RECORDINGS: dict[str, tuple[Callable[[h5py.File], object], str]] = {
    "never written": (never_written("recording_0001/s1"), "more numbers than the file has room for"),
    "under many names": (under_many_names, "more numbers than the file has room for"),
    "link": (lambda f: f["recording_0001"].__setitem__("x", h5py.ExternalLink("/etc/passwd", "/")), "is a link"),
    "text without a length": (lambda f: f["recording_0001"].attrs.__setitem__("gear", "A17"), "attribute gear is obj"),
}


@pytest.mark.parametrize("name", list(RECORDINGS))
def test_a_file_of_recordings_has_room_for_its_numbers(tmp_path: Path, name: str) -> None:
    change, message = RECORDINGS[name]
    seeds.one_file(tmp_path)
    sealed_anew(tmp_path / "bench.h5", change)
    refused(lambda: read_file(tmp_path / "bench.h5"), message)


def replaced(name: str, put: Callable[[h5py.File], object]) -> Callable[[h5py.File], None]:
    def change(file: h5py.File) -> None:
        del file[name]
        put(file)

    return change


DATA_SETS: dict[str, Callable[[h5py.File], object]] = {
    "never written": never_written("signals"),
    "link to a file": replaced("signals", lambda f: f.__setitem__("signals", h5py.ExternalLink("/etc/passwd", "/"))),
    "link to another name": replaced("seed", lambda f: f.__setitem__("seed", h5py.SoftLink("/severity"))),
    "raw data of a file": replaced("label", lambda f: f.create_dataset("label", (2,), "i1", external="/etc/passwd")),
    "missing": replaced("gear", lambda f: None),
    "text": replaced("gear", lambda f: f.create_dataset("gear", data=["a", "b"])),
    "another length": replaced("gear", lambda f: f.create_dataset("gear", (3,), "i4")),
    "label of no class": lambda f: f["label"].__setitem__(0, 77),
    "rate without end": lambda f: f.attrs.__setitem__("sampling_rate_hz", np.inf),
    "no rate": lambda f: f.attrs.__delitem__("sampling_rate_hz"),
    "text without a length": lambda f: f.attrs.__setitem__("configuration", "a: 1"),
    "many texts": lambda f: f.attrs.__setitem__("configuration", np.full(100, b"a: 1")),
}


@pytest.mark.parametrize("name", list(DATA_SETS))
def test_a_data_set_of_another_layout_is_refused(tmp_path: Path, name: str) -> None:
    seeds.data_set(tmp_path)
    sealed_anew(tmp_path / "set.h5", DATA_SETS[name])
    refused(lambda: storage.read(tmp_path / "set.h5"), r"set\.h5")


@pytest.mark.parametrize("content", [sealed(b""), sealed(b"no HDF5" * 100), SEAL_START.ljust(600)])
def test_a_seal_on_something_else(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "set.h5"
    path.write_bytes(content)
    for read in (storage.read, storage.shape, read_file):
        refused(lambda read=read: read(path), r"set\.h5")


# Models.


def rezipped(path: Path, compression: int = zipfile.ZIP_STORED, **changed: bytes) -> None:
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(path, "w", compression) as archive:
        for name, content in (members | changed).items():
            archive.writestr(name, content)


@pytest.mark.parametrize("write", [seeds.network, seeds.forest])
def test_an_archive_that_is_compressed_or_has_more_parts_than_room(tmp_path: Path, write: Callable) -> None:
    write(tmp_path)
    (path,) = tmp_path.iterdir()
    assert models.load(path, "cpu").predict(seeds.task()[0]).shape == (30,)
    sound = path.read_bytes()
    rezipped(path, zipfile.ZIP_DEFLATED, bomb=bytes(10**7))
    refused(lambda: models.load(path, "cpu"), path.name)
    path.write_bytes(pickle.dumps(print))
    refused(lambda: models.load(path, "cpu"), path.name)
    path.write_bytes(sound[:-30])
    refused(lambda: models.load(path, "cpu"), path.name)


def test_an_array_larger_than_its_part_is_not_laid_out(tmp_path: Path) -> None:
    seeds.forest(tmp_path)
    (path,) = tmp_path.iterdir()
    with zipfile.ZipFile(path) as archive:
        name = next(name for name in archive.namelist() if name.endswith(".npy"))
    head = io.BytesIO()
    np.lib.format.write_array_header_1_0(head, {"shape": (2**32,), "fortran_order": False, "descr": "<f8"})
    rezipped(path, **{name: head.getvalue()})
    refused(
        lambda: models.load(path, "cpu"), rf"{path.name}.*{name} is too small for an array of shape \(4294967296,\)"
    )


def test_a_network_larger_than_its_file_is_not_made(tmp_path: Path) -> None:
    seeds.network(tmp_path)
    path = tmp_path / "model.pt"
    content = torch.load(path, weights_only=True)
    content["architecture"]["options"] |= {"neurons": 10_000, "layers": 10}  # 3.6 GB
    torch.save(content, path)
    refused(lambda: neural.load(path, "cpu"), r"model\.pt")


def test_weights_that_are_no_numbers(tmp_path: Path) -> None:
    seeds.network(tmp_path)
    path = tmp_path / "model.pt"
    content = torch.load(path, weights_only=True)
    content["state"]["head.weight"][0, 0] = torch.nan
    torch.save(content, path)
    refused(lambda: neural.load(path, "cpu"), r"model\.pt")


def test_types_that_no_classifier_has_are_not_made(tmp_path: Path) -> None:
    seeds.forest(tmp_path)
    path = tmp_path / "model.skops"
    with zipfile.ZipFile(path) as archive:
        schema = json.loads(archive.read("schema.json"))
    schema |= {"__class__": "system", "__module__": "os", "__loader__": "FunctionNode", "content": "os.system"}
    rezipped(path, **{"schema.json": json.dumps(schema).encode()})
    refused(lambda: models.load(path), r"model\.skops")


# Text.

TEXTS = {
    "tag": "effects: !!python/object/apply:os.system ['true']",
    "tag of a name": "effects: [!!python/name:os.system ]",
    "aliases": BOMB + "effects: *j",
    "merged": "a: &a {x: 1}\nb: {<<: [*a, *a]}\neffects: []",
    "deep": "effects: " + "[" * 20_000,
    "no such day": "effects: 2001-13-45",
    "many digits": f"effects: {'9' * 5000}",
    "key twice": "effects: []\neffects: []",
    "number without limit": f"effects: [eccentric_wave_generator: {{r: {10**400}, theta: 1}}]",
    "module of Python": "effects: [antigravity:Effect: {}]",
    "no effect": "effects: [os:system: {}]",
    "no path": "effects: ['../a:b': {}]",
    "no text": "\x00",
}


@pytest.mark.parametrize("name", list(TEXTS))
def test_a_file_of_effects_is_plain_data(name: str) -> None:
    loaded = set(sys.modules)
    refused(lambda: text.from_text(TEXTS[name], "mine.yaml"), r"mine\.yaml")
    assert "antigravity" not in set(sys.modules) - loaded


@pytest.mark.parametrize("name", ["tag", "deep", "no such day"])
def test_a_column_map_is_plain_data(tmp_path: Path, name: str) -> None:
    (tmp_path / "map.yaml").write_text(TEXTS[name])
    refused(lambda: read_map(tmp_path / "map.yaml"), r"map\.yaml")


@pytest.mark.parametrize("content", ["[" * 100_000, "9" * 5000, "[]", "3", '{"files": 3}', "\udcff"])
def test_a_truth_that_is_none(tmp_path: Path, content: str) -> None:
    seeds.truth(tmp_path)
    raw = content.encode(errors="surrogateescape")
    (tmp_path / "bench.truth.json").write_bytes(raw)
    (tmp_path / "bench" / truth.SEAL).write_text(truth._digest(raw))
    refused(lambda: truth.open_truth(tmp_path / "bench"), r"bench\.truth\.json")


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    (tmp_path / "a.csv").mkdir()
    os.mkfifo(tmp_path / "b.csv")
    for name in ("a.csv", "b.csv"):
        with pytest.raises(FileDefect, match=name):
            foreign.read_columns(tmp_path / name, name, ["a"])


def test_a_short_run_of_the_fuzzer_finds_no_harm() -> None:
    """In a process of its own, for it forks; 50 spoiled files."""
    command = [sys.executable, "scripts/fuzz.py", "--seconds", "1", "--only", "one file"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "nothing but accepted and refused" in done.stdout
