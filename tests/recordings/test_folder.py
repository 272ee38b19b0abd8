"""Folders and files of recordings: exact round trips, and a message for every kind of bad file."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from recording_fixtures import assert_same, assert_sound, recording

from swgsim.recordings.files.folder import read_folder, write_folder
from swgsim.recordings.files.recording_file import read_file, write_file
from swgsim.tables import limits
from swgsim.tables.file_defect import FileDefect

ROWS = 60
GOOD = (recording(1, ROWS, label="healthy"), recording(2, ROWS, label="healthy"), recording(3, ROWS))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_folder(tmp_path / "bench", GOOD)
    return tmp_path / "bench"


# Round trips.


@given(values=st.lists(st.floats(-1e15, 1e15), min_size=20, max_size=20), name=st.text("äb, \"';x7", min_size=1))
@settings(max_examples=20, deadline=None)
def test_any_numbers_and_names_come_back(tmp_path_factory: pytest.TempPathFactory, values: list, name: str) -> None:
    made = recording(1, name=f"x{name}x", time=np.arange(20.0), channels={"s1": np.array(values)})
    place = tmp_path_factory.mktemp("any")
    for write, read, file in ((write_folder, read_folder, "bench"), (write_file, read_file, "bench.h5")):
        write(place / file, (made,))
        assert_same(read(place / file), (made,))
    assert {path.name for path in place.iterdir()} == {"bench", "bench.h5"}


@pytest.mark.parametrize("form", ["folder", "file"])
@pytest.mark.parametrize("channels", [list(GOOD[0].channels), ["s1", "s3"]], ids=["all channels", "two channels"])
def test_a_round_trip_is_exact(tmp_path: Path, form: str, channels: list[str]) -> None:
    chosen = tuple(replace(each, channels={name: each.channels[name] for name in channels}) for each in GOOD)
    write, read = {"folder": (write_folder, read_folder), "file": (write_file, read_file)}[form]
    write(tmp_path / "bench", chosen)
    assert_same(read(tmp_path / "bench"), chosen)
    assert [path.name for path in tmp_path.iterdir()] == ["bench"]


def test_a_wrapped_angle_comes_back_without_jumps(tmp_path: Path) -> None:
    wrapped = replace(GOOD[0], channels={"phi_in": np.mod(GOOD[0].channels["phi_in"] + np.pi, 2 * np.pi) - np.pi})
    write_folder(tmp_path / "bench", (wrapped,))
    (found,) = read_folder(tmp_path / "bench")
    np.testing.assert_allclose(found.channels["phi_in"], GOOD[0].channels["phi_in"], atol=1e-12)


UNWRITABLE = {
    "twice": (GOOD[0], GOOD[0]),
    "the channels": (GOOD[0], replace(GOOD[1], channels={"s1": GOOD[1].channels["s1"]})),
    "no channel": (replace(GOOD[0], channels={}),),
    "no number": (replace(GOOD[0], channels={"s1": np.full(ROWS, np.nan)}),),
    "a time that increases": (replace(GOOD[0], time=np.zeros(ROWS)),),
    "printable text": (replace(GOOD[0], name="two\nlines"),),
    "from 1 to": (),
}


@pytest.mark.parametrize("message", list(UNWRITABLE))
def test_recordings_that_could_not_be_read_back_are_not_written(tmp_path: Path, message: str) -> None:
    for write in (write_folder, write_file):
        with pytest.raises(FileDefect, match=message):
            write(tmp_path / "bench", UNWRITABLE[message])
    assert not list(tmp_path.iterdir())


def test_an_existing_folder_is_kept(folder: Path) -> None:
    with pytest.raises(ValueError, match="exists: remove it"):
        write_folder(folder, GOOD[:1])
    assert_same(read_folder(folder), GOOD)


# Bad files, each made from a good one, and part of the message.


def edited(name: str, change: Callable[[list[str]], object]) -> Callable[[Path], None]:
    """An edit of the lines of one file."""

    def edit(folder: Path) -> None:
        lines = (folder / name).read_text().splitlines()
        change(lines)
        (folder / name).write_text("\n".join(lines) + "\n")

    return edit


def cell(name: str, row: int, column: int, value: str) -> Callable[[Path], None]:
    """Another value of one cell; rows count from 1, columns from 0."""

    def change(lines: list[str]) -> None:
        cells = lines[row - 1].split(",")
        cells[column] = value
        lines[row - 1] = ",".join(cells)

    return edited(name, change)


FIRST = "recording_0001.csv"
HEADER = "t_s,phi_in_rad,n_in_rpm,T_in_nm,T_out_nm,s0_mv_v,s1_mv_v,s2_mv_v,s3_mv_v,s4_mv_v"
# In the manifest, the gear's name holds a comma and so a quote: columns after it are shifted by one.
BAD_FILES: dict[str, tuple[Callable[[Path], object], str]] = {
    "no manifest": (lambda f: (f / "manifest.csv").unlink(), "manifest"),
    "empty manifest": (lambda f: (f / "manifest.csv").write_text(""), "manifest.csv, row 1: found an empty file"),
    "manifest without rows": (edited("manifest.csv", lambda x: x.__delitem__(slice(1, 9))), "found 0 recordings"),
    "manifest lacks a column": (cell("manifest.csv", 1, 2, "label2"), "row 1: found no column gear"),
    "manifest has an unknown column": (cell("manifest.csv", 1, 9, "colour"), "row 1: found unknown column 'colour'"),
    "manifest has a column twice": (cell("manifest.csv", 1, 9, "gear"), "row 1: found twice the column 'gear'"),
    "manifest lacks a cell": (edited("manifest.csv", lambda x: x.append("a,b")), "row 5: found 2 cells, expected 10"),
    "manifest is no table": (edited("manifest.csv", lambda x: x.append('"a')), "manifest.csv: found no table"),
    "manifest is no text": (lambda f: (f / "manifest.csv").write_bytes(b"\xff\xfe\x00"), "csv: found no table"),
    "no number in the manifest": (
        cell("manifest.csv", 3, 5, "fast"),
        "manifest.csv, row 3, column n_in_rpm: found 'fast', expected a finite number",
    ),
    "not a number in the manifest": (cell("manifest.csv", 3, 6, "nan"), "row 3, column T_out_nm: found 'nan'"),
    "empty temperature": (cell("manifest.csv", 3, 8, ""), "column temperature_c: found '', expected a finite number"),
    "speed beyond limits": (cell("manifest.csv", 2, 5, "1e6"), "row 2: found a fact beyond its limits"),
    "repeat is no whole number": (cell("manifest.csv", 2, 7, "1.5"), "row 2, column repeat: found '1.5'"),
    "recording without a name": (cell("manifest.csv", 2, 0, ""), "row 2, column recording: found ''"),
    "recording twice": (cell("manifest.csv", 3, 0, "run 1"), "row 3, column recording: found 'run 1' as in row 2"),
    "file twice": (cell("manifest.csv", 3, 1, FIRST), f"row 3, column file: found '{FIRST}' as in row 2"),
    "row without file": (lambda f: (f / FIRST).unlink(), f"row 2, column file: found '{FIRST}', which does not exist"),
    "file without row": (
        lambda f: (f / "more.CSV").write_text(HEADER), "more.CSV: found no row for this file in the manifest",
    ),
    "empty file": (lambda f: (f / FIRST).write_text(""), f"{FIRST}, row 1: found an empty file"),
    "only a header": (lambda f: (f / FIRST).write_text(HEADER + "\n\n"), "row 2: found rows without numbers"),
    "too few rows": (edited(FIRST, lambda x: x.__delitem__(slice(9, None))), f"{FIRST}: found 8 samples"),
    "no time": (cell(FIRST, 1, 0, "T_in_nm2"), "row 1: found unknown column 'T_in_nm2', expected T_in_nm in N m"),
    "time missing": (
        lambda f: [edited(p.name, lambda x: x.__setitem__(slice(None), [r.split(",", 1)[1] for r in x]))(f)
                   for p in f.glob("rec*")],
        f"{FIRST}, row 1: found no column t_s",
    ),
    "only time": (edited(FIRST, lambda x: x.__setitem__(slice(None), [r.split(",")[0] for r in x])), "no channel"),
    "angle in degrees by its name": (cell(FIRST, 1, 1, "phi_in_deg"), "'phi_in_deg', expected phi_in_rad in rad"),
    "unknown unit": (cell(FIRST, 1, 6, "s1_um_m"), "found unknown column 's1_um_m', expected s1_mv_v in mV/V"),
    "unknown column": (cell(FIRST, 1, 1, "colour"), "found unknown column 'colour', expected some of t_s"),
    "column twice": (cell(FIRST, 1, 1, "n_in_rpm"), "row 1: found 2 columns 'n_in_rpm'"),
    "column without a name": (cell(FIRST, 1, 1, ""), "row 1: found unknown column ''"),
    "semicolons": (
        lambda f: (f / FIRST).write_text((f / FIRST).read_text().replace(",", ";")), "set separator: ';' in a map",
    ),
    "text in a cell": (
        cell(FIRST, 5, 1, "abc"), f"{FIRST}, row 5, column phi_in_rad: found 'abc', expected a number",
    ),
    "empty cell": (cell(FIRST, 7, 9, ""), "row 7, column s4_mv_v: found no number"),
    "hexadecimal": (cell(FIRST, 7, 9, "0x1F"), "row 7, column s4_mv_v: found '0x1F'"),
    "underscore": (cell(FIRST, 7, 9, "1_0"), "row 7, column s4_mv_v: found '1_0'"),
    "comment": (edited(FIRST, lambda x: x.insert(4, "# a comment")), "row 5, column t_s: found '# a comment'"),
    "not a number": (cell(FIRST, 9, 6, "nan"), "row 9, column s1_mv_v: found no number, expected a finite number"),
    "infinite": (cell(FIRST, 9, 6, "-inf"), "row 9, column s1_mv_v: found -inf"),
    "beyond all limits": (cell(FIRST, 9, 6, "-2e15"), "row 9, column s1_mv_v: found -2000000000000000.0"),
    "beyond floating point": (cell(FIRST, 9, 6, "1e999"), "row 9, column s1_mv_v: found inf"),
    "a cell too few": (edited(FIRST, lambda x: x.__setitem__(10, "1,2")), "row 11, column n_in_rpm: found no number"),
    "a cell too many": (edited(FIRST, lambda x: x.__setitem__(10, x[10] + ",1")), "row 11: found 11 cells"),
    "a cell too many everywhere": (
        edited(FIRST, lambda x: x.__setitem__(slice(1, None), [r + ",1" for r in x[1:]])), "row 2: found 11 cells",
    ),
    "blank line": (edited(FIRST, lambda x: x.insert(10, "")), "row 11, column t_s: found no number"),
    "no text": (
        lambda f: (f / FIRST).write_bytes((f / FIRST).read_bytes()[:9000] + b"\xff\xfe"), "bytes that are not text",
    ),
    "time stands": (edited(FIRST, lambda x: x.insert(20, x[19])), "row 21, column t_s: found"),
    "time runs back": (edited(FIRST, lambda x: x.insert(20, x.pop(30))), "row 22, column t_s: found"),
    "other channels": (
        edited(FIRST, lambda x: x.__setitem__(slice(None), [r.rsplit(",", 1)[0] for r in x])),
        "recording run 2: found the channels",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", list(BAD_FILES))
def test_a_bad_file_is_named(folder: Path, name: str) -> None:
    spoil, message = BAD_FILES[name]
    spoil(folder)
    with pytest.raises(FileDefect) as error:
        read_folder(folder)
    assert message in str(error.value)


def test_sizes_are_bounded(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "MOST_FILES", 2)
    with pytest.raises(FileDefect, match="found 3 recordings, expected from 1 to 2"):
        read_folder(folder)
    monkeypatch.setattr(limits, "MOST_FILES", 3)
    monkeypatch.setattr("swgsim.tables.text.MOST_ROWS", 50)
    with pytest.raises(FileDefect, match="found more rows, expected at most 50"):
        read_folder(folder)
    monkeypatch.setattr(limits, "LARGEST_FILE", 1000)
    with pytest.raises(FileDefect, match="bytes, expected at most 1000"):
        read_folder(folder)


# Any edit of a folder: a FileDefect, or recordings with sound numbers.


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with one short recording."""
    place = tmp_path_factory.mktemp("edited") / "bench"
    write_folder(place, (recording(1, 40),))
    return place


