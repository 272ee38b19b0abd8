"""Maps of gauges and of joints: lost readings, parts, files of single signals, accepted findings."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
import openpyxl
import pandas as pd
import pytest
import yaml
from formats import GAUGES, IN_PLAIN, LOG, OF_LOG, PLAIN, TIME, table

from swgsim.joint.intake.read import JointRecordings, read_joints
from swgsim.recordings.read import inspect_recordings
from swgsim.recordings.recording_set import RecordingSet
from swgsim.tables.file_defect import FileDefect

FACTS = {"facts": {"gear": "A", "session": "b", "n_in_rpm": 2000, "T_out_nm": 39.5, "repeat": 1}}


def gauges(place: Path, columns: dict[str, Any], **entries: Any) -> RecordingSet:
    table("files/run1.csv", columns)(place)
    (place / "map.yaml").write_text(yaml.safe_dump(yaml.safe_load(IN_PLAIN) | FACTS | entries))
    return inspect_recordings(place / "files", place / "map.yaml")


def joints(place: Path, *files: Any, **entries: Any) -> JointRecordings:
    for write in files:
        write(place / "files")
    config = {"robot": "mine", "files": ["*"]} | yaml.safe_load(OF_LOG) | entries
    (place / "source.yaml").write_text(yaml.safe_dump(config))
    return read_joints(place / "files", place / "source.yaml")


def lost(values: np.ndarray, *rows: int) -> list[object]:
    return ["nan" if row in rows else value for row, value in enumerate(values)]


def test_lost_readings_of_gauges_are_named_or_left_out(tmp_path: Path) -> None:
    spoiled = PLAIN | {"bridge": lost(PLAIN["bridge"], 30, 80)}
    with pytest.raises(FileDefect, match=r"row 32, column bridge: found no number and 1 more.*lost: \{leave_out: 2\}"):
        gauges(tmp_path, spoiled)
    with pytest.raises(FileDefect, match=r"row 32: found 2 of 120 rows with lost readings, expected at most 1"):
        gauges(tmp_path, spoiled, lost={"leave_out": 1})
    (found,) = (read := gauges(tmp_path, spoiled, lost={"leave_out": 2}))
    np.testing.assert_allclose(found.time, np.delete(TIME, [30, 80]))
    assert ("readings_left_out", "warn") in {(each.kind, each.severity) for each in read.defects}
    gap = {name: np.delete(np.array(values, object), 50) for name, values in spoiled.items()}
    read = gauges(tmp_path, gap, lost={"leave_out": 2})  # one more sample is missing than the map knows of
    assert ("samples_dropped", "refuse") in {(each.kind, each.severity) for each in read.defects}


def test_lost_readings_of_joints_are_a_finding_or_left_out(tmp_path: Path) -> None:
    write = table("run1.csv", LOG | {"i": lost(LOG["i"], 60)})
    read = joints(tmp_path, write)
    assert not read.recordings
    assert "column i" in str(read.defects[0])
    assert "leave_out: 1" in str(read.defects[0])
    (found,) = joints(tmp_path, write, lost="leave_out").recordings
    np.testing.assert_allclose(found.time, np.delete(TIME, 60))
    config = yaml.safe_load((tmp_path / "source.yaml").read_text())
    del config["time"]
    (tmp_path / "source.yaml").write_text(yaml.safe_dump(config | {"rate": "from_motion"}))
    with pytest.raises(FileDefect, match="found no time, expected a time or a rate"):
        read_joints(tmp_path / "files", tmp_path / "source.yaml")


def test_a_column_that_ends_early_or_is_slow_has_lost_nothing(tmp_path: Path) -> None:
    """To leave its other rows out would pair its values with times of others."""
    for rows in (range(100, len(TIME)), range(1, len(TIME), 2)):
        write = table("run1.csv", LOG | {"i": lost(LOG["i"], *rows)})
        for entry in ({}, {"lost": "leave_out"}):
            with pytest.raises((FileDefect, ValueError), match="needs its own time in a map, such as time: t") as found:
                joints(tmp_path, write, **entry).require_usable()
            assert f"leave_out: {len(rows)}" not in str(found.value)


def test_a_recording_is_split_into_its_parts(tmp_path: Path) -> None:
    parts = {"early": [0, 0.03], "late": [0.06, 9]}
    read = gauges(tmp_path, PLAIN, parts=parts)
    assert [each.name for each in read] == ["run1 early", "run1 late"]
    assert [each.repeat for each in read] == [1, 2]
    np.testing.assert_allclose(read[1].channels["s1"], GAUGES["s1"][60:])
    assert read[1].conditions.elapsed == pytest.approx(0.06)
    with pytest.raises(FileDefect, match="expected a length beyond 1 s, where part 'later' begins"):
        gauges(tmp_path, PLAIN, parts={"later": [1, 2]})
    with pytest.raises(FileDefect, match="must end after its start"):
        gauges(tmp_path, PLAIN, parts={"early": [3, 2]})


def test_a_log_is_split_into_runs_that_can_be_held_out(tmp_path: Path) -> None:
    time = np.arange(360) / 1000
    long = {"t": time, "q": 0.8 * np.sin(20 * time), "qd": 16 * np.cos(20 * time), "i": np.cos(20 * time)}
    read = joints(tmp_path, table("run1.csv", long), parts={"fit": [0, 0.2], "judge": [0.2, 9]})
    assert [each.name for each in read.recordings] == ["run1 fit", "run1 judge"]
    assert [len(each) for each in read.recordings] == [200, 160]


def test_files_of_single_signals_are_joined(tmp_path: Path) -> None:
    names = {"q": "position", "qd": "velocity", "i": "current"}
    write = [table(f"r1_{file}.csv", {"t": TIME, name: LOG[name]}) for name, file in names.items()]
    config = yaml.safe_load(OF_LOG)
    config["time"]["file"] = "position"
    for entry, file in zip(config["joints"]["elbow"]["signals"].values(), names.values(), strict=True):
        entry["file"] = file
    path = r"(?P<run>r\d+)_(?P<signal>[a-z]+)\.csv"
    (found,) = joints(tmp_path, *write, path=path, **config).recordings
    np.testing.assert_allclose(found.signals["current"], LOG["i"], rtol=1e-8)
    (tmp_path / "files" / "r1_current.csv").unlink()
    with pytest.raises(FileDefect, match="expected one with the signal 'current'"):
        read_joints(tmp_path / "files", tmp_path / "source.yaml")
    table("r1_current.csv", {"t": TIME[:-1], "i": LOG["i"][:-1]})(tmp_path / "files")
    with pytest.raises(FileDefect, match=r"r1_current\.csv, column t: found other times, expected the times of r1_pos"):
        read_joints(tmp_path / "files", tmp_path / "source.yaml")
    config["joints"]["elbow"]["signals"]["current"]["time"] = "t"
    (found,) = joints(tmp_path, path=path, **config).recordings
    np.testing.assert_allclose(found.signals["current"], LOG["i"][:-1], rtol=1e-8)


def test_an_accepted_finding_only_warns(tmp_path: Path) -> None:
    write = table("run1.csv", LOG | {"qd": 1.5 * LOG["qd"]})
    assert not joints(tmp_path, write).recordings
    read = joints(tmp_path, write, accept=["velocity_scale"])
    assert len(read.recordings) == 1
    assert "accepted in the map; else" in read.findings()
    with pytest.raises(FileDefect, match="'not_finite'"):
        joints(tmp_path, write, accept=["not_finite"])


def test_the_velocity_is_the_slope_of_the_angle(tmp_path: Path) -> None:
    config = yaml.safe_load(OF_LOG)
    signals = config["joints"]["elbow"]["signals"]
    signals["omega"] = {"from": "q", "smoothed_s": 0.005}
    (found,) = joints(tmp_path, table("run1.csv", LOG), **config).recordings
    np.testing.assert_allclose(found.signals["omega"][5:-5], LOG["qd"][5:-5], atol=2e-2)
    del signals["omega"]
    with pytest.raises(FileDefect, match=r"omega: \{from: q, smoothed_s: 0\.05\}"):
        joints(tmp_path, table("run1.csv", LOG), **config)


def test_signals_of_the_motor_need_the_gear_ratio(tmp_path: Path) -> None:
    config = yaml.safe_load(OF_LOG)
    config["joints"]["elbow"]["signals"]["q"]["at"] = "motor"
    del config["joints"]["elbow"]["gear_ratio"]
    with pytest.raises(FileDefect, match="the joint has no gear_ratio: give it"):
        joints(tmp_path, table("run1.csv", LOG), **config)


def test_an_angle_within_a_turn_of_the_motor_is_named(tmp_path: Path) -> None:
    config = yaml.safe_load(OF_LOG)
    config["joints"]["elbow"]["signals"]["q"] |= {"at": "motor", "wraps": True}
    read = joints(tmp_path, table("run1.csv", LOG | {"q": np.mod(100 * LOG["q"], 2 * np.pi)}), **config)
    assert "angle_of_motor_turn" in {each.kind for each in read.defects}


def test_notes_between_the_rows_of_a_sheet_are_comments(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    rows = pd.DataFrame(PLAIN).to_numpy().tolist()
    for row in (list(PLAIN), *rows[:50], ["# load was changed"], *rows[50:]):
        book.active.append(row)
    (tmp_path / "files").mkdir()
    book.save(tmp_path / "files" / "run1.xlsx")
    (tmp_path / "map.yaml").write_text(yaml.safe_dump(yaml.safe_load(IN_PLAIN) | FACTS | {"comment": "#"}))
    (found,) = inspect_recordings(tmp_path / "files", tmp_path / "map.yaml")
    np.testing.assert_allclose(found.channels["s1"], GAUGES["s1"])


def test_a_folder_without_files_of_numbers_is_named(tmp_path: Path) -> None:
    (tmp_path / "files").mkdir()
    (tmp_path / "files" / "notes.txt").write_text("bench 3")
    (tmp_path / "map.yaml").write_text(yaml.safe_dump(yaml.safe_load(IN_PLAIN) | FACTS))
    with pytest.raises(FileDefect, match=r"no file of numbers among notes\.txt, expected files that end in \.h5"):
        inspect_recordings(tmp_path / "files", tmp_path / "map.yaml")


def test_a_signal_with_its_own_time_is_interpolated(tmp_path: Path) -> None:
    slow = np.arange(0.0005, 0.119, 0.002)
    own = {"t2": [*slow, *[""] * (len(TIME) - len(slow))]}
    current = {"i": [*np.cos(20 * slow), *[""] * (len(TIME) - len(slow))]}
    config = yaml.safe_load(OF_LOG)
    config["joints"]["elbow"]["signals"]["current"]["time"] = "t2"
    (found,) = joints(tmp_path, table("run1.csv", LOG | own | current), **config).recordings
    inside = (slow[0] <= TIME) & (slow[-1] >= TIME)
    np.testing.assert_allclose(found.time, TIME[inside])
    np.testing.assert_allclose(found.signals["q"], LOG["q"][inside], rtol=1e-8)
    np.testing.assert_allclose(found.signals["current"], np.cos(20 * TIME[inside]), atol=1e-3)


def test_an_angle_is_continuous_before_it_is_interpolated(tmp_path: Path) -> None:
    """Between 359 and 1 degree a second clock does not pass 180."""
    own = np.arange(len(TIME)) / 1000 + 0.0004

    def angle(time: np.ndarray) -> np.ndarray:
        return 20 * time + 0.5 * np.sin(10 * time)

    config = yaml.safe_load(OF_LOG)
    config["joints"]["elbow"]["signals"]["q"] |= {"time": "t2", "unit": "deg", "wraps": True}
    signals = {"qd": 20 + 5 * np.cos(10 * TIME), "i": LOG["i"], "t2": own, "q": np.degrees(angle(own) + 6) % 360}
    (found,) = joints(tmp_path, table("run1.csv", {"t": TIME} | signals), **config).recordings
    error = found.signals["q"] - angle(TIME)[1:] - 6
    np.testing.assert_allclose(error, np.full(len(error), error[0]), atol=1e-5)  # whole turns are unknown


def test_a_clock_that_ends_early_is_named(tmp_path: Path) -> None:
    half = {"t2": [*TIME[:110], *[""] * 10], "i": [*LOG["i"][:110], *[""] * 10]}
    config = yaml.safe_load(OF_LOG)
    config["joints"]["elbow"]["signals"]["current"]["time"] = "t2"
    with pytest.raises(FileDefect, match="9 of 120 rows before or after the times of i, expected at most 0"):
        joints(tmp_path, table("run1.csv", LOG | half), **config)
    read = joints(tmp_path, **config, lost={"leave_out": 9})
    assert len(read.recordings[0]) == 110
    assert "readings_left_out" in {each.kind for each in read.defects}
    late = {"t2": TIME + 100}
    with pytest.raises(FileDefect, match=r"times of the others from 0 to 0\.119 s, and t2: 100 to 100\.119 s"):
        joints(tmp_path, table("run1.csv", LOG | late), **config)


def test_recordings_that_follow_one_another_have_facts_of_their_own(tmp_path: Path) -> None:
    parts = {"low": {"from": 0, "to": 0.06, "T_out_nm": 7, "repeat": 3}, "rise": [0.06, 9]}
    low, rise = sorted(gauges(tmp_path, PLAIN, parts=parts), key=lambda each: each.name)
    assert (low.name, low.point.T_out, low.repeat) == ("run1 low", 7, 3)
    assert (rise.name, rise.point.T_out, rise.repeat) == ("run1 rise", 39.5, 2)
    twice = {"run": np.repeat([1, 2], len(TIME))} | {name: np.tile(values, 2) for name, values in PLAIN.items()}
    each = {1: {"T_out_nm": 7}, 2: {"repeat": 2}}
    first, second = sorted(gauges(tmp_path, twice, each=each, rows={"run": "{each}"}), key=lambda each: each.name)
    assert (first.name, first.point.T_out, first.repeat) == ("run1 1", 7, 1)
    assert (second.name, second.point.T_out, second.repeat) == ("run1 2", 39.5, 2)
    with pytest.raises(FileDefect, match=r"found no part '3' of 'each', expected one of 1, 2"):
        gauges(tmp_path, twice, each=each | {3: {}}, rows={"run": "{each}"})
    with pytest.raises(FileDefect, match=r"column run: found no row with run = '5', expected one of '1', '2'"):
        gauges(tmp_path, twice, rows={"run": 5})


def test_one_row_for_each_joint_and_time(tmp_path: Path) -> None:
    two = {
        name: np.repeat(values, 2) * (1 if name == "t" else np.tile([1.0, 3.0], len(TIME)))
        for name, values in LOG.items()
    }
    long = {"name": ["elbow", "wrist"] * len(TIME), **two}
    config = yaml.safe_load(OF_LOG)
    for entry in (config["time"], *config["joints"]["elbow"]["signals"].values()):
        entry["rows"] = {"name": "elbow"}
    (found,) = joints(tmp_path, table("run1.csv", long), **config).recordings
    np.testing.assert_allclose(found.signals["q"], LOG["q"], rtol=1e-8)
    np.testing.assert_allclose(found.time, TIME)


def test_one_row_for_each_signal_and_time(tmp_path: Path) -> None:
    rows = [(time, name, LOG[name][number]) for number, time in enumerate(TIME) for name in ("q", "qd", "i")]
    ticks, tags, values = zip(*rows, strict=True)
    config = yaml.safe_load(OF_LOG)
    config["time"]["rows"] = {"tag": "q"}
    for entry in config["joints"]["elbow"]["signals"].values():
        entry["rows"] = {"tag": entry["column"]}
        entry["column"] = "value"
    (found,) = joints(tmp_path, table("log.csv", {"t": ticks, "tag": tags, "value": values}), **config).recordings
    np.testing.assert_allclose(found.signals["current"], LOG["i"], rtol=1e-8)


def test_recordings_within_a_file_are_named(tmp_path: Path) -> None:
    config = yaml.safe_load(OF_LOG)
    with pytest.raises(FileDefect, match=r"has 'each' and \{each\} in no column or sheet"):
        joints(tmp_path, table("run1.csv", LOG), **config, each="a.*")
    config["time"]["column"] = "{each}/t"
    with pytest.raises(FileDefect, match=r"has \{each\} and no 'each'"):
        joints(tmp_path, **config)
    with pytest.raises(FileDefect, match=r"run1\.csv: found a text file, expected a file with groups"):
        joints(tmp_path, **config, each="a.*")
    (tmp_path / "files" / "run1.csv").unlink()
    with h5py.File(tmp_path / "files" / "run1.h5", "w") as file:
        file["data/one/t"] = TIME
    with pytest.raises(FileDefect, match=r"found the parts 'data', 'data/one', expected some that match 'each'"):
        joints(tmp_path, **config, each="trial.*")


def test_time_stamps_of_the_files_of_a_run_must_agree(tmp_path: Path) -> None:
    config = yaml.safe_load(OF_LOG)
    config["time"] = {"file": "a", "column": "t", "unit": "iso"}
    for name, entry in config["joints"]["elbow"]["signals"].items():
        entry["file"] = "b" if name == "current" else "a"
    stamps = [(pd.Timestamp("2026-03-12") + pd.Timedelta(seconds=time)).isoformat() for time in TIME]
    late = [*stamps[1:], "2026-03-12T00:00:09"]
    of_both = [table("r1_a.csv", {"t": stamps, "q": LOG["q"], "qd": LOG["qd"]})]
    path = r"(?P<run>r1)_(?P<signal>[ab])\.csv"
    assert joints(tmp_path, *of_both, table("r1_b.csv", {"t": stamps, "i": LOG["i"]}), path=path, **config).recordings
    with pytest.raises(FileDefect, match=r"r1_b\.csv, column t: found other times, expected the times of r1_a\.csv"):
        joints(tmp_path, table("r1_b.csv", {"t": late, "i": LOG["i"]}), path=path, **config)
