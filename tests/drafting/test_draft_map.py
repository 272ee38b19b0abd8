"""Drafts of twenty layouts are read, and the numbers compared with the truth."""

import re
from pathlib import Path

import numpy as np
import pytest
from judged import mistake
from layouts import LAYOUTS

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
