"""Drafts of logs of robots and drives as people brought them: the reading must give the numbers of the truth."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
from judged import mistake
from layouts import RAD, Case, joint, rows

import swgsim as swg
from swgsim.drafting import command

MOVING = ("t", "q", "omega", "current")
NUMBERS = "\n".join(f"{place},{np.sin(place / 9)}" for place in range(300))


def one(m: dict, signals: tuple[str, ...] = MOVING, **more: np.ndarray) -> Case:
    """A joint as its file has it."""
    return Case("joints", {"joint_1": {name: m[name] for name in signals} | more})


def shares(folder: Path, m: dict) -> Case:
    names = "Zeit [s];$AXIS_ACT[2] [Grad];$VEL_AXIS_ACT[2] [%];$CURR_ACT[2] [%]\n"
    columns = [m["t"], m["q"] * RAD, m["omega"] * RAD / 1.56, m["current"] / 0.26]
    rows(folder / "a.csv", names, columns, ";", decimal=",")
    return one(m)


def scope(folder: Path, m: dict) -> Case:
    """Each channel has its time, and that of the current is half as fast."""
    names = ["ActPos", "ActVelo", "ActCurrent"]
    labelled = {"Name": names, "Symbol": ["A.Pos", "A.Velo", "A.I"], "Port": ["1", "1", "7"], "Unit": ["°", "°/s", "‰"]}
    before = "Scope\n\n" + "".join("\t".join(f"{k}\t{v}" for v in values) + "\n" for k, values in labelled.items())
    half = len(m["t"]) // 2
    slow = [[f"{x:.8g}" for x in each[::2]] + [""] * half for each in (m["t"] * 1e3, m["current"] / 0.0042)]
    columns = [m["t"] * 1e3, m["q"] * RAD, m["t"] * 1e3 + 0.5, np.interp(m["t"] + 5e-4, m["t"], m["omega"]) * RAD]
    rows(folder / "a.csv", before, [*columns, *slow], "\t", decimal=",")
    between = slice(1, 2 * half - 1)
    own = {"current": np.interp(m["t"], m["t"][::2], m["current"][::2])}
    return one({name: values[between] for name, values in (m | own).items()})


def several_tables(folder: Path, m: dict) -> Case:
    both = {"1": m, "2": joint(np.random.default_rng(5))}
    for each in both.values():
        rows(folder / "one.txt", "timestamp q qd i\n", [each[name] for name in MOVING], " ")
        with (folder / "all.csv").open("a") as every:
            every.write((folder / "one.txt").read_text())
    return Case("joints", {f"all {number} joint_1": {s: each[s] for s in MOVING} for number, each in both.items()})


def run_column(folder: Path, m: dict) -> Case:
    both = {"7": m, "8": joint(np.random.default_rng(5))}
    run = [str(number) for number in np.repeat(list(both), len(m["t"]))]
    columns = [np.concatenate([each[name] for each in both.values()]) for name in MOVING]
    rows(folder / "day.csv", "run,t,pos_rad,vel_rad_s,current_A\n", [run, *columns], ",")
    return Case("joints", {f"day {number} joint_1": {s: each[s] for s in MOVING} for number, each in both.items()})


def full_counter(folder: Path, m: dict) -> Case:
    us = [str((4_290_000_000 + int(each)) % 2**32) for each in np.round(m["t"] * 1e6)]
    rows(folder / "a.csv", "timestamp_us,pos,vel,Iq\n", [us, m["q"], m["omega"], m["current"]], ",")
    return one(m)


def lists(folder: Path, m: dict) -> Case:
    def cells(name: str) -> list[str]:
        return [f'"[{-x:.9g}, {x:.9g}]"' for x in m[name]]

    names = ["\"['wrist', 'elbow']\""] * len(m["t"])
    columns = [m["t"], names, cells("q"), cells("omega"), cells("T_sensor")]
    rows(folder / "a.csv", "time,name,position,velocity,effort\n", columns, ",")
    return Case("joints", {"joint_2": {"t": m["t"], "q": m["q"], "omega": m["omega"], "T_motor": m["T_sensor"]}})


def json_lines(folder: Path, m: dict) -> Case:
    samples = [{"t": t, "position": [-q, q], "velocity": [-w, w], "current": [i, i]}
               for t, q, w, i in zip(*(m[name] for name in MOVING), strict=True)]  # fmt: skip
    (folder / "a.jsonl").write_text("\n".join(map(json.dumps, samples)))
    return Case("joints", {"joint_2": {name: m[name] for name in MOVING}})


def motor_counts(folder: Path, m: dict) -> Case:
    """An encoder of one turn of the motor: in which turn it began is not known."""
    m = joint(np.random.default_rng(4), rate=1000.0)  # a turn is sampled often
    turns = m["q"] * 160 / (2 * np.pi)
    counts = [str(int(each) % 16384) for each in np.floor(turns * 16384)]
    rows(folder / "a.csv", "t,Encoder counts,velocity rpm,current_mA\n",
         [m["t"], counts, m["omega"] * 160 * 30 / np.pi, m["current"] * 1e3], ",")  # fmt: skip
    return one(m, q=(turns - np.floor(turns[0])) * 2 * np.pi / 160)


# What the user decides: a text of the draft and what stands in its place.
DECIDED = {
    shares: ("# ??? current: {column: '$CURR_ACT[2] [%]', unit: percent, rated: 1 A}",
             "current: {column: '$CURR_ACT[2] [%]', unit: percent, rated: 26 A}"),
    scope: ("# ??? current: {column: ActCurrent, time: 5, unit: permille, rated: 1 A}",
            "current: {column: ActCurrent, time: 5, unit: permille, rated: 4.2 A}"),
    motor_counts: ("gear_ratio: 1 ", "gear_ratio: 160 "),
}  # fmt: skip


@pytest.mark.parametrize(
    "write", [shares, scope, several_tables, run_column, full_counter, lists, json_lines, motor_counts]
)
def test_draft_is_right(write: Callable[[Path, dict], Case], tmp_path: Path) -> None:
    """Right as it is, or after the line that the draft asks for."""
    (tmp_path / "logs").mkdir()
    case = write(tmp_path / "logs", joint(np.random.default_rng(4)))
    draft = swg.draft_map(tmp_path / "logs")
    before, after = DECIDED.get(write, ("", ""))
    assert any(before.strip() in line for line in draft.questions)
    wrong = mistake(case, tmp_path / "logs", draft.text.replace(before, after), tmp_path / "map.yaml")
    assert not wrong, draft.text


def test_a_share_of_a_rated_velocity_follows_from_the_slope(tmp_path: Path) -> None:
    """It is no gear ratio, and without a load the draft says that nothing can be explained."""
    shares(tmp_path, joint(np.random.default_rng(4)))
    draft = swg.draft_map(tmp_path, known={"gear_ratio": 120})
    assert "unit: percent, rated: 156 deg/s}" in draft.text
    assert "at: motor" not in draft.text
    assert "# ??? nothing to explain in joint_1: map current, T_motor or T_sensor" in draft.questions


def test_all_given_files_are_drafted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """As if they were alone in their folder; the status is 1 if the draft reads none."""
    for name in ("a", "b", "c"):
        m = joint(np.random.default_rng(ord(name)))
        rows(tmp_path / f"{name}.csv", "t,pos_rad,vel_rad_s,current_A\n", [m[signal] for signal in MOVING], ",")
    given = [str(tmp_path / f"{name}.csv") for name in "ab"]
    chosen = {"files": given, "out": str(tmp_path / "map.yaml"), "kind": None, "known": {}}
    command.run(chosen)
    said = capsys.readouterr().out
    assert f"2 joint recordings of my robot in {tmp_path}" in said
    assert "each file is a session of its own" in said
    (tmp_path / "a.csv").write_text(f"t,q\n{NUMBERS}\n{NUMBERS}\n")
    with pytest.raises(ValueError, match="the draft reads no recording yet"):
        command.run(chosen | {"files": given[0], "out": str(tmp_path / "other.yaml")})
    said = capsys.readouterr().out
    assert f"no usable joint recordings in {tmp_path}" in said
    assert "for several recordings in one file, see each and rows" in said
    with pytest.raises(ValueError, match="a folder among several names"):
        swg.draft_map([tmp_path, given[0]])


def test_units_of_hdf5_are_texts_of_any_length(tmp_path: Path) -> None:
    m = joint(np.random.default_rng(4))
    with h5py.File(tmp_path / "a.h5", "w") as file:
        for name, values, unit in (("t", m["t"] * 1e3, "ms"), ("q", m["q"] * RAD, "deg"), ("i", m["current"], "A")):
            file[name] = values
            file[name].attrs["units"] = unit
    draft = swg.draft_map(tmp_path)
    assert [line for line in draft.questions if "unit" in line] == []
    assert "q: {column: q, unit: deg}" in draft.text


def test_other_formats_are_converted_as_the_page_shows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    m = joint(np.random.default_rng(4))
    np.savez(tmp_path / "run1.npz", time=m["t"], q=np.stack([m["q"], -m["q"]], 1), current=m["current"])
    with pytest.raises(ValueError, match=r"run1\.npz, expected files that end in \.h5.*formats\.md"):
        swg.draft_map(tmp_path)
    pd = pytest.importorskip("pandas")
    pd.DataFrame({name: m[name] for name in MOVING}).to_pickle(tmp_path / "run2.pkl")
    monkeypatch.chdir(tmp_path)
    page = (Path(__file__).parents[2] / "docs" / "formats.md").read_text(encoding="utf-8")
    exec(re.search(r"```python\n(.*?)```", page, re.DOTALL)[1])  # type: ignore[index]
    assert "q[2]" in swg.draft_map(tmp_path / "run1.h5").text
    assert swg.draft_map(tmp_path / "run2.parquet").readable
