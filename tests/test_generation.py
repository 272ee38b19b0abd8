"""Configuration of data sets: every choice builds, wrong ones are answered with the choices."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf

from swgsim import settings, storage
from swgsim.generation import run

ROOT = Path(__file__).parent.parent
CONF = ROOT / "conf"


def configuration(*overrides: str) -> dict[str, Any]:
    with initialize_config_dir(str(CONF), version_base="1.3"):
        return OmegaConf.to_container(compose("generate", list(overrides)), resolve=True)


@pytest.mark.parametrize("group", ["grid", "condition", "mesh", "window"])
def test_every_choice_of_every_group_builds(group: str) -> None:
    for file in sorted((CONF / group).glob("*.yaml")):
        config = configuration(f"{group}={file.stem}")
        assert len(settings.plan(config)) > 0
        settings.disturbance(config)


def test_the_paper_grid_has_6480_recordings_and_references() -> None:
    plan = settings.plan(configuration())
    assert len(plan) == 6480 + 3 * 6 * 20
    b1 = [gear.transmission.b1 for gear in plan.gears]
    assert b1[1] / b1[0] == pytest.approx(1.2)
    assert b1[2] / b1[0] == pytest.approx(0.8)


def test_the_sampled_grid_has_thirty_gears() -> None:
    plan = settings.plan(configuration("grid=sampled"))
    assert len(plan.gears) == 30
    assert len(plan) == 64_800 + 30 * 6 * 20


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
        ("grid.classes=[healthy,rusty]", "unknown class 'rusty'; choose from healthy"),
        ("grid.classes=[]", "the grid is empty"),
        ("grid.severities.root_tooth_crack=[0.1,0.03,0]", "stiffness_ratio of the root tooth crack is 0"),
        ("gears.gear1.gauges.gain=[1,1,1]", "gain has 3 values, expected one for each"),
    ],
)
def test_bad_choices_name_value_and_limit(override: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=message):
        run(configuration("grid=small", override, f"data={tmp_path}", "workers=1"))
    assert not list(tmp_path.glob("*.h5"))


def test_an_unknown_grid_is_answered_with_the_grids() -> None:
    command = [sys.executable, "scripts/generate.py", "grid=huge"]
    answer = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert answer.returncode != 0
    for choice in ("paper", "small", "sampled"):
        assert choice in answer.stderr


def test_disturbed_makes_the_clean_one_first_and_nothing_twice(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tiny = ["grid=small", "grid.variants=3", "grid.positions=1", "grid.references=1", f"data={tmp_path}", "workers=1"]
    disturbed = configuration(*tiny, "condition=disturbed", "mesh.sectors=60")
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