@given(
    which=st.sampled_from(["manifest.csv", FIRST]),
    at=st.floats(0, 1, exclude_max=True),
    removed=st.integers(0, 30),
    put=st.one_of(st.binary(max_size=12), st.text("0123456789.eE+-,;\n\r\"'nainf#_ \x00", max_size=12).map(str.encode)),
)
@settings(max_examples=120, deadline=None)
def test_any_edit_is_named_or_harmless(small: Path, which: str, at: float, removed: int, put: bytes) -> None:
    sound = (small / which).read_bytes()
    where = int(at * len(sound))
    (small / which).write_bytes(sound[:where] + put + sound[where + removed :])
    try:
        (found,) = read_folder(small)
        rows = [row for row in (small / FIRST).read_text("utf-8-sig").splitlines()[1:] if row.strip()]
        assert len(rows) == len(found.time)
        assert_sound(found)
    except FileDefect:
        pass
    finally:
        (small / which).write_bytes(sound)


@given(
    row=st.integers(1, 40),
    column=st.integers(0, 9),
    value=st.one_of(st.floats().map(repr), st.sampled_from(["", "nan", "1,5", "\uff11", "1e400", "--1", "0x1"])),
)
@settings(max_examples=60, deadline=None)
def test_any_other_cell_is_read_as_it_is_or_named(small: Path, row: int, column: int, value: str) -> None:
    sound = (small / FIRST).read_bytes()
    cell(FIRST, row + 1, column, value)(small)
    try:
        (found,) = read_folder(small)
        assert_sound(found)
        values = [found.time, *found.channels.values()][column]
        assert column == 1 or values[row - 1] == float(value)
    except FileDefect:
        pass
    finally:
        (small / FIRST).write_bytes(sound)
