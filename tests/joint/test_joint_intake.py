"""Reading of joint recordings: both shipped sources, and every kind of bad source and file."""

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from fabricated_joints import (
    KINOVA,
    KINOVA_RATE,
    START,
    UR,
    csv_text,
    kinova_folder,
    kinova_run,
    sound_ur,
    ur_folder,
    ur_run,
    write_file,
    write_kinova,
)
from scipy.io import savemat

from swgsim.joint.intake.read import read_joints
from swgsim.joint.intake.source_file import read_source
from swgsim.joint.split import select
from swgsim.tables.file_defect import FileDefect

CONFIG = yaml.safe_load(KINOVA.read_text())
JOINT = CONFIG["joints"]["joint_7"]


def test_a_kinova_folder_is_read(tmp_path: Path) -> None:
    files = read_joints(kinova_folder(tmp_path), KINOVA)
    assert [(each.session, each.name) for each in files.recordings] == [
        *(("S1", f"S1_2021-01-01_v{speed}") for speed in ("0.30", "0.50", "0.70")),
        ("S2", "S2_x_v0.50"),
    ]
    found, made = files.recordings[1], kinova_run(0.5, "S1_2021-01-01")
    assert (found.robot, found.joint, found.gear_ratio, found.torque_constant) == ("Kinova Gen3", "joint_7", 100, 7.6)
    np.testing.assert_allclose(found.signals["q"], np.unwrap(made["position_rad"][START:]), rtol=1e-12)
    for name, column in (("omega", "velocity_rad_s"), ("T_sensor", "torque_sensor_Nm"), ("current", "current_A")):
        np.testing.assert_array_equal(found.signals[name], made[column][START:])
    assert set(found.signals) == {"q", "omega", "T_sensor", "current"}
    assert np.ptp(found.signals["q"]) == pytest.approx(0.5 * 1500 / KINOVA_RATE, rel=0.01)
    for each in files.recordings:
        assert each.rate == pytest.approx(KINOVA_RATE, rel=0.005)
    rest = files.at_rest[0]
    assert (len(files.at_rest), rest.session, rest.name) == (1, "standstill_noise", "standstill_noise_2021-01-02")
    assert len(rest) == START + 400
    assert rest.rate == pytest.approx(KINOVA_RATE, rel=0.005)


def test_a_ur_folder_is_read(tmp_path: Path) -> None:
    files = read_joints(ur_folder(tmp_path), UR)
    found = [(each.session, each.name, each.joint) for each in files.recordings]
    trajectory = [("ur-2-8harm", name, f"joint_{i}") for name in ("ur-2-8harm", "ur-2-8harmLoad") for i in range(1, 7)]
    assert found == [("ur-1", "ur-1-joint_2", "joint_2"), *trajectory]
    made = ur_run((2,), "alone")
    first = files.recordings[0]
    np.testing.assert_array_equal(first.time, made[:, 0])
    np.testing.assert_array_equal(first.posture, made[:, 2:5].T)
    for name, column in (("q", 2), ("omega", 8), ("current", 14), ("T_rigid", 26)):
        np.testing.assert_array_equal(first.signals[name], made[:, column])


def test_joints_that_stand_beside_the_moved_one_show_the_noise_of_their_currents(tmp_path: Path) -> None:
    """What they hold of the load of the others is slow, and no noise."""
    table = ur_run((2,), "alone")
    table[:, 13] += 0.5 * np.sin(2 * np.pi * 0.3 * table[:, 0])
    files = read_joints(ur_folder(tmp_path, lambda _: table), UR)
    assert [each.joint for each in files.standing] == [f"joint_{i}" for i in (1, 3, 4, 5, 6)]
    for joint in ("joint_1", "joint_3"):
        case = select(files, None, joint, "current", "*Load", None)
        white = 0.1 * np.sqrt(1 - 2 * 5 / 94)
        assert case.floor == pytest.approx(white, rel=0.05)
        assert case.floor_how.startswith("above 5 Hz")
    assert select(files, None, "joint_2", "current", "*Load", "ur-1").floor is None


FULL = {
    "robot": "mine",
    "path": r"(?P<session>[^/]+)/(?P<run>.*)\.(?:csv|csv\.gz|parquet|mat)",
    "files": ["*/run*"],
    "rate_hz": 500,
    "start_up": {"seconds": 0.1},
    "joints": {
        "elbow": {
            "signals": {
                "q": {"column": "angle", "unit": "deg", "wraps": True},
                "omega": {"column": "speed", "unit": "rpm", "inverted": True},
                "current": {"column": "amps", "unit": "mA"},
                "T_sensor": {"column": "torque", "unit": "mN m"},
            }
        }
    },
    "posture": {"columns": ["shoulder", "angle"], "unit": "deg"},
}


