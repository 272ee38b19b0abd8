"""The zero of the angle: what no unit and no effect explains is told and taken out, all else is not."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from bench_fixtures import POINTS, good, with_channel
from chain_fixtures import GEAR, SECTORS

from swgsim.chain.chain import Run, simulate_turns
from swgsim.dataset.faults import FAULTS
from swgsim.effects import Effect
from swgsim.effects.channel_skew import ChannelSkew
from swgsim.effects.gauge_position import GaugePosition
from swgsim.effects.lobe_shift import LobeShift
from swgsim.effects.tilting_moment import TiltingMoment
from swgsim.gear.gear import Gear
from swgsim.gear.population import Population
from swgsim.identification import calls
from swgsim.identification.data import angle_zero
from swgsim.identification.data.angle_zero import from_zero, zero_defects, zero_of
from swgsim.identification.data.model import Model, predict
from swgsim.identification.report.answer import Answer
from swgsim.recordings.checks.thresholds import ANGLE_ZERO
from swgsim.recordings.read import read_recordings
from swgsim.recordings.recording import Recording
from swgsim.studies.examples import EXAMPLES

Recordings = tuple[Recording, ...]
EFFECTS = (
    TiltingMoment(0.05, 1.0),
    ChannelSkew(100e-6),
    ChannelSkew(-100e-6),
    LobeShift(0.05),
    LobeShift(0.2),
    GaugePosition(2, 0.1),
)
CORNERS = (POINTS[0], POINTS[-1])
GEAR_1 = Path(__file__).parents[2] / "conf" / "gear" / "gear1.yaml"


@pytest.fixture(scope="module", autouse=True)
def _predicted_once():
    """The same gear at the same points is asked for again and again here."""
    once = cache(lambda models, situations, layout: predict(models, situations, layout))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(angle_zero, "predict", lambda models, s, layout: once(tuple(models), tuple(s), layout))
        yield


def ahead(recordings: Recordings, angle: float) -> Recordings:
    return tuple(with_channel(each, "phi_in", each.channels["phi_in"] + angle) for each in recordings)


def turning(*units: tuple[Gear, tuple[Effect, ...]]) -> list[Recordings]:
    """Two revolutions without noise of several units, each at the least and at full load and speed."""
    runs = [Run(gear, point, effects) for gear, effects in units for point in CORNERS]
    found = simulate_turns(runs, revolutions=2, points=64, sectors=SECTORS)
    return [tuple(found[i : i + len(CORNERS)]) for i in range(0, len(found), len(CORNERS))]


def zero(recordings: Recordings) -> float:
    return zero_of(recordings, Model(GEAR))


@pytest.mark.parametrize(("angle", "said"), [(0.6, 0.6), (-0.4, -0.4), (0.15, 0.15), (0.6 + np.pi, 0.6)])
def test_another_zero_is_told_and_taken_out(angle: float, said: float) -> None:
    recordings = ahead(good(), angle)
    found = zero(recordings)
    assert found == pytest.approx(said, abs=0.02)
    assert zero(from_zero(recordings, found)) == 0
    (warning,) = zero_defects(recordings, found)
    assert warning.severity == "warn"
    assert f"{found:.3f} rad ahead" in warning.found
    assert "known up to half a turn" in warning.found
    assert not list(zero_defects(recordings, 0.0))


def test_it_is_found_by_one_gauge_and_through_an_eccentricity() -> None:
    eccentric = ahead(good(effects=(EXAMPLES["eccentric_wave_generator"],)), 0.6)
    one = tuple(replace(r, channels={name: r.channels[name] for name in ("phi_in", "s3")}) for r in good())
    for recordings in (eccentric, ahead(one, 0.6)):
        assert zero(recordings) == pytest.approx(0.6, abs=0.02)
    bare = tuple(replace(r, channels={name: r.channels[name] for name in ("phi_in", "s0")}) for r in good())
    assert zero(ahead(bare, 0.6)) == 0


@pytest.mark.parametrize("angle", [0.03, -0.03, np.pi])
def test_an_index_set_as_usual_is_taken_and_half_a_turn_is_not_seen(angle: float) -> None:
    assert zero(ahead(good(), angle)) == 0


def test_units_faults_and_strong_effects_are_taken() -> None:
    units = Population(8, w0_ratio=(0.9, 1.1), position=0.01).draw(GEAR, seed=4)
    effects = (*(EXAMPLES[label] for label in FAULTS), *EFFECTS)
    for recordings in turning(*((unit, ()) for unit in units), *((GEAR, (effect,)) for effect in effects)):
        for index in (-0.04, 0.04):
            assert zero(ahead(recordings, index)) == 0


def test_a_zero_in_a_column_map_mends_it(tmp_path: Path) -> None:
    folder, path = tmp_path / "foreign", tmp_path / "map.yaml"
    folder.mkdir()
    recordings = ahead(good(), 0.6)
    files = {}
    for each in recordings:
        degrees = np.degrees(each.channels["phi_in"])
        columns = {"t": each.time, "angle": -degrees, "s1": each.channels["s1"]}
        pd.DataFrame(columns).to_csv(folder / f"{each.name}.csv", index=False)
        files[f"{each.name}.csv"] = {
            "n_in_rpm": each.point.n_in_rpm, "T_out_nm": each.point.T_out, "repeat": each.repeat,
        }  # fmt: skip
    angle = {"column": "angle", "unit": "deg", "inverted": True}
    channels = {"t": {"column": "t", "unit": "s"}, "s1": {"column": "s1", "unit": "mV/V"}, "phi_in": angle}
    source = {"channels": channels, "facts": {"gear": "A", "session": "1"}, "files": files}
    for mended in (0.0, 0.6):
        path.write_text(yaml.safe_dump(source | {"channels": {**channels, "phi_in": {**angle, "zero_rad": mended}}}))
        assert zero(read_recordings(folder, path).recordings) == pytest.approx(0.6 - mended, abs=0.02)


def test_recordings_and_commissioning_are_counted_from_the_zero_of_the_gear(monkeypatch: pytest.MonkeyPatch) -> None:
    healthy, later = good(points=CORNERS), good(points=CORNERS, turns=13)
    recordings = tuple(replace(each, session="later") for each in later)
    seen, warnings = [], []
    monkeypatch.setattr(
        calls, "learn_unit", lambda measured, unit: seen.append(measured.recordings) or replace(unit, healthy=seen[0])
    )
    monkeypatch.setattr(calls, "answer", lambda recordings, *_, **__: seen.append(recordings) or object.__new__(Answer))
    monkeypatch.setattr(calls, "next_experiments", lambda found: None)
    monkeypatch.setattr(calls, "report", lambda found, kinds, more, defects, *_: warnings.extend(defects) or {})
    calls.identify(ahead(recordings, 0.6), calls.commission(ahead(healthy, 0.6), GEAR))
    for given, rights in zip(seen, (healthy, recordings), strict=True):
        for each, right in zip(given, rights, strict=True):
            np.testing.assert_allclose(each.channels["phi_in"], right.channels["phi_in"], atol=0.02)
    assert [(defect.kind, defect.severity) for defect in warnings] == [("angle_zero", "warn")]


@pytest.mark.parametrize("moved", [0.0, 0.4])
def test_recordings_of_another_zero_than_their_commissioning_are_refused(
    monkeypatch: pytest.MonkeyPatch, moved: float
) -> None:
    monkeypatch.setattr(calls, "learn_unit", lambda measured, unit: replace(unit, healthy=measured.recordings))
    unit = calls.commission(ahead(good(points=CORNERS), moved), GEAR)
    with pytest.raises(
        ValueError,
        match=rf"(?s)recordings: these .* (0.59|0.60)\d rad ahead .*{ANGLE_ZERO} rad.*zero_rad.*\[angle_zero\]",
    ):
        calls.identify(ahead(good(points=CORNERS, turns=13), 0.6 + moved), unit)
