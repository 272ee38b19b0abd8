"""The virtual test bench: recordings without a word of what is hidden in them, and a truth that cannot be changed."""

import json
import re
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf

from swgsim.bench.truth import open_truth, truth_of
from swgsim.identification.report import close_loop as job
from swgsim.jobs import settings
from swgsim.jobs.record_on_bench import run
from swgsim.recordings.read import inspect_recordings, read_recordings
from swgsim.recordings.recording import Recording
from swgsim.storage.labelled_signals import SENSORS

pytestmark = pytest.mark.end_to_end
ROOT = Path(__file__).parents[2]
HIDDEN = [{"zero_offset": {"sensor": 2, "offset": 0.0123456}}]


def recorded(folder: Path, *overrides: str, **changes: Any) -> tuple[Recording, ...]:
    """Two operating points on a coarse mesh."""
    small = ("mesh.sectors=40", "speeds_rpm=[4000]", "loads_nm=[7,70]", "sessions.repeats=2", "sampling.rate=2000")
    with initialize_config_dir(str(ROOT / "conf"), version_base="1.3"):
        config = OmegaConf.to_container(compose("record", [*small, f"out={folder}", *overrides]), resolve=True)
    assert isinstance(config, dict)
    result = run({**config, **changes})
    assert result["recordings"] == len(read_recordings(folder).recordings)
    return read_recordings(folder).recordings


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("clean") / "a"
    recorded(folder)
    return folder


