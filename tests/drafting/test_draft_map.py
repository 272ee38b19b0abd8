"""Drafts of twenty layouts are read, and the numbers compared with the truth."""

import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest
from judged import mistake
from layouts import LAYOUTS, gauges

import swgsim as swg
from swgsim.drafting import command

# Layouts whose draft needs one line of the user, as the files do not say it.
NEEDS_A_LINE = {"matlab_matrix", "motor_side"}


@pytest.mark.parametrize("name", LAYOUTS)
def test_draft_is_right(name: str, tmp_path: Path) -> None:
    """Right without correction, or after one line where the files cannot say it."""
    folder = tmp_path / "logs"
    folder.mkdir()
    case = LAYOUTS[name](folder, np.random.default_rng(len(name)))
    draft = swg.draft_map(folder, known=case.known)
    assert draft.kind == case.kind
    wrong = mistake(case, folder, draft.text, tmp_path / "map.yaml")
    if name in NEEDS_A_LINE:
        assert wrong
        assert case.line[0] in draft.text
        wrong = mistake(case, folder, draft.text.replace(*case.line, 1), tmp_path / "map.yaml")
    assert not wrong, draft.text


def test_draft_shows_itself(tmp_path: Path) -> None:
    """Table, lines to decide, findings of the reading, and a picture beside the map, which is not overwritten."""
    folder = tmp_path / "logs"
    folder.mkdir()
    LAYOUTS["nanoseconds"](folder, np.random.default_rng(1))
    draft = swg.draft_map(folder)
    shown = repr(draft)
    assert re.search(r"joint_1_pos_deg .* joint_1 q +deg", shown)
    assert "1 joint recordings" in shown
    assert "text" in draft.table().set_index("column").loc["mode", "why"]
    draft.save(tmp_path / "map.yaml")
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(ValueError, match="exists"):
        draft.save(tmp_path / "map.yaml")


def test_what_is_not_known_is_asked(tmp_path: Path) -> None:
    """Strain without gauge factor is not read: its lines are comments until the user decides."""
    folder = tmp_path / "logs"
    folder.mkdir()
    LAYOUTS["microstrain"](folder, np.random.default_rng(1))
    draft = swg.draft_map(folder)
    assert sum("gauge_factor" in line for line in draft.questions) == 5
    assert all(line.startswith("# ???") for line in draft.questions if "gauge_factor" in line)
    assert any("gear: unknown" in line for line in draft.questions)
    assert "1 recordings are read" in draft.findings


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """swg map writes the draft and prints what was taken for what."""
    folder = tmp_path / "logs"
    folder.mkdir()
    LAYOUTS["rtde"](folder, np.random.default_rng(1))
    out = tmp_path / "my_map.yaml"
    command.run({"files": str(folder), "out": str(out), "kind": None, "known": {"robot": "UR10e", "rated": None}})
    assert "robot: UR10e" in out.read_text(encoding="utf-8")
    assert "actual_qd_5" in capsys.readouterr().out
    with pytest.raises(ValueError, match="files is not given"):
        command.run({"files": None, "out": str(out), "kind": None, "known": {}})


ODD = {
    "empty.csv": b"",
    "header_only.csv": b"t,q,w\n",
    "no_text.csv": np.random.default_rng(0).bytes(5000),
    "notes.txt": b"these are notes\nof a test on 12.03.2026\n",
    "texts.csv": b"a,b\n" + b"x,y\n" * 30,
}


@pytest.mark.parametrize("name", ODD)
def test_what_is_no_table_is_refused(name: str, tmp_path: Path) -> None:
    """With the file and what was found."""
    (tmp_path / name).write_bytes(ODD[name])
    with pytest.raises(ValueError, match=f"{name}: found 0 rows of numbers|found 1 rows"):
        swg.draft_map(tmp_path)


def test_unusual_numbers_are_drafted(tmp_path: Path) -> None:
    """A column that stands, one without readings, numbers without end, and a name that looks like a formula."""
    lines = [f"{i / 100},{np.sin(i / 9)},1,nan,1e300,{i % 7}" for i in range(300)]
    (tmp_path / "a.csv").write_text("\n".join(["t,q$_{,vel,temp,x,y", *lines]) + "\n", encoding="utf-8")
    draft = swg.draft_map(tmp_path)
    assert "smoothed_s" in draft.text
    assert draft.plot().axes


def test_a_wrong_velocity_is_not_read(tmp_path: Path) -> None:
    """The column of another joint, or one with a dead band, is no velocity of this angle."""
    t = np.arange(2000) / 200
    table = np.column_stack([t, np.sin(t), np.cos(3 * t)])
    np.savetxt(tmp_path / "a.csv", table, delimiter=",", header="time_s,pos_rad,vel_rad_s", comments="")
    draft = swg.draft_map(tmp_path)
    assert "omega: {from: q, smoothed_s: 0.05}" in draft.text
    assert any("vel_rad_s" in line and line.startswith("# ???") for line in draft.questions)


def _cells(signals: dict, names: Iterable[str]) -> list[list[str]]:
    """Columns of text, the time in ms."""
    return [[f"{1000 * value if name == 't' else value:.6g}" for value in signals[name]] for name in names]


def test_recordings_side_by_side_are_not_mixed(tmp_path: Path) -> None:
    """The first one is drafted; the columns whose names come again are of another one, here shorter."""
    first, second = (gauges(np.random.default_rng(1), load=load) for load in (39.0, 7.0))
    names = {"t": "t [ms]", "phi_in": "angle [rad]", "T_out": "torque [Nm]", "s1": "bridge 1 [mV/V]"}
    cells = _cells(first, names)
    cells += [[*column[:2000], *[""] * 1000] for column in _cells(second, names)]
    header = ",".join([*names.values(), *names.values()])
    text = "\n".join([header, *(",".join(row) for row in zip(*cells, strict=True))])
    (tmp_path / "two.csv").write_text(text + "\n", encoding="utf-8")
    draft = swg.draft_map(tmp_path)
    taken = draft.table().set_index("column")["taken for"]
    assert taken[["1", "2", "3", "4"]].tolist() == ["t", "phi_in", "T_out?", "s1"]
    assert "T_out_nm: 39" in draft.text
    assert "n_in_rpm: 1200" in draft.text


def test_a_slow_clock_without_a_unit_is_asked_for(tmp_path: Path) -> None:
    """Steps of 0.1 are as well milliseconds."""
    rows = "\n".join(f"{i / 10},{np.sin(i / 50)},{np.cos(i / 50)}" for i in range(600))
    (tmp_path / "a.csv").write_text(f"time,pos_rad,current_A\n{rows}\n", encoding="utf-8")
    assert any("its unit" in line for line in swg.draft_map(tmp_path).questions)


def test_a_named_text_file_is_read_back(tmp_path: Path) -> None:
    """Files of this ending are read only if the map names them."""
    m = gauges(np.random.default_rng(1))
    np.savetxt(tmp_path / "a.txt", np.column_stack([m[name] for name in ("t", "phi_in", "T_out", "s1")]),
               delimiter="\t", header="t [s]\tangle [rad]\ttorque [Nm]\tbridge 1 [mV/V]", comments="")  # fmt: skip
    draft = swg.draft_map(tmp_path)
    assert "a.txt: {}" in draft.text
    assert "1 recordings are read" in draft.findings
