"""Recordings in: round trips, every class of bad file by its name, and a reader that accepts nothing silently."""

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pytest
import xarray
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.io import savemat

from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import OperatingPoint
from swgsim.recordings.checks.inspection import inspect
from swgsim.recordings.files import limits as reading_limits
from swgsim.recordings.files.file_defect import FileDefect
from swgsim.recordings.files.folder import read_folder, write_folder
from swgsim.recordings.files.recording_file import TITLE, read_file, write_file
from swgsim.recordings.files.source_map import read_map
from swgsim.recordings.files.sources import read_mapped
from swgsim.recordings.read import inspect_recordings, read_recordings
from swgsim.recordings.recording import Recording

EXAMPLE_MAP = Path(__file__).parents[2] / "conf" / "sources" / "example.yaml"
ROWS = 600


def recording(number: int, **changes: object) -> Recording:
    """Made up by formula, with every channel and a healthy gear's symmetry."""
    rng = np.random.default_rng(number)
    point = OperatingPoint(2000, 39.5)
    time = np.arange(ROWS) / 3000
    phi = 0.1 * number + point.omega_in * time
    gauges = {f"s{i}": 0.06 + 0.17 * np.cos(2 * phi - np.pi * i) + 1e-3 * rng.normal(size=ROWS) for i in range(1, 5)}
    channels = {
        "phi_in": phi,
        "n_in": 2000 + rng.normal(size=ROWS),
        "T_in": 0.5 + 0.01 * rng.normal(size=ROWS),
        "T_out": 39.5 + rng.normal(size=ROWS),
        "s0": 0.13 + 0.01 * np.cos(4 * phi) + 1e-3 * rng.normal(size=ROWS),
        **gauges,
    }
    made = Recording(
        f"run {number}", "A, 17", "monday", point, number, time, channels, Conditions(24.5, 60.0), "healthy"
    )
    return replace(made, **changes)


GOOD = (recording(1), recording(2), recording(3, label=""))


def assert_same(found: tuple[Recording, ...], expected: tuple[Recording, ...]) -> None:
    """Every fact and every number, exactly."""
    assert len(found) == len(expected)
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_array_equal(one.time, other.time)
        assert list(one.channels) == list(other.channels)
        for name in other.channels:
            np.testing.assert_array_equal(one.channels[name], other.channels[name])
        assert replace(one, time=other.time, channels={}) == replace(other, channels={})


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_folder(tmp_path / "bench", GOOD)
    return tmp_path / "bench"


# Round trips.


def test_a_folder_round_trip_is_exact(folder: Path) -> None:
    assert_same(read_folder(folder), GOOD)
    assert sorted(path.name for path in folder.parent.iterdir()) == ["bench"]


def test_a_file_round_trip_is_exact(tmp_path: Path) -> None:
    write_file(tmp_path / "bench.h5", GOOD)
    assert_same(read_file(tmp_path / "bench.h5"), GOOD)
    assert [path.name for path in tmp_path.iterdir()] == ["bench.h5"]


@given(values=st.lists(st.floats(-1e15, 1e15), min_size=20, max_size=20), name=st.text("äb, \"';x7", min_size=1))
@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_numbers_and_names_come_back(tmp_path_factory: pytest.TempPathFactory, values: list, name: str) -> None:
    made = recording(1, name=f"x{name}x", time=np.arange(20.0), channels={"s1": np.array(values)})
    place = tmp_path_factory.mktemp("any")
    write_folder(place / "bench", (made,))
    write_file(place / "bench.h5", (made,))
    assert_same(read_folder(place / "bench"), (made,))
    assert_same(read_file(place / "bench.h5"), (made,))


def test_channels_that_are_not_there_are_not_there(tmp_path: Path) -> None:
    fewer = tuple(replace(each, channels={"s1": each.channels["s1"], "s3": each.channels["s3"]}) for each in GOOD)
    write_folder(tmp_path / "bench", fewer)
    assert_same(read_folder(tmp_path / "bench"), fewer)