def elbow() -> dict[str, np.ndarray]:
    rng = np.random.default_rng(1)
    time = np.arange(800) / 500
    return {
        "angle": np.mod(350 + 40 * time, 360),
        "speed": -np.full(800, 40 / 6) + 0.01 * rng.normal(size=800),
        "amps": 100 + rng.normal(size=800),
        "torque": 1000 + rng.normal(size=800),
        "shoulder": np.full(800, 90.0),
    }


SAVERS: dict[str, Callable[[Path, dict], None]] = {
    "run 1.csv": lambda path, columns: pd.DataFrame(columns).to_csv(path, index=False),
    "run 1.csv.gz": lambda path, columns: pd.DataFrame(columns).to_csv(path, index=False),
    "run 1.parquet": lambda path, columns: pd.DataFrame(columns).to_parquet(path),
    "run 1.mat": lambda path, columns: savemat(path, columns, do_compression=True),
}


def write_source(path: Path, config: object) -> Path:
    path.write_text(yaml.safe_dump(config))
    return path


@pytest.mark.parametrize("file", list(SAVERS))
def test_a_robot_of_ones_own_needs_a_source_only(tmp_path: Path, file: str) -> None:
    (tmp_path / "data" / "monday").mkdir(parents=True)
    SAVERS[file](tmp_path / "data" / "monday" / file, elbow())
    files = read_joints(tmp_path / "data", write_source(tmp_path / "mine.yaml", FULL))
    (found,) = files.recordings
    assert files.defects == ()
    assert (found.robot, found.session, found.name, found.joint) == ("mine", "monday", "run 1", "elbow")
    assert (len(found), found.rate) == (750, pytest.approx(500))
    np.testing.assert_allclose(found.signals["q"], np.radians(350 + 40 * (0.1 + found.time)), rtol=1e-9)
    assert found.signals["omega"].mean() == pytest.approx(np.radians(40), rel=1e-3)
    assert found.signals["current"].mean() == pytest.approx(0.1, rel=1e-2)
    assert found.signals["T_sensor"].mean() == pytest.approx(1, rel=1e-2)
    np.testing.assert_allclose(found.posture[0], np.pi / 2)


def test_a_start_in_seconds_is_cut_by_the_clock(tmp_path: Path) -> None:
    text = UR.read_text().replace("time: {column: 1, unit: s}", "time: {column: 1, unit: s}\nstart_up: {seconds: 2}")
    (tmp_path / "ur.yaml").write_text(text)
    files = read_joints(ur_folder(tmp_path / "ur"), tmp_path / "ur.yaml")
    time = ur_run((2,), "alone")[:, 0]
    assert files.recordings[0].time[0] == time[time >= time[0] + 2 - 1e-9][0]


def test_the_example_of_the_documentation_is_a_source(tmp_path: Path) -> None:
    text = (Path(__file__).parents[2] / "docs" / "joint_recordings.md").read_text()
    (tmp_path / "my_robot.yaml").write_text(text.split("```yaml\n")[1].split("```")[0])
    rng = np.random.default_rng(1)
    time = np.arange(3000) / 500
    columns = {
        "t": 1000 * time,
        "elbow_angle": np.mod(350 + 60 * time + 1e-4 * rng.normal(size=3000), 360),
        "elbow_speed": 60 + rng.normal(size=3000),
        "elbow_current": -500 + rng.normal(size=3000),
        "base_angle": np.zeros(3000),
        "shoulder_angle": np.full(3000, 45.0),
    }
    at_rest = {**columns, "elbow_angle": np.full(3000, 10.0), "elbow_speed": np.zeros(3000)}
    for name, said in (("sine_1", columns), ("rest", at_rest)):
        rows = np.column_stack(list(said.values()))
        write_file(tmp_path / "my_logs" / "monday" / f"{name}.csv", csv_text(",".join(said), rows))
    files = read_joints(tmp_path / "my_logs", tmp_path / "my_robot.yaml")
    assert files.defects == ()
    assert [(each.session, each.name, each.joint) for each in files.recordings] == [("monday", "sine_1", "elbow")]
    assert files.recordings[0].signals["current"].mean() == pytest.approx(0.5, rel=1e-3)
    assert (len(files.recordings[0]), len(files.at_rest[0])) == (2750, 3000)


def changed(**changes: object) -> dict:
    return {**CONFIG, **changes}


def joint(**changes: object) -> dict:
    return changed(joints={"joint_7": {**JOINT, **changes}})


def signal(name: str, **changes: object) -> dict:
    return joint(signals={**JOINT["signals"], name: {"column": "x", "unit": "rad", **changes}})


