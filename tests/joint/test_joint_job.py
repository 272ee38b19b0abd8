"""The question to a robot joint from end to end: files and a source in, the answer out."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from joint_fixtures import Hidden, trajectories

from swgsim.effects.text import from_text
from swgsim.joint import cases
from swgsim.joint import close_joint_loop as job
from swgsim.joint.intake.read import read_joints
from swgsim.joint.intake.source_file import read_source
from swgsim.joint.regression import Table, rms

SOURCE = {
    "robot": "tester",
    "path": r"(?P<run>(?P<session>[^_]+)_.*)\.csv",
    "files": ["*.csv"],
    "time": {"column": "t", "unit": "s"},
    "joints": {
        "elbow": {
            "signals": {
                "q": {"column": "q", "unit": "rad"},
                "omega": {"column": "v", "unit": "rad/s"},
                "current": {"column": "i", "unit": "A"},
                "T_rigid": {"column": "T", "unit": "N m"},
            }
        }
    },
}
HIDDEN = Hidden(load=0.01)
SEARCHED = ["load_dependent_friction", "stribeck_friction"]
KEYS = {"verdict", "noise_floor", "calibrated", "effects", "rejected", "error", "unknown", "next_experiment"}


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("joint")
    (folder / "source.yaml").write_text(yaml.safe_dump(SOURCE))
    (folder / "logs").mkdir()
    for number, each in enumerate(trajectories("job", HIDDEN), 1):
        table = {"t": each.time, **{column: each.signals[name] for column, name in
                 (("q", "q"), ("v", "omega"), ("i", "current"), ("T", "T_rigid"))}}  # fmt: skip
        pd.DataFrame(table).to_csv(folder / "logs" / f"day{number}_run.csv", index=False)
    return folder


def asked(files: Path, **changes: object) -> dict:
    plain = {"source": str(files / "source.yaml"), "recordings": str(files / "logs"), "out": str(files / "answer")}
    return {**cases.OPEN, **plain, "holdout": "day4", "searched": SEARCHED, **changes}


@pytest.fixture(scope="module")
def answered(files: Path) -> job.Outcome:
    return job.run(asked(files), lambda _: None)


def test_the_answer_names_what_was_hidden_and_judges_it_elsewhere(files, answered):
    said = json.loads((files / "answer" / "report.json").read_text())
    assert said.keys() >= KEYS
    assert said == json.loads(json.dumps(answered.report))
    assert [effect["name"] for effect in said["effects"]] == ["load_dependent_friction"]
    size = said["effects"][0]["parameters"]["load_dependent_friction"]
    assert size["ci95"][0] < HIDDEN.load < size["ci95"][1]
    assert said["error"]["after"]["heldout"] < 0.7 * said["error"]["before"]["heldout"]
    assert said["split"]["heldout"] == ["day4_run"]
    assert "load dependent friction" in (files / "answer" / "page.html").read_text()


def test_the_model_that_is_written_predicts_what_was_judged(files, answered):
    terms = from_text((files / "answer" / "effects.yaml").read_text(), "effects.yaml")
    recordings = read_joints(files / "logs", read_source(files / "source.yaml")).recordings
    held = Table(tuple(each for each in recordings if each.session == "day4"), "current")
    missed = held.signal - np.concatenate([sum(term.signal(each) for term in terms) for each in held.recordings])
    assert rms(missed) == pytest.approx(answered.report["error"]["after"]["heldout"], rel=1e-6)


def test_a_folder_may_judge(files, answered, tmp_path):
    folders = {"day1": "fit", "day2": "fit", "day3": "fit", "day4": "judge"}
    for day, folder in folders.items():
        (tmp_path / folder).mkdir(exist_ok=True)
        (tmp_path / folder / f"{day}_run.csv").write_bytes((files / "logs" / f"{day}_run.csv").read_bytes())
    places = {"recordings": str(tmp_path / "fit"), "holdout": str(tmp_path / "judge"), "out": str(tmp_path / "answer")}
    assert job.run(asked(files, **places), lambda _: None).report["error"] == answered.report["error"]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"holdout": "day9"}, "'day9' of holdout= meets no session"),
        ({"holdout": "*"}, "0 recordings of elbow to fit and 4 to judge"),
        ({"holdout": None}, "give a pattern"),
        ({"joint": "wrist"}, "joint=wrist is none of the recordings': choose joint= from elbow"),
        ({"signal": "T_sensor"}, "signal=T_sensor.*choose signal= from current"),
        ({"searched": ["coning"]}, "'coning' is no effect on a joint; choose from asymmetric_friction"),
        ({"recordings": None}, "recordings=FOLDER"),
        ({"holdout": "day4, dya3"}, "'dya3' of holdout= meets no session and no run: the sessions are day1"),
        ({"without": "day5"}, "'day5' of without= meets"),
        ({"source": "ur11"}, "source=ur11 is no file: choose from.*kinova_gen3.*ur10e"),
    ],
)
def test_a_question_that_cannot_be_asked_is_answered_with_the_choices(files, changes, message):
    with pytest.raises(ValueError, match=message):
        job.run(asked(files, **changes), lambda _: None)


def test_an_effect_of_a_user_is_searched(files, tmp_path, monkeypatch):
    (tmp_path / "of_a_user.py").write_text(
        "from swgsim.joint.effects.slip import LoadDependentFriction\nclass Mine(LoadDependentFriction):\n    pass\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    kinds = job.library({"searched": [], "library": ["of_a_user:Mine"]})
    assert [kind.__name__ for kind in kinds] == ["Mine"]


@pytest.mark.parametrize("library", ["asymmetric_friction", ["asymmetric_friction"]])
def test_names_are_a_list_or_a_text_with_commas(library):
    kinds = job.library({"searched": ", ".join(SEARCHED), "library": library})
    assert [kind.name() for kind in kinds] == [*SEARCHED, "asymmetric_friction"]
    assert [kind.name() for kind in job.library({"searched": SEARCHED, "library": None})] == SEARCHED
    with pytest.raises(ValueError, match="'' is no effect on a joint"):
        job.library({"searched": "asymmetric_friction,", "library": None})


def test_cases_are_answered_once_and_missing_ones_are_named(files, tmp_path, monkeypatch, capsys):
    case = {"source": str(files / "source.yaml"), "recordings": "logs", "holdout": "day4", "searched": SEARCHED}
    config = {
        "folder": str(files), "only": "*", "out": str(tmp_path / "joints"), "report": str(tmp_path / "report"),
        "docs": str(tmp_path / "docs"), "workers": 1, "cases": {"elbow": case, "wrist": case | {"recordings": "lost"}},
    }  # fmt: skip
    cases.run(config)
    assert "wrist: " in capsys.readouterr().out
    said = json.loads((tmp_path / "report" / "joints.json").read_text())
    assert list(said["cases"]) == ["elbow"]
    assert list(said["missing"]) == ["wrist"]
    rungs = said["cases"]["elbow"]["rungs"]
    assert [rung["effect"] for rung in rungs if rung["kept"]] == ["textbook", "load_dependent_friction"]
    assert "load dependent friction" in (tmp_path / "docs" / "ladders.md").read_text()
    assert (tmp_path / "docs" / "elbow_ladder.png").read_bytes().startswith(b"\x89PNG")
    monkeypatch.setattr(job, "run", lambda *_: pytest.fail("computed again"))
    cases.run(config)
    assert json.loads((tmp_path / "report" / "joints.json").read_text()) == said


def test_a_message_about_a_file_says_of_which_folder(files, tmp_path):
    (tmp_path / "day4_run.csv").write_text("t,q,v,i,T\n")
    for choice in ("recordings", "holdout"):
        with pytest.raises(
            ValueError, match=rf"{choice}={tmp_path}: day4_run\.csv, row 2: found a header without rows"
        ):
            job.run(asked(files, **{choice: str(tmp_path)}), lambda _: None)


def test_a_folder_that_cannot_be_written_is_refused_before_anything_is_read(files):
    with pytest.raises(FileExistsError, match=r"source\.yaml was not written; choose another folder"):
        job.run(asked(files, recordings="lost", out=str(files / "source.yaml")), lambda _: None)


def test_what_was_fitted_may_not_judge(files, tmp_path):
    with pytest.raises(ValueError, match="run day1_run of the holdout folder is also in the recordings to fit"):
        job.run(asked(files, holdout=str(files / "logs"), out=str(tmp_path)), lambda _: None)


def test_a_case_that_cannot_be_answered_does_not_stop_the_others(files, tmp_path, capsys):
    case = {"source": str(files / "source.yaml"), "recordings": "logs", "holdout": "day4", "searched": []}
    config = {
        "folder": str(files), "only": "*", "out": str(tmp_path / "joints"), "report": str(tmp_path), "docs": None,
        "workers": 1, "cases": {"wrist": case | {"joint": "wrist"}, "elbow": case},
    }  # fmt: skip
    cases.run(config)
    said = json.loads((tmp_path / "joints.json").read_text())
    assert list(said["cases"]) == ["elbow"]
    assert "choose joint= from elbow" in said["missing"]["wrist"]


def test_the_command_takes_a_source_by_its_name_and_by_its_file(files, tmp_path):
    script = Path(job.__file__).parents[2] / "scripts" / "close_loop.py"
    asked_for = [
        sys.executable,
        str(script),
        f"recordings={files / 'logs'}",
        "holdout=day4",
        "searched=[stribeck_friction]",
    ]
    store = f"tracking.folder={tmp_path / 'runs'}"
    done = subprocess.run(
        [*asked_for, f"source={files / 'source.yaml'}", f"out={tmp_path / 'answer'}", store],
        capture_output=True, text=True, cwd=tmp_path, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "effects found" in done.stdout
    other = subprocess.run(
        [*asked_for, "source=ur10e", store], capture_output=True, text=True, cwd=tmp_path, check=False
    )
    assert "no match in the defaults" not in other.stderr.lower()
    assert "as the source" in other.stderr or "ur-" in other.stderr