def test_a_wrapped_angle_comes_back_without_jumps(tmp_path: Path) -> None:
    wrapped = replace(GOOD[0], channels={"phi_in": np.mod(GOOD[0].channels["phi_in"] + np.pi, 2 * np.pi) - np.pi})
    write_folder(tmp_path / "bench", (wrapped,))
    (found,) = read_folder(tmp_path / "bench")
    np.testing.assert_allclose(found.channels["phi_in"], GOOD[0].channels["phi_in"], atol=1e-12)


def test_xarray_opens_the_file_with_units(tmp_path: Path) -> None:
    write_file(tmp_path / "bench.h5", GOOD)
    with xarray.open_dataset(tmp_path / "bench.h5", engine="h5netcdf", group="recording_0002") as data:
        assert data["s1"].dims == ("time",)
        assert data["s1"].attrs["units"] == "mV/V"
        assert data["time"].attrs["units"] == "s"
        assert data.attrs["T_out_nm"] == 39.5
        np.testing.assert_array_equal(data["phi_in"].values, GOOD[1].channels["phi_in"])
    with h5py.File(tmp_path / "bench.h5") as file:
        assert all(variable.fletcher32 for variable in file["recording_0001"].values())


def test_one_way_in_for_every_form(folder: Path, tmp_path: Path) -> None:
    write_file(tmp_path / "bench.h5", GOOD)
    assert_same(read_recordings(folder).recordings, GOOD)
    assert_same(read_recordings(tmp_path / "bench.h5").recordings, GOOD)
    with pytest.raises(ValueError, match=r"found nothing, expected a folder with manifest\.csv"):
        read_recordings(tmp_path / "absent")


def test_what_forbids_use_is_listed_unless_one_only_inspects(tmp_path: Path) -> None:
    wrong = {"phi_in": 180 / np.pi, "s2": -1}
    spoiled = tuple(
        replace(each, channels={name: wrong.get(name, 1) * values for name, values in each.channels.items()})
        for each in GOOD
    )
    write_folder(tmp_path / "bench", spoiled)
    with pytest.raises(ValueError, match="cannot be used") as error:
        read_recordings(tmp_path / "bench")
    assert "[angle_in_degrees]; also in 2 others: run 2, run 3" in str(error.value)
    assert "[gauge_inverted]" in str(error.value)
    assert "warn" not in str(error.value)
    intake = inspect_recordings(tmp_path / "bench")
    assert_same(intake.recordings, spoiled)
    assert {"angle_in_degrees", "gauge_inverted", "short"} <= {defect.kind for defect in intake.defects}
    assert [defect.kind for defect in read_recordings_good(tmp_path).defects] == ["short"] * 3


def read_recordings_good(tmp_path: Path) -> object:
    write_folder(tmp_path / "good", GOOD)
    return read_recordings(tmp_path / "good")


# Writing.


def test_what_could_not_be_read_back_is_not_written(tmp_path: Path) -> None:
    bad = {
        "twice": (GOOD[0], GOOD[0]),
        "the channels": (GOOD[0], replace(GOOD[1], channels={"s1": GOOD[1].channels["s1"]})),
        "no channel": (replace(GOOD[0], channels={}),),
        "nan": (replace(GOOD[0], channels={"s1": np.full(ROWS, np.nan)}),),
        "a time that increases": (replace(GOOD[0], time=np.zeros(ROWS)),),
        "printable text": (replace(GOOD[0], name="two\nlines"),),
        "from 1 to": (),
    }
    for message, recordings in bad.items():
        with pytest.raises(FileDefect, match=message):
            write_folder(tmp_path / "bench", recordings)
        with pytest.raises(FileDefect, match=message):
            write_file(tmp_path / "bench.h5", recordings)
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_there_is_kept(folder: Path) -> None:
    with pytest.raises(ValueError, match="is there already"):
        write_folder(folder, GOOD[:1])
    assert_same(read_folder(folder), GOOD)


