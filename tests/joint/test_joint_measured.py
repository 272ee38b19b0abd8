"""The shipped sources on the files they are for, which may not be copied here: tests skip where they are absent."""

import gzip
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from fabricated_joints import KINOVA, MEASURED, UR

from swgsim.joint.effects import SEARCHED
from swgsim.joint.effects.friction import StribeckFriction
from swgsim.joint.effects.ripple import InertiaRipple
from swgsim.joint.effects.slip import LoadDependentFriction
from swgsim.joint.intake.read import JointFiles, read_joints
from swgsim.joint.judged import Judged
from swgsim.joint.ladder import climb
from swgsim.joint.split import chosen
from swgsim.joint.term import Term

KINOVA_FILES, UR_FILES = MEASURED / "kinova_gen3_joint7", MEASURED / "ur10e"
WITHOUT = "the measured files are absent: docs/joint_recordings.md says where to get them"
with_kinova = pytest.mark.skipif(not KINOVA_FILES.is_dir(), reason=WITHOUT)
with_ur = pytest.mark.skipif(not UR_FILES.is_dir(), reason=WITHOUT)


def kinds(files: JointFiles) -> dict[str, int]:
    found = [each.kind for each in files.defects]
    return {kind: found.count(kind) for kind in sorted(set(found))}


@with_kinova
def test_kinova_files_are_read_without_refusal() -> None:
    files = read_joints(KINOVA_FILES, KINOVA)
    assert {each.severity for each in files.defects} == {"warn"}
    assert len(files.recordings) == 29
    rates = np.array([each.rate for each in files.recordings])
    assert (round(rates.min()), round(rates.max())) == (849, 897)
    assert {each.session for each in files.recordings} == {"S1", "S2", "S3"}
    (rest,) = files.at_rest
    assert rest.signals["T_sensor"].std() == pytest.approx(0.010, abs=0.001)
    # The recorder stood still and then lost rows in all of S1, and once in S2 and S3; two runs hardly moved.
    assert kinds(files) == {"angle_jumps": 7, "rate_of_others": 1, "repeated_rows": 7, "short_way": 2}
    for each in files.recordings:
        assert (np.diff(each.signals["q"]) < np.pi).all()


@with_ur
def test_ur_files_are_read_without_refusal() -> None:
    files = read_joints(UR_FILES, UR)
    assert kinds(files) == {"time_jumps": 4}
    assert {each.severity for each in files.defects} == {"warn"}
    assert len(files.recordings) == 39
    assert {round(each.rate) for each in files.recordings} <= {93, 94, 95}
    assert {each.joint for each in files.recordings if "joint_" in each.name} == {"joint_1", "joint_2", "joint_3"}
    assert {(each.joint, each.name[-7:]) for each in files.standing} >= {("joint_1", "joint_3"), ("joint_2", "joint_1")}
    loaded = [each for each in files.recordings if each.name.endswith("Load")]
    assert {each.session for each in loaded} == {"ur-20_02_19_14harm50sec"}


@with_kinova
def test_measured_files_that_were_spoiled_are_named(tmp_path: Path) -> None:
    """Made in a temporary folder, which pytest removes."""
    for speed in ("0.30", "0.50", "0.70", "0.90"):
        name = f"S3_2022-03-17_v{speed}.csv.gz"
        header, *rows = gzip.decompress((KINOVA_FILES / name).read_bytes()).decode().splitlines()
        cells = [row.split(",") for row in rows]
        if speed == "0.30":
            cells = cells[:500] + cells[500::2]
        if speed == "0.50":
            cells = [[*each[:2], "0.5", *each[3:]] for each in cells]
        if speed == "0.70":
            cells = cells[:1200] + cells[1300:]
        text = "\n".join([header, *map(",".join, cells)])
        (tmp_path / name).write_bytes(gzip.compress(text.encode(), 1))
    found = {(each.kind, each.recording[-12:-8]) for each in read_joints(tmp_path, KINOVA).defects}
    assert found == {("half_rate", "0.30"), ("velocity_constant", "0.50"), ("angle_jumps", "0.70")}


@with_ur
@pytest.mark.parametrize(("joint", "noise"), [("joint_1", 0.052), ("joint_2", 0.050), ("joint_3", 0.031)])
def test_noise_of_the_currents_is_that_of_the_joints_that_stand(joint: str, noise: float) -> None:
    case = chosen(read_joints(UR_FILES, UR), None, joint, "current", "*-50sec_12harm", None)
    assert case.floor == pytest.approx(noise, abs=1e-3)


def ladder(
    folder: Path, source: Path, joint: str, signal: str, holdout: str, without: str | None, kinds: Sequence[type[Term]]
) -> Judged:
    case = chosen(read_joints(folder, source), None, joint, signal, holdout, without)
    return Judged(climb(case.table, kinds), case.heldout, case.floor)


@pytest.fixture
def _no_waves(monkeypatch: pytest.MonkeyPatch) -> None:
    """Waves take minutes to try, and friction is found without them as well; make joints tries them."""
    monkeypatch.setattr("swgsim.joint.ladder.waves", lambda *_: [])


@with_ur
@pytest.mark.usefixtures("_no_waves")
@pytest.mark.parametrize("joint", ["joint_2", "joint_3"])
def test_friction_that_grows_with_the_load_is_found_where_there_is_load(joint: str) -> None:
    judged = ladder(UR_FILES, UR, joint, "current", "*-50sec_12harm,*-20sec_10harm", "*Load", SEARCHED)
    assert LoadDependentFriction in {type(step.term) for step in judged.ladder.steps}
    assert judged.after.heldout < 0.9 * judged.before.heldout


@with_ur
def test_friction_that_grows_with_the_load_is_not_claimed_of_an_upright_axis() -> None:
    """It carries no load but inertia. What the model lacks is the wave of both lobes of the wave generator, which the
    inertia of the arm holds back.
    """
    judged = ladder(UR_FILES, UR, "joint_1", "current", "*-50sec_12harm,*-20sec_10harm", "*Load", SEARCHED)
    assert LoadDependentFriction not in {type(step.term) for step in judged.ladder.steps}
    assert [step.term.order for step in judged.ladder.steps if isinstance(step.term, InertiaRipple)] == [202.0]
    assert judged.after.heldout < 0.98 * judged.before.heldout


@with_kinova
@pytest.mark.usefixtures("_no_waves")
def test_stribeck_friction_is_not_claimed_of_a_current_that_does_not_need_it() -> None:
    judged = ladder(KINOVA_FILES, KINOVA, "joint_7", "current", "S3", None, SEARCHED)
    assert StribeckFriction not in {type(step.term) for step in judged.ladder.steps}