BAD_SOURCES: dict[str, tuple[object, str]] = {
    "no mapping": ([1, 2], "the source is '[1, 2]', must be names with values"),
    "unknown key": (changed(colour=1), "unknown choice 'colour' of the source; choose from robot, files, rest"),
    "no joints": ({key: value for key, value in CONFIG.items() if key != "joints"}, "the source has no joints"),
    "a joint that is a list": (changed(joints={"a": [1]}), "a is '[1]', must be names with values"),
    "unknown key of a joint": (joint(mass=1), "unknown choice 'mass' of joint_7; choose from signals, gear_ratio"),
    "no angle": (joint(signals={"omega": JOINT["signals"]["omega"]}), "joint_7 has no signal q"),
    "no signals": (joint(signals=None), "signals of joint_7 is 'None'"),
    "unknown signal": (signal("speed"), "unknown choice 'speed' of signals of joint_7; choose from q, omega, T_sensor"),
    "unknown unit": (
        signal("omega", unit="knots"),
        "'knots' of the unit of omega; choose from rad/s, mrad/s",
    ),
    "a torque as a current": (signal("current", column="tau", unit="Nm"), "a torque: map it as T_motor"),
    "unknown key of a signal": (signal("q", scale=2), "unknown choice 'scale' of q; choose from column, file, unit"),
    "wraps": (signal("omega", unit="rad/s", wraps=True), "unknown choice 'wraps' of omega"),
    "column by truth": (signal("q", column=True), "column of q is 'True'"),
    "one column twice": (signal("q", column="current_A"), "column 'current_A' is two signals of joint_7"),
    "gear ratio of 0": (joint(gear_ratio=0), "gear_ratio of joint_7 is 0.0"),
    "gear ratio in words": (joint(gear_ratio="100:1"), "gear_ratio is '100:1', must be a number"),
    "no rate": ({key: value for key, value in CONFIG.items() if not key.startswith("rate")}, "the source has no time"),
    "another rate": (changed(rate="fast"), "rate is 'fast', must be from_motion"),
    "time and rate": (changed(time={"column": "t", "unit": "s"}), "both time and a rate"),
    "time that wraps": (changed(time={"column": "t", "unit": "s", "wraps": True}), "'wraps' of time"),
    "start in seconds": (changed(start_up={"seconds": 1}), "give it in samples"),
    "start twice": (changed(start_up={"seconds": 1, "samples": 1}), "keep one"),
    "start before": (changed(start_up={"samples": -1}), "samples of start_up is -1"),
    "posture as a text": (changed(posture={"columns": "q", "unit": "rad"}), "columns of posture is 'q'"),
    "header in words": (changed(header="none"), "header is 'none', must be true or false"),
    "files outside": (changed(files=["../*.csv"]), "files has '../*.csv', must be a pattern inside the folder"),
    "no files": (changed(files=[]), "files is empty"),
    "a path with another group": (changed(path="(?P<session>.*)(?P<run>.*)(?P<day>.*)"), "unknown choice 'day'"),
    "a path with a group without a name": (changed(path="(?P<session>.*)(?P<run>(a+)+)"), "no regular expression"),
    "a path that is long": (changed(path="a" * 1001), "must be printable text of at most 1000"),
    "a path of much memory": (changed(path="(?P<session>(?:(?:a{99}){99}){99})(?P<run>b)"), "no regular expression"),
}


@pytest.mark.parametrize("name", list(BAD_SOURCES))
def test_a_bad_source_is_named(tmp_path: Path, name: str) -> None:
    config, message = BAD_SOURCES[name]
    with pytest.raises(FileDefect) as error:
        read_source(write_source(tmp_path / "source.yaml", config))
    assert message in str(error.value)
    assert "expected a source (docs/formats.md" in str(error.value)


def test_a_source_is_small_and_plain_yaml(tmp_path: Path) -> None:
    path = tmp_path / "source.yaml"
    path.write_text("robot: !!python/object/apply:os.system ['true']")
    with pytest.raises(FileDefect, match="no YAML"):
        read_source(path)
    path.write_text("#" * (2**20 + 1))
    with pytest.raises(FileDefect, match="a source of at most 1048576"):
        read_source(path)


def test_a_regular_expression_does_not_hang(tmp_path: Path) -> None:
    path = write_source(tmp_path / "source.yaml", changed(path=r"(?P<session>(?:a+)+)(?P<run>(?:a|aa)+b)", files="a*"))
    (tmp_path / ("a" * 200 + ".csv")).write_text("")
    with pytest.raises(FileDefect, match="does not match 'path'"):
        read_joints(tmp_path, path)