# Bad files, each made from a good one: how, and what the message says.


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
    "file outside": (cell("manifest.csv", 2, 1, "../a.csv"), "row 2, column file: found '../a.csv'"),
    "absolute file": (cell("manifest.csv", 2, 1, "/etc/passwd"), "column file: found '/etc/passwd', expected the"),
    "file of another system": (cell("manifest.csv", 2, 1, "C:a.csv"), "column file: found 'C:a.csv', expected the"),
    "a folder as file": (cell("manifest.csv", 2, 1, "."), "row 2, column file: found '.'"),
    "empty file": (lambda f: (f / FIRST).write_text(""), f"{FIRST}, row 1: found an empty file"),
    "only a header": (lambda f: (f / FIRST).write_text(HEADER + "\n\n"), "row 2: found a header without rows"),
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
    "column twice": (cell(FIRST, 1, 1, "n_in_rpm"), "row 1: found 'n_in_rpm' as column 3"),
    "column without a name": (cell(FIRST, 1, 1, ""), "row 1: found '' as column 2"),
    "semicolons": (
        lambda f: (f / FIRST).write_text((f / FIRST).read_text().replace(",", ";")), "expected commas",
    ),
    "text in a cell": (
        cell(FIRST, 5, 1, "abc"), f"{FIRST}, row 5, column phi_in_rad: found 'abc', expected a finite number",
    ),
    "empty cell": (cell(FIRST, 7, 9, ""), "row 7, column s4_mv_v: found ''"),
    "hexadecimal": (cell(FIRST, 7, 9, "0x1F"), "row 7, column s4_mv_v: found '0x1F'"),
    "underscore": (cell(FIRST, 7, 9, "1_0"), "row 7, column s4_mv_v: found '1_0'"),
    "comment": (edited(FIRST, lambda x: x.insert(4, "# a comment")), "row 5: found 1 cells, expected 10"),
    "not a number": (cell(FIRST, 9, 6, "nan"), "row 9, column s1_mv_v: found nan, expected a finite number"),
    "infinite": (cell(FIRST, 9, 6, "-inf"), "row 9, column s1_mv_v: found -inf"),
    "beyond all limits": (cell(FIRST, 9, 6, "-2e15"), "row 9, column s1_mv_v: found -2000000000000000.0"),
    "beyond floating point": (cell(FIRST, 9, 6, "1e999"), "row 9, column s1_mv_v: found inf"),
    "a cell too few": (edited(FIRST, lambda x: x.__setitem__(10, "1,2")), "row 11: found 2 cells, expected 10"),
    "a cell too many": (edited(FIRST, lambda x: x.__setitem__(10, x[10] + ",1")), "row 11: found 11 cells"),
    "a cell too many everywhere": (
        edited(FIRST, lambda x: x.__setitem__(slice(1, None), [r + ",1" for r in x[1:]])), "row 2: found 11 cells",
    ),
    "blank line": (edited(FIRST, lambda x: x.insert(10, "")), "row 11: found a blank line"),
    "no text": (
        lambda f: (f / FIRST).write_bytes((f / FIRST).read_bytes()[:9000] + b"\xff\xfe"), "bytes that are no text",
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


def test_links_that_lead_outside_are_not_followed(folder: Path) -> None:
    outside = folder.parent / "outside.csv"
    os.replace(folder / FIRST, outside)
    (folder / FIRST).symlink_to(outside)
    with pytest.raises(FileDefect, match="which leads outside"):
        read_folder(folder)


def test_sizes_are_bounded(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading_limits, "MOST_FILES", 2)
    with pytest.raises(FileDefect, match="found 3 recordings, expected from 1 to 2"):
        read_folder(folder)
    monkeypatch.setattr(reading_limits, "MOST_FILES", 3)
    monkeypatch.setattr("swgsim.recordings.files.csv_table.MOST_ROWS", 100)
    with pytest.raises(FileDefect, match="row 102: found more rows, expected at most 100"):
        read_folder(folder)
    monkeypatch.setattr(reading_limits, "LARGEST_FILE", 1000)
    with pytest.raises(FileDefect, match="bytes, expected at most 1000"):
        read_folder(folder)


# The one-file form, spoiled.


def test_a_damaged_or_foreign_file_is_named(tmp_path: Path) -> None:
    path = tmp_path / "bench.h5"
    write_file(path, GOOD)
    content = bytearray(path.read_bytes())
    content[20_000] ^= 1
    path.write_bytes(content)
    with pytest.raises(ValueError, match=r"bench\.h5: damaged or truncated"):
        read_recordings(path)
    path.write_bytes(content[:100])
    with pytest.raises(ValueError, match=r"bench\.h5: not a file of recordings"):
        read_recordings(path)


FOREIGN: dict[str, tuple[Callable[[h5py.File], object], str]] = {
    "title": (lambda f: f.attrs.__setitem__("title", np.bytes_("other")), "the title 'other'"),
    "no fact": (lambda f: f["recording_0001"].attrs.__delitem__("gear"), "found no gear"),
    "unknown unit": (lambda f: f["recording_0001/s1"].attrs.__setitem__("units", np.bytes_("V/V")), "found unit 'V/V'"),
    "unknown variable": (lambda f: f["recording_0001"].create_dataset("x", data=np.ones(ROWS)), "unknown variable 'x'"),
    "no time": (lambda f: f["recording_0001"].__delitem__("time"), "found lengths"),
    "external link": (
        lambda f: f.__setitem__("recording_0004", h5py.ExternalLink("other.h5", "/")), "which is a link",
    ),
    "soft link": (lambda f: f.__setitem__("recording_0004", h5py.SoftLink("/recording_0001")), "which is a link"),
    "text": (
        lambda f: (f["recording_0001"].__delitem__("s1"), f["recording_0001"].create_dataset("s1", data=["a"] * ROWS),
                   f["recording_0001/s1"].attrs.__setitem__("units", np.bytes_("mV/V"))),
        "expected real numbers",
    ),
    "empty": (lambda f: f.clear(), "found 0 recordings"),
}  # fmt: skip


@pytest.mark.parametrize("name", list(FOREIGN))
def test_a_sealed_file_with_other_contents_is_named(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    change, message = FOREIGN[name]
    path = tmp_path / "bench.h5"
    write_file(path, GOOD)
    with h5py.File(path, "r+") as file:
        assert file.attrs["title"].decode() == TITLE
        change(file)
    monkeypatch.setattr("swgsim.recordings.files.recording_file.verify", lambda path: None)
    with pytest.raises(FileDefect, match=message):
        read_file(path)


# Column maps.

TO_FOREIGN = {
    "Time": lambda r: 1e3 * r.time,
    "EncoderAngle": lambda r: np.degrees(r.channels["phi_in"]) % 360,
    "Speed": lambda r: r.channels["n_in"] * 2 * np.pi / 60,
    "TorqueIn": lambda r: 1e3 * r.channels["T_in"],
    "TorqueOut": lambda r: r.channels["T_out"],
    "Bridge0": lambda r: r.channels["s0"] / 0.002,
    "Bridge1": lambda r: 1e-3 * r.channels["s1"],
    "Bridge2": lambda r: -1e-3 * r.channels["s2"],
    "Bridge3": lambda r: 1e-3 * r.channels["s3"],
    "Bridge4": lambda r: 1e-3 * r.channels["s4"],
}


def save_v5(path: Path, columns: dict) -> None:
    savemat(path, columns, do_compression=True)


def save_v73(path: Path, columns: dict) -> None:
    """As MATLAB does: HDF5 with rows of the transposed, behind a block of 512 bytes."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in columns.items():
            file.create_dataset(name, data=values[None])


def save_parquet(path: Path, columns: dict) -> None:
    pd.DataFrame(columns).to_parquet(path)


def save_csv(path: Path, columns: dict) -> None:
    pd.DataFrame(columns).to_csv(path, index=False)


SAVERS = {"v5.mat": save_v5, "v73.mat": save_v73, "x.parquet": save_parquet, "x.csv": save_csv}


def mapped(folder: Path, saver: str, **changes: object) -> tuple[Path, Path]:
    """A folder with two foreign files and the example map for them."""
    folder.mkdir()
    config = yaml.safe_load(EXAMPLE_MAP.read_text())
    config["files"] = {}
    for number, each in enumerate(GOOD[:2], 1):
        name = f"run{number}.{saver.split('.')[1]}"
        SAVERS[saver](folder / name, {column: make(each) for column, make in TO_FOREIGN.items()})
        config["files"][name] = {"n_in_rpm": 2000, "T_out_nm": 39.5, "repeat": number}
    path = folder.parent / "map.yaml"
    path.write_text(yaml.safe_dump({**config, **changes}))
    return folder, path


@pytest.mark.parametrize("saver", list(SAVERS))
def test_foreign_files_are_read_through_a_map(tmp_path: Path, saver: str) -> None:
    folder, path = mapped(tmp_path / "foreign", saver)
    found = read_recordings(folder, path).recordings
    assert [each.name for each in found] == ["run1", "run2"]
    for one, other in zip(found, GOOD, strict=False):
        assert one.point == other.point
        assert (one.gear, one.session, one.repeat) == ("A17", "monday", other.repeat)
        np.testing.assert_allclose(one.time, other.time, rtol=1e-14)
        for name, values in other.channels.items():
            np.testing.assert_allclose(one.channels[name], values, rtol=1e-9, atol=1e-12)


def test_a_sampling_rate_in_place_of_the_time(tmp_path: Path) -> None:
    channels = {"s1": {"column": "Bridge1", "unit": "V/V"}}
    folder, path = mapped(tmp_path / "foreign", "x.parquet", channels=channels, sampling_rate_hz=3000)
    found = read_mapped(folder, read_map(path))
    np.testing.assert_allclose(found[0].time, GOOD[0].time)
    assert list(found[0].channels) == ["s1"]


BAD_MAPS: dict[str, tuple[dict[str, object], str]] = {
    "unknown entry": ({"chanels": {}}, "unknown choice 'chanels' of the column map"),
    "unknown channel": ({"channels": {"s9": {"column": "a", "unit": "V/V"}}}, "unknown choice 's9' of channels"),
    "unknown unit": ({"channels": {"s1": {"column": "a", "unit": "bar"}}}, "unknown choice 'bar' of the unit of s1"),
    "unit of another quantity": ({"channels": {"t": {"column": "a", "unit": "rad"}}}, "unknown choice 'rad'"),
    "no unit": ({"channels": {"s1": {"column": "a"}}}, "unit of channel s1 is 'None'"),
    "strain without a bridge": ({"channels": {"s1": {"column": "a", "unit": "um/m"}}}, "gauge_factor and active_arms"),
    "arms that are no number": (
        {"channels": {"s1": {"column": "a", "unit": "um/m", "gauge_factor": 2.0, "active_arms": True}}},
        "active_arms of s1 is True, must be one of 1, 2, 4",
    ),
    "no time": ({"channels": {"s1": {"column": "a", "unit": "V/V"}}}, "either the channel t or sampling_rate_hz"),
    "time twice": ({"sampling_rate_hz": 1000}, "either the channel t or sampling_rate_hz"),
    "zero of a gauge": ({"channels": {"s1": {"column": "a", "unit": "V/V", "zero_rad": 0.1}}}, "only phi_in has one"),
    "zero beyond a turn": (
        {"channels": {"phi_in": {"column": "a", "unit": "deg", "zero_rad": 34.4}}}, "zero_rad of phi_in is 34.4",
    ),
    "channels are a list": ({"channels": [1]}, "channels is '\\[1\\]', must be names with values"),
    "no such column": (
        {"channels": {"t": {"column": "Clock", "unit": "s"}}}, "run1.parquet: found columns Time.*expected 'Clock'",
    ),
    "unknown fact": ({"facts": {"gear": "A", "session": "b", "weather": 1}}, "unknown fact 'weather'"),
    "no gear": ({"facts": {"session": "b"}}, "found no gear"),
    "file without entry": ({"files": {"run1.parquet": {}}}, "run2.parquet: found no entry for this file"),
    "entry outside": (
        {"files": {"run1.parquet": {}, "run2.parquet": {}, "../a.mat": {}}},
        "found no n_in_rpm|'../a.mat', expected the name",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", list(BAD_MAPS))
def test_a_bad_map_is_named(tmp_path: Path, name: str) -> None:
    changes, message = BAD_MAPS[name]
    folder, path = mapped(tmp_path / "foreign", "x.parquet", **changes)
    with pytest.raises(FileDefect, match=message):
        read_recordings(folder, path)


def test_objects_in_foreign_files_are_refused(tmp_path: Path) -> None:
    folder, path = mapped(tmp_path / "foreign", "v5.mat")
    columns = {column: make(GOOD[0]) for column, make in TO_FOREIGN.items()}
    for bad, message in (
        ({"Speed": np.array(["a", "b"], dtype=object)}, "expected"),
        ({"Speed": columns["Speed"] + 1j}, "expected real numbers"),
        ({"Speed": np.ones((20, 30))}, "expected real numbers in one row or column"),
        ({"Speed": columns["Speed"][:-1]}, "columns of different lengths"),
        ({"Speed": {"a": 1.0}}, "expected"),
    ):
        save_v5(folder / "run1.mat", {**columns, **bad})
        with pytest.raises(FileDefect, match=message):
            read_recordings(folder, path)


# Fuzz.


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with one short recording."""
    short = replace(GOOD[0], time=np.arange(40) / 3000, channels={n: v[:40] for n, v in GOOD[0].channels.items()})
    place = tmp_path_factory.mktemp("fuzz") / "bench"
    write_folder(place, (short,))
    return place


def assert_nothing_is_accepted_silently(folder: Path, content: dict[str, bytes]) -> None:
    """Either a FileDefect, or recordings whose numbers can be computed with and are those of the text."""
    for name, raw in content.items():
        (folder / name).write_bytes(raw)
    try:
        found = read_folder(folder)
    except FileDefect:
        return
    for each in found:
        inspect((each,))
        assert np.isfinite(each.time).all()
        assert (np.diff(each.time) > 0).all()
        assert all(np.isfinite(values).all() for values in each.channels.values())
        text = (folder / FIRST).read_text("utf-8-sig").rstrip().splitlines()
        said = [float(row.split(",")[0]) for row in text[1:] if row.strip()]
        assert len(said) == len(each.time) or not said


@given(
    which=st.sampled_from(["manifest.csv", FIRST]),
    at=st.floats(0, 1, exclude_max=True),
    removed=st.integers(0, 30),
    put=st.one_of(st.binary(max_size=12), st.text("0123456789.eE+-,;\n\r\"'nainf#_ \x00", max_size=12).map(str.encode)),
)
@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_edit_is_named_or_harmless(small: Path, which: str, at: float, removed: int, put: bytes) -> None:
    sound = {path.name: path.read_bytes() for path in small.iterdir()}
    where = int(at * len(sound[which]))
    raw = sound[which][:where] + put + sound[which][where + removed :]
    try:
        assert_nothing_is_accepted_silently(small, {which: raw})
    finally:
        (small / which).write_bytes(sound[which])


@given(
    row=st.integers(1, 40),
    column=st.integers(0, 9),
    value=st.one_of(st.floats().map(repr), st.sampled_from(["", "nan", "1,5", "\uff11", "1e400", "--1", "0x1"])),
)
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_other_cell_is_read_as_it_is_or_named(small: Path, row: int, column: int, value: str) -> None:
    sound = (small / FIRST).read_bytes()
    cell(FIRST, row + 1, column, value)(small)
    try:
        (found,) = read_folder(small)
        inspect((found,))
        values = [found.time, *found.channels.values()][column]
        assert np.isfinite(values).all()
        assert (np.diff(found.time) > 0).all()
        assert column == 1 or values[row - 1] == float(value)
    except FileDefect:
        pass
    finally:
        (small / FIRST).write_bytes(sound)
