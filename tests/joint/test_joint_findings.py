"""Findings on joint recordings: each kind on a fabricated run, and none on sound ones."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fabricated_joints import (
    KINOVA,
    SPOILED,
    START,
    UR,
    UR_SPOILED,
    Table,
    kinova_folder,
    kinova_rest,
    kinova_run,
    ur_folder,
    ur_run,
    write_file,
    write_kinova,
)

from swgsim.joint.intake.read import JointRecordings, read_joints
from swgsim.joint.intake.scale import HALVES, MISTAKES, mistake, way
from swgsim.joint.intake.source_file import read_source
from swgsim.recordings.checks.defect import Defect


def kinds(files: JointRecordings) -> set[tuple[str, str, str]]:
    return {(each.kind, each.severity, each.recording) for each in files.defects}


def of(column: str, change: Callable[[np.ndarray], np.ndarray]) -> Callable[[Table], Table]:
    """A run with one column changed."""
    return lambda run: {**run, column: change(run[column])}


def rows(choose: Callable[[np.ndarray], np.ndarray]) -> Callable[[Table], Table]:
    """A run with other rows."""
    chosen: Callable[[Table], np.ndarray] = lambda run: choose(np.arange(len(run["position_rad"])))  # noqa: E731
    return lambda run: {name: values[chosen(run)] for name, values in run.items()}


def put(values: np.ndarray, where: slice | int, value: float) -> np.ndarray:
    values = values.copy()
    values[where] = value
    return values


def unwrapped(run: Table) -> np.ndarray:
    return np.unwrap(run["position_rad"])


T, Q, V = "torque_sensor_Nm", "position_rad", "velocity_rad_s"
LATER = slice(START + 600, START + 1300)

# Runs whose rate comes from their motion: change, and kind, severity and words of the finding.
KINOVA_CASES: dict[str, tuple[Callable[[Table], Table], str, str, str]] = {
    "every other row is missing": (rows(lambda i: i[::2]), "half_rate", "refuse", "every other row is missing"),
    "every row twice": (rows(lambda i: np.repeat(i, 2)), "repeated_rows", "refuse", "rows that repeat the one before"),
    "velocity twice too large": (of(V, lambda v: 2 * v), "double_rate", "refuse", "twice its true value"),
    "rows cut out": (rows(lambda i: np.delete(i, np.arange(900, 1000))), "angle_jumps", "warn", "usual steps too long"),
    "rows cut out in large parts": (
        rows(lambda i: np.delete(i, np.r_[700:1100, 1200:1500])), "angle_jumps", "refuse", "rows are missing",
    ),
    "the recorder stood still": (
        rows(lambda i: np.where((i > 900) & (i < 940), 900, i)), "repeated_rows", "warn", "39 of them in a row",
    ),
    "constant velocity": (of(V, lambda v: np.full_like(v, 0.5)), "velocity_constant", "refuse", "0.5 rad/s throughout"),
    "no velocity": (of(V, np.zeros_like), "velocity_constant", "refuse", "0 rad/s throughout"),
    "set velocity": (
        of(V, lambda v: np.where(np.arange(len(v)) < 1500, 0.5, 0.501)), "velocity_set", "refuse", "a set value",
    ),
    "velocity of another time": (
        lambda run: {**run, V: 0.5 + 0.9 * np.sin(np.arange(len(run[V])) / 100)},
        "velocity_against_angle", "refuse", "of the same joint and time",
    ),
    "velocity of the motor": (of(V, lambda v: 100 * v), "velocity_of_motor", "refuse", "100 times that of the output"),
    "velocity scaled": (of(V, lambda v: 1.5 * v), "velocity_scale", "refuse", "a factor of 0.66"),
    "velocity scaled a little": (of(V, lambda v: 1.15 * v), "velocity_scale", "warn", "a factor of 0.8"),
    "velocity backwards": (of(V, np.negative), "velocity_backwards", "refuse", "inverted: true"),
    "angle in degrees": (of(Q, np.degrees), "angle_in_degrees", "refuse", "unit: deg"),
    "angle that goes on": (
        of(Q, lambda q: np.linspace(0, 600, len(q))), "angle_beyond_revolution", "refuse", "remove wraps",
    ),
    "angle frozen": (of(Q, lambda q: put(q, LATER, q[LATER.start])), "frozen", "refuse", "of the way"),
    "torque frozen": (of(T, lambda x: put(x, LATER, 0.11)), "frozen", "refuse", "check the connection"),
    "torque frozen for a while": (
        of(T, lambda x: put(x, slice(800, 950), 0.11)), "frozen", "warn", "150 times 0.11 in a row",
    ),
    "torque zero": (of(T, np.zeros_like), "all_zero", "refuse", "0 throughout"),
    "torque clipped": (of(T, lambda x: np.minimum(x, 0.13)), "clipped", "warn", "samples of exactly 0.13"),
    "torque clipped for the most part": (of(T, lambda x: np.maximum(x, 0.11)), "clipped", "refuse", "exactly 0.11"),
    "not a number": (of(T, lambda x: put(x, 900, np.nan)), "not_finite", "refuse", "row 902: found 1 of"),
    "a few rows only": (rows(lambda i: i[: START + 60]), "too_short", "refuse", "60 samples after the start"),
    "less than a turn of the motor": (
        lambda run: {**run, Q: np.linspace(1, 1.05, len(run[Q])), V: 0.044 * run[V]}, "short_way", "warn",
        "revolutions of the motor",
    ),
    "hardly moved": (
        of(Q, lambda q: np.linspace(1, 1.01, len(q))), "rate_of_others", "warn", "the median of the other runs",
    ),
    "a long start": (
        lambda run: kinova_run(0.5, "long start", transient=3000), "start_up", "warn", "samples more by start_up",
    ),
    "the same as another": (
        lambda run: kinova_run(0.3, "S1_2021-01-01"), "same_twice", "refuse", "the same numbers as",
    ),
}  # fmt: skip


def test_sound_runs_have_no_findings(tmp_path: Path) -> None:
    assert read_joints(kinova_folder(tmp_path / "kinova"), KINOVA).defects == ()
    assert read_joints(ur_folder(tmp_path / "ur"), UR).defects == ()


@pytest.mark.parametrize("name", list(KINOVA_CASES))
def test_a_spoiled_run_is_named(tmp_path: Path, name: str) -> None:
    spoil, kind, severity, words = KINOVA_CASES[name]
    files = read_joints(kinova_folder(tmp_path, spoil), KINOVA)
    found = [each for each in files.defects if each.kind == kind]
    assert found, [str(each) for each in files.defects]
    blamed = {"same_twice": found[0].recording}.get(kind, SPOILED)
    assert [(each.severity, each.recording) for each in found] == [(severity, blamed)]
    assert words in str(found[0])
    left = [each for each in files.recordings if f"{each.name} {each.joint}" == blamed]
    refused = any(each.severity == "refuse" for each in files.defects if each.recording == blamed)
    assert bool(left) != refused
    assert {each.recording for each in files.defects} == {blamed}


# Runs with a clock.
UR_Q, UR_V, UR_I, UR_RIGID = 2, 8, 14, 26  # of joint 2, counted from 0


def column(number: int, change: Callable[[np.ndarray], np.ndarray]) -> Callable[[np.ndarray], np.ndarray]:
    def changed(table: np.ndarray) -> np.ndarray:
        table = table.copy()
        table[:, number] = change(table[:, number])
        return table

    return changed


UR_CASES: dict[str, tuple[Callable[[np.ndarray], np.ndarray], str, str, str]] = {
    "angle in degrees": (column(UR_Q, np.degrees), "angle_in_degrees", "refuse", "57.3 times as far"),
    "velocity in degrees": (column(UR_V, np.degrees), "velocity_in_deg_s", "refuse", "0.01745 times"),
    "velocity backwards": (column(UR_V, np.negative), "velocity_backwards", "refuse", "opposite to the change"),
    "velocity half": (column(UR_V, lambda v: v / 2), "velocity_scale", "refuse", "a factor of 2 fits"),
    "time in milliseconds": (column(0, lambda t: 1e3 * t), "time_unit", "refuse", "the time is in milliseconds"),
    "velocity of joint 3": (
        lambda table: np.where(np.arange(31) == UR_V, ur_run((3,), "other")[:, [9]], table),
        "velocity_against_angle", "refuse", "of the same joint",
    ),
    "both in degrees": (
        lambda table: column(UR_V, np.degrees)(column(UR_Q, np.degrees)(table)), "implausible_speed", "warn",
        "set at: motor",
    ),
    "angle wraps": (
        column(UR_Q, lambda q: np.mod(q, 2 * np.pi)), "angle_wraps", "refuse", "wraps: true",
    ),
    "rows cut out": (lambda table: np.delete(table, range(500, 520), axis=0), "time_jumps", "warn", "steps such as"),
    "time stands": (column(0, lambda t: put(t, 300, t[299])), "clock_backwards", "refuse", "row 301"),
    "counter is full": (
        column(0, lambda t: t - (2**32 / 1e6) * (t > t[300])), "clock_backwards", "refuse", "bits: 32",
    ),
    "midnight": (column(0, lambda t: t - 86400 * (t > t[300])), "clock_backwards", "refuse", "passes midnight"),
    "no rigid-body torque": (column(UR_RIGID, np.zeros_like), "all_zero", "warn", "T_rigid"),
    "posture not known": (column(4, lambda q: put(q, 9, np.inf)), "not_finite", "refuse", "posture 3, row 10"),
}  # fmt: skip


@pytest.mark.parametrize("name", list(UR_CASES))
def test_a_spoiled_run_with_a_clock_is_named(tmp_path: Path, name: str) -> None:
    spoil, kind, severity, words = UR_CASES[name]
    files = read_joints(ur_folder(tmp_path, spoil), UR)
    found = [each for each in files.defects if each.kind == kind]
    assert [each.severity for each in found] == [severity], [str(each) for each in files.defects]
    assert words in str(found[0])
    assert {each.recording for each in files.defects} <= {UR_SPOILED, "ur-1-joint_2"}
    assert (len(files.recordings) == 12) == any(each.severity == "refuse" for each in files.defects)


def test_a_session_at_half_rate_is_seen_beside_the_declared_rate(tmp_path: Path) -> None:
    for speed in (0.3, 0.5, 0.7):
        run = {name: values[::2] for name, values in kinova_run(speed, "half", rows=3000).items()}
        write_kinova(tmp_path / f"S3_v{speed}.csv", run)
    source = read_source(KINOVA)
    assert {each[:2] for each in kinds(read_joints(tmp_path, source))} == {("half_rate", "refuse")}
    assert kinds(read_joints(tmp_path, replace(source, rate_hz=None))) == set()


def test_a_wrong_declared_rate_is_named(tmp_path: Path) -> None:
    text = KINOVA.read_text().replace("rate: from_motion\n", "").replace("rate_hz: 870", "rate_hz: 440")
    (tmp_path / "source.yaml").write_text(text)
    files = read_joints(kinova_folder(tmp_path / "runs"), tmp_path / "source.yaml")
    assert {each.kind for each in files.defects} == {"double_rate"}
    assert files.recordings == ()
    assert [each.rate for each in files.at_rest] == pytest.approx([440])


def test_a_start_that_was_not_cut_is_reported(tmp_path: Path) -> None:
    source = replace(read_source(KINOVA), start_samples=0)
    files = read_joints(kinova_folder(tmp_path), source)
    assert {each[:2] for each in kinds(files)} == {("start_up", "warn")}
    assert len(files.recordings) == 4


def test_standstill_that_moves_or_has_no_noise_is_refused(tmp_path: Path) -> None:
    kinova_folder(tmp_path)
    write_kinova(tmp_path / "standstill_noise_moves.csv", kinova_run(0.1, "moves"))
    write_kinova(tmp_path / "standstill_noise_set.csv", {**kinova_rest(), T: np.full(900, 0.1)})
    files = read_joints(tmp_path, KINOVA)
    assert kinds(files) == {
        ("moves_at_rest", "refuse", "standstill_noise_moves joint_7"),
        ("no_noise", "refuse", "standstill_noise_set joint_7"),
    }
    assert [each.name for each in files.at_rest] == ["standstill_noise_2021-01-02"]


def test_a_file_that_matches_no_pattern_is_reported(tmp_path: Path) -> None:
    write_file(kinova_folder(tmp_path) / "other" / "x.csv", b"a,b\n1,1\n")
    assert kinds(read_joints(tmp_path, KINOVA)) == {("not_in_map", "warn", "other/x.csv")}


def test_a_joint_that_turns_or_swings_goes_as_far_by_angle_as_by_velocity() -> None:
    time = np.arange(4000) / 500
    for q, omega in (
        (0.3 * time, np.full(4000, 0.3)),
        (-0.3 * time, np.full(4000, -0.3)),
        (np.sin(3 * time), 3 * np.cos(3 * time)),
    ):
        by_angle, by_velocity = way(q, omega, time)
        assert by_angle / by_velocity == pytest.approx(1, abs=1e-4)
        assert abs(by_angle) > 2
        rate = way(q, omega).by_velocity / by_angle
        assert rate == pytest.approx(500, rel=1e-4)


def test_mistakes_go_by_their_ratio() -> None:
    named = {kind: ratio for kind, ratio, _ in (*HALVES, *MISTAKES)}
    for kind, ratio in {**named, "velocity_of_motor": 1 / 101, "angle_of_motor": 101.0}.items():
        for off in (0.98, 1.0, 1.02):
            found = mistake(off * ratio, 101.0, clock=False)
            assert found is not None
            assert found[0] == kind
    assert mistake(1.3, 101.0, clock=False) is None
    assert mistake(1 / 101, None, clock=False) is None


def test_every_finding_is_in_the_documentation() -> None:
    root = Path(__file__).parents[2]
    sources = [path.read_text() for path in (root / "swgsim" / "joint" / "intake").glob("*.py")]
    kinds = {kind for text in sources for kind in re.findall(r'Defect\(\s*"(\w+)"', text)}
    kinds |= {kind for kind, _, _ in (*HALVES, *MISTAKES)} | {"velocity_scale"}
    page = (root / "docs" / "joint_recordings.md").read_text()
    assert len(kinds) > 25
    assert {kind for kind in kinds if f"`{kind}`" not in page} == set()


def test_findings_of_a_chosen_joint_leave_out_those_of_others() -> None:
    found = tuple(
        Defect("all_zero", "refuse", name, "current", "0 throughout", "a signal", "check the connection")
        for name in ("run1 joint_1", "run1 joint_2", "run1")
    )
    files = JointRecordings((), (), found, refused=(("day", "run1", "joint_1"), ("day", "run1", "joint_2")))
    said = files.findings("joint_2")
    assert "run1 joint_2" in said
    assert "joint_1" not in said
    assert "also in 1 others: run1" in said
    assert "joint_1" in files.findings()