@pytest.fixture(scope="module")
def riddle(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("riddle") / "a"
    recorded(folder, "effect=tilting_moment", "seed=987654321", "unit=8765", hidden=HIDDEN)
    return folder


def test_the_same_command_writes_the_same_bytes(clean: Path, tmp_path: Path) -> None:
    recorded(tmp_path / "a")
    assert contents(tmp_path / "a") == contents(clean)
    assert truth_of(tmp_path / "a").read_bytes() == truth_of(clean).read_bytes()


def test_recordings_are_sound_and_numbered(clean: Path) -> None:
    recordings = inspect_recordings(clean)
    assert recordings.defects == ()
    assert [r.repeat for r in recordings] == [1, 1, 2, 2]
    elapsed = [r.conditions.elapsed for r in recordings]
    assert elapsed == sorted(elapsed)
    assert all(r.session == "1" and np.ptp(r.channels["phi_in"]) > 2 * np.pi * 11.9 for r in recordings)


def test_sessions_have_names_and_zeros_of_their_own(tmp_path: Path) -> None:
    of_sessions = ("sessions.sessions=2", "sessions.name=monday", "sessions.repeats=1", "condition.bench.flange_out=0")
    recordings = recorded(tmp_path / "a", *of_sessions, loads_nm=[0])
    zeros = {r.session: r.channels["T_out"].mean() for r in recordings}
    assert list(zeros) == ["monday-1", "monday-2"]
    assert abs(zeros["monday-1"] - zeros["monday-2"]) > 0.01


def test_the_folder_tells_nothing_of_what_is_hidden(riddle: Path) -> None:
    known = b"\n".join(contents(riddle).values())
    assert b"tilting_moment" in known
    for secret in (b"zero_offset", b"hidden", b"987654321"):
        assert secret not in known
    assert not {b"0.0123456", b"8765"} & set(re.split(rb"[^\w.]", known))
    unit = open_truth(riddle)["unit"]
    for secret in (unit["transmission"]["k1"], unit["wave_generator"]["w0"], unit["gauges"]["gain"][0]):
        assert repr(secret).encode() not in known
    assert yaml.safe_load((riddle / "gear.yaml").read_text())["transmission"]["k1"] == 4733.0
    assert [effect.name() for effect in settings.effects(str(riddle / "effects.yaml"))] == ["tilting_moment"]


def test_the_truth_opens_and_says_what_was_hidden(riddle: Path) -> None:
    truth = open_truth(riddle)
    assert truth["hidden"] == HIDDEN
    assert truth["choices"]["seed"] == 987654321
    checked = subprocess.run(["sha256sum", "--check", "a/seal.txt"], cwd=riddle.parent, check=False)
    assert checked.returncode == 0


def altered_truth(folder: Path) -> None:
    path = truth_of(folder)
    path.write_text(path.read_text().replace('"hidden": []', '"hidden": [{}]'))


def altered_sample(folder: Path) -> None:
    path = folder / "recording_0002.csv"
    path.write_text(path.read_text().replace("1", "2", 1))


@pytest.mark.parametrize(
    ("tamper", "message"),
    [
        (altered_truth, "a.truth.json is not the truth that was sealed"),
        (altered_sample, "a is not as it was recorded: recording_0002.csv changed"),
        (lambda folder: (folder / "recording_0001.csv").unlink(), "recording_0001.csv changed, added or removed"),
        (lambda folder: (folder / "note.txt").write_text("x"), "note.txt changed, added or removed"),
        (lambda folder: (folder / "seal.txt").write_text(""), "is not the truth that was sealed"),
        (lambda folder: (folder / "seal.txt").unlink(), "cannot be checked without it"),
        (lambda folder: truth_of(folder).unlink(), "cannot be checked without it"),
    ],
)
def test_tampering_is_detected(tamper: Any, message: str, clean: Path, tmp_path: Path) -> None:
    folder = tmp_path / "a"
    folder.mkdir()
    for name, content in contents(clean).items():
        (folder / name).write_bytes(content)
    truth_of(folder).write_bytes(truth_of(clean).read_bytes())
    assert open_truth(folder) == json.loads(truth_of(clean).read_text())
    tamper(folder)
    with pytest.raises(ValueError, match=message):
        open_truth(folder)


def test_the_truth_of_another_folder_is_not_shown_beside_an_answer(clean: Path, riddle: Path, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=rf"does not belong to the seal .*seal\.txt: give {truth_of(clean)}"):
        job._hidden(truth_of(riddle), str(clean))
    shown = job._hidden(truth_of(riddle), str(riddle))
    assert shown.startswith("a zero offset of s2: ")
    elsewhere = tmp_path / "kept.json"
    elsewhere.write_bytes(truth_of(riddle).read_bytes())
    assert job._hidden(elsewhere, str(riddle)) == shown
    assert job._hidden(elsewhere, str(tmp_path)) == shown  # without a seal nobody can tell


def test_a_hidden_zero_offset_moves_only_its_gauge(clean: Path, tmp_path: Path) -> None:
    sound, shifted = read_recordings(clean).recordings, recorded(tmp_path / "a", hidden=HIDDEN)
    for one, other in zip(sound, shifted, strict=True):
        assert (one.name, one.conditions) == (other.name, other.conditions)
        for name, values in one.channels.items():
            if name == SENSORS[2]:
                np.testing.assert_allclose(other.channels[name] - values, 0.0123456, atol=1e-4)
            else:
                np.testing.assert_array_equal(other.channels[name], values)


def test_a_hidden_effect_with_a_random_phase_moves_no_other_draw(clean: Path, tmp_path: Path) -> None:
    hidden = [{"mains_hum": {"amplitude": 0.001}}]
    for one, other in zip(read_recordings(clean).recordings, recorded(tmp_path / "a", hidden=hidden), strict=True):
        np.testing.assert_array_equal(other.channels["T_in"], one.channels["T_in"])
        assert 1e-4 < np.abs(other.channels["s1"] - one.channels["s1"]).max() < 2e-3


def test_commissioning_and_test_are_of_one_unit_on_other_days(clean: Path, riddle: Path, tmp_path: Path) -> None:
    recorded(tmp_path / "a", "sessions.name=commissioning", "label=healthy")
    units = [open_truth(folder)["unit"] for folder in (clean, tmp_path / "a", riddle)]
    assert units[0] == units[1]
    assert units[0] != units[2]
    first, commissioning = read_recordings(clean).recordings[0], read_recordings(tmp_path / "a").recordings[0]
    assert (commissioning.session, commissioning.label, first.label) == ("commissioning", "healthy", "")
    assert not np.array_equal(first.channels["s1"], commissioning.channels["s1"])


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"hidden": [{"cam": {}}]}, "unknown effect 'cam'. The library has"),
        ({"hidden": "nowhere.yaml"}, "no file of effects 'nowhere.yaml'; give a list such as"),
        ({"speeds_rpm": 2000}, r"speeds_rpm is 2000, must be a list such as \[2000\]"),
        ({"loads_nm": []}, r"operating points of the sessions are \(\), must be one or more"),
        ({"loads_nm": [7, 7]}, "each once"),
        ({"sessions": {"repeats": 0}}, "repeats of the sessions is 0, must be an integer from 1"),
        ({"instruments": {"wander": -1}}, "wander of the instruments is -1, must be a finite number from 0"),
        ({"condition": {"name": "clean", "bench": None}}, "condition clean has no bench.*condition=bench"),
    ],
)
def test_a_bad_choice_is_named_and_leaves_nothing(changes: dict[str, Any], message: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=message):
        recorded(tmp_path / "a", **changes)
    assert not list(tmp_path.iterdir())


def test_nothing_is_overwritten(clean: Path, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"a is there already: remove it, or choose another folder with out=\.\.\."):
        recorded(clean)
    truth_of(tmp_path / "a").touch()
    with pytest.raises(ValueError, match=r"a\.truth\.json is there already"):
        recorded(tmp_path / "a")