GOOD_ROWS = csv_text("", np.column_stack([np.linspace(1, 2, 700), np.full((700, 3), 0.5)])).decode()
HEADER = "position_rad,velocity_rad_s,torque_sensor_Nm,current_A\n"
BAD_FILES: dict[str, tuple[str, str]] = {
    "semicolons": ((HEADER + GOOD_ROWS).replace(",", ";"), "set separator: ';' in a map"),
    "no such column": ((HEADER + GOOD_ROWS).replace("current_A", "amps"), "expected 'current_A', as the map says"),
    "a column twice": (
        (HEADER + GOOD_ROWS).replace("current_A", "position_rad"),
        "2 columns 'position_rad', 'position_rad'",
    ),
    "text": (HEADER + "1,2,3,x\n" + GOOD_ROWS, "row 2, column current_A: found 'x', expected a number"),
}


@pytest.mark.parametrize("name", list(BAD_FILES))
def test_a_bad_file_is_named(tmp_path: Path, name: str) -> None:
    content, message = BAD_FILES[name]
    write_file(tmp_path / "S1_v1.csv", content.encode())
    with pytest.raises(FileDefect) as error:
        read_joints(tmp_path, KINOVA)
    assert str(error.value).startswith("S1_v1.csv")
    assert message in str(error.value)


def test_no_file_outside_the_folder_is_read(tmp_path: Path) -> None:
    folder = kinova_folder(tmp_path / "runs")
    outside = tmp_path / "outside"
    outside.mkdir()
    os.replace(folder / "S2_x_v0.50.csv.gz", outside / "S2_x_v0.50.csv.gz")
    (folder / "linked").symlink_to(outside)
    assert "S2" not in {each.session for each in read_joints(folder, KINOVA).recordings}
    (folder / "S2_x_v0.50.csv.gz").symlink_to(outside / "S2_x_v0.50.csv.gz")
    with pytest.raises(FileDefect, match="which leads outside"):
        read_joints(folder, KINOVA)


def test_files_and_source_must_agree(tmp_path: Path) -> None:
    with pytest.raises(FileDefect, match="found no folder"):
        read_joints(tmp_path / "none", KINOVA)
    (tmp_path / "empty").mkdir()
    with pytest.raises(FileDefect, match=r"no file that matches S\*_v\*\.csv"):
        read_joints(tmp_path / "empty", KINOVA)
    write_file(tmp_path / "other" / "Sx_v1.csv", b"")
    with pytest.raises(FileDefect, match="does not match 'path'"):
        read_joints(tmp_path / "other", KINOVA)
    for place in ("a", "b"):
        write_kinova(tmp_path / "twice" / place / "S1_v1.csv", kinova_run(1.0, place))
    with pytest.raises(FileDefect, match="the run 'S1_v1 joint_7' twice"):
        read_joints(tmp_path / "twice", KINOVA)
    write_file(tmp_path / "short" / "ur-1.csv", csv_text("", ur_run((1,), 0)[:, :20]))
    with pytest.raises(FileDefect, match="found 20 columns, expected a column 26"):
        read_joints(tmp_path / "short", UR)
    text = UR.read_text().replace("joint_[1-6]", "joint_[1-9]")
    (tmp_path / "nine.yaml").write_text(text)
    write_file(tmp_path / "nine" / "ur-1-joint_9.csv", sound_ur((1,), "nine"))
    with pytest.raises(FileDefect, match="found the joint 'joint_9', expected one of joint_1"):
        read_joints(tmp_path / "nine", tmp_path / "nine.yaml")


def test_runs_that_never_move_need_a_declared_rate(tmp_path: Path) -> None:
    write_kinova(tmp_path / "S1_v0.csv", kinova_run(0.0, "still"))
    files = read_joints(tmp_path, KINOVA)
    assert [each.rate for each in files.recordings] == pytest.approx([870])
    source = write_source(tmp_path / "mine.yaml", {key: value for key, value in CONFIG.items() if key != "rate_hz"})
    files = read_joints(tmp_path, source)
    assert files.recordings == ()
    assert [(each.kind, each.severity) for each in files.defects] == [("no_rate", "refuse")]


@pytest.mark.parametrize("angle", [6 - 1e-2 * np.arange(750), 1e-3 * np.arange(750)], ids=["back", "forth"])
def test_the_largest_and_the_smallest_numbers_are_judged(tmp_path: Path, angle: np.ndarray) -> None:
    ramp, zero = np.arange(750.0), np.zeros(750)
    for number, columns in enumerate(((zero, 1e14 * np.sin(ramp), zero, zero), (angle, 1e-300 * ramp, zero, zero))):
        write_file(tmp_path / f"S1_v{number}.csv", csv_text(HEADER.strip(), np.column_stack(columns)))
    files = read_joints(tmp_path, KINOVA)
    refused = {each.recording for each in files.defects if each.severity == "refuse"}
    assert len(files.recordings) + len(refused) == 2
