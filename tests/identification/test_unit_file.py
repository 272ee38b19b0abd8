"""A commissioned unit in a file: the same answers, the same bytes, and nothing that runs."""

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import h5py
import pytest
import small_bench
import yaml
from recording_fixtures import sealed
from small_bench import coarse_model

from swgsim.effects import EccentricWaveGenerator, Effect, FlankFriction
from swgsim.effects.line_between import FixedFrequency
from swgsim.effects.quantity import size
from swgsim.gear.gear import OperatingPoint
from swgsim.identification import Unit, commission, commission_job, identify
from swgsim.identification.fit.unit_file import is_unit_file
from swgsim.identification.report import close_loop as job
from swgsim.jobs.settings import gear
from swgsim.recordings import write_folder
from swgsim.storage.attributes import set_attributes
from swgsim.storage.storage import SEAL_SIZE, seal

pytestmark = [pytest.mark.end_to_end, pytest.mark.slow]

GEAR = yaml.safe_load((Path(__file__).parents[2] / "conf" / "gear" / "gear1.yaml").read_text())
POINTS = tuple(OperatingPoint(n, T) for n in (2000.0, 4000.0) for T in (7.0, 39.0))
recorded = partial(small_bench.recorded, gear(GEAR), points=POINTS)
DECLARED = (FlankFriction(1.3), FixedFrequency(1e-3, phase=0.1, pattern="in s1 alone", frequency=50.1))


class Kink(Effect):
    """An effect of a user, in a module that can be imported."""

    place = "mesh"
    height: float = size(unit="-", low=0, high=1, typical=0.1)


@pytest.fixture(scope="module", autouse=True)
def _small_mesh():
    with coarse_model():
        yield


@pytest.fixture(scope="module")
def unit() -> Unit:
    return commission(recorded(DECLARED[0], seed=1), gear(GEAR), declared=DECLARED)


@pytest.fixture(scope="module")
def path(unit: Unit, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("units") / "gear.unit.h5"
    unit.save(path)
    return path


@pytest.mark.slow
def test_answers_from_the_file_are_those_of_the_unit(unit: Unit, path: Path) -> None:
    recordings = recorded(DECLARED[0], EccentricWaveGenerator(3e-5, 1.0), seed=2)
    reports = [identify(recordings, each, effects=[EccentricWaveGenerator]).report for each in (unit, Unit.load(path))]
    one, other = (json.dumps({**report, "seconds": 0, "made": {}}) for report in reports)
    assert one == other
    assert reports[0]["effects"]


def test_the_same_unit_has_the_same_bytes_and_a_few_megabytes(unit: Unit, path: Path, tmp_path: Path) -> None:
    found = Unit.load(path)
    found.save(tmp_path / "again.unit.h5")
    assert (tmp_path / "again.unit.h5").read_bytes() == path.read_bytes()
    assert path.stat().st_size < 5e6
    assert found.model.effects == unit.model.effects
    assert found.interharmonics == DECLARED[1:]
    assert is_unit_file(path)
    assert [each.name for each in path.parent.iterdir()] == [path.name]


def _spoiled(path: Path, to: Path, change: Callable[[h5py.File], object]) -> Path:
    to.write_bytes(path.read_bytes())
    with h5py.File(to, "a") as file:
        change(file)
    seal(to, "unit")
    return to


def _version(file: h5py.File) -> None:
    set_attributes(file, version="0-older", swgsim="0.1.9")


def _effect(name: str, file: h5py.File) -> None:
    set_attributes(file["unit/model/effects"], **{"0": json.dumps({name: {}})})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (_version, r"version 0-older of the format, written by swgsim 0\.1\.9, expected 1-"),
        (lambda file: file["unit/model"].__delitem__("gear"), r"unit\.model\.gear: found nothing, expected Gear"),
        (lambda file: file["unit/nominal/transmission"].attrs.create("N", 5), r"nominal\.transmission: N .* 5, must"),
        (partial(_effect, "cam_forms"), r"unit\.model\.effects\.0: unknown effect 'cam_forms'"),
        (partial(_effect, "antigravity:fly"), r"effects\.0: found the effect 'antigravity:fly', whose module is not"),
        (lambda file: file["unit"].__delitem__("reach"), "a unit that was not commissioned"),
        (lambda file: (file["unit"].__delitem__("shift"), file["unit"].create_dataset("shift", data=[0.5])),
         "its directions are not those of this version"),
    ],
)  # fmt: skip
def test_a_file_of_another_form_is_refused_with_the_field(path, tmp_path, change, message) -> None:
    spoiled = _spoiled(path, tmp_path / "spoiled.unit.h5", change)
    with pytest.raises(ValueError, match=rf"spoiled\.unit\.h5: .*{message}.*; commission"):
        Unit.load(spoiled)
    assert "antigravity" not in sys.modules


def test_what_is_no_file_of_a_unit_is_refused(path: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.h5"
    with pytest.raises(ValueError, match=r"other\.h5: no such file, expected a unit; commission"):
        Unit.load(other)
    other.write_bytes(sealed(b"recordings"))
    with pytest.raises(ValueError, match=r"other\.h5: not a file of unit"):
        Unit.load(other)
    other.write_bytes(path.read_bytes()[: SEAL_SIZE + 5000])
    with pytest.raises(ValueError, match=r"other\.h5: damaged or truncated.*; commission the unit again"):
        Unit.load(other)
    assert not is_unit_file(tmp_path)


def test_an_effect_of_a_user_is_kept_by_its_import_path(unit: Unit, tmp_path: Path) -> None:
    own = replace(unit, model=replace(unit.model, effects=(*unit.model.effects, Kink())))
    own.save(tmp_path / "own.unit.h5")
    assert Unit.load(tmp_path / "own.unit.h5").model.effects[-1] == Kink()


class Asked(Exception):
    """Instead of an answer, with the unit that it would be of."""


def test_the_commands_keep_a_unit_and_use_it(unit: Unit, tmp_path: Path, capsys, monkeypatch) -> None:
    def ask(_: object, asked: Unit, **choices: object) -> None:
        raise Asked(asked)

    monkeypatch.setattr(commission_job, "commission", lambda *_, **choices: unit)
    monkeypatch.setattr(job, "identify", ask)
    write_folder(tmp_path / "recordings", recorded(seed=1))
    kept = str(tmp_path / "gear.unit.h5")
    chosen = {"recordings": str(tmp_path / "recordings"), "mapping": None, "gear": GEAR, "effects": [], "out": kept}
    commission_job.run(chosen)
    assert f"{kept}: Unit of gear 1, commissioned on 8 recordings" in capsys.readouterr().out
    chosen |= {
        "commissioning": kept, "commissioning_mapping": None, "out": str(tmp_path / "answer"), "searched": None,
        "library": [], "truth": None, "interest": 0.2, "seed": 0,
    }  # fmt: skip
    with pytest.raises(Asked) as asked:
        job.run(chosen)
    assert asked.value.args[0].model.gear == unit.model.gear
    with pytest.raises(ValueError, match=r"effects= is for recordings, commissioning=.* is a unit that has it"):
        job.run(chosen | {"effects": [{"gauge_gain": {"sensor": 1, "share": 0.1}}]})
