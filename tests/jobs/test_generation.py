"""Configuration of data sets: every choice builds, wrong ones are answered with the choices."""

import fcntl
from pathlib import Path
from typing import IO, Any

import pytest
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf

from swgsim.commands.mistakes import unknown
from swgsim.common.files import sole_maker
from swgsim.jobs import settings
from swgsim.jobs.generate_data_set import run
from swgsim.storage import storage

pytestmark = pytest.mark.end_to_end
ROOT = Path(__file__).parents[2]
CONF = ROOT / "conf"


def configuration(*overrides: str) -> dict[str, Any]:
    with initialize_config_dir(str(CONF), version_base="1.3"):
        return OmegaConf.to_container(compose("generate", list(overrides)), resolve=True)


@pytest.mark.parametrize("group", ["grid", "condition", "mesh", "window"])
def test_every_choice_of_every_group_builds(group: str) -> None:
    for file in sorted((CONF / group).glob("*.yaml")):
        config = configuration(f"{group}={file.stem}")
        settings.plan(config)
        settings.disturbance(config)


def test_the_grids_have_the_recordings_of_their_gears_and_the_references() -> None:
    plan = settings.plan(configuration())
    assert len(plan) == 6480 + 3 * 6 * 20
    b1 = [gear.transmission.b1 for gear in plan.gears]
    assert [b1[1] / b1[0], b1[2] / b1[0]] == pytest.approx([1.2, 0.8])
    sampled = settings.plan(configuration("grid=sampled"))
    assert (len(sampled.gears), len(sampled)) == (30, 64_800 + 30 * 6 * 20)


def test_one_more_gear_is_one_word() -> None:
    plan = settings.plan(configuration("+gear@gears.mine=gear3", "gears.mine.number=4"))
    assert [gear.number for gear in plan.gears] == [1, 2, 3, 4]


def test_misspelt_parameters_are_answered_with_the_choices() -> None:
    config = configuration()
    config["gears"]["gear1"]["transmission"]["k3"] = 1.0
    with pytest.raises(ValueError, match=r"unknown choice 'k3' of Transmission; choose from N, alpha_tooth, k1, k2"):
        settings.plan(config)


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("gears.gear1.transmission.k1=-5", "k1 of the transmission is -5"),
        ("mesh.sectors=33", "must be even"),
        ("grid.classes=[healthy,rusty]", "unknown choice 'rusty' of the classes; choose from healthy"),
        ("grid.classes=[]", "the grid is empty"),
        ("grid.severities.root_tooth_crack=[0.1,0.03,0]", "stiffness_ratio of root tooth crack is 0"),
        ("gears.gear1.gauges.gain=[1,1,1]", "gain has 3 values, expected one for each"),
        ("grid.name=../paper", r"name of the grid is '../paper', must be of letters, digits"),
        ("condition.name=''", "name of the condition is '', must be of letters, digits"),
        ("workers=0", "workers is 0, must be an integer from 1, or null"),
        ("workers=1.5", "workers is 1.5, must be an integer"),
    ],
)
def test_bad_choices_name_value_and_limit(override: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=message):
        run(configuration("grid=small", f"data={tmp_path}", "workers=1", override))
    assert not list(tmp_path.iterdir())


def tiny(data: Path, *overrides: str) -> dict[str, Any]:
    """The smallest grid on a coarse mesh."""
    sizes = ("grid.variants=3", "grid.positions=1", "grid.references=1", "mesh.sectors=60")
    return configuration("grid=small", *sizes, f"data={data}", "workers=1", *overrides)


def test_disturbed_makes_the_clean_one_first_and_nothing_twice(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    disturbed = tiny(tmp_path, "condition=disturbed")
    first = run(disturbed)
    assert first["recordings"] == 3 * 4 * (1 + 6 * 3)
    assert {p.name for p in tmp_path.glob("*.h5")} == {"small-clean.h5", "small-disturbed.h5"}
    capsys.readouterr()
    assert run(disturbed) == first
    assert "is there already" in capsys.readouterr().out

    # A damaged file is told of and made again.
    path = tmp_path / "small-disturbed.h5"
    content = path.read_bytes()
    path.write_bytes(content[:-1])
    run(disturbed)
    assert "damaged or truncated" in capsys.readouterr().out
    assert path.read_bytes() == content
    assert "speeds_rpm" in storage.attributes(path)["configuration"]


def test_a_data_set_of_other_choices_is_replaced_aloud(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    point = ("grid.speeds_rpm=[2000]", "grid.loads_nm=[7]")
    path = Path(run(tiny(tmp_path, *point))["path"])
    assert "replaced" not in capsys.readouterr().out
    run(tiny(tmp_path, *point, "window.samples=700"))
    assert f"{path} was made by other choices and is replaced" in capsys.readouterr().out
    assert storage.read(path).signals.shape[2] == 700


def test_a_lock_that_its_owner_removes_meanwhile_keeps_others_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Removed after this process has opened it and before it has locked it."""
    path, lock = tmp_path / "a.h5", tmp_path / ".a.h5.lock"
    flock = fcntl.flock

    def late(raw: IO[bytes], how: int) -> None:
        monkeypatch.setattr(fcntl, "flock", flock)
        lock.unlink()
        flock(raw, how)

    monkeypatch.setattr(fcntl, "flock", late)
    with sole_maker(path):
        with pytest.raises(RuntimeError, match="another process"), sole_maker(path):
            pass
        assert lock.exists()
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("script", "word", "choices"),
    [
        ("generate", "grid.varients=3", "speeds_rpm, variants"),
        ("train", "clasifier=rf", "classifier, compute"),
    ],
)
def test_a_misspelt_key_is_answered_with_the_keys(script: str, word: str, choices: str) -> None:
    (answer,) = unknown(script, [word])
    assert f"unknown choice '{word.split('=')[0].split('.')[-1]}'; did you mean" in answer
    assert choices in answer
