"""Identification of a robot joint from end to end: files and a source in, the answer out."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from hydra import compose, initialize_config_dir
from joint_fixtures import Hidden, trajectories
from prepared_store import prepared

from learn import tracking
from learn.commands import close_loop
from swgsim.common.configured import conf_folder, plain
from swgsim.effects.text import from_text
from swgsim.joint import JointAnswer, JointRecordings, cases, identify_joint, recordings_of
from swgsim.joint import close_joint_loop as job
from swgsim.joint.identify import effects_of
from swgsim.joint.regression import Table, rms

SIGNALS = {"q": ("q", "rad"), "omega": ("v", "rad/s"), "current": ("i", "A"), "T_rigid": ("T", "N m")}
SOURCE = {
    "robot": "tester",
    "path": r"(?P<run>(?P<session>[^_]+)_.*)\.csv",
    "files": ["*.csv"],
    "time": {"column": "t", "unit": "s"},
    "joints": {
        "elbow": {"signals": {name: {"column": column, "unit": unit} for name, (column, unit) in SIGNALS.items()}}
    },
}
HIDDEN = Hidden(load=0.01)
SEARCHED = ["load_dependent_friction", "stribeck_friction"]
KEYS = {"verdict", "noise_floor", "calibrated", "effects", "rungs", "error", "unknown", "next_experiment"}


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("joint")
    (folder / "source.yaml").write_text(yaml.safe_dump(SOURCE))
    (folder / "logs").mkdir()
    for number, each in enumerate(trajectories("job", HIDDEN), 1):
        table = {"t": each.time, **{column: each.signals[name] for name, (column, _) in SIGNALS.items()}}
        pd.DataFrame(table).to_csv(folder / "logs" / f"day{number}_run.csv", index=False)
    return folder


@pytest.fixture(scope="module")
def recordings(files: Path) -> JointRecordings:
    return recordings_of(files / "source.yaml", files / "logs")


@pytest.fixture(scope="module")
def progress() -> list[str]:
    return []


@pytest.fixture(scope="module")
def answer(files: Path, recordings: JointRecordings, progress: list[str]) -> JointAnswer:
    found = identify_joint(recordings, holdout="day4", searched=SEARCHED, progress=progress.append)
    found.save(files / "answer")
    return found


def config(files: Path, **changes: object) -> dict:
    plain = {"source": str(files / "source.yaml"), "recordings": str(files / "logs"), "out": str(files / "other")}
    return {**cases.OPTIONAL, **plain, "holdout": "day4", "searched": SEARCHED, **changes}


def test_the_answer_names_the_hidden_effect_and_tests_it_on_other_recordings(files, answer):
    said = json.loads((files / "answer" / "report.json").read_text())
    assert said.keys() >= KEYS
    assert said == json.loads(json.dumps(answer.report))
    assert [effect["name"] for effect in said["effects"]] == ["load_dependent_friction"]
    size = said["effects"][0]["parameters"]["load_dependent_friction"]
    assert size["ci95"][0] < HIDDEN.load < size["ci95"][1]
    assert said["error"]["after"]["heldout"] < 0.7 * said["error"]["before"]["heldout"]
    assert said["split"]["heldout"] == ["day4_run"]
    assert "load dependent friction" in (files / "answer" / "page.html").read_text()


def test_recordings_and_answer_describe_themselves(recordings, answer, progress):
    assert "4 joint recordings of tester" in repr(recordings)
    assert "elbow: 4 runs of sessions day1, day2, day3, day4; signals q, omega, current, T_rigid" in repr(recordings)
    first, second, *_ = repr(answer).splitlines()
    assert first.startswith("textbook model explains 98.")
    assert second == answer.sentence
    assert list(answer.table().effect[:2]) == ["textbook", "load_dependent_friction"]
    assert [line.split(":")[0] for line in progress[:3]] == ["textbook model", "step 1", "step 2"]
    assert "+ load dependent friction: error 0.0" in progress[1]
    assert progress[1].endswith("A on the fitted recordings")


def test_the_written_model_predicts_the_held_out_recordings(files, recordings, answer):
    terms = from_text((files / "answer" / "effects.yaml").read_text(), "effects.yaml")
    held = Table(tuple(each for each in recordings.recordings if each.session == "day4"), "current")
    missed = held.signal - np.concatenate([sum(term.signal(each) for term in terms) for each in held.recordings])
    assert rms(missed) == pytest.approx(answer.report["error"]["after"]["heldout"], rel=1e-6)


def test_a_folder_may_be_held_out(files, answer, tmp_path):
    folders = {"day1": "fit", "day2": "fit", "day3": "fit", "day4": "held"}
    for day, folder in folders.items():
        (tmp_path / folder).mkdir(exist_ok=True)
        (tmp_path / folder / f"{day}_run.csv").write_bytes((files / "logs" / f"{day}_run.csv").read_bytes())
    fitted, held = (recordings_of(files / "source.yaml", tmp_path / folder) for folder in ("fit", "held"))
    assert identify_joint(fitted, holdout=held, searched=SEARCHED).report["error"] == answer.report["error"]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"holdout": "day9"}, "'day9' of holdout= meets no session"),
        ({"holdout": "*"}, "0 recordings of elbow to fit and 4 held out"),
        ({"holdout": None}, "give a pattern"),
        ({"joint": "wrist"}, "joint=wrist is not in the recordings: choose joint= from elbow"),
        ({"signal": "T_sensor"}, "signal=T_sensor.*choose signal= from current"),
        ({"searched": ["coning"]}, "'coning' is no effect on a joint; choose from asymmetric_friction"),
        ({"holdout": "day4, dya3"}, "'dya3' of holdout= meets no session and no run: the usable sessions are day1"),
        ({"holdout": ["day4", "dya3"]}, "'dya3' of holdout= meets no session and no run: the usable sessions are day1"),
        ({"without": "day5"}, "'day5' of without= meets"),
    ],
)
def test_an_impossible_choice_is_refused_with_the_choices(recordings, changes, message):
    with pytest.raises(ValueError, match=message):
        identify_joint(recordings, **{"holdout": "day4", "searched": SEARCHED, **changes})


def test_an_unknown_source_is_refused_with_those_of_robots():
    with pytest.raises(ValueError, match=r"choose from kinova_gen3, ur10e, or give the path") as error:
        recordings_of("ur11", "logs")
    assert "example" not in str(error.value)


def test_refused_recordings_are_named_with_the_reason(files, tmp_path):
    """Degrees that the source calls radians."""
    for day in ("day1", "day2", "day4"):
        table = pd.read_csv(files / "logs" / f"{day}_run.csv")
        table.assign(q=np.degrees(table.q)).to_csv(tmp_path / f"{day}_run.csv", index=False)
    spoiled = recordings_of(files / "source.yaml", tmp_path)
    assert "refused: 3" in repr(spoiled)
    with pytest.raises(ValueError, match=r"all 3 recordings in .* refused, 3 of them for angle_in_degrees: .*day1_run"):
        identify_joint(spoiled, holdout="day4")
    for day in ("day1", "day2"):
        (tmp_path / f"{day}_run.csv").write_bytes((files / "logs" / f"{day}_run.csv").read_bytes())
    with pytest.raises(ValueError, match=r"'day4' of holdout= matches only refused recordings \(day4_run\)"):
        identify_joint(recordings_of(files / "source.yaml", tmp_path), holdout="day4")


def test_an_answer_names_what_it_does_not_use_and_what_small_motions_cannot_show(files, tmp_path):
    """One run is refused, one moves too little, and one moves by less than a revolution of the motor."""
    factors = {"day1": (np.degrees(1), 1), "day2": (2e-3, 2e-3), "day3": (0.05, 0.05), "day4": (0.05, 0.05)}
    for day, (angle, speed) in factors.items():
        table = pd.read_csv(files / "logs" / f"{day}_run.csv")
        table.assign(q=angle * table.q, v=speed * table.v).to_csv(tmp_path / f"{day}_run.csv", index=False)
    answer = identify_joint(recordings_of(files / "source.yaml", tmp_path), holdout="day4", searched=SEARCHED)
    left_out = answer.report["split"]["left_out"]
    assert [each.split(":")[0] for each in left_out] == ["day2_run", "day1_run"]
    assert "less than 0.005 rad" in left_out[0]
    assert "refused for angle_in_degrees" in left_out[1]
    cautions = answer.report["cautions"]
    assert [each for each in cautions if each.startswith("not used")] == [f"not used: {each}" for each in left_out]
    assert any("2 of 2 recordings move by" in each and "hysteresis" in each for each in cautions)


def test_unused_recordings_are_named_if_too_few_remain(files, tmp_path):
    for day in ("day1", "day4"):
        table = pd.read_csv(files / "logs" / f"{day}_run.csv")
        small = table.assign(q=0.001 * table.q, v=0.001 * table.v)
        small.to_csv(tmp_path / f"{day}_run.csv", index=False)
    with pytest.raises(ValueError, match=r"not used: day1_run: moved 0\.00\d+ rad, less than 0\.005 rad"):
        identify_joint(recordings_of(files / "source.yaml", tmp_path), holdout="day4")


def test_an_effect_of_a_user_is_tested(tmp_path, monkeypatch):
    (tmp_path / "of_a_user.py").write_text(
        "from swgsim.joint.effects.slip import LoadDependentFriction\nclass Mine(LoadDependentFriction):\n    pass\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    assert [kind.__name__ for kind in effects_of([], ["of_a_user:Mine"])] == ["Mine"]


@pytest.mark.parametrize("library", ["asymmetric_friction", ["asymmetric_friction"]])
def test_names_are_a_list_or_a_text_with_commas(library):
    kinds = effects_of(", ".join(SEARCHED), library)
    assert [kind.name() for kind in kinds] == [*SEARCHED, "asymmetric_friction"]
    assert [kind.name() for kind in effects_of(SEARCHED, None)] == SEARCHED
    with pytest.raises(ValueError, match="'' is no effect on a joint"):
        effects_of("asymmetric_friction,", None)


def joints(files: Path, tmp_path: Path, **chosen: dict) -> dict:
    case = {"source": str(files / "source.yaml"), "recordings": "logs", "holdout": "day4", "searched": SEARCHED}
    return {
        "folder": str(files), "only": "*", "out": str(tmp_path / "joints"), "report": str(tmp_path / "report"),
        "docs": str(tmp_path / "docs"), "workers": 1,
        "cases": {name: case | changes for name, changes in chosen.items()},
    }  # fmt: skip


def test_cases_are_answered_once_and_those_without_an_answer_are_named(files, tmp_path, monkeypatch, capfd):
    config = joints(files, tmp_path, elbow={}, lost={"recordings": "lost"}, wrist={"joint": "wrist"})
    cases.run(config)
    printed = capfd.readouterr()
    assert f"lost: {files / 'lost'} does not exist" in printed.out
    assert "elbow: step 1: + load dependent friction" in printed.err
    said = json.loads((tmp_path / "report" / "joints.json").read_text())
    assert list(said["cases"]) == ["elbow"]
    assert sorted(said["missing"]) == ["lost", "wrist"]
    assert "choose joint= from elbow" in said["missing"]["wrist"]
    rungs = said["cases"]["elbow"]["rungs"]
    assert [rung["effect"] for rung in rungs if rung["kept"]] == ["textbook", "load_dependent_friction"]
    assert "load dependent friction" in (tmp_path / "docs" / "ladders.md").read_text()
    assert (tmp_path / "docs" / "elbow_ladder.png").read_bytes().startswith(b"\x89PNG")
    monkeypatch.setattr(job, "run", lambda *_, **__: pytest.fail("computed again"))
    again = {"elbow": config["cases"]["elbow"], "other": {}}
    cases.run(config | {"cases": again, "only": ["elbow", "e*"]})
    assert json.loads((tmp_path / "report" / "joints.json").read_text())["cases"] == said["cases"]


def test_without_any_files_the_joints_end_with_an_error(files, tmp_path):
    with pytest.raises(ValueError, match=r"needs the folders lost\. .*docs/joint_recordings.md"):
        cases.run(joints(files, tmp_path, wrist={"recordings": "lost"}))
    assert not (tmp_path / "report").exists()


def test_a_message_about_a_file_names_its_folder(files, tmp_path):
    (tmp_path / "day4_run.csv").write_text("t,q,v,i,T\n")
    for choice in ("recordings", "holdout"):
        message = rf"{choice}={tmp_path}: day4_run\.csv, row 2: found names without rows"
        with pytest.raises(ValueError, match=message):
            job.run(config(files, **{choice: str(tmp_path)}), lambda _: None)


def test_configurations_are_refused_before_anything_is_computed(files, tmp_path):
    with pytest.raises(FileExistsError, match=r"source\.yaml was not written; choose another folder"):
        job.run(config(files, recordings="lost", out=str(files / "source.yaml")), lambda _: None)
    with pytest.raises(ValueError, match="recordings=FOLDER"):
        job.run(config(files, recordings=None), lambda _: None)
    with pytest.raises(ValueError, match="run day1_run of the holdout folder is also in the recordings to fit"):
        job.run(config(files, holdout=str(files / "logs"), out=str(tmp_path)), lambda _: None)


@pytest.mark.end_to_end
def test_the_command_keeps_the_answer_as_a_run(files, tmp_path, capsys):
    choices = [f"recordings={files / 'logs'}", f"source={files / 'source.yaml'}", "holdout=day4"]
    choices += ["searched=[stribeck_friction]", f"out={tmp_path / 'answer'}"]
    choices += [f"tracking.folder={prepared(tmp_path / 'runs')}"]
    with initialize_config_dir(str(conf_folder()), version_base="1.3"):
        close_loop.run(plain(compose("close_loop", choices)))
    assert "effects found" in capsys.readouterr().out
    store = tracking.local_store(str(tmp_path / "runs"), "loop")
    (run,) = store.client.search_runs([store.experiment_id])
    assert run.info.status == "FINISHED"
